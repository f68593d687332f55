//! Rounding outward to f32, and ULPs over intervals.

use crate::domain::rules::{self, FLUSH, ulp};

/// The largest f32.
pub(super) const MAX: f64 = rules::OVERFLOW.limit();
/// The bits that an f64 has and an f32 lacks.
pub(super) const BELOW: u64 = (1 << 29) - 1;
/// Widens a number of ULPs to cover the intermediate roundings of f64.
pub(super) const OUTWARD: f64 = 1.0 + 1.0 / (1u64 << 20) as f64;

/// The largest f32 not above a number. A number below the normal ones may be flushed: it is 0, if that is lower. It
/// is minus infinity below the range, and above it the largest f32, which a GPU may return instead of infinity.
#[inline(always)]
pub(super) fn down(x: f64) -> f64 {
    let size = x.abs();
    if (FLUSH..=MAX).contains(&size) {
        let bits = x.to_bits();
        let negative = ((bits as i64) >> 63) as u64;
        return f64::from_bits(bits.wrapping_add(negative & BELOW) & !BELOW);
    }
    down_out_of_range(x)
}

fn down_out_of_range(x: f64) -> f64 {
    if x == 0.0 {
        0.0
    } else if x.abs() < FLUSH {
        if x < 0.0 { -FLUSH } else { 0.0 }
    } else if x > MAX {
        MAX
    } else {
        f64::NEG_INFINITY
    }
}

/// The smallest f32 not below a number, with the same rules.
#[inline(always)]
pub(super) fn up(x: f64) -> f64 {
    -down(-x)
}

/// `a + b` of two f32 numbers, not above the exact sum after [`down`]: if f64, too, loses the smaller operand, the
/// sum is moved by a little.
#[inline(always)]
pub(super) fn sum_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if (sum == a && b < 0.0) || (sum == b && a < 0.0) { sum.next_down() } else { sum }
}

/// `a + b` of two f32 numbers, not below the exact sum after [`up`].
#[inline(always)]
pub(super) fn sum_up(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if (sum == a && b > 0.0) || (sum == b && a > 0.0) { sum.next_up() } else { sum }
}

/// The lower bound of the numbers at most `n` ULP below any number from `low` to `high`. The ULP doubles at each
/// power of two, so it is taken at the largest number that could reach below the others.
#[inline(always)]
pub(super) fn ulps_below(low: f64, high: f64, n: f64) -> f64 {
    let reached = low + 2.0 * n * ulp(low);
    let reached = if high < reached { high } else { reached };
    let at = if low > 0.0 { reached } else { low };
    low - n * OUTWARD * ulp(at)
}

/// The upper bound of the numbers at most `n` ULP above any number from `low` to `high`.
#[inline(always)]
pub(super) fn ulps_above(low: f64, high: f64, n: f64) -> f64 {
    -ulps_below(-high, -low, n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_outward_and_keeps_what_is_an_f32() {
        for x in [1.0, -1.0, 0.5, 1.5e30, -3.0e-30, 0.0, f64::from(f32::MAX), f64::from(f32::MIN_POSITIVE)] {
            let single = f64::from(x as f32);
            assert_eq!((down(single), up(single)), (single, single), "{x}");
        }
        for x in [0.1, -0.1, 1.0 + 1e-12, -1.0 - 1e-12, 1e30, -7.7e-37] {
            let (low, high) = (down(x), up(x));
            assert!(low < x && x < high && f64::from(low as f32) == low && f64::from(high as f32) == high, "{x}");
            assert!(high - low <= ulp(x) * 1.01, "neighbors of {x}");
        }
    }

    #[test]
    fn what_is_too_small_or_too_large_keeps_its_ways_out() {
        assert_eq!((down(1e-40), up(1e-40)), (0.0, FLUSH));
        assert_eq!((down(-1e-40), up(-1e-40)), (-FLUSH, 0.0));
        assert_eq!((down(1e39), up(1e39)), (MAX, f64::INFINITY));
        assert_eq!((down(-1e39), up(-1e39)), (f64::NEG_INFINITY, -MAX));
    }

    #[test]
    fn a_summand_that_is_lost_still_counts() {
        assert!(down(sum_down(1.0, -1e-30)) < 1.0 && up(sum_up(1.0, 1e-30)) > 1.0);
        assert_eq!(down(sum_down(1.0, 1e-30)), 1.0);
        assert_eq!(sum_down(0.25, 0.5), 0.75);
    }

    #[test]
    fn ulps_see_the_power_of_two_inside() {
        let below = 1.0 - 1e-7;
        assert!(ulps_below(below, 1.0, 2.0) <= 1.0 - 2.0 * ulp(1.0));
        assert!(ulps_below(below, below, 2.0) > 1.0 - 2.0 * ulp(1.0) - 1e-7);
        assert!(ulps_above(-1.0, -below, 2.0) >= -1.0 + 2.0 * ulp(1.0));
    }
}
