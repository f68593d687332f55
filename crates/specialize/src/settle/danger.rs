//! What an operation demands of its operands: where a literal would let a driver gain or lose a NaN or an infinity.
//!
//! *In:* an operation with the facts of its operands. *Out:* a [`Demand`] for each operand.
//!
//! | operation | what a driver may do with a literal | so |
//! | --- | --- | --- |
//! | `x * c`, `dot(x, c)`, products of matrices | drop `x` for `c` = 0 | no 0 unless `x` is finite |
//! | `(x * a) * b` | multiply `a` and `b` first, which may overflow or not | kept unless `x` is bounded, or no constant is above 1 |
//! | `(x + a) + b` | add `a` and `b` first | kept where a constant is so large that it could overflow |
//! | `x / c` | multiply with `1 / c` | kept where that is not a normal number |
//! | `c / x` | drop `x` for `c` = 0 | no 0 unless `x` is finite and not 0 |
//! | `mix(a, b, c)` | drop `a` or `b` | kept unless both are finite |
//! | `pow(x, c)` | write products, roots or 1 | kept unless `x` >= 0 and `c` > 0 |
//! | `min`, `max`, `clamp` | saturate, which turns a NaN to 0 | kept where `x` may be NaN |
//! | any, of constants alone | compute it, by other rules | kept unless the result is finite |
//! | integer division, shifts | refuse or leave undefined | kept where the specification leaves it undefined |

use super::Demand;
use crate::facts::{Fact, GREATEST, Range, at, spread};
use crate::forward::Walked;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, Scalar, ScalarValue, Types};
use smallvec::{SmallVec, smallvec};

/// Magnitudes up to this may be multiplied in any order.
const MODERATE: f64 = 1.152_921_504_606_847e18;
/// Constants up to this may be added in any order: even together with the greatest float they round to it.
const SMALL: f64 = 1e30;

/// A demand for each operand.
pub(super) type Own = SmallVec<[Demand; 4]>;

/// The demands of an operation on its operands.
pub(super) fn own(types: &Types, walked: &Walked, id: ExprId) -> Own {
    let expr = walked.shader.expr(id);
    let children = expr.kind.children();
    let mut demands: Own = smallvec![Demand::NONE; children.len()];
    let facts = |child: usize| children.get(child).map_or(&[][..], |child| walked.facts(*child));
    let is_float = |child: usize| {
        children.get(child).and_then(|child| types.scalar_of(walked.shader.expr(*child).ty)) == Some(Scalar::Float)
    };
    match &expr.kind {
        ExprKind::Binary(op, ..) | ExprKind::Assign(Some(op), ..) => {
            let before = walked.before.get(&id).map_or(&[][..], |before| before.as_slice());
            let left = if matches!(expr.kind, ExprKind::Assign(..)) { before } else { facts(0) };
            let pair =
                if is_float(0) || is_float(1) { float_pair(*op, left, facts(1)) } else { int_pair(*op, facts(1)) };
            demands.copy_from_slice(&pair);
        }
        ExprKind::BuiltinCall(function, _) => builtin(*function, &facts, &mut demands),
        _ => {}
    }
    let computed = matches!(expr.kind, ExprKind::Binary(..) | ExprKind::BuiltinCall(..) | ExprKind::Convert(_));
    if computed && is_constant_without_value(walked, id, types) {
        demands.iter_mut().for_each(|demand| *demand = Demand::KEEP);
    }
    demands
}

/// A driver could compute it, and it might not be finite, or GLSL leaves it undefined.
fn is_constant_without_value(walked: &Walked, id: ExprId, types: &Types) -> bool {
    let facts = walked.facts(id);
    let constant = !facts.is_empty() && facts.iter().all(|fact| fact.constant) && facts.iter().any(|fact| fact.bound);
    if !constant || facts.iter().all(|fact| fact.value().is_some()) {
        return false;
    }
    match types.scalar_of(walked.shader.expr(id).ty) {
        Some(Scalar::Float) => facts.iter().any(|fact| !fact.range().is_finite()),
        _ => true,
    }
}

fn float_pair(op: BinaryOp, a: &[Fact], b: &[Fact]) -> [Demand; 2] {
    let len = a.len().max(b.len()).max(1);
    let mut demands = [Demand::NONE; 2];
    for index in 0..len {
        let (a, b) = (spread_or_any(a, index), spread_or_any(b, index));
        let [x, y] = match op {
            BinaryOp::Mul => product(a, b, false),
            BinaryOp::Div => quotient(a, b),
            BinaryOp::Add | BinaryOp::Sub => sum(a, b),
            BinaryOp::MatMul => [Demand::NONE; 2],
            _ => [Demand::NONE; 2],
        };
        demands = [demands[0].and(x), demands[1].and(y)];
    }
    if op == BinaryOp::MatMul {
        // Any component of one may meet any of the other.
        let finite = |facts: &[Fact]| !facts.is_empty() && facts.iter().all(|fact| fact.range().is_finite());
        demands = [zero_unless(finite(b)), zero_unless(finite(a))];
    }
    demands
}

fn spread_or_any(facts: &[Fact], index: usize) -> Fact {
    if facts.is_empty() { Fact::ANY } else { spread(facts, index) }
}

fn zero_unless(finite: bool) -> Demand {
    if finite { Demand::NONE } else { Demand::NO_ZERO }
}

fn keep_unless(safe: bool) -> Demand {
    if safe { Demand::NONE } else { Demand::KEEP }
}

