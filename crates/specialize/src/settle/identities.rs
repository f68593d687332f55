//! Operations that give one of their operands back, bit for bit.
//!
//! *In:* an operation with the facts of its operands. *Out:* the operand that it gives back, if it is sure.
//! *Holds:* signs of zeros and NaNs come out alike: `x + 0.0` is `x` only where `x` is not -0, `max(x, 0.0)` only where `x`
//! is neither NaN nor below. Where nobody sees the sign of a zero (see `signs`), -0 is 0.

use crate::Math;
use crate::facts::{Fact, GREATEST, Range, What, at, spread};
use crate::forward::Walked;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, LogicalOp, Scalar, ScalarValue, TypeId};
use smallvec::SmallVec;
use std::borrow::Cow;

/// The number of the operand that an operation gives back.
pub(super) fn operand(walked: &Walked, id: ExprId) -> Option<usize> {
    let expr = walked.shader.expr(id);
    let operation = Operation::of(walked, id);
    let typed = |index: usize| operation.ty(index) == Some(expr.ty);
    let facts = |index: usize| operation.facts(index);
    let pure = |index: usize| operation.is_pure(index);
    let gives = |kept: usize, other: usize, test: &dyn Fn(Fact, Fact) -> bool| {
        (typed(kept) && pure(other) && holds(facts(kept), facts(other), test)).then_some(kept)
    };
    let leaves = |kept: usize, other: usize, neutral: bool| {
        (typed(kept) && pure(other) && truth(facts(other)) == Some(neutral)).then_some(kept)
    };
    match &expr.kind {
        ExprKind::Logical(op, ..) => leaves(0, 1, *op == LogicalOp::And),
        ExprKind::Binary(BinaryOp::Equal, ..) => leaves(0, 1, true).or_else(|| leaves(1, 0, true)),
        ExprKind::Binary(BinaryOp::NotEqual | BinaryOp::LogicalXor, ..) => {
            leaves(0, 1, false).or_else(|| leaves(1, 0, false))
        }
        ExprKind::Binary(BinaryOp::MatMul, ..) => {
            let leaves = |kept: usize, other: usize| {
                (typed(kept) && pure(other) && is_product_with_one(facts(kept), facts(other))).then_some(kept)
            };
            leaves(1, 0).or_else(|| leaves(0, 1))
        }
        ExprKind::Binary(op, ..) => of_numbers(walked.math, *op, &gives),
        ExprKind::BuiltinCall(F::Max, _) => gives(0, 1, &is_above).or_else(|| gives(1, 0, &is_above)),
        ExprKind::BuiltinCall(F::Min, _) => gives(0, 1, &is_below).or_else(|| gives(1, 0, &is_below)),
        ExprKind::BuiltinCall(F::Clamp, _) => {
            gives(0, 1, &is_above).filter(|_| pure(2) && holds(facts(0), facts(2), &is_below))
        }
        ExprKind::BuiltinCall(F::Abs, _) => {
            (typed(0) && holds(facts(0), facts(0), &|x, _| is_not_negative(x))).then_some(0)
        }
        ExprKind::BuiltinCall(F::Fract, _) => {
            (typed(0) && holds(facts(0), facts(0), &|x, _| is_not_negative(x) && x.range().high < 1.0)).then_some(0)
        }
        ExprKind::BuiltinCall(F::Mod, _) => gives(0, 1, &is_remainder),
        ExprKind::BuiltinCall(F::Pow, _) => gives(0, 1, &|x, c| is_not_negative(x) && is(c, 1.0)),
        ExprKind::BuiltinCall(F::Mix, _) => mixed(walked.math, &facts).filter(|kept| typed(*kept) && (0..3).all(pure)),
        _ => None,
    }
}

/// The number of the scalar that an operation with a vector gives back in every component: of `vec3(1.0) * x` the second.
pub(super) fn spread_operand(walked: &Walked, id: ExprId) -> Option<usize> {
    let expr = walked.shader.expr(id);
    let ExprKind::Binary(op, ..) = expr.kind else { return None };
    let operation = Operation::of(walked, id);
    let typed = |index: usize| operation.ty(index).is_some_and(|ty| is_vector_of(expr.ty, ty));
    let gives = |kept: usize, other: usize, test: &dyn Fn(Fact, Fact) -> bool| {
        let facts = |index: usize| operation.facts(index);
        let each = (0..facts(other).len()).all(|index| test(spread(facts(kept), index), at(facts(other), index)));
        (typed(kept) && operation.is_pure(other) && !facts(other).is_empty() && each).then_some(kept)
    };
    of_numbers(walked.math, op, &gives)
}

