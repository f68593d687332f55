//! Generates random fragment shaders as text. They are well-typed and contain nothing that GLSL leaves undefined (no
//! index out of bounds, no division by zero, no read before a write). They contain everything that a lowering has to
//! get right: side effects in expressions, `out` parameters that name one variable twice, fall-through cases, names
//! that hide others, aggregates by value.
//!
//! *Holds:* the same seed gives the same text. Numbers remain small dyadic fractions where possible, so that most
//! results are exact and the reference's bound is narrow.

mod expressions;

use std::fmt::Write;

/// Random numbers from a seed, the same in every run.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def0);
        for _ in 0..4 {
            random.pick(2);
        }
        random
    }

    fn pick(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % count
    }

    fn one_of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> &'a T {
        list[self.pick(list.len())]
    }
}

/// A variable in scope.
#[derive(Clone)]
struct Variable {
    name: String,
    ty: &'static str,
    writable: bool,
}

/// A function that may be called: its name, result and parameters with their modes.
struct Callable {
    name: String,
    ret: &'static str,
    params: Vec<(&'static str, &'static str)>,
}

const STRUCT: &str = "struct S { float f; ivec2 i; vec3 v[2]; mat2 m; };\n";
const SCALARS: [&str; 4] = ["float", "int", "uint", "bool"];
const VECTORS: [[&str; 3]; 4] =
    [["vec2", "vec3", "vec4"], ["ivec2", "ivec3", "ivec4"], ["uvec2", "uvec3", "uvec4"], ["bvec2", "bvec3", "bvec4"]];
const MATRICES: [&str; 4] = ["mat2", "mat3", "mat2x3", "mat3x2"];
/// The types of locals.
const TYPES: [&str; 21] = [
    "float", "float", "int", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec3", "uvec2", "uvec4",
    "bvec2", "bvec3", "mat2", "mat3", "mat2x3", "S", "float[4]", "ivec3[2]",
];

/// The class of a scalar or vector and its size.
fn shape(ty: &str) -> Option<(usize, usize)> {
    if let Some(class) = SCALARS.iter().position(|scalar| *scalar == ty) {
        return Some((class, 1));
    }
    let class = VECTORS.iter().position(|row| row.contains(&ty))?;
    Some((class, VECTORS[class].iter().position(|name| *name == ty)? + 2))
}

fn vector(class: usize, size: usize) -> &'static str {
    if size == 1 { SCALARS[class] } else { VECTORS[class][size - 2] }
}

/// The columns and rows of a matrix type.
fn matrix(ty: &str) -> Option<(usize, usize)> {
    Some(match ty {
        "mat2" => (2, 2),
        "mat3" => (3, 3),
        "mat2x3" => (2, 3),
        "mat3x2" => (3, 2),
        _ => return None,
    })
}

/// The element type and the length of an array type.
fn array(ty: &str) -> Option<(&'static str, usize)> {
    Some(match ty {
        "float[4]" => ("float", 4),
        "ivec3[2]" => ("ivec3", 2),
        "vec3[2]" => ("vec3", 2),
        _ => return None,
    })
}

/// A random fragment shader.
pub fn fragment(seed: u64) -> String {
    let mut writer = Writer {
        random: Random::new(seed),
        text: String::new(),
        scopes: Vec::new(),
        functions: Vec::new(),
        indent: 0,
        names: 0,
        loops: 0,
        breakable: 0,
        ret: "void",
        budget: 0,
    };
    writer.shader();
    writer.text
}

struct Writer {
    random: Random,
    text: String,
    scopes: Vec<Vec<Variable>>,
    functions: Vec<Callable>,
    indent: usize,
    names: usize,
    loops: usize,
    breakable: usize,
    ret: &'static str,
    /// How many statements may still be written.
    budget: usize,
}

impl Writer {
    fn line(&mut self, line: &str) {
        let indent = "    ".repeat(self.indent);
        writeln!(self.text, "{indent}{line}").expect("a String takes text");
    }

    fn declare(&mut self, name: &str, ty: &'static str, writable: bool) {
        let variable = Variable { name: name.into(), ty, writable };
        self.scopes.last_mut().expect("a scope is open").push(variable);
    }

