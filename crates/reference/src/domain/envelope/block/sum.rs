//! Sums of blocks, in any order.

use super::EnvelopeBlock;
use super::lane::LaneBounds;
use crate::domain::envelope::EnvelopeFloat;
use crate::domain::envelope::float::{greatest, least};
use crate::domain::{Block, WIDTH};

/// A sum in progress, with the state that [`EnvelopeFloat::summed`] keeps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    value: [f64; WIDTH],
    low: [f64; WIDTH],
    high: [f64; WIDTH],
    deepest: [f64; WIDTH],
    highest: [f64; WIDTH],
    /// The number of terms that are not 0.
    count: [f64; WIDTH],
    /// 0 if all terms are numbers of few digits.
    uneven: [u64; WIDTH],
    nan: u8,
}

impl Sum {
    #[inline(always)]
    fn push(&mut self, term: &EnvelopeBlock) {
        for lane in 0..WIDTH {
            let (low, high) = (term.low[lane], term.high[lane]);
            self.value[lane] += term.value[lane];
            self.low[lane] += low;
            self.high[lane] += high;
            self.deepest[lane] += least(low, 0.0);
            self.highest[lane] += greatest(high, 0.0);
            self.count[lane] += if (low != 0.0) | (high != 0.0) { 1.0 } else { 0.0 };
            self.uneven[lane] |= u64::from(!EnvelopeFloat::is_plain(low, high));
        }
        self.nan |= term.nan;
    }

    /// The sum of `count` terms.
    #[inline(always)]
    pub(super) fn of(count: usize, term: impl Fn(usize) -> EnvelopeBlock) -> EnvelopeBlock {
        // -0 and a number are that number, whatever its sign.
        let mut sum = Self { value: [-0.0; WIDTH], ..Self::default() };
        for place in 0..count {
            sum.push(&term(place));
        }
        let sum = &sum;
        let mut out = EnvelopeBlock { value: sum.value, nan: sum.nan, ..EnvelopeBlock::default() };
        out.fill(
            #[inline(always)]
            move |lane| sum.bounds(lane),
            0,
            #[inline(always)]
            move |lane| EnvelopeFloat::summed((0..count).map(|place| term(place).get(lane))),
        );
        out
    }

    /// The bounds of the sum in a lane.
    #[inline(always)]
    fn bounds(&self, lane: usize) -> LaneBounds {
        let size = greatest(self.highest[lane], -self.deepest[lane]);
        let plain = self.uneven[lane] == 0;
        let roundings = EnvelopeFloat::roundings_of_sum(self.count[lane], plain, size);
        LaneBounds::rounded(self.low[lane] - roundings, self.high[lane] + roundings).or_special(!size.is_finite())
    }
}