/// The number of the operand that an operation gives back as its opposite: of `a == false` the first.
pub(super) fn negated_operand(walked: &Walked, id: ExprId) -> Option<usize> {
    let expr = walked.shader.expr(id);
    let ExprKind::Binary(op, ..) = expr.kind else { return None };
    let neutral = match op {
        BinaryOp::Equal => false,
        BinaryOp::NotEqual | BinaryOp::LogicalXor => true,
        _ => return None,
    };
    let operation = Operation::of(walked, id);
    let leaves = |kept: usize, other: usize| {
        let is_bool = operation.ty(kept) == Some(TypeId::BOOL);
        (is_bool && operation.is_pure(other) && truth(operation.facts(other)) == Some(neutral)).then_some(kept)
    };
    leaves(0, 1).or_else(|| leaves(1, 0))
}

/// The number of the operand of which an operation gives a part back, and the number of the part: of `dot(v, vec3(0.0, 0.0, 1.0))` the third
/// component of the first, of `m * vec2(1.0, 0.0)` the first column.
pub(super) fn part(walked: &Walked, id: ExprId) -> Option<(usize, u8)> {
    let operation = Operation::of(walked, id);
    let finite = |facts: &[Fact]| !facts.is_empty() && facts.iter().all(|fact| fact.range().is_finite());
    let of = |kept: usize, axis: usize| {
        let (facts, part) =
            (operation.facts(kept), axis_of(operation.facts(axis)).filter(|_| operation.is_pure(axis))?);
        let len = facts.len() / operation.facts(axis).len();
        let own = facts.get(part * len..(part + 1) * len)?;
        let keeps = finite(facts) && own.iter().all(|fact| !fact.range().negative_zero);
        keeps.then_some((kept, part as u8))
    };
    match walked.shader.expr(id).kind {
        ExprKind::BuiltinCall(F::Dot, _) => of(0, 1).or_else(|| of(1, 0)),
        // A matrix times a vector; of two matrices, the second is no axis.
        ExprKind::Binary(BinaryOp::MatMul, ..)
            if operation.facts(0).len() > operation.facts(1).len()
                && operation.ty(1).is_some_and(|ty| is_vector_of(ty, TypeId::FLOAT)) =>
        {
            of(0, 1)
        }
        _ => None,
    }
}

/// Which axis a vector is: the number of its component that is 1 where all others are 0.
fn axis_of(facts: &[Fact]) -> Option<usize> {
    let axis = facts.iter().position(|fact| is(*fact, 1.0)).filter(|_| facts.len() > 1)?;
    facts.iter().enumerate().all(|(index, fact)| index == axis || fact.is_zero()).then_some(axis)
}

/// Whether an operation gives a value with the first fact back, where the other has the second.
type Test<'a> = &'a dyn Fn(Fact, Fact) -> bool;

