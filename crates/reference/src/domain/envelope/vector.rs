//! Sums, in any order.

use super::EnvelopeFloat;
use super::float::{greatest, least};
use crate::domain::Number;
use crate::domain::rules::ulp;

impl EnvelopeFloat {
    /// The exact sum, plus one rounding for each addition, each as large as the largest partial sum of any order
    /// allows.
    #[inline(always)]
    pub(super) fn summed(terms: impl Iterator<Item = Self> + Clone) -> Self {
        // -0 and a number are that number, whatever its sign.
        let (mut value, mut low, mut high) = (-0.0, 0.0, 0.0);
        let (mut deepest, mut highest) = (0.0, 0.0);
        let (mut may_be_nan, mut count, mut plain) = (false, 0.0, true);
        for term in terms.clone() {
            value += term.value;
            low += term.low;
            high += term.high;
            deepest += least(term.low, 0.0);
            highest += greatest(term.high, 0.0);
            may_be_nan |= term.may_be_nan;
            count += f64::from(u8::from(term.low != 0.0 || term.high != 0.0));
            plain &= Self::is_plain(term.low, term.high);
        }
        let size = greatest(highest, -deepest);
        if !size.is_finite() {
            return terms.reduce(Self::add).unwrap_or_default().of_value(value);
        }
        let roundings = Self::roundings_of_sum(count, plain, size);
        Self::rounded(value, low - roundings, high + roundings, may_be_nan)
    }

    /// Whether a term has so few digits that it may add up without rounding.
    #[inline(always)]
    pub(super) fn is_plain(low: f64, high: f64) -> bool {
        /// 1.5 * 2^52: adding it rounds to an integer.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let steps = low * GRID;
        (low == high) & ((steps + ROUND) - ROUND == steps)
    }

    /// The total error of the additions: none if every partial sum is an f32, or if there is only one term.
    #[inline(always)]
    pub(super) fn roundings_of_sum(count: f64, plain: bool, size: f64) -> f64 {
        let exact = (count <= 1.0) | (plain & (size < PLAIN));
        if exact { 0.0 } else { (count - 1.0) * ulp(size) * (1.0 + 1e-6) }
    }
}

/// Multiples of 1 / this below [`PLAIN`] add up without rounding.
const GRID: f64 = 4096.0;
const PLAIN: f64 = 4096.0;
