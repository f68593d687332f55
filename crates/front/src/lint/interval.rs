//! [`Range`]: the bounds of a value, and whether they are known to be reached; with its arithmetic.
//!
//! *Holds:* the bounds are those of exact arithmetic. A sum or a product of two values that both vary reaches nothing, since they may
//! depend on each other.

/// The bounds of all components of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether some input leads to the lower bound, or below zero if there is no bound.
    pub(super) reaches_low: bool,
    /// Whether some input leads to the upper bound, or above zero if there is no bound.
    pub(super) reaches_high: bool,
}

impl Range {
    /// Nothing is known.
    pub(super) const UNKNOWN: Self =
        Self { low: f64::NEG_INFINITY, high: f64::INFINITY, reaches_low: false, reaches_high: false };

    /// Bounds that are both reached.
    pub(super) const fn reached(low: f64, high: f64) -> Self {
        Self { low, high, reaches_low: true, reaches_high: true }
    }

    /// Bounds of which nothing more is known.
    pub(super) const fn within(low: f64, high: f64) -> Self {
        Self { low, high, reaches_low: false, reaches_high: false }
    }

    pub(super) fn negated(self) -> Self {
        Self { low: -self.high, high: -self.low, reaches_low: self.reaches_high, reaches_high: self.reaches_low }
    }

    pub(super) fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            reaches_low: if self.low <= other.low { self.reaches_low } else { other.reaches_low },
            reaches_high: if self.high >= other.high { self.reaches_high } else { other.reaches_high },
        }
    }

    /// The sum; it reaches its bounds only if one side is a constant, since two values may depend on each other.
    pub(super) fn plus(self, other: Self) -> Self {
        let fixed = self.is_point() || other.is_point();
        Self {
            low: self.low + other.low,
            high: self.high + other.high,
            reaches_low: fixed && self.reaches_low && other.reaches_low,
            reaches_high: fixed && self.reaches_high && other.reaches_high,
        }
    }

    pub(super) fn times(self, other: Self) -> Self {
        let (this, other) = if self.is_point() { (other, self) } else { (self, other) };
        if other.is_point() {
            let scale = |bound: f64| if other.low == 0.0 { 0.0 } else { bound * other.low };
            let scaled = Self { low: scale(this.low), high: scale(this.high), ..this };
            return if other.low < 0.0 {
                Self {
                    low: scaled.high,
                    high: scaled.low,
                    reaches_low: this.reaches_high,
                    reaches_high: this.reaches_low,
                }
            } else {
                scaled
            };
        }
        let corners = [this.low * other.low, this.low * other.high, this.high * other.low, this.high * other.high];
        if corners.iter().any(|corner| corner.is_nan()) {
            let negative = this.low < 0.0 || other.low < 0.0;
            return Self::within(if negative { f64::NEG_INFINITY } else { 0.0 }, f64::INFINITY);
        }
        Self::within(
            corners.iter().copied().fold(f64::INFINITY, f64::min),
            corners.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    pub(super) fn is_point(self) -> bool {
        self.low == self.high
    }

    /// The range under a function that grows.
    pub(super) fn under(self, grows: impl Fn(f64) -> f64) -> Self {
        Self { low: grows(self.low), high: grows(self.high), ..self }
    }

    pub(super) fn at_least(self, other: Self) -> Self {
        // A maximum with a constant is at its lower bound where the operand is at its own, or below the constant.
        let (this, other) = if self.is_point() { (other, self) } else { (self, other) };
        let fixed = other.is_point();
        Self {
            low: this.low.max(other.low),
            high: this.high.max(other.high),
            reaches_low: fixed && this.reaches_low,
            reaches_high: fixed && this.reaches_high,
        }
    }

    pub(super) fn at_most(self, other: Self) -> Self {
        self.negated().at_least(other.negated()).negated()
    }

    pub(super) fn abs(self) -> Self {
        if self.low >= 0.0 {
            return self;
        }
        if self.high <= 0.0 {
            return self.negated();
        }
        let reaches = self.reaches_low && self.reaches_high;
        Self { low: 0.0, high: self.high.max(-self.low), reaches_low: reaches, reaches_high: reaches }
    }
}

#[cfg(test)]
mod tests {
    use super::Range;

    #[test]
    fn bounds_are_reached_where_one_side_is_a_constant() {
        let (cosine, zero, one) = (Range::reached(-1.0, 1.0), Range::reached(0.0, 0.0), Range::reached(1.0, 1.0));
        let unknown = Range::within(-1.0, 1.0);
        assert_eq!(cosine.at_least(zero), Range::reached(0.0, 1.0));
        assert_eq!(zero.at_least(cosine), Range::reached(0.0, 1.0));
        assert_eq!(cosine.at_most(zero), Range::reached(-1.0, 0.0));
        assert_eq!(cosine.at_least(unknown), unknown);
        assert_eq!(one.plus(cosine.negated()), Range::reached(0.0, 2.0));
        assert_eq!(cosine.plus(cosine), Range::within(-2.0, 2.0));
        assert_eq!(cosine.times(Range::reached(-0.5, -0.5)), Range::reached(-0.5, 0.5));
        assert_eq!(cosine.times(zero), zero);
        assert_eq!(cosine.abs(), Range::reached(0.0, 1.0));
        assert_eq!(unknown.abs(), Range::within(0.0, 1.0));
        assert!(!Range::UNKNOWN.times(cosine).reaches_low);
    }
}