    /// All variables that no inner one hides.
    fn visible(&self) -> Vec<Variable> {
        let mut seen: Vec<&str> = Vec::new();
        let mut found = Vec::new();
        for variable in self.scopes.iter().rev().flat_map(|scope| scope.iter().rev()) {
            if !seen.contains(&variable.name.as_str()) {
                seen.push(&variable.name);
                found.push(variable.clone());
            }
        }
        found
    }

    fn shader(&mut self) {
        self.text.push_str("#version 150\n");
        self.text.push_str(STRUCT);
        self.text.push_str(
            "flat in vec4 a;\nflat in ivec4 b;\nout vec4 c0;\nout vec4 c1;\n\
             uniform float k = 0.75;\nuniform ivec2 n = ivec2(3, -5);\n\
             uniform float t[4] = float[4](1.0, -2.0, 0.5, 4.0);\n\
             uniform Block { vec3 w; mat3x2 x; int y[2]; } block;\n",
        );
        self.scopes.push(Vec::new());
        for (name, ty) in [("a", "vec4"), ("b", "ivec4"), ("k", "float"), ("n", "ivec2"), ("t", "float[4]")] {
            self.declare(name, ty, false);
        }
        for (name, ty) in [("block.w", "vec3"), ("block.x", "mat3x2")] {
            self.declare(name, ty, false);
        }
        for (name, ty) in [("g", "float"), ("h", "ivec3"), ("s", "S"), ("gu", "uint")] {
            let init = self.expr(ty, 2);
            self.line(&format!("{ty} {name} = {init};"));
            self.declare(name, ty, true);
        }
        for index in 0..self.random.pick(4) {
            self.function(index);
        }
        self.main();
    }

    fn function(&mut self, index: usize) {
        let ret = ["float", "int", "vec3", "uint", "S", "bool", "void"][self.random.pick(7)];
        let count = self.random.pick(4);
        let mut params = Vec::new();
        let mut heads = Vec::new();
        self.scopes.push(Vec::new());
        for number in 0..count {
            let ty = TYPES[self.random.pick(TYPES.len())];
            let mode = ["in", "in", "out", "inout", "const in"][self.random.pick(5)];
            // Sometimes a parameter hides a global.
            let name = if self.random.pick(6) == 0 && number == 0 { "g".into() } else { format!("p{number}") };
            heads.push(format!("{mode} {} {name}{}", base(ty), dims(ty)));
            self.declare(&name, ty, mode != "const in");
            params.push((mode, ty));
        }
        let name = format!("f{index}");
        self.line(&format!("{ret} {name}({}) {{", heads.join(", ")));
        self.indent += 1;
        // `out` parameters are written before anything reads them.
        for (number, (mode, ty)) in params.iter().enumerate() {
            if *mode == "out" {
                let name = self.scopes.last().expect("open")[number].name.clone();
                let value = self.literal(ty);
                self.line(&format!("{name} = {value};"));
            }
        }
        self.ret = ret;
        self.budget = 6;
        self.statements(2);
        if ret != "void" {
            let value = self.expr(ret, 2);
            self.line(&format!("return {value};"));
        }
        self.indent -= 1;
        self.line("}");
        self.scopes.pop();
        self.functions.push(Callable { name, ret, params });
    }

