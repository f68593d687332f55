//! [`Range`]: where a `float` can be, on every conforming target.
//!
//! *In:* ranges of operands. *Out:* the range of the result of an operation, rounded outward by what a target's precision
//! (Vulkan, "Precision of core SPIR-V Instructions") may add: contraction, flushing of subnormals and any order of
//! summation included.
//!
//! *Holds:* a result that a conforming f32 target, the reference in f32 or the reference in f64 can give lies in the range,
//! or is NaN and [`Range::nan`] says so. The ends are f64; an end beyond the greatest f32 is infinite.

/// The least normal f32.
const LEAST_NORMAL: f64 = f32::MIN_POSITIVE as f64;
/// The greatest f32.
pub(crate) const GREATEST: f64 = f32::MAX as f64;
/// One ULP of f32, relative.
const ULP: f64 = f32::EPSILON as f64;

/// An interval of f32 numbers with what it leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    /// The least value.
    pub(crate) low: f64,
    /// The greatest value.
    pub(crate) high: f64,
    /// Whether it can be NaN.
    pub(crate) nan: bool,
    /// Whether it can be -0, in the reference's f32, which flushes nothing.
    pub(crate) negative_zero: bool,
}

impl Range {
    /// Everything.
    pub(crate) const ANY: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, nan: true, negative_zero: true };

    /// Exactly one number.
    pub(crate) fn point(value: f32) -> Self {
        if value.is_nan() {
            return Self::ANY;
        }
        let wide = f64::from(value);
        let negative_zero = value == 0.0 && value.is_sign_negative();
        Self { low: wide, high: wide, nan: false, negative_zero }.flushed()
    }

    /// All numbers between two, both included.
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Self { low, high, nan: false, negative_zero: low <= 0.0 && high >= 0.0 }
    }

    /// The same, rounded outward by so many ULPs.
    fn rounded(low: f64, high: f64, ulps: f64) -> Self {
        let slack = ulps * ULP;
        let low = if low.is_nan() { f64::NEG_INFINITY } else { low };
        let high = if high.is_nan() { f64::INFINITY } else { high };
        let mut range = Self::between(low - low.abs() * slack, high + high.abs() * slack);
        if range.low < -GREATEST || low == f64::NEG_INFINITY {
            range.low = f64::NEG_INFINITY;
        }
        if range.high > GREATEST || high == f64::INFINITY {
            range.high = f64::INFINITY;
        }
        range.flushed()
    }

    /// Ends among the subnormals go to 0, since a target may flush them.
    fn flushed(self) -> Self {
        let low = if self.low > 0.0 && self.low < LEAST_NORMAL { 0.0 } else { self.low };
        let high = if self.high < 0.0 && self.high > -LEAST_NORMAL { 0.0 } else { self.high };
        Self { low, high, ..self }
    }

    fn with(self, nan: bool, negative_zero: bool) -> Self {
        Self { nan, negative_zero: negative_zero && self.has_zero(), ..self }
    }

    /// The least range that holds both.
    pub(crate) fn join(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            nan: self.nan || other.nan,
            negative_zero: self.negative_zero || other.negative_zero,
        }
    }

    /// Neither NaN nor infinite.
    pub(crate) fn is_finite(self) -> bool {
        !self.nan && self.is_bounded()
    }

    /// Not infinite.
    pub(crate) fn is_bounded(self) -> bool {
        self.low >= -GREATEST && self.high <= GREATEST
    }

    /// Whether 0 is among the values.
    pub(crate) fn has_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// The greatest magnitude.
    pub(crate) fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Neither negative, nor -0.
    pub(crate) fn is_plus(self) -> bool {
        self.low >= 0.0 && !self.negative_zero
    }

    fn may_be_infinite(self) -> bool {
        !self.is_bounded()
    }

    /// `-x`
    pub(crate) fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low, nan: self.nan, negative_zero: self.has_zero() }
    }

    /// `a + b`
    pub(crate) fn add(self, other: Self) -> Self {
        let opposite = (self.high == f64::INFINITY && other.low == f64::NEG_INFINITY)
            || (self.low == f64::NEG_INFINITY && other.high == f64::INFINITY);
        let range = Self::rounded(self.low + other.low, self.high + other.high, 1.0);
        range.with(self.nan || other.nan || opposite, self.negative_zero && other.negative_zero)
    }

    /// `a - b`
    pub(crate) fn sub(self, other: Self) -> Self {
        let plus = other.low <= 0.0 && other.high >= 0.0;
        let range = self.add(other.neg());
        range.with(range.nan, self.negative_zero && plus)
    }

    /// `a * b`
    pub(crate) fn mul(self, other: Self) -> Self {
        let undefined = (self.has_zero() && other.may_be_infinite()) || (other.has_zero() && self.may_be_infinite());
        let corners = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        let range = Self::hull(&corners, 1.0);
        let alike = (self.is_plus() && other.is_plus()) || (self.high < 0.0 && other.high < 0.0);
        range.with(self.nan || other.nan || undefined, !alike)
    }

    /// `x * x`
    pub(crate) fn square(self) -> Self {
        let least = if self.has_zero() { 0.0 } else { self.low.abs().min(self.high.abs()) };
        Self::rounded(least * least, self.magnitude() * self.magnitude(), 1.0).with(self.nan, false)
    }

    /// `a / b`: within 2.5 ULP for divisors from 2^-126 to 2^126, anything beyond.
    pub(crate) fn div(self, other: Self) -> Self {
        let huge = other.magnitude() > 2f64.powi(126);
        if other.has_zero() || huge {
            let signless = self.low >= 0.0 && other.is_plus();
            let low = if signless { 0.0 } else { f64::NEG_INFINITY };
            let nan = self.nan || other.nan || huge || self.has_zero() || self.may_be_infinite();
            return Self { low, high: f64::INFINITY, nan, negative_zero: !(self.is_plus() && other.is_plus()) };
        }
        let corners = [self.low / other.low, self.low / other.high, self.high / other.low, self.high / other.high];
        let alike = (self.is_plus() && other.is_plus()) || (self.high < 0.0 && other.high < 0.0);
        Self::hull(&corners, 4.0).with(self.nan || other.nan, !alike)
    }

    fn hull(corners: &[f64], ulps: f64) -> Self {
        // A corner of 0 times infinity is 0; that it may be NaN is noted apart.
        let corners = corners.iter().map(|corner| if corner.is_nan() { 0.0 } else { *corner });
        let (low, high) =
            corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), corner| (low.min(corner), high.max(corner)));
        Self::rounded(low, high, ulps)
    }

    /// `a0 b0 + a1 b1 + ...` in any order.
    pub(crate) fn sum(terms: &[Self]) -> Self {
        let Some((first, rest)) = terms.split_first() else { return Self::point(0.0) };
        let plain = rest.iter().fold(*first, |sum, term| sum.add(*term));
        if !plain.is_bounded() {
            return plain;
        }
        let nonnegative = terms.iter().all(|term| term.low >= 0.0);
        let slack: f64 = terms.iter().map(|term| term.magnitude()).sum::<f64>() * ULP * (terms.len() as f64 + 1.0);
        let low = if nonnegative { plain.low.min((plain.low - slack).max(0.0)) } else { plain.low - slack };
        Self { low, high: plain.high + slack, ..plain }.flushed()
    }

    /// `min(a, b)`: of a NaN either operand may come back.
    pub(crate) fn min(self, other: Self) -> Self {
        self.extremum(other, f64::min)
    }

    /// `max(a, b)`
    pub(crate) fn max(self, other: Self) -> Self {
        self.extremum(other, f64::max)
    }

    fn extremum(self, other: Self, pick: fn(f64, f64) -> f64) -> Self {
        let range = Self {
            low: pick(self.low, other.low),
            high: pick(self.high, other.high),
            nan: self.nan || other.nan,
            negative_zero: self.negative_zero || other.negative_zero,
        };
        // Where one is NaN the other comes back, wherever it lies.
        let range = if self.nan { range.join(Self { nan: false, ..other }) } else { range };
        if other.nan { range.join(Self { nan: false, ..self }) } else { range }
    }

    /// `abs(x)`
    pub(crate) fn abs(self) -> Self {
        let low = if self.has_zero() { 0.0 } else { self.low.abs().min(self.high.abs()) };
        Self { low, high: self.magnitude(), nan: self.nan, negative_zero: false }
    }

    /// A function that grows, within so many ULPs and so much; `None` of an end is beyond all bounds.
    pub(crate) fn growing(self, f: fn(f64) -> f64, ulps: f64, error: f64) -> Self {
        let (low, high) = (f(self.low), f(self.high));
        let range = Self::rounded(low, high, ulps);
        let nan = self.nan || low.is_nan() || high.is_nan();
        Self { low: range.low - error, high: range.high + error, nan, negative_zero: true }.flushed()
    }

    /// The same, never below a number.
    pub(crate) fn at_least(self, low: f64) -> Self {
        let low = self.low.max(low);
        Self { low, high: self.high.max(low), negative_zero: self.negative_zero && low <= 0.0, ..self }
    }

    /// What is left of it where it is known to be in another range, and no NaN.
    pub(crate) fn within(self, other: Self) -> Self {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        if low > high { self } else { Self { low, high, nan: false, ..self } }
    }

    /// Whether `a < b`, where that is sure. With a NaN it is false.
    pub(crate) fn less(self, other: Self) -> Option<bool> {
        match () {
            () if self.low >= other.high => Some(false),
            () if self.nan || other.nan => None,
            () if self.high < other.low => Some(true),
            () => None,
        }
    }

    /// Whether `a <= b`, where that is sure. With a NaN it is false.
    pub(crate) fn less_equal(self, other: Self) -> Option<bool> {
        match () {
            () if self.low > other.high => Some(false),
            () if self.nan || other.nan => None,
            () if self.high <= other.low => Some(true),
            () => None,
        }
    }

    /// Whether `a == b`, where that is sure. With a NaN it is false.
    pub(crate) fn equal(self, other: Self) -> Option<bool> {
        (self.high < other.low || other.high < self.low).then_some(false)
    }
}

#[cfg(test)]
mod tests {
    use super::Range;

    #[test]
    fn zero_times_what_may_be_infinite_may_be_nan() {
        let any = Range { nan: false, ..Range::ANY };
        assert!(Range::point(0.0).mul(any).nan);
        assert!(!Range::point(2.0).mul(any).nan);
    }

    #[test]
    fn squares_and_products_of_what_is_not_negative_have_no_sign() {
        let unit = Range::between(-1.0, 1.0);
        assert!(unit.square().is_plus());
        assert!(!unit.mul(unit).is_plus());
        assert!(!Range::point(0.0).add(Range::between(-0.0, 1.0)).negative_zero);
    }

    #[test]
    fn an_answer_of_true_is_sure_only_where_no_nan_is() {
        let plus = Range::between(1.0, 2.0);
        assert_eq!(Range::point(0.0).less(plus), Some(true));
        assert_eq!(Range::point(0.0).less(Range { nan: true, ..plus }), None);
        assert_eq!(plus.less(Range { nan: true, ..Range::point(0.0) }), Some(false));
        assert_eq!(plus.less_equal(plus), None);
    }
}
