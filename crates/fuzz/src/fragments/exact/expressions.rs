//! Expressions of a type.

use super::{MATRICES, Writer, array, matrix, parenthesized, shape, vector};

impl Writer {
    pub(super) fn expr(&mut self, ty: &str, depth: usize) -> String {
        if depth == 0 || self.random.pick(6) == 0 {
            let places = self.places(ty, false);
            return if places.is_empty() || self.random.pick(3) == 0 {
                self.literal(ty)
            } else {
                places[self.random.pick(places.len())].clone()
            };
        }
        let depth = depth - 1;
        match self.random.pick(14) {
            0 => {
                let (condition, yes, no) = (self.expr("bool", depth), self.expr(ty, depth), self.expr(ty, depth));
                // Arrays are not allowed in `?:`.
                return if array(ty).is_some() { yes } else { format!("({condition} ? {yes} : {no})") };
            }
            1 if array(ty).is_none() => {
                let (first, second) = (self.assignment(depth), self.expr(ty, depth));
                return format!("({first}, {second})");
            }
            2 | 3 => {
                if let Some(call) = self.call_of(ty, depth) {
                    return call;
                }
            }
            4 if array(ty).is_none() => {
                if let Some(place) = self.place(ty) {
                    let value = self.expr(ty, depth);
                    return format!("({place} = {value})");
                }
            }
            _ => {}
        }
        if let Some((class, size)) = shape(ty) {
            return match class {
                0 => self.floats(size, depth),
                1 => self.ints(size, depth),
                2 => self.uints(size, depth),
                _ => self.bools(size, depth),
            };
        }
        if let Some((columns, rows)) = matrix(ty) {
            return self.matrices(ty, columns, rows, depth);
        }
        if let Some((element, len)) = array(ty) {
            let list: Vec<String> = (0..len).map(|_| self.expr(element, depth.min(1))).collect();
            return format!("{ty}({})", list.join(", "));
        }
        let members = ["float", "ivec2", "vec3[2]", "mat2"].map(|member| self.expr(member, depth.min(1)));
        format!("S({})", members.join(", "))
    }

    pub(super) fn two(&mut self, ty: &str, depth: usize) -> (String, String) {
        (self.expr(ty, depth), self.expr(ty, depth))
    }

    fn floats(&mut self, size: usize, depth: usize) -> String {
        let ty = vector(0, size);
        match self.random.pick(if size == 1 { 14 } else { 12 }) {
            0..=2 => {
                let operator = self.random.one_of(&["+", "-", "*"]);
                let (a, b) = self.two(ty, depth);
                let value = format!("({a} {operator} {b})");
                if operator == "*" { format!("clamp({value}, -100.0, 100.0)") } else { value }
            }
            3 => {
                let (a, b) = (self.expr(ty, depth), self.expr("float", depth));
                format!("({a} * clamp({b}, -2.0, 2.0))")
            }
            4 => {
                let function = self.random.one_of(&["abs", "floor", "sign", "ceil", "fract", "trunc"]);
                format!("{function}({})", self.expr(ty, depth))
            }
            5 => {
                let function = self.random.one_of(&["min", "max", "step"]);
                let (a, b) = self.two(ty, depth);
                format!("{function}({a}, {b})")
            }
            6 => format!("clamp({}, -4.0, 4.0)", self.expr(ty, depth)),
            7 => {
                let (a, b) = self.two(ty, depth);
                let factor = self.expr(vector(3, size), depth);
                if size == 1 { format!("mix({a}, {b}, {factor})") } else { format!("mix({a}, {b}, 0.5)") }
            }
            8 => match self.random.pick(3) {
                0 => format!("{ty}({} & 0xff)", self.expr(vector(1, size), depth)),
                1 => format!("{ty}({} & 0xffu)", self.expr(vector(2, size), depth)),
                _ => format!("{ty}({})", self.expr(vector(3, size), depth)),
            },
            9 => {
                let from = 2 + self.random.pick(3);
                let base = self.expr(vector(0, from), depth);
                let swizzle: String =
                    (0..size).map(|_| "xyzw".chars().nth(self.random.pick(from)).expect("in range")).collect();
                format!("({base}).{swizzle}")
            }
            10 if size == 2 => format!("({} * {})", self.expr("mat2", depth), self.expr("vec2", depth)),
            10 if size == 3 => format!("({} * {})", self.expr("mat2x3", depth), self.expr("vec2", depth)),
            10 | 11 => format!("-{}", parenthesized(&self.expr(ty, depth))),
            12 => {
                let vector = vector(0, 2 + self.random.pick(3));
                let (a, b) = self.two(vector, depth);
                format!("clamp(dot({a}, {b}), -100.0, 100.0)")
            }
            _ => format!("determinant({})", self.expr("mat2", depth)),
        }
    }