    fn main(&mut self) {
        self.line("void main() {");
        self.indent += 1;
        self.ret = "void";
        self.scopes.push(Vec::new());
        self.line("c0 = vec4(0.0); c1 = vec4(0.0);");
        self.declare("c0", "vec4", true);
        self.budget = 14;
        self.statements(3);
        let rows = self.visible();
        let mut floats = Vec::new();
        let mut ints = Vec::new();
        for variable in rows {
            let name = &variable.name;
            match (shape(variable.ty), variable.ty) {
                (Some((0, 1)), _) => floats.push(name.clone()),
                (Some((0, _)), _) => floats.push(format!("dot({name}, {name})")),
                (Some((1, 1)), _) => ints.push(name.clone()),
                (Some((1, _)), _) => ints.push(format!("({name}.x ^ {name}.y * 3)")),
                (Some((2, 1)), _) => ints.push(format!("int({name})")),
                (Some((2, _)), _) => ints.push(format!("int({name}.x + {name}.y * 7u)")),
                (Some((3, 1)), _) => ints.push(format!("int({name})")),
                (Some(_), _) => ints.push(format!("(any({name}) ? 5 : 9)")),
                (_, "S") => {
                    floats.push(format!("({name}.f + {name}.v[1].y + {name}.m[1][0])"));
                    ints.push(format!("{name}.i.y"));
                }
                (_, "float[4]") => floats.push(format!("({name}[0] - {name}[3])")),
                (_, "ivec3[2]") => ints.push(format!("{name}[1].z")),
                _ => floats.push(format!("{name}[1][0]")),
            }
        }
        let floats: Vec<_> = floats.iter().map(|term| format!("clamp({term}, -1000.0, 1000.0)")).collect();
        self.line(&format!("float fs = {};", floats.join(" + ")));
        self.line("int is = 17;");
        for term in ints {
            self.line(&format!("is = is * 31 + {term};"));
        }
        self.line("c0 += vec4(fs, g, s.v[0].x, 1.0);");
        self.line("c1 = vec4(is & 0xffff, (is >> 16) & 0xffff, gu & 0xffffu, 1.0);");
        self.indent -= 1;
        self.line("}");
        self.scopes.pop();
    }

    fn statements(&mut self, depth: usize) {
        for _ in 0..1 + self.random.pick(5) {
            if self.budget == 0 {
                return;
            }
            self.budget -= 1;
            self.statement(depth);
        }
    }

    fn block(&mut self, depth: usize) {
        self.indent += 1;
        self.scopes.push(Vec::new());
        self.statements(depth);
        self.scopes.pop();
        self.indent -= 1;
    }

    fn statement(&mut self, depth: usize) {
        let inner = depth.saturating_sub(1);
        match self.random.pick(if depth == 0 { 10 } else { 20 }) {
            0..=3 => self.declaration(),
            4..=7 => {
                let assignment = self.assignment(2);
                self.line(&format!("{assignment};"));
            }
            8 => match self.call_of("void", 2) {
                Some(call) => self.line(&format!("{call};")),
                None => self.declaration(),
            },
            9 => self.jump(),
            10..=13 => {
                let condition = self.expr("bool", 2);
                self.line(&format!("if ({condition}) {{"));
                self.block(inner);
                while self.random.pick(3) == 0 {
                    let condition = self.expr("bool", 2);
                    self.line(&format!("}} else if ({condition}) {{"));
                    self.block(inner);
                }
                if self.random.pick(2) == 0 {
                    self.line("} else {");
                    self.block(inner);
                }
                self.line("}");
            }
            14..=16 => self.iteration(inner),
            17 | 18 => self.switch(inner),
            _ => {
                self.line("{");
                self.block(inner);
                self.line("}");
            }
        }
    }

    fn declaration(&mut self) {
        let ty = TYPES[self.random.pick(TYPES.len())];
        let init = self.expr(ty, 3);
        // A name that hides an outer one and that the innermost scope does not have.
        let outer: Vec<String> =
            self.scopes[..self.scopes.len() - 1].iter().flatten().map(|v| v.name.clone()).collect();
        let own: Vec<&String> = self.scopes.last().expect("open").iter().map(|variable| &variable.name).collect();
        let hidden: Vec<&String> = outer
            .iter()
            .filter(|name| {
                !own.contains(name) && !name.contains('.') && !["c0", "g", "s", "gu", "b"].contains(&name.as_str())
            })
            // This test does not cover whether a loop's body may hide the loop's own variable.
            .filter(|name| !name.starts_with('i'))
            .collect();
        let name = if self.indent > 1 && !hidden.is_empty() && self.random.pick(4) == 0 {
            hidden[self.random.pick(hidden.len())].clone()
        } else {
            self.names += 1;
            format!("v{}", self.names)
        };
        self.line(&format!("{} {name}{} = {init};", base(ty), dims(ty)));
        self.declare(&name, ty, true);
    }

    fn jump(&mut self) {
        let condition = self.expr("bool", 2);
        let what = match self.random.pick(6) {
            0 | 1 if self.loops > 0 => "continue;".to_owned(),
            2 | 3 if self.breakable > 0 => "break;".to_owned(),
            4 if self.ret != "void" => format!("return {};", self.expr(self.ret, 2)),
            5 if self.random.pick(3) == 0 => "discard;".to_owned(),
            _ => format!("{};", self.assignment(1)),
        };
        self.line(&format!("if ({condition}) {what}"));
    }

