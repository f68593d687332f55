//! Operations of the language on blocks.

use super::EnvelopeBlock;
use super::lane::LaneBounds;
use super::sum::Sum;
use crate::domain::envelope::{EnvelopeFloat, EnvelopeInt, powers};
use crate::domain::{Block, Integer, Number, NumberBlock, WIDTH, rules, unit};
use std::f64::consts::{LN_2, LOG2_E};

/// The answers for the lanes of a block.
pub(super) type Answers = [EnvelopeInt; WIDTH];

impl EnvelopeBlock {
    /// A comparison, given the lanes where it is true of all pairs, and those where it is true of none.
    #[inline(always)]
    fn answered(
        &self,
        other: &Self,
        always: impl Fn(LaneBounds, LaneBounds) -> bool,
        never: impl Fn(LaneBounds, LaneBounds) -> bool,
        answer: impl Fn(f64, f64) -> bool,
    ) -> Answers {
        let nan = self.nan | other.nan;
        let mut answers = Answers::default();
        for (lane, slot) in answers.iter_mut().enumerate() {
            let (a, b) = (self.bounds(lane), other.bounds(lane));
            let decided = nan >> lane & 1 == 0;
            let (always, never) = (always(a, b) & decided, never(a, b) & decided);
            let likely = answer(self.value[lane], other.value[lane]);
            *slot = EnvelopeInt {
                bits: u32::from(always | (likely & !never)),
                low: i32::from(always),
                high: i32::from(!never),
            };
        }
        answers
    }
}

