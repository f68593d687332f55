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
                is_bound: !(always | never),
            };
        }
        answers
    }
}

/// Operations of one block: the scalar's for the value and for lanes with a NaN, and the bounds.
macro_rules! of_one {
    ($($name:ident($a:ident) = $bounds:expr;)*) => {
        $(
            #[inline(always)]
            fn $name(&self) -> Self {
                self.by_parts(
                    Number::$name,
                    #[inline(always)]
                    |$a| $bounds,
                    Number::$name,
                )
            }
        )*
    };
}

/// Operations of two blocks. `dropping NaN`: a lane may drop a NaN, and is the scalar's then.
macro_rules! of_two {
    ($($name:ident($a:ident, $b:ident) $(dropping $nan:ident)? = $bounds:expr;)*) => {
        $(
            #[inline(always)]
            fn $name(&self, other: &Self) -> Self {
                self.by_both(
                    other,
                    of_two!(@scalar self, other $($nan)?),
                    Number::$name,
                    #[inline(always)]
                    |$a, $b| $bounds,
                    Number::$name,
                )
            }
        )*
    };
    (@scalar $self:ident, $other:ident) => { 0 };
    (@scalar $self:ident, $other:ident NaN) => { $self.nan | $other.nan };
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
    // A row has the scalar's name, and the bounds of a lane.
    of_one! {
        neg(a) = a.neg();
        abs(a) = a.abs();
        square(a) = a.square();
        floor(bounds) = bounds.rising(f64::floor);
        fract(a) = a.fract();
        sqrt(a) = a.square_root();
        inversesqrt(a) = a.inverse_square_root();
        exp(bounds) = bounds.exponential(#[inline(always)] |end| powers::exp2(end * LOG2_E));
        exp2(bounds) = bounds.exponential(powers::exp2);
        log(bounds) = bounds.logarithm(#[inline(always)] |end| powers::log2(end) * LN_2);
        log2(bounds) = bounds.logarithm(powers::log2);
    }
    of_two! {
        add(a, b) = a.add(b);
        sub(a, b) = a.sub(b);
        mul(a, b) = a.mul(b);
        div(a, b) = a.div(b);
        pow(a, b) = a.power(b);
        min(a, b) dropping NaN = a.min(b);
        max(a, b) dropping NaN = a.max(b);
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