    /// A loop of a few iterations with a counter that nothing else writes.
    fn iteration(&mut self, depth: usize) {
        self.names += 1;
        let counter = format!("i{}", self.names);
        let rounds = 1 + self.random.pick(4);
        let form = self.random.pick(3);
        let extra = if self.random.pick(3) == 0 { format!(" && {}", self.expr("bool", 2)) } else { String::new() };
        match form {
            0 => self.line(&format!("for (int {counter} = 0; {counter} < {rounds}{extra}; {counter}++) {{")),
            1 => {
                self.line(&format!("int {counter} = 0;"));
                self.line(&format!("while ({counter}++ < {rounds}{extra}) {{"));
            }
            _ => {
                self.line(&format!("int {counter} = 0;"));
                self.line("do {");
            }
        }
        if form > 0 {
            self.declare(&counter, "int", false);
        }
        self.scopes.push(Vec::new());
        if form == 0 {
            self.declare(&counter, "int", false);
        }
        let outer = (self.loops, self.breakable);
        (self.loops, self.breakable) = (1, 1);
        self.block(depth);
        (self.loops, self.breakable) = outer;
        self.scopes.pop();
        match form {
            2 => self.line(&format!("}} while (++{counter} < {rounds}{extra});")),
            _ => self.line("}"),
        }
    }

    fn switch(&mut self, depth: usize) {
        let selector = if self.random.pick(2) == 0 {
            format!("({}) & 3", self.expr("int", 2))
        } else {
            format!("int(({}) & 3u)", self.expr("uint", 2))
        };
        self.line(&format!("switch ({selector}) {{"));
        let default_at = self.random.pick(5);
        let outer = self.breakable;
        self.breakable += 1;
        for case in 0..3 {
            if case == default_at {
                self.line("default:");
            }
            self.line(&format!("case {case}: {{"));
            self.block(depth);
            let ends = self.random.pick(2) == 0;
            self.line(if ends { "} break;" } else { "}" });
        }
        // The last case must not be empty.
        self.line(if default_at == 3 { "default: break;" } else { "case 3: break;" });
        self.breakable = outer;
        self.line("}");
    }

    fn literal(&mut self, ty: &str) -> String {
        if let Some((class, size)) = shape(ty) {
            let one = |writer: &mut Self| match class {
                0 => writer.random.one_of(&["0.0", "1.0", "0.5", "-1.25", "2.0", "3.5"]).to_owned(),
                1 => writer.random.one_of(&["0", "1", "2", "-3", "7", "1000", "0x7fffffff"]).to_owned(),
                2 => writer.random.one_of(&["0u", "1u", "5u", "255u", "0xffffffffu"]).to_owned(),
                _ => writer.random.one_of(&["true", "false"]).to_owned(),
            };
            if size == 1 {
                return one(self);
            }
            let list: Vec<String> = (0..size).map(|_| one(self)).collect();
            return format!("{}({})", vector(class, size), list.join(", "));
        }
        if let Some((columns, rows)) = matrix(ty) {
            let list: Vec<String> = (0..columns * rows).map(|_| self.literal("float")).collect();
            return format!("{ty}({})", list.join(", "));
        }
        if let Some((element, len)) = array(ty) {
            let list: Vec<String> = (0..len).map(|_| self.literal(element)).collect();
            return format!("{ty}({})", list.join(", "));
        }
        let members = ["float", "ivec2", "vec3[2]", "mat2"].map(|member| self.literal(member));
        format!("S({})", members.join(", "))
    }

