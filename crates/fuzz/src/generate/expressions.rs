//! Expressions of a type: operators, constructors, conversions, calls.
//!
//! *In:* a type and a depth. *Out:* an expression. *Holds:* it has this type without a conversion, but for operands of operators where the
//! version converts them, and its value is defined.

use super::tree::{Expr, Use};
use super::types::{BOOL, FLOAT, INT, Ty, UINT};
use super::writer::Writer;
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

/// Integers that have bounds, and the largest that they may be.
const BOUNDED: &[(&str, usize)] = &[
    ("((@ & 0xffff) % 7)", 6),
    ("(@ & 3)", 3),
    ("clamp(@, -2, 4)", 4),
    ("((@ & 0xff) >> 4)", 15),
    ("((@ & 0xff) / 32)", 7),
    ("min(@, 5)", 5),
];

impl Writer<'_> {
    /// An expression of a type.
    pub(super) fn expr(&mut self, ty: &Ty, depth: usize) -> Expr {
        if depth == 0 || self.expressions_left == 0 {
            return self.simple(ty);
        }
        self.expressions_left -= 1;
        let composed = match self.chance.below(16) {
            0..=2 => Some(self.simple(ty)),
            3..=6 => self.builtin(ty, depth - 1),
            7 => self.call(ty, depth - 1),
            8 => self.ternary(ty, depth - 1),
            9 => self.sequence(ty, depth - 1),
            10 => self.macro_use(ty, depth - 1),
            11 => self.assigned(ty, depth - 1),
            _ => None,
        };
        composed.unwrap_or_else(|| self.operation(ty, depth - 1))
    }

    /// A variable, a part of one, or a literal.
    pub(super) fn simple(&mut self, ty: &Ty) -> Expr {
        if !self.chance.once_in(4)
            && let Some(part) = self.part(ty, false)
        {
            return part;
        }
        self.literal(ty)
    }

    /// A literal, or a constructor of literals.
    pub(super) fn literal(&mut self, ty: &Ty) -> Expr {
        match ty {
            Ty::Vector(scalar, 1) => {
                let text = self.number(*scalar);
                Expr::leaf(ty.clone(), text).used(Use::Literal)
            }
            Ty::Vector(scalar, size) => {
                let splat = self.chance.once_in(3);
                let count = if splat { 1 } else { usize::from(*size) };
                let parts: Vec<Expr> = (0..count).map(|_| self.literal(&Ty::Vector(*scalar, 1))).collect();
                constructed(ty, parts)
            }
            Ty::Matrix(columns, rows) => {
                let count = if self.chance.once_in(2) { 1 } else { usize::from(columns * rows) };
                let parts = (0..count).map(|_| self.literal(&FLOAT)).collect();
                constructed(ty, parts)
            }
            Ty::Array(element, size) => {
                let parts = (0..*size).map(|_| self.literal(element)).collect();
                constructed(ty, parts)
            }
            Ty::Struct(number) => {
                let members = self.structs.get(*number).cloned().unwrap_or_default();
                let parts = members.iter().map(|(_, ty)| self.literal(ty)).collect();
                constructed(ty, parts)
            }
        }
    }

    fn number(&mut self, scalar: Scalar) -> String {
        const FLOATS: &[&str] = &[
            "0.0", "1.0", "0.5", "-0.25", "2.0", "-1.5", "3.0", "0.125", ".75", "4.", "1e-1", "0.7", "-2.3", "17.0",
            "0.0625", "1.9e1",
        ];
        const INTS: &[&str] = &["0", "1", "2", "-1", "3", "-7", "5", "0x1f", "017", "100", "-32768", "12345"];
        const UINTS: &[&str] = &["0u", "1u", "2u", "7u", "0xffU", "4000000000u", "31u"];
        if self.chance.once_in(3) {
            return self.long_number(scalar);
        }
        let (text, parenthesized) = match scalar {
            Scalar::Float => (self.chance.word(FLOATS), true),
            Scalar::Int => (self.chance.word(INTS), true),
            Scalar::Uint => (self.chance.word(UINTS), false),
            Scalar::Bool => (self.chance.word(&["true", "false"]), false),
        };
        if parenthesized && text.starts_with('-') { format!("({text})") } else { text.to_owned() }
    }

    /// A number of any digits.
    fn long_number(&mut self, scalar: Scalar) -> String {
        let number = self.chance.below(100_000);
        match scalar {
            Scalar::Float => format!("{}.{number:05}", self.chance.below(4)),
            Scalar::Int => match self.chance.below(3) {
                0 => format!("0x{:x}", number % 4096),
                1 => format!("0{:o}", number % 512),
                _ => (number % 1000).to_string(),
            },
            Scalar::Uint => format!("{number}u"),
            Scalar::Bool => if number.is_multiple_of(2) { "true" } else { "false" }.to_owned(),
        }
    }

    /// `(c ? a : b)`
    fn ternary(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        if !self.is_value(ty) || (matches!(ty, Ty::Array(..)) && !self.language.since(430, 320)) {
            return None;
        }
        self.note("?:");
        let condition = self.expr(&BOOL, depth);
        let (yes, no) = self.apart(|this| (this.expr(ty, depth), this.expr(ty, depth)));
        Some(Expr::new(ty.clone(), "(@ ? @ : @)", vec![condition, yes, no]))
    }

    /// Makes a part that not all invocations evaluate.
    pub(super) fn apart<T>(&mut self, make: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.is_uniform, false);
        let made = make(self);
        self.is_uniform = before;
        made
    }

    /// `(a, b)`
    fn sequence(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        if !self.chance.once_in(3)
            || (self.is_constant && self.language.has(Feature::VariableSequences))
            || !self.is_value(ty)
        {
            return None;
        }
        self.note("comma");
        let other = self.basic_type();
        let (first, second) = (self.expr(&other, depth), self.expr(ty, depth));
        Some(Expr::new(ty.clone(), "(@, @)", vec![first, second]))
    }

    /// `(a = b)`, `a++`
    fn assigned(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        if self.is_constant
            || !self.chance.once_in(2)
            || matches!(ty, Ty::Array(..) | Ty::Struct(_))
            || ty.is_vector_of(Scalar::Bool)
        {
            return None;
        }
        let place = self.part(ty, true)?.used(Use::Fixed);
        let is_whole = matches!(ty, Ty::Vector(Scalar::Int | Scalar::Uint, _));
        if is_whole && self.chance.once_in(2) {
            self.note("increment");
            let pattern = self.chance.word(&["@++", "++@", "@--", "--@"]);
            return Some(Expr::new(ty.clone(), pattern, vec![place]));
        }
        self.note("assignment as a value");
        let value = self.expr(ty, depth);
        Some(Expr::new(ty.clone(), self.chance.word(&["(@ = @)", "(@ += @)"]), vec![place, value]))
    }

    /// An operator, a constructor or a conversion.
    fn operation(&mut self, ty: &Ty, depth: usize) -> Expr {
        match ty {
            Ty::Vector(Scalar::Float, size) => self.floats(ty, *size, depth),
            Ty::Vector(Scalar::Bool, 1) => self.truth(depth),
            Ty::Vector(Scalar::Bool, size) => {
                let parts = (0..*size).map(|_| self.expr(&BOOL, depth)).collect();
                constructed(ty, parts)
            }
            Ty::Vector(scalar, size) => self.integers(ty, *scalar, *size, depth),
            Ty::Matrix(columns, rows) => self.matrix(ty, *columns, *rows, depth),
            Ty::Array(element, size) => {
                self.note("array constructor");
                let parts = (0..*size).map(|_| self.expr(element, depth.min(1))).collect();
                constructed(ty, parts)
            }
            Ty::Struct(number) => {
                self.note("struct constructor");
                let members = self.structs.get(*number).cloned().unwrap_or_default();
                let parts = members.iter().map(|(_, ty)| self.expr(ty, depth.min(1))).collect();
                constructed(ty, parts)
            }
        }
    }

    fn floats(&mut self, ty: &Ty, size: u8, depth: usize) -> Expr {
        let one = |this: &mut Self, ty: &Ty| this.expr(ty, depth);
        match self.chance.below(12) {
            0 if self.chance.once_in(2) => self.difference(ty, depth),
            0..=3 => {
                let pattern = self.chance.word(&["(@ + @)", "(@ - @)", "(@ * @)"]);
                let (left, right) = self.mixed(ty, depth);
                Expr::new(ty.clone(), pattern, vec![left, right])
            }
            4 if self.chance.once_in(2) => {
                let divisor = self.chance.word(&["(@ / 2.0)", "(@ / 3.0)", "(@ / 0.5)", "(@ / 1.0)"]);
                Expr::new(ty.clone(), divisor, vec![one(self, ty)])
            }
            4 => Expr::new(ty.clone(), "(@ / (abs(@) + 0.75))", vec![one(self, ty), one(self, ty)])
                .or_plain(self.is_constant),
            5 if self.chance.once_in(2) => {
                self.note("operation on a neutral number");
                let pattern = self.chance.word(&["(@ - 0.0)", "(0.0 - @)", "(@ * 1.0)", "(@ + 0.0)", "(1.0 * @)"]);
                Expr::new(ty.clone(), pattern, vec![one(self, ty)])
            }
            5 => Expr::new(ty.clone(), "(- @)", vec![one(self, ty)]),
            6 | 7 => self.conversion(ty, Scalar::Float, size, depth),
            8 if self.matrices_with(size) => {
                self.note("matrix times vector");
                let columns = self.columns_with(size);
                let (matrix, vector) = (Ty::Matrix(columns, size), Ty::Vector(Scalar::Float, columns));
                Expr::new(ty.clone(), "(@ * @)", vec![one(self, &matrix), one(self, &vector)])
            }
            9 if self.matrices_with(size) => {
                self.note("vector times matrix");
                let rows = self.columns_with(size);
                let (vector, matrix) = (Ty::Vector(Scalar::Float, rows), Ty::Matrix(size, rows));
                Expr::new(ty.clone(), "(@ * @)", vec![one(self, &vector), one(self, &matrix)])
            }
            _ => self.composed(ty, Scalar::Float, size, depth),
        }
    }

    fn integers(&mut self, ty: &Ty, scalar: Scalar, size: u8, depth: usize) -> Expr {
        let has_bits = self.language.has(Feature::IntegerOperators);
        let one = |this: &mut Self| this.expr(ty, depth);
        let (unit, mask) = if scalar == Scalar::Uint { ("7u", "31u") } else { ("7", "31") };
        match self.chance.below(12) {
            0 if self.chance.once_in(3) => self.difference(ty, depth),
            0..=2 => {
                let pattern = self.chance.word(&["(@ + @)", "(@ - @)", "(@ * @)"]);
                let (left, right) = self.mixed(ty, depth);
                Expr::new(ty.clone(), pattern, vec![left, right])
            }
            3 if has_bits => {
                self.note("bit operator");
                let pattern = self.chance.word(&["(@ & @)", "(@ | @)", "(@ ^ @)"]);
                let (left, right) = self.mixed(ty, depth);
                Expr::new(ty.clone(), pattern, vec![left, right])
            }
            4 if has_bits => {
                self.note("shift");
                let operator = self.chance.word(&["<<", ">>"]);
                let by = if self.chance.once_in(2) { ty.clone() } else { Ty::Vector(scalar, 1) };
                let right = self.expr(&by, depth);
                Expr::new(ty.clone(), &format!("(@ {operator} (@ & {mask}))"), vec![one(self), right])
            }
            5 if has_bits => {
                self.note("complement");
                Expr::new(ty.clone(), "(~@)", vec![one(self)])
            }
            6 if has_bits => {
                self.note("remainder");
                // Of negative numbers it is undefined.
                let pattern = if scalar == Scalar::Uint { "(@ % 7u)" } else { "((@ & 0xffff) % 7)" };
                Expr::new(ty.clone(), pattern, vec![one(self)])
            }
            7 => {
                let divisor = self.chance.word(&["3", "2", "5"]);
                let suffix = unit.trim_start_matches('7');
                Expr::new(ty.clone(), &format!("(@ / {divisor}{suffix})"), vec![one(self)])
            }
            8 => Expr::new(ty.clone(), "(- @)", vec![one(self)]),
            9 | 10 => self.conversion(ty, scalar, size, depth),
            _ => self.composed(ty, scalar, size, depth),
        }
    }

    fn truth(&mut self, depth: usize) -> Expr {
        let operands = |this: &mut Self, ty: &Ty| vec![this.expr(ty, depth), this.expr(ty, depth)];
        match self.chance.below(9) {
            8 if self.language.has(Feature::IntegerOperators) => self.at_a_bound(depth),
            0..=2 => {
                self.note("comparison");
                let ty = if self.chance.once_in(2) { FLOAT } else { INT };
                let ty = if self.language.basics.contains(&UINT) && self.chance.once_in(4) { UINT } else { ty };
                let pattern = self.chance.word(&["(@ < @)", "(@ >= @)", "(@ <= @)", "(@ > @)"]);
                Expr::new(BOOL, pattern, operands(self, &ty))
            }
            3 | 4 => {
                self.note("equality");
                let ty = self.value_type();
                let pattern = self.chance.word(&["(@ == @)", "(@ != @)"]);
                Expr::new(BOOL, pattern, operands(self, &ty))
            }
            5 | 6 => {
                self.note("logical operator");
                let pattern = self.chance.word(&["(@ && @)", "(@ || @)", "(@ ^^ @)"]);
                let left = self.expr(&BOOL, depth);
                let right = self.apart(|this| this.expr(&BOOL, depth));
                Expr::new(BOOL, pattern, vec![left, right])
            }
            _ => Expr::new(BOOL, "(!@)", vec![self.expr(&BOOL, depth)]),
        }
    }

    /// A comparison of what has bounds with a number at one of them.
    fn at_a_bound(&mut self, depth: usize) -> Expr {
        self.note("comparison at a bound");
        let (pattern, most) = self.chance.one(BOUNDED).copied().unwrap_or(("(@ & 3)", 3));
        let near = (most + self.chance.below(3)).saturating_sub(1);
        let operator = self.chance.word(&["<", "<=", ">", ">=", "==", "!="]);
        let bounded = if self.is_constant && (pattern.contains("clamp") || pattern.contains("min")) {
            "(@ & 3)"
        } else {
            pattern
        };
        let bounded = Expr::new(INT, bounded, vec![self.expr(&INT, depth)]);
        let bound = Expr::leaf(INT, near.to_string()).used(Use::Literal);
        let operands = if self.chance.once_in(3) { vec![bound, bounded] } else { vec![bounded, bound] };
        Expr::new(BOOL, &format!("(@ {operator} @)"), operands)
    }

    fn matrix(&mut self, ty: &Ty, columns: u8, rows: u8, depth: usize) -> Expr {
        self.note("matrix operation");
        let one = |this: &mut Self, ty: &Ty| this.expr(ty, depth);
        match self.chance.below(7) {
            0 | 1 => {
                let pattern = self.chance.word(&["(@ + @)", "(@ - @)"]);
                Expr::new(ty.clone(), pattern, vec![one(self, ty), one(self, ty)])
            }
            2 => Expr::new(ty.clone(), "(@ * @)", vec![one(self, &FLOAT), one(self, ty)]),
            3 => {
                let inner = self.columns_with(rows);
                let (left, right) = (Ty::Matrix(inner, rows), Ty::Matrix(columns, inner));
                if !self.language.basics.contains(&left) || !self.language.basics.contains(&right) {
                    return self.literal(ty);
                }
                Expr::new(ty.clone(), "(@ * @)", vec![one(self, &left), one(self, &right)])
            }
            4 if self.language.has(Feature::MatrixFromMatrix) => {
                let other = self.columns_with(rows);
                let other = Ty::Matrix(other, if self.language.has_word("mat2x3") { rows } else { other });
                Expr::new(ty.clone(), &format!("{}(@)", ty.name()), vec![one(self, &other)])
            }
            _ => {
                let parts = (0..columns).map(|_| self.expr(&Ty::Vector(Scalar::Float, rows), depth.min(1))).collect();
                constructed(ty, parts)
            }
        }
    }

    /// Whether matrices have this number of rows.
    fn matrices_with(&self, size: u8) -> bool {
        size > 1
    }

    /// The columns of a matrix with so many rows that the language has.
    fn columns_with(&mut self, rows: u8) -> u8 {
        if self.language.has_word("mat2x3") { 2 + self.chance.below(3) as u8 } else { rows }
    }
}

impl Expr {
    /// A quotient, without a function where the expression has to be constant.
    fn or_plain(self, is_constant: bool) -> Self {
        if !is_constant {
            return self;
        }
        let Self { ty, operands, .. } = self;
        Self::new(ty, "(@ - @)", operands)
    }
}

/// `vec2(a, b)`
pub(super) fn constructed(ty: &Ty, parts: Vec<Expr>) -> Expr {
    let places = vec!["@"; parts.len()].join(", ");
    Expr::new(ty.clone(), &format!("{}({places})", ty.name()), parts)
}