    fn ints(&mut self, size: usize, depth: usize) -> String {
        let ty = vector(1, size);
        match self.random.pick(9) {
            0..=2 => {
                let operator = self.random.one_of(&["+", "-", "*", "&", "|", "^"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} {b})")
            }
            3 => {
                let (a, b) = self.two(ty, depth);
                format!("({a} / (({b} & 7) + 1))")
            }
            4 => {
                let (a, b) = self.two(ty, depth);
                format!("(({a} & 0xffff) % (({b} & 7) + 1))")
            }
            5 => {
                let operator = self.random.one_of(&["<<", ">>"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} ({b} & 31))")
            }
            6 if size == 1 => match self.place("int") {
                Some(place) => match self.random.pick(4) {
                    0 => format!("{place}++"),
                    1 => format!("--{place}"),
                    2 => format!("++{place}"),
                    _ => format!("{place}--"),
                },
                None => format!("~{}", parenthesized(&self.expr(ty, depth))),
            },
            7 => format!("{ty}(clamp({}, -1000.0, 1000.0))", self.expr(vector(0, size), depth)),
            _ => {
                let function = self.random.one_of(&["abs", "sign", "-", "~"]);
                format!("{function}({})", self.expr(ty, depth))
            }
        }
    }

    fn uints(&mut self, size: usize, depth: usize) -> String {
        let ty = vector(2, size);
        match self.random.pick(6) {
            0 | 1 => {
                let operator = self.random.one_of(&["+", "-", "*", "&", "|", "^"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} {b})")
            }
            2 => {
                let operator = self.random.one_of(&["/", "%"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} (({b} & 15u) + 1u))")
            }
            3 => {
                let operator = self.random.one_of(&["<<", ">>"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} ({b} & 31u))")
            }
            4 => format!("{ty}({})", self.expr(vector(1, size), depth)),
            _ => {
                let (a, b) = self.two(ty, depth);
                format!("max({a}, {b})")
            }
        }
    }

    fn bools(&mut self, size: usize, depth: usize) -> String {
        if size > 1 {
            let class = self.random.pick(3);
            let (a, b) = self.two(vector(class, size), depth);
            let function = self.random.one_of(&["lessThan", "greaterThanEqual", "equal", "notEqual"]);
            return format!("{function}({a}, {b})");
        }
        match self.random.pick(8) {
            0..=2 => {
                let ty = ["int", "uint", "float"][self.random.pick(3)];
                let operator = self.random.one_of(&["<", ">=", "<=", ">"]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} {b})")
            }
            3 => {
                let ty = ["ivec2", "S", "ivec3[2]", "mat2", "bool", "uvec2"][self.random.pick(6)];
                let operator = self.random.one_of(&["==", "!="]);
                let (a, b) = self.two(ty, depth);
                format!("({a} {operator} {b})")
            }
            4 | 5 => {
                let operator = self.random.one_of(&["&&", "||", "^^"]);
                let (a, b) = self.two("bool", depth);
                format!("({a} {operator} {b})")
            }
            6 => format!("!{}", parenthesized(&self.expr("bool", depth))),
            _ => {
                let function = self.random.one_of(&["any", "all"]);
                let size = 2 + self.random.pick(2);
                format!("{function}({})", self.expr(vector(3, size), depth))
            }
        }
    }

    fn matrices(&mut self, ty: &str, columns: usize, rows: usize, depth: usize) -> String {
        match self.random.pick(6) {
            0 => {
                let (a, b) = self.two(ty, depth);
                format!("({a} {} {b})", self.random.one_of(&["+", "-"]))
            }
            1 => {
                let (a, b) = self.two(ty, depth);
                format!("matrixCompMult({a}, {b})")
            }
            2 => {
                let list: Vec<String> = (0..columns).map(|_| self.expr(vector(0, rows), depth.min(1))).collect();
                format!("{ty}({})", list.join(", "))
            }
            3 if columns == rows => format!("transpose({})", self.expr(ty, depth)),
            3 if ty == "mat2x3" => format!("transpose({})", self.expr("mat3x2", depth)),
            4 if columns == rows => {
                let other = MATRICES[self.random.pick(2)];
                format!("{ty}({})", self.expr(other, depth))
            }
            _ => {
                let (a, b) = (self.expr(vector(0, rows), depth), self.expr(vector(0, columns), depth));
                format!("outerProduct({a}, {b})")
            }
        }
    }
}
