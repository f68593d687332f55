//! Functions that inherit their precision from a formula.
//!
//! *In:* a block, and a rule with a formula of one argument. *Out:* the formula's intervals at both bounds of each lane, and
//! what the scalar function makes of them. *Holds:* the formula is most of the cost, so only that is computed for all lanes
//! together. Only the bounds of its intervals are read, so parts of it compute no exact values, which would take calls.

use super::EnvelopeBlock;
use crate::domain::envelope::formula::{self, evaluate};
use crate::domain::envelope::{EnvelopeFloat, powers};
use crate::domain::rules::Rule;
use crate::domain::{Block, Number, NumberBlock, WIDTH};
use glisten_front::builtin::operations::{Binary, Formula, Unary};
use std::f64::consts::{LN_2, LOG2_E};

impl EnvelopeBlock {
    /// A function of each lane, and of the intervals of a rule's formula at both of its bounds.
    pub(super) fn between_ends(
        &self,
        rule: &Rule,
        lane: impl Fn(EnvelopeFloat, [EnvelopeFloat; 2]) -> EnvelopeFloat,
    ) -> Self {
        let ends = [self.low, self.high].map(|ends| match rule.formula() {
            Some(formula) => bounds(formula, &Self { value: ends, low: ends, high: ends, nan: 0 }),
            None => *self,
        });
        let mut out = Self::default();
        for place in 0..WIDTH {
            let [low, high] = &ends;
            out.set(place, lane(self.get(place), [low.get(place), high.get(place)]));
        }
        out
    }
}

/// The bounds of a formula with one argument. The values mean nothing.
fn bounds(formula: &Formula, x: &EnvelopeBlock) -> EnvelopeBlock {
    let of = |part: &Formula| bounds(part, x);
    match formula {
        Formula::Argument(_) => *x,
        Formula::Constant(value) => EnvelopeBlock::splat(EnvelopeFloat::from_f64(*value)),
        Formula::Unary(op, a) => unary(*op, &of(a)),
        Formula::Binary(Binary::Mul, a, b) if a.same(b) => {
            let a = of(a);
            wide(|| a.square())
        }
        Formula::Binary(op, a, b) => binary(*op, &of(a), &of(b)),
        _ => x.map(|x| evaluate(formula, &[&[x]], 0)),
    }
}

/// Runs an operation compiled for the vector unit.
#[inline(always)]
fn wide(work: impl FnOnce() -> EnvelopeBlock) -> EnvelopeBlock {
    EnvelopeBlock::vectorized(work)
}

/// Leaves the exact values as they are.
#[inline(always)]
fn unchanged(value: f64) -> f64 {
    value
}

fn unary(op: Unary, x: &EnvelopeBlock) -> EnvelopeBlock {
    match op {
        Unary::Neg => wide(|| x.neg()),
        Unary::Sqrt => wide(|| x.sqrt()),
        Unary::Exp => wide(
            #[inline(always)]
            || {
                x.by_parts(
                    unchanged,
                    #[inline(always)]
                    |bounds| {
                        bounds.exponential(
                            #[inline(always)]
                            |end| powers::exp2(end * LOG2_E),
                        )
                    },
                    Number::exp,
                )
            },
        ),
        Unary::Log => wide(
            #[inline(always)]
            || {
                x.by_parts(
                    unchanged,
                    #[inline(always)]
                    |bounds| {
                        bounds.logarithm(
                            #[inline(always)]
                            |end| powers::log2(end) * LN_2,
                        )
                    },
                    Number::log,
                )
            },
        ),
        _ => x.map(|x| formula::unary(op, x)),
    }
}

fn binary(op: Binary, x: &EnvelopeBlock, y: &EnvelopeBlock) -> EnvelopeBlock {
    match op {
        Binary::Add => wide(|| x.add(y)),
        Binary::Sub => wide(|| x.sub(y)),
        Binary::Mul => wide(|| x.mul(y)),
        Binary::Div => wide(|| x.div(y)),
        _ => x.zip(y, |x, y| formula::binary(op, x, y)),
    }
}