/// The operand that an operator on numbers gives back. `gives` tries one, by the other and a test.
fn of_numbers(math: Math, op: BinaryOp, gives: &dyn Fn(usize, usize, Test<'_>) -> Option<usize>) -> Option<usize> {
    match op {
        BinaryOp::Mul => gives(0, 1, &|_, c| is(c, 1.0)).or_else(|| gives(1, 0, &|_, c| is(c, 1.0))),
        BinaryOp::Div => gives(0, 1, &|_, c| is(c, 1.0)),
        BinaryOp::Add | BinaryOp::Sub if math == Math::Fast && gives(0, 1, &is_zero).is_some() => Some(0),
        BinaryOp::Add if math == Math::Fast && gives(1, 0, &is_zero).is_some() => Some(1),
        BinaryOp::Add => gives(0, 1, &adds_nothing).or_else(|| gives(1, 0, &adds_nothing)),
        BinaryOp::Sub => gives(0, 1, &takes_nothing),
        _ => None,
    }
}

/// An operation and its operands.
struct Operation<'w> {
    walked: &'w Walked,
    children: SmallVec<[ExprId; 4]>,
    facts: SmallVec<[Cow<'w, [Fact]>; 4]>,
}

impl<'w> Operation<'w> {
    fn of(walked: &'w Walked, id: ExprId) -> Self {
        let children = walked.shader.expr(id).kind.children();
        let facts = children.iter().map(|child| as_seen(walked, id, walked.facts(*child))).collect();
        Self { walked, children, facts }
    }

    fn facts(&self, index: usize) -> &[Fact] {
        self.facts.get(index).map_or(&[][..], |facts| facts)
    }

    fn ty(&self, index: usize) -> Option<TypeId> {
        self.children.get(index).map(|child| self.walked.shader.expr(*child).ty)
    }

    fn is_pure(&self, index: usize) -> bool {
        let note = self.children.get(index).and_then(|child| self.walked.notes.get(child.index()));
        note.is_some_and(|note| note.pure)
    }
}

/// The facts of an operand as an operation needs them: where nobody sees the sign of a zero of its result, -0 is 0.
pub(super) fn as_seen<'w>(walked: &Walked, operation: ExprId, facts: &'w [Fact]) -> Cow<'w, [Fact]> {
    if !walked.is_unsigned(operation) {
        Cow::Borrowed(facts)
    } else if facts.is_empty() {
        // Of a vector: this holds for each component.
        Cow::Owned(vec![Fact::ANY.without_sign()])
    } else {
        Cow::Owned(facts.iter().map(|fact| fact.without_sign()).collect())
    }
}

/// Whether a type is that of vectors of such scalars.
pub(super) fn is_vector_of(vector: TypeId, scalar: TypeId) -> bool {
    [Scalar::Float, Scalar::Int, Scalar::Uint]
        .into_iter()
        .any(|of| scalar == TypeId::vector(of, 1) && (2..=4).any(|size| vector == TypeId::vector(of, size)))
}

fn truth(facts: &[Fact]) -> Option<bool> {
    facts.first().filter(|_| facts.len() == 1).and_then(|fact| fact.truth())
}

/// Whether `t = 0 op v` is `t = v`, from what is known of `t` before.
pub(super) fn starts(op: BinaryOp, before: &[Fact], value: &[Fact]) -> bool {
    match op {
        BinaryOp::Add => holds(value, before, &adds_nothing),
        BinaryOp::Mul => holds(value, before, &|_, c| is(c, 1.0)),
        _ => false,
    }
}

/// Whether `t op= v` leaves `t` as it is, from what is known of `t` before: what [`operand`] is for `t op v`.
pub(super) fn keeps(op: BinaryOp, math: Math, before: &[Fact], value: &[Fact]) -> bool {
    match op {
        BinaryOp::Mul | BinaryOp::Div => holds(before, value, &|_, c| is(c, 1.0)),
        BinaryOp::Add | BinaryOp::Sub if math == Math::Fast && holds(before, value, &is_zero) => true,
        BinaryOp::Add => holds(before, value, &adds_nothing),
        BinaryOp::Sub => holds(before, value, &takes_nothing),
        _ => false,
    }
}

fn holds(kept: &[Fact], other: &[Fact], test: &dyn Fn(Fact, Fact) -> bool) -> bool {
    let len = kept.len().max(other.len());
    !other.is_empty()
        && (0..len)
            .all(|index| test(if kept.is_empty() { Fact::ANY } else { spread(kept, index) }, spread(other, index)))
}

fn is(fact: Fact, value: f32) -> bool {
    match fact.value() {
        Some(ScalarValue::Float(known)) => known.to_bits() == value.to_bits(),
        Some(ScalarValue::Int(known)) => known as f32 == value,
        Some(ScalarValue::Uint(known)) => known as f32 == value,
        Some(ScalarValue::Bool(_)) | None => false,
    }
}

/// Whether it is 0, of either sign: under fast math that adds nothing to anything.
fn is_zero(_: Fact, c: Fact) -> bool {
    is(c, 0.0) || is(c, -0.0)
}

/// `x + c`: `-0 + 0` is 0.
fn adds_nothing(x: Fact, c: Fact) -> bool {
    let integers = matches!(c.what, What::Value(ScalarValue::Int(0) | ScalarValue::Uint(0)));
    integers || is(c, -0.0) || (c.is_zero() && !x.range().negative_zero)
}

