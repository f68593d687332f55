//! How tightly expressions bind (WGSL §8.17), and which parentheses that makes necessary.

use super::tree::Expr;

/// How tightly an expression binds; a larger number binds more tightly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    /// `&&`, `||`, and the binary bit operators: they do not mix.
    Logical,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
}

pub(super) fn level_of(op: &str) -> Level {
    match op {
        "*" | "/" | "%" => Level::Product,
        "+" | "-" => Level::Sum,
        "<<" | ">>" => Level::Shift,
        "==" | "!=" | "<" | ">" | "<=" | ">=" => Level::Relation,
        _ => Level::Logical,
    }
}

impl Expr<'_> {
    pub(super) fn level(&self) -> Level {
        match self {
            Self::Binary(op, ..) => level_of(op),
            _ => Level::Unary,
        }
    }

    /// Whether `.x` or `[i]` can follow without parentheses.
    pub(super) fn is_postfix(&self) -> bool {
        !matches!(self, Self::Unary(..) | Self::Binary(..) | Self::Number(_))
    }

    /// Whether it begins with an operator.
    pub(super) fn begins_with(&self, op: &str) -> bool {
        match self {
            Self::Unary(own, _) => *own == op,
            Self::Number(number) => number.digits.starts_with(op),
            _ => false,
        }
    }
}

/// Whether an operand of a binary operator needs no parentheses.
pub(super) fn fits(op: &str, operand: &Expr<'_>, is_left: bool) -> bool {
    let level = operand.level();
    match level_of(op) {
        Level::Product => level >= if is_left { Level::Product } else { Level::Unary },
        Level::Sum => level >= if is_left { Level::Sum } else { Level::Product },
        Level::Shift => level == Level::Unary,
        Level::Relation => level >= Level::Sum,
        Level::Logical | Level::Unary => {
            let chain = is_left && matches!(operand, Expr::Binary(inner, ..) if *inner == op);
            match op {
                "&&" | "||" => chain || level >= Level::Relation,
                _ => chain || level == Level::Unary,
            }
        }
    }
}

/// Whether arguments compare so that `f(a < b, c > d)` would be a name with parameters: comparisons then keep their
/// parentheses.
pub(super) fn compared(arguments: &[Expr<'_>]) -> bool {
    let any = |starts: char| arguments.iter().any(|argument| has_operator(argument, starts));
    arguments.iter().any(|argument| argument.level() < Level::Sum) && any('<') && any('>')
}

/// Whether an operator that begins with `<` or `>` is in an expression.
fn has_operator(expr: &Expr<'_>, start: char) -> bool {
    match expr {
        Expr::Number(_) | Expr::Leaf(_) | Expr::Constant(_) | Expr::Local(_) => false,
        Expr::Call(_, arguments) => arguments.iter().any(|argument| has_operator(argument, start)),
        Expr::Index(left, right) => has_operator(left, start) || has_operator(right, start),
        Expr::Member(base, _) | Expr::Unary(_, base) => has_operator(base, start),
        Expr::Binary(op, left, right) => {
            op.starts_with(start) || has_operator(left, start) || has_operator(right, start)
        }
    }
}
