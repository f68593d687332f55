//! What an operator demands of its operands: where a literal would let a driver gain or lose a NaN or an infinity.
//!
//! *In:* an operation with the facts of its operands. *Out:* a [`Demand`] for each operand. *Holds:* operators and classes of
//! functions are matched without a wildcard, so what is added does not compile until it is judged. Functions are in
//! `builtins`.
//!
//! | operation | what a driver may do with a literal | so |
//! | --- | --- | --- |
//! | `x * c`, products of matrices | drop `x` for `c` = 0 | no 0 unless `x` is finite |
//! | `(x * a) * b` | multiply `a` and `b` first, which may overflow or not | kept unless `x` is bounded, or no constant is above 1 |
//! | `(x + a) + b` | add `a` and `b` first | kept where a constant is so large that it could overflow |
//! | `x / c` | multiply with `1 / c` | kept where that is not a normal number |
//! | `c / x` | drop `x` for `c` = 0 | no 0 unless `x` is finite and not 0 |
//! | `x * c`, `x + c`, `mix` and so on | for `c` = 0, ignore the sign of a 0 that comes out | no 0 where an operation sees that sign |
//! | any, of constants alone | compute it, by other rules | kept unless the result is finite |
//! | integer division, shifts | refuse or leave undefined | kept where the specification leaves it undefined |

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use super::operands::{Operands, Own, keep_unless, product, quotient, spread_or_any, sum, whole, zero_unless};
use super::{Demand, builtins};
use crate::facts::Fact;
use crate::forward::Walked;
use glisten_front::builtin::operations::Class;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, Scalar, Types};
use smallvec::smallvec;

/// The demands of an operation on its operands.
pub(super) fn own(types: &Types, walked: &Walked, id: ExprId) -> Own {
    let kind = &walked.shader.expr(id).kind;
    let operands = Operands::of(types, walked, kind);
    let mut demands: Own = smallvec![Demand::NONE; operands.len()];
    // Whether a driver that finds a 0 among the operands may give a 0 of either sign (Vulkan: without `SignedZeroInfNanPreserve`).
    let loses_signs = match kind {
        ExprKind::Binary(op, ..) | ExprKind::Assign(Some(op), ..) => {
            let before = walked.before.get(&id).map_or(&[][..], |before| before.as_slice());
            let left = if matches!(kind, ExprKind::Assign(..)) { before } else { operands.facts(0) };
            let floats = operands.is_float(0) || operands.is_float(1);
            let right = operands.facts(1);
            demands.copy_from_slice(&if floats { float_pair(*op, left, right) } else { int_pair(*op, right) });
            matches!(op, BinaryOp::Mul | BinaryOp::Div | BinaryOp::Add | BinaryOp::Sub | BinaryOp::MatMul)
        }
        ExprKind::BuiltinCall(function, _) => {
            demands = builtins::own(*function, &operands);
            builtins::loses_signs(function.class())
        }
        // These compute nothing, or it is the specification that says what they give.
        ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Member(..)
        | ExprKind::Index(..)
        | ExprKind::Swizzle(..)
        | ExprKind::Convert(_)
        | ExprKind::Construct(..)
        | ExprKind::Unary(..)
        | ExprKind::Logical(..)
        | ExprKind::Ternary(..)
        | ExprKind::Comma(..)
        | ExprKind::Call(..)
        | ExprKind::IncDec(..)
        | ExprKind::Assign(None, ..)
        | ExprKind::Error => false,
    };
    if loses_signs && walked.is_looked_at(id) {
        let floats = demands.iter_mut().enumerate().filter(|(index, _)| operands.is_float(*index));
        floats.for_each(|(_, demand)| *demand = demand.and(Demand::NO_ZERO));
    }
    if is_constant_without_value(walked, id, types) {
        demands.iter_mut().for_each(|demand| *demand = Demand::KEEP);
    }
    demands
}

