//! Whether two expressions are the same.
//!
//! *In:* two expressions of one stage. *Out:* whether they have the same form, or give the same value. *Holds:* numbers are compared by their
//! bits, so that the zeros of both signs differ. *Not done here:* expressions that are written differently and compute the same.

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use super::{ExprId, ExprKind, Shader, is_pure};

/// How many parts are compared. Larger expressions are never the same: who compares at each level would compare forever.
const MOST: usize = 256;

/// Whether two expressions have the same form and name the same variables, so that they compute the same from the same values.
pub fn same_form(shader: &Shader, a: ExprId, b: ExprId) -> bool {
    let mut pending = vec![(a, b)];
    let mut count = 0;
    while let Some((a, b)) = pending.pop() {
        count += 1;
        let (one, other) = (shader.expr(a), shader.expr(b));
        let (first, second) = (one.kind.children(), other.kind.children());
        let alike = one.ty == other.ty && first.len() == second.len() && same_kind(&one.kind, &other.kind);
        if !alike || count > MOST {
            return false;
        }
        pending.extend(first.into_iter().zip(second));
    }
    true
}

/// Whether two expressions have the same form, and evaluating them does nothing but give a value, which is the same then.
pub fn same_value(shader: &Shader, a: ExprId, b: ExprId) -> bool {
    same_form(shader, a, b) && is_pure(shader, a)
}

/// Whether two expressions are the same but for their operands.
fn same_kind(a: &ExprKind, b: &ExprKind) -> bool {
    match (a, b) {
        (ExprKind::Literal(a), ExprKind::Literal(b)) => a.is_same(*b),
        (ExprKind::Var(a), ExprKind::Var(b)) => a == b,
        (ExprKind::Member(_, a), ExprKind::Member(_, b)) => a == b,
        (ExprKind::Swizzle(_, a), ExprKind::Swizzle(_, b)) => a == b,
        (ExprKind::Construct(a, _), ExprKind::Construct(b, _)) => a == b,
        (ExprKind::Unary(a, _), ExprKind::Unary(b, _)) => a == b,
        (ExprKind::IncDec(a, _), ExprKind::IncDec(b, _)) => a == b,
        (ExprKind::Binary(a, ..), ExprKind::Binary(b, ..)) => a == b,
        (ExprKind::Logical(a, ..), ExprKind::Logical(b, ..)) => a == b,
        (ExprKind::Assign(a, ..), ExprKind::Assign(b, ..)) => a == b,
        (ExprKind::Call(a, _), ExprKind::Call(b, _)) => a == b,
        (ExprKind::BuiltinCall(a, _), ExprKind::BuiltinCall(b, _)) => a == b,
        (ExprKind::Index(..), ExprKind::Index(..))
        | (ExprKind::Convert(_), ExprKind::Convert(_))
        | (ExprKind::Ternary(..), ExprKind::Ternary(..))
        | (ExprKind::Comma(..), ExprKind::Comma(..)) => true,
        (
            ExprKind::Error
            | ExprKind::Literal(_)
            | ExprKind::Var(_)
            | ExprKind::Member(..)
            | ExprKind::Index(..)
            | ExprKind::Swizzle(..)
            | ExprKind::Convert(_)
            | ExprKind::Construct(..)
            | ExprKind::Unary(..)
            | ExprKind::IncDec(..)
            | ExprKind::Binary(..)
            | ExprKind::Logical(..)
            | ExprKind::Ternary(..)
            | ExprKind::Assign(..)
            | ExprKind::Comma(..)
            | ExprKind::Call(..)
            | ExprKind::BuiltinCall(..),
            _,
        ) => false,
    }
}
