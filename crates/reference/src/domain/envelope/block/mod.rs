//! [`EnvelopeBlock`]: eight numbers, with each of their parts side by side, so that an operation is a few vector
//! instructions.
//!
//! *In:* operands of eight lanes. *Out:* the result of [`EnvelopeFloat`]'s operation in each lane.
//!
//! *Holds:* the scalar operation is the definition. Nearly all lanes are computed together without branches. A lane
//! that needs special treatment by a rule (infinite bounds, a NaN that may be dropped, a divisor that contains 0) is
//! *special*, and the scalar operation computes it again. Both have the same result, except for the sign of a zero.
//!
//! | file | contents |
//! | --- | --- |
//! | `inherited` | functions that inherit from a formula, at both bounds of all lanes |
//! | `lane` | the operations on one lane's bounds, without branches |
//! | `operations` | the operations on blocks |
//! | `sum` | sums of products, in any order |

mod inherited;
mod lane;
mod operations;
mod sum;
#[cfg(test)]
mod tests;

use super::EnvelopeFloat;
use crate::domain::{Block, Element, WIDTH};
use lane::LaneBounds;
use std::cell::Cell;
use std::hint::black_box;

thread_local! {
    /// How often special lanes of a block were computed again on this thread.
    static REDONE: Cell<u64> = const { Cell::new(0) };
}

/// The cost of computing special lanes of blocks again on this thread since the last call: half an addition of 64 lanes each time.
pub(crate) fn take_redone() -> u64 {
    REDONE.take() / 2
}

/// A number in each of eight lanes. Vectors of four never cross a cache line.
#[repr(align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnvelopeBlock {
    value: [f64; WIDTH],
    low: [f64; WIDTH],
    high: [f64; WIDTH],
    /// The lanes that may be NaN.
    nan: u8,
}

/// The special lanes are those that are not 0.
type Special = [u64; WIDTH];

impl Element for EnvelopeFloat {
    type Block = EnvelopeBlock;
}

impl Block<EnvelopeFloat> for EnvelopeBlock {
    #[inline(always)]
    fn splat(number: EnvelopeFloat) -> Self {
        Self {
            value: [number.value; WIDTH],
            low: [number.low; WIDTH],
            high: [number.high; WIDTH],
            nan: if number.may_be_nan { u8::MAX } else { 0 },
        }
    }

    #[inline(always)]
    fn of(numbers: &[EnvelopeFloat; WIDTH]) -> Self {
        let mut out = Self::default();
        for (lane, number) in numbers.iter().enumerate() {
            out.value[lane] = number.value;
            out.low[lane] = number.low;
            out.high[lane] = number.high;
            out.nan |= u8::from(number.may_be_nan) << lane;
        }
        out
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> EnvelopeFloat {
        let lane = lane % WIDTH;
        EnvelopeFloat {
            value: self.value[lane],
            low: self.low[lane],
            high: self.high[lane],
            may_be_nan: self.nan >> lane & 1 == 1,
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, number: EnvelopeFloat) {
        let lane = lane % WIDTH;
        self.value[lane] = number.value;
        self.low[lane] = number.low;
        self.high[lane] = number.high;
        self.nan = self.nan & !(1 << lane) | u8::from(number.may_be_nan) << lane;
    }

    #[inline(always)]
    fn replaced(&self, by: &Self, mask: u8) -> Self {
        let mut out = *self;
        for lane in 0..WIDTH {
            let new = mask >> lane & 1 == 1;
            out.value[lane] = if new { by.value[lane] } else { self.value[lane] };
            out.low[lane] = if new { by.low[lane] } else { self.low[lane] };
            out.high[lane] = if new { by.high[lane] } else { self.high[lane] };
        }
        out.nan = self.nan & !mask | by.nan & mask;
        out
    }
}

impl EnvelopeBlock {
    #[inline(always)]
    fn bounds(&self, lane: usize) -> LaneBounds {
        LaneBounds::of(self.low[lane], self.high[lane])
    }

    /// Writes the bounds of all lanes, and computes those again that are special or in `forced`.
    #[inline(always)]
    fn fill(&mut self, bounds: impl Fn(usize) -> LaneBounds, forced: u8, exact: impl Fn(usize) -> EnvelopeFloat) {
        let (mut low, mut high, mut special) = ([0.0; WIDTH], [0.0; WIDTH], [0; WIDTH]);
        let mut any = u64::from(forced);
        for lane in 0..WIDTH {
            let bounds = bounds(lane);
            low[lane] = bounds.low;
            high[lane] = bounds.high;
            special[lane] = u64::from(bounds.special);
            any |= special[lane];
        }
        self.low = low;
        self.high = high;
        if any != 0 {
            // These are copies, so that the compiler knows that nothing else reads or writes what the loop does.
            *self = black_box(*self).redone(black_box(special), forced, exact);
        }
    }

    #[cold]
    #[inline(never)]
    fn redone(mut self, special: Special, forced: u8, exact: impl Fn(usize) -> EnvelopeFloat) -> Self {
        REDONE.set(REDONE.get() + 1);
        for (lane, special) in special.iter().enumerate() {
            if *special != 0 || forced >> lane & 1 == 1 {
                self.set(lane, exact(lane));
            }
        }
        self
    }

    /// Applies a function.
    #[inline(always)]
    fn by_parts(
        &self,
        value: impl Fn(f64) -> f64,
        bounds: impl Fn(LaneBounds) -> LaneBounds,
        exact: impl Fn(EnvelopeFloat) -> EnvelopeFloat,
    ) -> Self {
        let mut out = Self { nan: self.nan, ..Self::default() };
        for lane in 0..WIDTH {
            out.value[lane] = value(self.value[lane]);
        }
        out.fill(
            #[inline(always)]
            move |lane| bounds(self.bounds(lane)),
            0,
            #[inline(always)]
            move |lane| exact(self.get(lane)),
        );
        out
    }

    /// Applies a function of two operands; `forced` contains the lanes that may drop a NaN.
    #[inline(always)]
    fn by_both(
        &self,
        other: &Self,
        forced: u8,
        value: impl Fn(f64, f64) -> f64,
        bounds: impl Fn(LaneBounds, LaneBounds) -> LaneBounds,
        exact: impl Fn(EnvelopeFloat, EnvelopeFloat) -> EnvelopeFloat,
    ) -> Self {
        let mut out = Self { nan: self.nan | other.nan, ..Self::default() };
        for lane in 0..WIDTH {
            out.value[lane] = value(self.value[lane], other.value[lane]);
        }
        out.fill(
            #[inline(always)]
            move |lane| bounds(self.bounds(lane), other.bounds(lane)),
            forced,
            #[inline(always)]
            move |lane| exact(self.get(lane), other.get(lane)),
        );
        out
    }
}
