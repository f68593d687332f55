//! The operands of an operation, and what products, quotients and sums demand of theirs.
//!
//! *In:* facts. *Out:* [`Operands`], and a [`Demand`] for each operand of such an operation, by the table in [`danger`](super::danger).

use super::Demand;
use crate::facts::{Fact, GREATEST, Range, spread};
use crate::forward::Walked;
use glisten_front::hir::{ExprKind, Scalar, ScalarValue, Types};
use smallvec::SmallVec;

/// Magnitudes up to this may be multiplied in any order.
const MODERATE: f64 = 1.152_921_504_606_847e18;
/// Constants up to this may be added in any order: even together with the greatest float they round to it.
const SMALL: f64 = 1e30;

/// A demand for each operand.
pub(super) type Own = SmallVec<[Demand; 4]>;

/// The operands of an operation.
pub(super) struct Operands<'w> {
    /// The facts of each, and what its scalars are.
    list: SmallVec<[(&'w [Fact], Option<Scalar>); 4]>,
}

impl<'w> Operands<'w> {
    /// Those of an operation.
    pub(super) fn of(types: &Types, walked: &'w Walked, kind: &ExprKind) -> Self {
        let each = kind.children().into_iter();
        Self { list: each.map(|id| (walked.facts(id), types.scalar_of(walked.shader.expr(id).ty))).collect() }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// The facts of one.
    pub(super) fn facts(&self, index: usize) -> &'w [Fact] {
        self.list.get(index).map_or(&[], |(facts, _)| facts)
    }

    /// The fact of a component; a scalar is every component.
    pub(super) fn fact(&self, index: usize, component: usize) -> Fact {
        let facts = self.facts(index);
        if facts.is_empty() { Fact::ANY } else { spread(facts, component) }
    }

    /// The number of components of the longest, at least one.
    pub(super) fn components(&self) -> usize {
        self.list.iter().map(|(facts, _)| facts.len()).max().unwrap_or(0).max(1)
    }

    /// Whether the scalars of one are floats.
    pub(super) fn is_float(&self, index: usize) -> bool {
        self.list.get(index).is_some_and(|(_, scalar)| *scalar == Some(Scalar::Float))
    }

    /// Whether one is known to be neither infinite nor NaN.
    pub(super) fn is_finite(&self, index: usize) -> bool {
        self.all(index, |range| range.is_finite())
    }

    /// Whether one is known to be so small that products of a few such numbers do not overflow.
    pub(super) fn is_moderate(&self, index: usize) -> bool {
        self.all(index, |range| range.is_finite() && range.magnitude() <= 1e9)
    }

    /// Whether one is known not to be NaN.
    pub(super) fn has_no_nan(&self, index: usize) -> bool {
        self.all(index, |range| !range.nan)
    }

    fn all(&self, index: usize, holds: impl Fn(Range) -> bool) -> bool {
        let facts = self.facts(index);
        !facts.is_empty() && facts.iter().all(|fact| holds(fact.range()))
    }
}

/// The fact of a component of what may be unknown.
pub(super) fn spread_or_any(facts: &[Fact], index: usize) -> Fact {
    if facts.is_empty() { Fact::ANY } else { spread(facts, index) }
}

/// No 0 unless this holds.
pub(super) fn zero_unless(finite: bool) -> Demand {
    if finite { Demand::NONE } else { Demand::NO_ZERO }
}

/// No literal unless this holds.
pub(super) fn keep_unless(safe: bool) -> Demand {
    if safe { Demand::NONE } else { Demand::KEEP }
}

/// The factors of a product; `divides`: the second is a divisor.
pub(super) fn product(a: Fact, b: Fact, divides: bool) -> [Demand; 2] {
    let (x, y) = (a.range(), b.range());
    let zero = [zero_unless(y.is_finite()), zero_unless(x.is_finite())];
    let order = match (a.constant, b.constant) {
        (false, true) => [Demand::NONE, joined(a, y, divides)],
        (true, false) => [joined(b, x, false), Demand::NONE],
        (false, false) if (a.up && b.scaled) || (b.up && a.scaled) => {
            let safe = x.is_bounded() && y.is_bounded() && x.magnitude().max(y.magnitude()) <= MODERATE;
            [keep_unless(safe), keep_unless(safe)]
        }
        (false, false) | (true, true) => [Demand::NONE; 2],
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

/// Whether a divisor may become its reciprocal.
pub(super) fn has_reciprocal(divisor: Range) -> bool {
    let least = divisor.low.abs().min(divisor.high.abs());
    !divisor.has_zero() && least >= 2f64.powi(-120) && divisor.magnitude() <= 2f64.powi(120)
}

/// The operands of a quotient.
pub(super) fn quotient(a: Fact, b: Fact) -> [Demand; 2] {
    let y = b.range();
    let divisor = if b.constant { keep_unless(has_reciprocal(y)).and(product(a, b, true)[1]) } else { Demand::NONE };
    let dividend = zero_unless(y.is_finite() && !y.has_zero());
    let scale = if a.constant { Demand::NONE } else { product(a, b, true)[0] };
    [dividend.and(scale), divisor]
}

/// The terms of a sum.
pub(super) fn sum(a: Fact, b: Fact) -> [Demand; 2] {
    let safe = |constant: Fact, other: Fact| {
        let both = constant.range().magnitude() + other.range().magnitude();
        constant.range().magnitude() <= SMALL || both < GREATEST / 4.0
    };
    match (a.constant, b.constant) {
        (true, false) => [keep_unless(safe(a, b)), Demand::NONE],
        (false, true) => [Demand::NONE, keep_unless(safe(b, a))],
        (true, true) | (false, false) => [Demand::NONE; 2],
    }
}

/// An integer that is known.
pub(super) fn whole(fact: Fact) -> Option<i64> {
    match fact.value()? {
        ScalarValue::Int(value) => Some(i64::from(value)),
        ScalarValue::Uint(value) => Some(i64::from(value)),
        ScalarValue::Float(_) | ScalarValue::Bool(_) => None,
    }
}
