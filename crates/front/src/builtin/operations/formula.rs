//! [`Formula`]: an expression of other operations, with which a specification defines the precision of a function.
//!
//! *In:* the rows of [`precision`](super::precision). *Out:* trees that the reference's envelope evaluates, and their
//! text in GLSL.

use super::{Binary, Unary};
use std::fmt::{self, Display, Formatter};

/// An expression over the arguments of a function, component by component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Formula {
    /// The argument with this index; for a vector, the component that is computed.
    Argument(u8),
    /// A number.
    Constant(f64),
    /// An operation on one float.
    Unary(Unary, &'static Formula),
    /// An operation on two floats.
    Binary(Binary, &'static Formula, &'static Formula),
    /// The sum of the products of all components, in any order.
    Dot(&'static Formula, &'static Formula),
    /// Another component: `n` further, cyclically.
    Next(u8, &'static Formula),
    /// `a < b ? c : d`
    IfLess(&'static [Formula; 4]),
    /// The result of either.
    Either(&'static Formula, &'static Formula),
    /// The first formula, whose only argument `t` is the result of the second.
    With(&'static Formula, &'static Formula),
}

impl Formula {
    /// Whether two formulas are written in the same way. It can be used in constants, where `==` cannot.
    pub const fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Argument(a), Self::Argument(b)) => *a == *b,
            (Self::Constant(a), Self::Constant(b)) => a.to_bits() == b.to_bits(),
            (Self::Unary(f, a), Self::Unary(g, b)) => *f as u8 == *g as u8 && a.same(b),
            (Self::Binary(f, a, b), Self::Binary(g, c, d)) => *f as u8 == *g as u8 && a.same(c) && b.same(d),
            (Self::Dot(a, b), Self::Dot(c, d))
            | (Self::Either(a, b), Self::Either(c, d))
            | (Self::With(a, b), Self::With(c, d)) => a.same(c) && b.same(d),
            (Self::Next(n, a), Self::Next(m, b)) => *n == *m && a.same(b),
            (Self::IfLess([a, b, c, d]), Self::IfLess([e, f, g, h])) => {
                a.same(e) && b.same(f) && c.same(g) && d.same(h)
            }
            _ => false,
        }
    }

    /// The text with these names for the arguments.
    pub fn text(&self, names: &[&str]) -> String {
        Text { formula: self, names }.to_string()
    }

    /// The precedence of the outermost operation (§5.1).
    fn precedence(&self) -> u8 {
        match self {
            Self::IfLess(_) | Self::Either(..) | Self::With(..) => 0,
            Self::Binary(Binary::Add | Binary::Sub, ..) => 1,
            Self::Binary(Binary::Mul | Binary::Div, ..) => 2,
            Self::Unary(Unary::Neg, _) => 3,
            _ => 4,
        }
    }
}

struct Text<'a> {
    formula: &'a Formula,
    names: &'a [&'a str],
}

impl Text<'_> {
    fn part<'a>(&'a self, formula: &'a Formula) -> Text<'a> {
        Text { formula, names: self.names }
    }

    /// Writes an operand, in parentheses if its precedence is below `least`.
    fn operand(&self, f: &mut Formatter<'_>, formula: &Formula, least: u8) -> fmt::Result {
        let text = self.part(formula);
        if formula.precedence() < least { write!(f, "({text})") } else { write!(f, "{text}") }
    }
}

impl Display for Text<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let own = self.formula.precedence();
        match *self.formula {
            Formula::Argument(number) => match self.names.get(usize::from(number)) {
                Some(name) => f.write_str(name),
                None => write!(f, "x{number}"),
            },
            Formula::Constant(value) => write!(f, "{value:?}"),
            Formula::Unary(Unary::Neg, a) => {
                f.write_str("-")?;
                self.operand(f, a, own)
            }
            Formula::Unary(op, a) => write!(f, "{}({})", op.name(), self.part(a)),
            Formula::Binary(op, a, b) if own <= 2 => {
                self.operand(f, a, own)?;
                write!(f, " {} ", op.name())?;
                self.operand(f, b, own + u8::from(matches!(op, Binary::Sub | Binary::Div)))
            }
            Formula::Binary(op, a, b) => write!(f, "{}({}, {})", op.name(), self.part(a), self.part(b)),
            Formula::Dot(a, b) => write!(f, "dot({}, {})", self.part(a), self.part(b)),
            Formula::Next(n, a) => {
                self.operand(f, a, 4)?;
                write!(f, "[i + {n}]")
            }
            Formula::IfLess([a, b, c, d]) => {
                write!(f, "{} < {} ? {} : {}", self.part(a), self.part(b), self.part(c), self.part(d))
            }
            Formula::Either(a, b) => write!(f, "{}, or {}", self.part(a), self.part(b)),
            Formula::With(a, t) => {
                write!(f, "{} with t = {}", Text { formula: a, names: &["t"] }, self.part(t))
            }
        }
    }
}

/// Builds a tree: `formula!((+ x (sqrt y)))` in prefix form, with `x`, `y`, `z` for the arguments.
macro_rules! formula {
    (x) => { $crate::builtin::operations::Formula::Argument(0) };
    (y) => { $crate::builtin::operations::Formula::Argument(1) };
    (z) => { $crate::builtin::operations::Formula::Argument(2) };
    ($value:literal) => { $crate::builtin::operations::Formula::Constant($value) };
    ((+ $a:tt $b:tt)) => { formula!((Add $a $b)) };
    ((- $a:tt $b:tt)) => { formula!((Sub $a $b)) };
    ((* $a:tt $b:tt)) => { formula!((Mul $a $b)) };
    ((/ $a:tt $b:tt)) => { formula!((Div $a $b)) };
    ((dot $a:tt $b:tt)) => { $crate::builtin::operations::Formula::Dot(&formula!($a), &formula!($b)) };
    ((next $n:literal $a:tt)) => { $crate::builtin::operations::Formula::Next($n, &formula!($a)) };
    ((either $a:tt $b:tt)) => { $crate::builtin::operations::Formula::Either(&formula!($a), &formula!($b)) };
    ((with $a:tt $b:tt)) => { $crate::builtin::operations::Formula::With(&formula!($a), &formula!($b)) };
    ((less $a:tt $b:tt $c:tt $d:tt)) => {
        $crate::builtin::operations::Formula::IfLess(&[formula!($a), formula!($b), formula!($c), formula!($d)])
    };
    ((number $value:expr)) => { $crate::builtin::operations::Formula::Constant($value) };
    (($op:ident $a:tt)) => {
        $crate::builtin::operations::Formula::Unary($crate::builtin::operations::Unary::$op, &formula!($a))
    };
    (($op:ident $a:tt $b:tt)) => {
        $crate::builtin::operations::Formula::Binary(
            $crate::builtin::operations::Binary::$op,
            &formula!($a),
            &formula!($b),
        )
    };
}
pub(super) use formula;
