//! Sums, in any order.

use super::EnvelopeFloat;
use super::round::{down, up};
use crate::cpu::domain::Number;
use crate::cpu::domain::rules::ulp;

impl EnvelopeFloat {
    /// The exact sum, and a rounding for each addition, each as large as the largest partial sum of any order allows.
    #[inline(always)]
    pub(super) fn summed(terms: impl Iterator<Item = Self> + Clone) -> Self {
        let (mut value, mut low, mut high) = (0.0, 0.0, 0.0);
        let (mut deepest, mut highest) = (0.0, 0.0);
        let (mut may_be_nan, mut count, mut plain) = (false, 0.0, true);
        for product in terms.clone() {
            value += product.value;
            low += product.low;
            high += product.high;
            deepest += product.low.min(0.0);
            highest += product.high.max(0.0);
            may_be_nan |= product.may_be_nan;
            count += f64::from(u8::from(product.low != 0.0 || product.high != 0.0));
            plain &= product.low == product.high && (product.low * GRID).fract() == 0.0;
        }
        let size = highest.max(-deepest);
        if !size.is_finite() {
            return terms.reduce(Self::add).unwrap_or_default().of_value(value);
        }
        if count <= 1.0 || (plain && size < PLAIN) {
            // Every partial sum is an f32, or there is but one summand.
            return Self { value, low: down(low), high: up(high), may_be_nan };
        }
        let roundings = (count - 1.0) * ulp(size) * (1.0 + 1e-6);
        Self::rounded(value, low - roundings, high + roundings, may_be_nan)
    }
}

/// Multiples of 1 / this below [`PLAIN`] add up without rounding.
const GRID: f64 = 4096.0;
const PLAIN: f64 = 4096.0;