/// A driver could compute it, and it might not be finite, or GLSL leaves it undefined.
fn is_constant_without_value(walked: &Walked, id: ExprId, types: &Types) -> bool {
    let expr = walked.shader.expr(id);
    let by_component = match &expr.kind {
        ExprKind::Convert(_) => true,
        ExprKind::Binary(op, ..) => *op != BinaryOp::MatMul,
        ExprKind::BuiltinCall(function, _) => {
            matches!(function.class(), Class::Unary(_) | Class::Binary(_) | Class::Ternary(_) | Class::Numbers(_))
        }
        ExprKind::Error
        | ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Member(..)
        | ExprKind::Index(..)
        | ExprKind::Swizzle(..)
        | ExprKind::Construct(..)
        | ExprKind::Unary(..)
        | ExprKind::Logical(..)
        | ExprKind::Ternary(..)
        | ExprKind::Comma(..)
        | ExprKind::Call(..)
        | ExprKind::IncDec(..)
        | ExprKind::Assign(..) => return false,
    };
    let facts = walked.facts(id);
    let float = types.scalar_of(expr.ty) == Some(Scalar::Float);
    let free =
        |fact: &Fact| fact.constant && fact.bound && fact.value().is_none() && !(float && fact.range().is_finite());
    if by_component {
        return facts.iter().any(free);
    }
    let constant = !facts.is_empty() && facts.iter().all(|fact| fact.constant);
    constant && facts.iter().any(free)
}

fn float_pair(op: BinaryOp, a: &[Fact], b: &[Fact]) -> [Demand; 2] {
    let each = |judge: fn(Fact, Fact) -> [Demand; 2]| {
        let mut demands = [Demand::NONE; 2];
        for index in 0..a.len().max(b.len()).max(1) {
            let [x, y] = judge(spread_or_any(a, index), spread_or_any(b, index));
            demands = [demands[0].and(x), demands[1].and(y)];
        }
        demands
    };
    match op {
        BinaryOp::Mul => each(|a, b| product(a, b, false)),
        BinaryOp::Div => each(quotient),
        BinaryOp::Add | BinaryOp::Sub => each(sum),
        BinaryOp::MatMul => {
            // Any component of one may meet any of the other.
            let finite = |facts: &[Fact]| !facts.is_empty() && facts.iter().all(|fact| fact.range().is_finite());
            [zero_unless(finite(b)), zero_unless(finite(a))]
        }
        // A comparison gives no float, and a NaN to nobody.
        BinaryOp::Less
        | BinaryOp::Greater
        | BinaryOp::LessEqual
        | BinaryOp::GreaterEqual
        | BinaryOp::Equal
        | BinaryOp::NotEqual => [Demand::NONE; 2],
        // There are none of floats.
        BinaryOp::Rem
        | BinaryOp::Shl
        | BinaryOp::Shr
        | BinaryOp::BitAnd
        | BinaryOp::BitXor
        | BinaryOp::BitOr
        | BinaryOp::LogicalXor => [Demand::KEEP; 2],
    }
}

fn int_pair(op: BinaryOp, b: &[Fact]) -> [Demand; 2] {
    let right = match op {
        BinaryOp::Div | BinaryOp::Rem => keep_unless(b.iter().all(|fact| whole(*fact).is_none_or(|value| value > 0))),
        BinaryOp::Shl | BinaryOp::Shr => {
            keep_unless(b.iter().all(|fact| whole(*fact).is_none_or(|value| (0..32).contains(&value))))
        }
        // Defined for all operands.
        BinaryOp::Add
        | BinaryOp::Sub
        | BinaryOp::Mul
        | BinaryOp::MatMul
        | BinaryOp::BitAnd
        | BinaryOp::BitXor
        | BinaryOp::BitOr
        | BinaryOp::Less
        | BinaryOp::Greater
        | BinaryOp::LessEqual
        | BinaryOp::GreaterEqual
        | BinaryOp::Equal
        | BinaryOp::NotEqual
        | BinaryOp::LogicalXor => Demand::NONE,
    };
    [Demand::NONE, right]
}
