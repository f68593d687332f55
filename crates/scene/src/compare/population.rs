//! [`Population`]: what a number of simulated conforming GPUs drew, and whether a pixel lies far outside of that.
//!
//! *In:* the colors of the members, and a GPU's color. *Out:* whether the color is suspect.
//!
//! *The rule:* a channel is suspect if it is further outside of the population's range than [`SPREADS`] times the
//! width of that range and [`ULPS`] units in the last place of the larger bound, or if it is not finite and no member's
//! is. Only a pixel that all members cover is judged so. From [`MIN_SHARE`] of the covered pixels and [`MIN_PIXELS`]
//! pixels on, suspects fail a comparison.

use super::ulp_f32;
use crate::picture::Interval;

/// How many widths of the population's range a number may be outside of it.
pub const SPREADS: f64 = 8.0;

/// How many units in the last place a number may be outside of the population's range.
pub const ULPS: f64 = 64.0;

/// The share of the covered pixels from which suspects fail.
pub const MIN_SHARE: f64 = 0.001;

/// The number of suspects that fail at least.
pub const MIN_PIXELS: u64 = 8;

/// The pictures of a number of simulated conforming GPUs, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Population {
    /// The number of members.
    pub members: u32,
    /// The seed of their differences.
    pub seed: u64,
    /// For each attachment, pixel and channel, the lowest and highest number of the members that cover the pixel, and
    /// whether one of them is NaN. Infinities are bounds like other numbers.
    pub ranges: Vec<Vec<[Interval; 4]>>,
    /// The number of members that cover each pixel.
    pub covered: Vec<u32>,
}

impl Population {
    /// Whether a GPU's color is far outside of what the members drew.
    pub fn is_suspect(&self, attachment: usize, pixel: usize, color: [f64; 4]) -> bool {
        let all_cover = self.covered.get(pixel) == Some(&self.members);
        let ranges = self.ranges.get(attachment).and_then(|colors| colors.get(pixel)).filter(|_| all_cover);
        ranges.is_some_and(|ranges| ranges.iter().zip(color).any(|(range, value)| is_outside(*range, value)))
    }
}

fn is_outside(range: Interval, value: f64) -> bool {
    if range.contains(value) {
        return false;
    }
    if !value.is_finite() || !range.width().is_finite() {
        return !value.is_finite();
    }
    let largest = range.low.abs().max(range.high.abs());
    let margin = SPREADS * range.width() + ULPS * ulp_f32(largest);
    value < range.low - margin || value > range.high + margin
}

/// Whether so many suspects fail a comparison.
pub(super) fn fails(suspect: u64, covered: u64) -> bool {
    suspect >= MIN_PIXELS && suspect as f64 > MIN_SHARE * covered as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_outside_is_suspect() {
        let range = Interval { low: 0.5, high: 0.5 + 1e-5, may_be_nan: false };
        let cases = [
            (0.5, false),
            (0.5 - 7e-5, false),
            (0.5 - 1e-4, true),
            (0.5 + 1.5e-4, true),
            (f64::NAN, true),
            (f64::INFINITY, true),
        ];
        let population = Population { members: 2, seed: 1, ranges: vec![vec![[range; 4]; 2]], covered: vec![2, 1] };
        for (value, suspect) in cases {
            assert_eq!(population.is_suspect(0, 0, [0.5, 0.5, value, 0.5]), suspect, "{value}");
            assert!(!population.is_suspect(0, 1, [value; 4]), "not all members cover it");
        }
        assert!(!is_outside(Interval::point(1.0), 1.0 + 60.0 * ulp_f32(1.0)));
        assert!(!is_outside(Interval { may_be_nan: true, ..range }, f64::NAN));
        assert!(!is_outside(Interval { high: f64::INFINITY, ..range }, 0.1), "an unbounded range tells nothing");
    }

    #[test]
    fn few_suspects_fail_nothing() {
        let cases = [(7, 100, false), (8, 100, true), (8, 8000, false), (9, 8000, true)];
        for (suspect, covered, expected) in cases {
            assert_eq!(fails(suspect, covered), expected, "{suspect} of {covered}");
        }
    }
}