    /// L-values of a type among the variables: whole variables, members, elements, components.
    fn places(&mut self, ty: &str, writable: bool) -> Vec<String> {
        let index = |writer: &mut Self, len: usize| match writer.random.pick(3) {
            0 => format!("({}) & {}", writer.small_int(), len.next_power_of_two() / 2 * 2 - 1),
            _ => writer.random.pick(len).to_string(),
        };
        let mut found = Vec::new();
        for variable in self.visible() {
            if writable && !variable.writable {
                continue;
            }
            let name = &variable.name;
            if variable.ty == ty {
                found.push(name.clone());
                found.push(name.clone());
            }
            match (shape(variable.ty), matrix(variable.ty), array(variable.ty)) {
                (Some((class, size)), ..) if size > 1 && shape(ty) == Some((class, 1)) => {
                    let dynamic = index(self, if size == 3 { 2 } else { size });
                    found.push(format!("{name}[{dynamic}]"));
                    found.push(format!("{name}.{}", &"xyzw"[..size].chars().nth(self.random.pick(size)).expect("in")));
                }
                (_, Some((columns, rows)), _) if ty == vector(0, rows) => {
                    let column = self.random.pick(columns);
                    found.push(format!("{name}[{column}]"));
                }
                (_, _, Some((element, len))) if element == ty => {
                    let dynamic = index(self, len);
                    found.push(format!("{name}[{dynamic}]"));
                }
                _ if variable.ty == "S" => match ty {
                    "float" => found.extend([format!("{name}.f"), format!("{name}.m[1][0]")]),
                    "ivec2" => found.push(format!("{name}.i")),
                    "int" => found.push(format!("{name}.i.y")),
                    "vec3" => {
                        let dynamic = index(self, 2);
                        found.push(format!("{name}.v[{dynamic}]"));
                    }
                    "mat2" => found.push(format!("{name}.m")),
                    _ => {}
                },
                _ => {}
            }
        }
        found
    }

    /// An `int` expression without effects.
    fn small_int(&mut self) -> String {
        let ints: Vec<String> = self.visible().into_iter().filter(|v| v.ty == "int").map(|v| v.name).collect();
        match ints.is_empty() {
            true => format!("b.{}", self.random.one_of(&["x", "y", "z"])),
            false => ints[self.random.pick(ints.len())].clone(),
        }
    }

    fn place(&mut self, ty: &str) -> Option<String> {
        let places = self.places(ty, true);
        (!places.is_empty()).then(|| places[self.random.pick(places.len())].clone())
    }

    /// An assignment as an expression, without parentheses.
    fn assignment(&mut self, depth: usize) -> String {
        let ty = TYPES[self.random.pick(TYPES.len())];
        let Some(place) = self.place(ty) else { return self.literal("float") };
        if let Some((class, size)) = shape(ty) {
            // Several components at once, in another order.
            if size == 3 && place.chars().all(|c| c.is_alphanumeric()) && self.random.pick(3) == 0 {
                let value = self.expr(vector(class, 2), depth);
                return format!("{place}.{} = {value}", self.random.one_of(&["zx", "yx", "xz"]));
            }
            let operators: &[&str] = match class {
                0 => &["=", "=", "+=", "-="],
                1 | 2 => &["=", "=", "+=", "-=", "*=", "&=", "|=", "^="],
                _ => &["="],
            };
            let operator = self.random.one_of(operators);
            let value = self.expr(ty, depth);
            return format!("{place} {operator} {value}");
        }
        let value = self.expr(ty, depth);
        format!("{place} = {value}")
    }

    /// A call of a function with this result type, if there is one whose `out` arguments can be provided.
    fn call_of(&mut self, ret: &str, depth: usize) -> Option<String> {
        let fitting: Vec<usize> = (0..self.functions.len()).filter(|&index| self.functions[index].ret == ret).collect();
        if fitting.is_empty() {
            return None;
        }
        let index = fitting[self.random.pick(fitting.len())];
        let (name, params) = (self.functions[index].name.clone(), self.functions[index].params.clone());
        let mut arguments = Vec::new();
        for (mode, ty) in params {
            arguments.push(match mode {
                "out" | "inout" => self.place(ty)?,
                _ => self.expr(ty, depth.saturating_sub(1)),
            });
        }
        Some(format!("{name}({})", arguments.join(", ")))
    }
}

fn parenthesized(text: &str) -> String {
    format!("({text})")
}

/// `float` of `float[4]`.
fn base(ty: &str) -> &str {
    ty.split('[').next().unwrap_or(ty)
}

/// `[4]` of `float[4]`.
fn dims(ty: &str) -> &str {
    ty.find('[').map_or("", |at| &ty[at..])
}

#[cfg(test)]
mod tests {
    use super::fragment;

    #[test]
    fn a_seed_is_a_text() {
        assert_eq!(fragment(5), fragment(5));
        assert_ne!(fragment(5), fragment(6));
    }
}