fn product(a: Fact, b: Fact, divides: bool) -> [Demand; 2] {
    let (x, y) = (a.range(), b.range());
    let zero = [zero_unless(y.is_finite()), zero_unless(x.is_finite())];
    let order = match (a.constant, b.constant) {
        (false, true) => [Demand::NONE, joined(a, y, divides)],
        (true, false) => [joined(b, x, false), Demand::NONE],
        (false, false) if (a.up && b.scaled) || (b.up && a.scaled) => {
            let safe = x.is_bounded() && y.is_bounded() && x.magnitude().max(y.magnitude()) <= MODERATE;
            [keep_unless(safe), keep_unless(safe)]
        }
        _ => [Demand::NONE; 2],
    };
    [zero[0].and(order[0]), zero[1].and(order[1])]
}

/// The demand on a constant factor next to others.
fn joined(product: Fact, constant: Range, divides: bool) -> Demand {
    let range = product.range();
    let bounded = range.is_bounded() && range.magnitude() <= MODERATE && constant.magnitude() <= MODERATE;
    let large = if divides { constant.low.abs().min(constant.high.abs()) < 1.0 } else { constant.magnitude() > 1.0 };
    let alone = if large { !product.scaled } else { !product.up };
    keep_unless(bounded || alone)
}

fn quotient(a: Fact, b: Fact) -> [Demand; 2] {
    let (x, y) = (a.range(), b.range());
    let least = y.low.abs().min(y.high.abs());
    let normal = !y.has_zero() && least >= 2f64.powi(-120) && y.magnitude() <= 2f64.powi(120);
    let divisor = if b.constant { keep_unless(normal).and(product(a, b, true)[1]) } else { Demand::NONE };
    let dividend = zero_unless(y.is_finite() && !y.has_zero());
    let scale = if a.constant { Demand::NONE } else { product(a, b, true)[0] };
    let _ = x;
    [dividend.and(scale), divisor]
}

fn sum(a: Fact, b: Fact) -> [Demand; 2] {
    let safe = |constant: Fact, other: Fact| {
        let both = constant.range().magnitude() + other.range().magnitude();
        constant.range().magnitude() <= SMALL || both < GREATEST / 4.0
    };
    match (a.constant, b.constant) {
        (true, false) => [keep_unless(safe(a, b)), Demand::NONE],
        (false, true) => [Demand::NONE, keep_unless(safe(b, a))],
        _ => [Demand::NONE; 2],
    }
}

fn int_pair(op: BinaryOp, b: &[Fact]) -> [Demand; 2] {
    let defined = |fact: &Fact| match (op, fact.value()) {
        (BinaryOp::Div | BinaryOp::Rem, Some(ScalarValue::Int(value))) => value > 0,
        (BinaryOp::Div | BinaryOp::Rem, Some(ScalarValue::Uint(value))) => value > 0,
        (BinaryOp::Shl | BinaryOp::Shr, Some(ScalarValue::Int(value))) => (0..32).contains(&value),
        (BinaryOp::Shl | BinaryOp::Shr, Some(ScalarValue::Uint(value))) => value < 32,
        _ => true,
    };
    [Demand::NONE, keep_unless(b.iter().all(defined))]
}

fn builtin<'w>(function: F, facts: &dyn Fn(usize) -> &'w [Fact], demands: &mut Own) {
    let finite = |child: usize| {
        let facts = facts(child);
        !facts.is_empty() && facts.iter().all(|fact| fact.range().is_finite())
    };
    let no_nan = |child: usize| !facts(child).is_empty() && facts(child).iter().all(|fact| !fact.range().nan);
    let own: Own = match function {
        F::Dot | F::Cross | F::MatrixCompMult | F::OuterProduct | F::Reflect | F::Faceforward | F::Atan => {
            smallvec![zero_unless(finite(1)), zero_unless(finite(0)), zero_unless(finite(0) && finite(1))]
        }
        F::Refract => {
            let all = keep_unless(finite(0) && finite(1) && finite(2));
            smallvec![all, all, all]
        }
        F::Mix => {
            let [a, b, t] = [0, 1, 2].map(finite);
            // Which of the two a `bvec` chooses is no arithmetic; its facts are no finite floats.
            smallvec![keep_unless(t), keep_unless(t), keep_unless(a && b)]
        }
        F::Pow => powers(facts(0), facts(1)),
        F::Min | F::Max => smallvec![keep_unless(no_nan(1)), keep_unless(no_nan(0))],
        F::Clamp => smallvec![Demand::NONE, keep_unless(no_nan(0)), keep_unless(no_nan(0))],
        F::Smoothstep => {
            let apart = (0..facts(0).len().max(1)).all(|index| {
                let width = spread_or_any(facts(1), index).range().sub(spread_or_any(facts(0), index).range());
                !width.has_zero() && width.is_finite()
            });
            let edges = keep_unless(apart && finite(2));
            smallvec![edges, edges, Demand::NONE]
        }
        F::Mod => {
            let apart = !facts(1).is_empty() && facts(1).iter().all(|fact| !fact.range().has_zero());
            smallvec![zero_unless(finite(1)), keep_unless(apart && finite(0))]
        }
        _ => smallvec![],
    };
    demands.iter_mut().zip(own).for_each(|(slot, demand)| *slot = demand);
}

fn powers(x: &[Fact], y: &[Fact]) -> Own {
    let len = x.len().max(y.len()).max(1);
    let mut demands: Own = smallvec![Demand::NONE; 2];
    for index in 0..len {
        let (x, y) = (at(x, index.min(x.len().max(1) - 1)), at(y, index.min(y.len().max(1) - 1)));
        let base = x.range().low > 0.0 && (x.range().equal(Range::point(1.0)).is_some() || y.range().is_finite());
        let exponent = x.range().low >= 0.0 && y.range().low > 0.0;
        demands[0] = demands[0].and(keep_unless(base));
        demands[1] = demands[1].and(keep_unless(exponent));
    }
    demands
}
