//! [`Interval`]: an interval of possible values of a number.

use serde::Serialize;

/// A closed interval of reals, and whether the number may be NaN. Bounds may be infinite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
    /// Whether the number may be NaN.
    pub may_be_nan: bool,
}

impl Interval {
    /// Any value.
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, may_be_nan: true };

    /// Exactly one value; for NaN, any value.
    pub fn point(value: f64) -> Self {
        if value.is_nan() { Self::ALL } else { Self { low: value, high: value, may_be_nan: false } }
    }

    /// The values at most `error` from `value`; any value if that is NaN.
    pub fn around(value: f64, error: f64) -> Self {
        let (low, high) = (value - error, value + error);
        if low <= high { Self { low, high, may_be_nan: false } } else { Self::ALL }
    }

    /// Whether the number may have this value.
    pub fn contains(self, value: f64) -> bool {
        if value.is_nan() { self.may_be_nan } else { self.low <= value && value <= self.high }
    }

    /// The smallest interval that contains both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            may_be_nan: self.may_be_nan || other.may_be_nan,
        }
    }

    /// How far the number may be from `from`, which is inside, on the side of `to`: infinite if it is unbounded
    /// there, 0 if the number is exact.
    pub fn room(self, from: f64, to: f64) -> f64 {
        let room = match to.partial_cmp(&from) {
            Some(std::cmp::Ordering::Less) => from - self.low,
            Some(std::cmp::Ordering::Greater) => self.high - from,
            _ => (from - self.low).max(self.high - from),
        };
        if room.is_nan() { f64::INFINITY } else { room.max(0.0) }
    }

    /// The largest distance of the number from `from`.
    pub fn reach(self, from: f64) -> f64 {
        if self.low == from && self.high == from {
            return 0.0;
        }
        let reach = (from - self.low).max(self.high - from);
        if reach.is_nan() { f64::INFINITY } else { reach.max(0.0) }
    }

    /// The distance between the bounds.
    pub fn width(self) -> f64 {
        if self.low == self.high { 0.0 } else { self.high - self.low }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_their_ends_and_nan_only_if_told() {
        let range = Interval::around(1.0, 0.5);
        assert!(range.contains(0.5) && range.contains(1.5) && !range.contains(1.6) && !range.contains(f64::NAN));
        assert!(Interval::ALL.contains(f64::NAN) && Interval::ALL.contains(f64::INFINITY));
        assert_eq!(Interval::point(f64::NAN), Interval::ALL);
        assert_eq!(Interval::around(f64::INFINITY, f64::INFINITY), Interval::ALL);
    }

    #[test]
    fn room_is_that_of_the_side() {
        let range = Interval { low: 0.0, high: 3.0, may_be_nan: false };
        assert_eq!((range.room(1.0, 0.5), range.room(1.0, 2.0), range.room(1.0, 1.0)), (1.0, 2.0, 2.0));
        assert_eq!(range.hull(Interval::point(-1.0)).width(), 4.0);
        assert_eq!(Interval::point(f64::INFINITY).reach(f64::INFINITY), 0.0);
    }
}