/// `x - c`: `-0 - -0` is 0.
fn takes_nothing(x: Fact, c: Fact) -> bool {
    let integers = matches!(c.what, What::Value(ScalarValue::Int(0) | ScalarValue::Uint(0)));
    let is_plain = c.is_zero() && !c.range().negative_zero;
    integers || is_plain || (c.is_zero() && !x.range().negative_zero)
}

/// Whether a linear algebra product of a vector or a matrix with a matrix gives it back: the matrix is the identity, and sums that
/// end in zeros of either sign keep what is finite and not -0.
fn is_product_with_one(kept: &[Fact], matrix: &[Fact]) -> bool {
    let side = matrix.len().isqrt();
    let is_identity = side >= 2
        && side * side == matrix.len()
        && matrix
            .iter()
            .enumerate()
            .all(|(index, fact)| if index % (side + 1) == 0 { is(*fact, 1.0) } else { fact.is_zero() });
    let keeps = |fact: &Fact| fact.range().is_finite() && !fact.range().negative_zero;
    is_identity && !kept.is_empty() && kept.iter().all(keeps)
}

/// Whether it is neither below 0, nor -0, nor NaN.
fn is_not_negative(x: Fact) -> bool {
    match x.what {
        What::Value(ScalarValue::Float(_)) | What::Float(_) => {
            let range = x.range();
            !range.nan && !range.negative_zero && range.low >= 0.0
        }
        What::Value(ScalarValue::Int(low)) | What::Int(low, _) => low >= 0,
        _ => false,
    }
}

/// `mod(x, y)` of an `x` between 0 and a finite `y`: the whole number of `x / y`, however it is rounded, is 0.
fn is_remainder(x: Fact, y: Fact) -> bool {
    let (range, whole) = (x.range(), y.range());
    is_not_negative(x) && is_not_negative(y) && whole.is_bounded() && range.high < whole.low * (1.0 - 1e-5)
}

/// Whether one may be 0 and the other -0: which of equal numbers comes back depends on their order.
fn may_be_both_zeros(a: Range, b: Range) -> bool {
    a.has_zero() && b.has_zero() && (a.negative_zero || b.negative_zero)
}

/// `max(x, c)`
fn is_above(x: Fact, c: Fact) -> bool {
    let (range, limit) = (x.range(), c.range());
    let floats = matches!(c.what, What::Value(ScalarValue::Float(_)) | What::Float(_));
    floats && !range.nan && !limit.nan && range.low >= limit.high && !may_be_both_zeros(range, limit)
}

/// `min(x, c)`
fn is_below(x: Fact, c: Fact) -> bool {
    let (range, limit) = (x.range(), c.range());
    let floats = matches!(c.what, What::Value(ScalarValue::Float(_)) | What::Float(_));
    floats && !range.nan && !limit.nan && range.high <= limit.low && !may_be_both_zeros(range, limit)
}

/// `mix(a, b, 0.0)` and `mix(a, b, 1.0)` of moderate numbers, or of any where all are taken to be finite. What is left of the other is a
/// 0 of either sign, which changes nothing but a -0.
fn mixed<'f>(math: Math, facts: &dyn Fn(usize) -> &'f [Fact]) -> Option<usize> {
    let moderate = |facts: &[Fact]| {
        let small = |fact: &Fact| {
            fact.range().is_finite() && (math != Math::Exact || fact.range().magnitude() < GREATEST / 4.0)
        };
        !facts.is_empty() && facts.iter().all(small)
    };
    let all = |value: f32| !facts(2).is_empty() && facts(2).iter().all(|fact| is(*fact, value) && !is_integer(*fact));
    let kept = if all(0.0) { 0 } else { all(1.0).then_some(1)? };
    let exact = moderate(facts(0)) && moderate(facts(1)) && facts(kept).iter().all(|fact| !fact.range().negative_zero);
    (math == Math::Fast || exact).then_some(kept)
}

fn is_integer(fact: Fact) -> bool {
    matches!(fact.value(), Some(ScalarValue::Int(_) | ScalarValue::Uint(_) | ScalarValue::Bool(_)))
}