impl NumberBlock<EnvelopeFloat> for EnvelopeBlock {
    const OWN: bool = true;
    #[inline(always)]
    fn if_vectorized<R>(work: impl FnOnce() -> R) -> Option<R> {
        unit::if_wide(work)
    }
    #[inline(always)]
    fn vectorized<R>(work: impl FnOnce() -> R) -> R {
        unit::widest(work)
    }
    #[inline(always)]
    fn widen(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn narrow(wide: &Self) -> Self {
        *wide
    }
    #[inline(always)]
    fn sum(count: usize, term: impl Fn(usize) -> Self) -> Self {
        Sum::of(count, term)
    }
    #[inline(always)]
    fn neg(&self) -> Self {
        self.by_parts(
            Number::neg,
            #[inline(always)]
            |a| a.neg(),
            Number::neg,
        )
    }
    #[inline(always)]
    fn abs(&self) -> Self {
        self.by_parts(
            Number::abs,
            #[inline(always)]
            |a| a.abs(),
            Number::abs,
        )
    }
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self.by_both(
            other,
            0,
            Number::add,
            #[inline(always)]
            |a, b| a.add(b),
            Number::add,
        )
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.by_both(
            other,
            0,
            Number::sub,
            #[inline(always)]
            |a, b| a.sub(b),
            Number::sub,
        )
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        self.by_both(
            other,
            0,
            Number::mul,
            #[inline(always)]
            |a, b| a.mul(b),
            Number::mul,
        )
    }
    #[inline(always)]
    fn square(&self) -> Self {
        self.by_parts(
            Number::square,
            #[inline(always)]
            |a| a.square(),
            Number::square,
        )
    }
    #[inline(always)]
    fn div(&self, other: &Self) -> Self {
        self.by_both(
            other,
            0,
            Number::div,
            #[inline(always)]
            |a, b| a.div(b),
            Number::div,
        )
    }
    #[inline(always)]
    fn floor(&self) -> Self {
        self.by_parts(
            Number::floor,
            #[inline(always)]
            |bounds| bounds.rising(f64::floor),
            Number::floor,
        )
    }
    #[inline(always)]
    fn fract(&self) -> Self {
        self.by_parts(
            Number::fract,
            #[inline(always)]
            |a| a.fract(),
            Number::fract,
        )
    }
    #[inline(always)]
    fn sqrt(&self) -> Self {
        self.by_parts(
            Number::sqrt,
            #[inline(always)]
            |a| a.square_root(),
            Number::sqrt,
        )
    }
    #[inline(always)]
    fn inversesqrt(&self) -> Self {
        self.by_parts(
            Number::inversesqrt,
            #[inline(always)]
            |a| a.inverse_square_root(),
            Number::inversesqrt,
        )
    }
    #[inline(always)]
    fn exp(&self) -> Self {
        self.by_parts(
            Number::exp,
            #[inline(always)]
            |bounds| {
                bounds.exponential(
                    #[inline(always)]
                    |end| powers::exp2(end * LOG2_E),
                )
            },
            Number::exp,
        )
    }
    #[inline(always)]
    fn exp2(&self) -> Self {
        self.by_parts(
            Number::exp2,
            #[inline(always)]
            |bounds| bounds.exponential(powers::exp2),
            Number::exp2,
        )
    }
    #[inline(always)]
    fn log(&self) -> Self {
        self.by_parts(
            Number::log,
            #[inline(always)]
            |bounds| {
                bounds.logarithm(
                    #[inline(always)]
                    |end| powers::log2(end) * LN_2,
                )
            },
            Number::log,
        )
    }
    #[inline(always)]
    fn log2(&self) -> Self {
        self.by_parts(
            Number::log2,
            #[inline(always)]
            |bounds| bounds.logarithm(powers::log2),
            Number::log2,
        )
    }
    #[inline(always)]
    fn pow(&self, exponent: &Self) -> Self {
        self.by_both(
            exponent,
            0,
            Number::pow,
            #[inline(always)]
            |a, b| a.power(b),
            Number::pow,
        )
    }
    fn sinh(&self) -> Self {
        self.between_ends(&rules::SINH, |x, ends| x.rising_between(&rules::SINH, f64::sinh, ends))
    }
    fn cosh(&self) -> Self {
        let mut out = self.abs().between_ends(&rules::COSH, |x, ends| x.rising_between(&rules::COSH, f64::cosh, ends));
        out.value = self.value.map(f64::cosh);
        out
    }
    fn tanh(&self) -> Self {
        self.between_ends(&rules::TANH, EnvelopeFloat::hyperbolic_tangent)
    }
    fn asinh(&self) -> Self {
        self.between_ends(&rules::ASINH, |x, ends| x.rising_between(&rules::ASINH, f64::asinh, ends))
    }
    fn acosh(&self) -> Self {
        self.between_ends(&rules::ACOSH, EnvelopeFloat::area_cosine)
    }
    fn atanh(&self) -> Self {
        self.between_ends(&rules::ATANH, EnvelopeFloat::area_tangent)
    }
    #[inline(always)]
    fn unit_scale(&self) -> Self {
        self.by_parts(
            #[inline(always)]
            |value| 1.0 / value.sqrt(),
            #[inline(always)]
            |a| a.unit_scale(),
            Number::unit_scale,
        )
    }
    #[inline(always)]
    fn scaled(&self, scale: &Self) -> Self {
        self.by_both(
            scale,
            0,
            Number::mul,
            #[inline(always)]
            |a, b| a.scaled(b),
            Number::scaled,
        )
    }
    #[inline(always)]
    fn limited(&self, least: &Self, most: &Self) -> Self {
        let mut out = self.max(least).min(most);
        let mut crossed = 0;
        for lane in 0..WIDTH {
            crossed |= u64::from(least.high[lane] > most.low[lane]);
        }
        if crossed != 0 {
            for lane in 0..WIDTH {
                out.set(lane, self.get(lane).limited(least.get(lane), most.get(lane)));
            }
        }
        out
    }
    #[inline(always)]
    fn cosine_at_most(&self) -> Self {
        // Infinite bounds leave everything unchanged.
        self.by_parts(
            #[inline(always)]
            |value| value,
            #[inline(always)]
            |a| a.cosine_at_most(),
            Number::cosine_at_most,
        )
    }
    #[inline(always)]
    fn min(&self, other: &Self) -> Self {
        self.by_both(
            other,
            self.nan | other.nan,
            Number::min,
            #[inline(always)]
            |a, b| a.min(b),
            Number::min,
        )
    }
    #[inline(always)]
    fn max(&self, other: &Self) -> Self {
        self.by_both(
            other,
            self.nan | other.nan,
            Number::max,
            #[inline(always)]
            |a, b| a.max(b),
            Number::max,
        )
    }
    #[inline(always)]
    fn mix(&self, y: &Self, a: &Self) -> Self {
        let nan = self.nan | y.nan | a.nan;
        let mut out = Self { nan, ..Self::default() };
        for lane in 0..WIDTH {
            out.value[lane] = self.value[lane] * (1.0 - a.value[lane]) + y.value[lane] * a.value[lane];
        }
        out.fill(
            #[inline(always)]
            move |lane| self.bounds(lane).mixed(y.bounds(lane), a.bounds(lane)),
            0,
            #[inline(always)]
            move |lane| self.get(lane).mix(y.get(lane), a.get(lane)),
        );
        out
    }
    #[inline(always)]
    fn less(&self, other: &Self) -> Answers {
        self.answered(
            other,
            #[inline(always)]
            |a, b| a.high < b.low,
            #[inline(always)]
            |a, b| a.low >= b.high,
            #[inline(always)]
            |a, b| a < b,
        )
    }
    #[inline(always)]
    fn less_equal(&self, other: &Self) -> Answers {
        self.answered(
            other,
            #[inline(always)]
            |a, b| a.high <= b.low,
            #[inline(always)]
            |a, b| a.low > b.high,
            #[inline(always)]
            |a, b| a <= b,
        )
    }
    #[inline(always)]
    fn equal(&self, other: &Self) -> Answers {
        self.answered(
            other,
            #[inline(always)]
            |a, b| (a.low == a.high) & (b.low == b.high) & (a.low == b.low),
            #[inline(always)]
            |a, b| (a.high < b.low) | (b.high < a.low),
            #[inline(always)]
            |a, b| a == b,
        )
    }

    /// `condition ? yes : no`
    #[inline(always)]
    fn select(condition: &Answers, yes: &Self, no: &Self) -> Self {
        let mut out = Self::default();
        let either = yes.nan | no.nan;
        for (lane, condition) in condition.iter().enumerate() {
            let (holds, undecided) = (condition.bits != 0, condition.low != condition.high);
            let (chosen, other) =
                if holds { (yes.bounds(lane), no.bounds(lane)) } else { (no.bounds(lane), yes.bounds(lane)) };
            out.value[lane] = if holds { yes.value[lane] } else { no.value[lane] };
            out.low[lane] = if undecided & (other.low < chosen.low) { other.low } else { chosen.low };
            out.high[lane] = if undecided & (other.high > chosen.high) { other.high } else { chosen.high };
        }
        if either != 0 {
            for (lane, condition) in condition.iter().enumerate() {
                let nan = if condition.bits != 0 { yes.nan } else { no.nan };
                out.nan |= if condition.is_decided() { nan } else { either } & 1 << lane;
            }
        }
        out
    }
}
