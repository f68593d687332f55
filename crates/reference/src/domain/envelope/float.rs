//! Operators, comparisons, conversions and selecting functions of the envelope.

use super::round::{OUTWARD, down, sum_down, sum_up, ulps_above, ulps_below, up};
use super::{EnvelopeFloat, EnvelopeInt, powers};
use crate::domain::rules::{self, FLUSH, ulp};
use crate::domain::{Integer, Number};
use glisten_front::builtin::operations::Precision;
use glisten_scene::picture::Interval;
use std::f64::consts::{LN_2, LOG2_E};

/// `minNum`: a NaN is dropped.
#[inline(always)]
pub(super) fn least(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

#[inline(always)]
pub(super) fn greatest(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Whether a number is 2^n, for an n from -126 to 126, or the negative of that.
#[inline(always)]
pub(super) fn is_power_of_two(value: f64) -> bool {
    const MANTISSA: u64 = (1 << 52) - 1;
    value.to_bits() & MANTISSA == 0 && (FLUSH..=1.0 / FLUSH).contains(&value.abs())
}

impl EnvelopeFloat {
    /// The largest component of a unit vector: seven ULP of the quotient by the length, and half of the sum's four
    /// inside the root.
    pub(super) const COSINE: f64 = 1.0 + 10.0 / (1 << 23) as f64;
    /// The relative error of the reciprocal of a length by WGSL's rule: two ULP of the inverse root, and 2.5 of its
    /// reciprocal.
    pub(super) const UNIT_SCALE: f64 = (rules::INVERSESQRT.ulps() + rules::DIV.ulps() + 1e-5) / (1 << 23) as f64;
    /// The error of an exponent up to which [`ROUND_TRIP`](Self::ROUND_TRIP) holds.
    pub(super) const FAR_OFF: f64 = 0.25;
    /// `2^-e (1 - ROUND_TRIP e e)` is below `2 - 2^e` and its roundings, up to [`FAR_OFF`](Self::FAR_OFF).
    pub(super) const ROUND_TRIP: f64 = 0.75;

    /// Whether the interval contains 0.
    #[inline(always)]
    fn holds_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    fn is_infinite_perhaps(self) -> bool {
        self.low == f64::NEG_INFINITY || self.high == f64::INFINITY
    }

    /// A sum with an infinite bound.
    #[cold]
    fn infinite_sum(self, other: Self) -> Self {
        let end = |a: f64, b: f64, instead: f64| if (a + b).is_nan() { instead } else { a + b };
        let cancels = |a: Self, b: Self| a.high == f64::INFINITY && b.low == f64::NEG_INFINITY;
        Self {
            value: self.value + other.value,
            low: down(end(self.low, other.low, f64::NEG_INFINITY)),
            high: up(end(self.high, other.high, f64::INFINITY)),
            may_be_nan: self.may_be_nan || other.may_be_nan || cancels(self, other) || cancels(other, self),
        }
    }

    /// A product with an infinite bound.
    #[cold]
    fn infinite_product(self, other: Self) -> Self {
        let value = self.value * other.value;
        let nan = |a: Self, b: Self| a.holds_zero() && b.is_infinite_perhaps();
        let may_be_nan = self.may_be_nan || other.may_be_nan || nan(self, other) || nan(other, self);
        // Infinity times 0, where 0 is exact or a bound: the finite numbers yield only 0.
        let of = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let corners =
            [of(self.low, other.low), of(self.low, other.high), of(self.high, other.low), of(self.high, other.high)];
        let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self::rounded(value, low, high, may_be_nan)
    }

    /// A quotient whose divisor may be 0.
    fn over_zero(self, other: Self) -> Self {
        // The result is unspecified (GLSL 1.50 §4.1.4, §5.9).
        Self::anything(self.value / other.value)
    }

    /// A function without rounding that never decreases.
    #[inline(always)]
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self { value: f(self.value), low: f(self.low), high: f(self.high), may_be_nan: self.may_be_nan }
    }

    /// A decided answer if every pair yields the same.
    #[inline(always)]
    fn answered(self, other: Self, always: bool, never: bool, answer: bool) -> EnvelopeInt {
        if !(self.may_be_nan || other.may_be_nan) {
            if always {
                return EnvelopeInt::from_bool(true);
            }
            if never {
                return EnvelopeInt::from_bool(false);
            }
        }
        EnvelopeInt::undecided(answer)
    }

    /// `min` or `max` if an operand may be NaN: then the result is the other one, or NaN (§8.3 does not define it).
    fn with_nan(self, a: Self, b: Self) -> Self {
        if !matches!(rules::EXTREMUM.precision, Precision::EitherOfNan) {
            return self;
        }
        let other =
            |dropped: Self, kept: Self, joined: Self| if dropped.may_be_nan { joined.joined(kept) } else { joined };
        other(b, a, other(a, b, self))
    }

    /// `mod`, from the interval of its formula.
    fn modulo_by(self, y: Self, formula: Self) -> Self {
        if !(y.low > 0.0 || y.high < 0.0) || formula.may_be_nan {
            return formula;
        }
        // Between 0 and y, widened by the error of the quotient, whose floor is then another one, and by the
        // roundings of the product and the difference.
        let (x, most, least) =
            (self.low.abs().max(self.high.abs()), y.low.abs().max(y.high.abs()), y.low.abs().min(y.high.abs()));
        let quotient = (rules::DIV.ulps() + 1.0) * OUTWARD * ulp(x / least) * most;
        let slack = quotient + 2.0 * ulp(x + most + quotient);
        formula.within(down(y.low.min(0.0) - slack), up(y.high.max(0.0) + slack))
    }

    /// Whether dividing by it is one multiplication by an f32, for which every way of dividing is correctly rounded.
    #[inline(always)]
    fn is_halving(self) -> bool {
        self.low == self.high && is_power_of_two(self.low)
    }

    fn to_int_by(self, bits: u32, limit: impl Fn(f64) -> i64) -> EnvelopeInt {
        if self.may_be_nan {
            return EnvelopeInt::unknown(bits);
        }
        match (i32::try_from(limit(self.low)), i32::try_from(limit(self.high))) {
            (Ok(low), Ok(high)) => EnvelopeInt::with_interval(bits, low, high),
            _ if self.low == self.high => EnvelopeInt::from_bits(bits),
            _ => EnvelopeInt::unknown(bits),
        }
    }
}

impl Number for EnvelopeFloat {
    type Int = EnvelopeInt;
    type Wide = Self;
    const HAS_INTERVALS: bool = true;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        if value.is_nan() {
            return Self::anything(value);
        }
        let flushed = value != 0.0 && value.abs() < FLUSH;
        let (low, high) = if flushed { (value.min(0.0), value.max(0.0)) } else { (value, value) };
        if flushed || f64::from(value as f32) == value {
            return Self { value, low, high, may_be_nan: false };
        }
        Self { value, low: down(low), high: up(high), may_be_nan: false }
    }
    #[inline(always)]
    fn with_interval(value: f64, interval: Interval) -> Self {
        Self::rounded(value, interval.low, interval.high, interval.may_be_nan)
    }
    fn integer_with_interval(value: f64, interval: Interval) -> Self {
        Self { value, low: interval.low, high: interval.high, may_be_nan: interval.may_be_nan }
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn interval(self) -> Interval {
        self.as_range()
    }
    #[inline(always)]
    fn joined(self, other: Self) -> Self {
        Self::joined(self, other)
    }
    #[inline(always)]
    fn widen(self) -> Self {
        self
    }
    #[inline(always)]
    fn narrow(wide: Self) -> Self {
        wide
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (low, high) = (sum_down(self.low, other.low), sum_up(self.high, other.high));
        if (high - low).is_finite() {
            return Self {
                value: self.value + other.value,
                low: down(low),
                high: up(high),
                may_be_nan: self.may_be_nan | other.may_be_nan,
            };
        }
        self.infinite_sum(other)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        if self.low >= 0.0 && other.low >= 0.0 {
            // Most products in shaders have operands that are not negative.
            let (low, high) = (self.low * other.low, self.high * other.high);
            if high.is_finite() {
                let may_be_nan = self.may_be_nan | other.may_be_nan;
                return Self { value: self.value * other.value, low: down(low), high: up(high), may_be_nan };
            }
        }
        let (ll, lh) = (self.low * other.low, self.low * other.high);
        let (hl, hh) = (self.high * other.low, self.high * other.high);
        // Products of two f32 numbers are exact in f64.
        if (ll + lh + hl + hh).is_finite() {
            return Self {
                value: self.value * other.value,
                low: down(least(least(ll, lh), least(hl, hh))),
                high: up(greatest(greatest(ll, lh), greatest(hl, hh))),
                may_be_nan: self.may_be_nan | other.may_be_nan,
            };
        }
        self.infinite_product(other)
    }
    #[inline(always)]
    fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let low = if self.holds_zero() { 0.0 } else { least(a, b) };
        Self { value: self.value * self.value, low: down(low), high: up(greatest(a, b)), may_be_nan: self.may_be_nan }
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        if other.holds_zero() {
            return self.over_zero(other);
        }
        let value = self.value / other.value;
        if other.is_halving() {
            let quotient = self.mul(Self::exact(1.0 / other.low));
            return Self { may_be_nan: quotient.may_be_nan | other.may_be_nan, ..quotient.of_value(value) };
        }
        let (ll, lh) = (self.low / other.low, self.low / other.high);
        let (hl, hh) = (self.high / other.low, self.high / other.high);
        let (low, high) = (least(least(ll, lh), least(hl, hh)), greatest(greatest(ll, lh), greatest(hl, hh)));
        let sizes = (other.low.abs().min(other.high.abs()), other.low.abs().max(other.high.abs()));
        // Outside this range the specification promises nothing.
        if !(sizes.0 >= FLUSH && sizes.1 <= 1.0 / FLUSH && (ll + lh + hl + hh).is_finite()) {
            return Self { may_be_nan: true, ..Self::anything(value) };
        }
        let n = rules::DIV.ulps();
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n) };
        let above = if high == 0.0 { 0.0 } else { ulps_above(low, high, n) };
        Self::rounded(value, below, above, self.may_be_nan | other.may_be_nan)
    }
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, low: -self.high, high: -self.low, may_be_nan: self.may_be_nan }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let low = if self.holds_zero() { 0.0 } else { least(a, b) };
        Self { value: self.value.abs(), low, high: greatest(a, b), may_be_nan: self.may_be_nan }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        let sign = self.rising(Number::sign);
        if self.may_be_nan { sign.joined(Self::exact(0.0)) } else { sign }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.rising(f64::floor)
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        self.rising(f64::ceil)
    }
    #[inline(always)]
    fn trunc(self) -> Self {
        self.rising(f64::trunc)
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.rising_by(&rules::ROUND, f64::round_ties_even)
    }
    #[inline(always)]
    fn cosine_at_most(self) -> Self {
        if (self.high - self.low).is_finite() {
            return Self { low: greatest(self.low, -Self::COSINE), high: least(self.high, Self::COSINE), ..self };
        }
        // The squared length may be flushed or overflow.
        self
    }
    fn unit_scale(self) -> Self {
        Self::unit_scale(self)
    }
    fn scaled(self, scale: Self) -> Self {
        Self::scaled(self, scale)
    }
    fn less_itself(self) -> Self {
        if self.is_infinite_perhaps() || self.may_be_nan { self.sub(self) } else { Self::exact(0.0) }
    }
    fn over_itself(self) -> Self {
        // 1, or NaN for 0, an infinity and NaN.
        let value = if self.value == 0.0 || !self.value.is_finite() { f64::NAN } else { 1.0 };
        let (least, most) = (self.low.abs().min(self.high.abs()), self.low.abs().max(self.high.abs()));
        if self.holds_zero() || self.may_be_nan || least < FLUSH || most > 1.0 / FLUSH {
            return self.div(self);
        }
        let n = rules::DIV.ulps();
        Self::rounded(value, ulps_below(1.0, 1.0, n), ulps_above(1.0, 1.0, n), false)
    }
    #[inline(always)]
    fn limited(self, least: Self, most: Self) -> Self {
        let limited = self.max(least).min(most);
        if least.high <= most.low { limited } else { Self::anything(limited.value) }
    }
    fn fract(self) -> Self {
        let value = self.value - self.value.floor();
        if self.low.floor() == self.high.floor() && self.low.is_finite() {
            let whole = self.low.floor();
            return Self::rounded(value, self.low - whole, self.high - whole, self.may_be_nan);
        }
        Self { value, low: 0.0, high: 1.0, may_be_nan: self.may_be_nan || self.is_infinite_perhaps() }
    }
    fn modulo(self, y: Self) -> Self {
        self.modulo_by(y, Self::by_formula(&rules::MOD, Number::modulo(self.value, y.value), &[self, y]))
    }
    fn modulo_loosened(self, y: Self) -> Self {
        let quotient = self.div(y).loosened(y);
        let formula = self.sub(y.mul(quotient.floor()));
        self.modulo_by(y, formula.of_value(Number::modulo(self.value, y.value)))
    }
    fn smoothstep_loosened(edge0: Self, edge1: Self, x: Self) -> Self {
        let span = edge1.sub(edge0);
        let found = Self::smooth_step(edge0, edge1, x);
        if !span.is_halving() {
            return found;
        }
        let quotient = x.sub(edge0).div(span).loosened(span);
        found.joined(Self::smooth_step(Self::exact(0.0), Self::exact(1.0), quotient))
    }
    #[inline(always)]
    fn loosened(self, divisor: Self) -> Self {
        if !divisor.is_halving() || !(self.high - self.low).is_finite() || self.low == 0.0 && self.high == 0.0 {
            return self;
        }
        let n = rules::DIV.ulps();
        let below = if self.low == 0.0 { 0.0 } else { ulps_below(self.low, self.high, n) };
        let above = if self.high == 0.0 { 0.0 } else { ulps_above(self.low, self.high, n) };
        Self::rounded(self.value, below, above, self.may_be_nan)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let both = Self {
            value: Number::min(self.value, other.value),
            low: least(self.low, other.low),
            high: least(self.high, other.high),
            may_be_nan: self.may_be_nan | other.may_be_nan,
        };
        if both.may_be_nan { both.with_nan(self, other) } else { both }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let both = Self {
            value: Number::max(self.value, other.value),
            low: greatest(self.low, other.low),
            high: greatest(self.high, other.high),
            may_be_nan: self.may_be_nan | other.may_be_nan,
        };
        if both.may_be_nan { both.with_nan(self, other) } else { both }
    }
    fn mix(self, y: Self, a: Self) -> Self {
        self.mixed(y, a)
    }
    fn smoothstep(edge0: Self, edge1: Self, x: Self) -> Self {
        Self::smooth_step(edge0, edge1, x)
    }
    fn sqrt(self) -> Self {
        self.square_root()
    }
    fn inversesqrt(self) -> Self {
        self.inverse_square_root()
    }
    fn pow(self, exponent: Self) -> Self {
        self.power(exponent)
    }
    fn exp(self) -> Self {
        self.exponential(self.value.exp(), |end| powers::exp2(end * LOG2_E))
    }
    fn log(self) -> Self {
        self.logarithm(self.value.ln(), |end| powers::log2(end) * LN_2)
    }
    fn exp2(self) -> Self {
        self.exponential(self.value.exp2(), powers::exp2)
    }
    fn log2(self) -> Self {
        self.logarithm(self.value.log2(), powers::log2)
    }
    fn sin(self) -> Self {
        self.sine()
    }
    fn cos(self) -> Self {
        self.cosine()
    }
    fn tan(self) -> Self {
        self.tangent()
    }
    fn asin(self) -> Self {
        self.arc_sine()
    }
    fn acos(self) -> Self {
        self.arc_cosine()
    }
    fn atan(self) -> Self {
        self.arc_tangent()
    }
    fn atan2(self, x: Self) -> Self {
        self.angle(x)
    }
    fn sinh(self) -> Self {
        self.rising_by(&rules::SINH, f64::sinh)
    }
    fn cosh(self) -> Self {
        self.hyperbolic_cosine()
    }
    fn tanh(self) -> Self {
        self.hyperbolic_tangent(self.at_ends(&rules::TANH))
    }
    fn asinh(self) -> Self {
        self.rising_by(&rules::ASINH, f64::asinh)
    }
    fn acosh(self) -> Self {
        self.area_cosine(self.at_ends(&rules::ACOSH))
    }
    fn atanh(self) -> Self {
        self.area_tangent(self.at_ends(&rules::ATANH))
    }
    #[inline(always)]
    fn less(self, other: Self) -> EnvelopeInt {
        self.answered(other, self.high < other.low, self.low >= other.high, self.value < other.value)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> EnvelopeInt {
        self.answered(other, self.high <= other.low, self.low > other.high, self.value <= other.value)
    }
    #[inline(always)]
    fn equal(self, other: Self) -> EnvelopeInt {
        let same = self.is_point() && other.is_point() && self.low == other.low;
        let disjoint = self.high < other.low || other.high < self.low;
        self.answered(other, same, disjoint, self.value == other.value)
    }
    fn isnan(self) -> EnvelopeInt {
        if self.may_be_nan { EnvelopeInt::undecided(self.value.is_nan()) } else { EnvelopeInt::from_bool(false) }
    }
    fn isinf(self) -> EnvelopeInt {
        let answer = self.value.is_infinite();
        if self.is_point() || !self.is_infinite_perhaps() && !self.may_be_nan {
            return EnvelopeInt::from_bool(self.low.is_infinite());
        }
        EnvelopeInt::undecided(answer)
    }
    #[inline(always)]
    fn select(condition: EnvelopeInt, yes: Self, no: Self) -> Self {
        let (chosen, other) = if condition.bits != 0 { (yes, no) } else { (no, yes) };
        if condition.is_decided() { chosen } else { chosen.joined(other) }
    }
    fn from_int(value: EnvelopeInt) -> Self {
        let (low, high) = value.interval();
        Self::rounded(f64::from(value.bits as i32), f64::from(low), f64::from(high), false)
    }
    fn from_uint(value: EnvelopeInt) -> Self {
        let (low, high) = value.interval();
        let (low, high) = match (value.is_decided(), low >= 0) {
            (true, _) => (f64::from(value.bits), f64::from(value.bits)),
            (false, true) => (f64::from(low), f64::from(high)),
            (false, false) => (0.0, f64::from(u32::MAX)),
        };
        Self::rounded(f64::from(value.bits), low, high, false)
    }
    fn to_int(self) -> EnvelopeInt {
        const BEYOND: f64 = 2_147_483_648.0;
        if self.low <= -BEYOND - 1.0 || self.high >= BEYOND {
            return EnvelopeInt::unknown(Number::to_int(self.value));
        }
        self.to_int_by(Number::to_int(self.value), |end| i64::from(end as i32))
    }
    fn to_uint(self) -> EnvelopeInt {
        // A negative number has no `uint` (§5.4.1), nor has one that needs more than 32 bits.
        if self.low <= -1.0 || self.high >= 4_294_967_296.0 {
            return EnvelopeInt::unknown(Number::to_uint(self.value));
        }
        self.to_int_by(Number::to_uint(self.value), |end| i64::from(end as u32))
    }
    fn to_bits(self) -> EnvelopeInt {
        self.bits_of()
    }
    fn from_bits(bits: EnvelopeInt) -> Self {
        Self::with_bits(bits)
    }
    fn to_half(self) -> EnvelopeInt {
        self.half_of()
    }
    fn from_half(bits: EnvelopeInt) -> Self {
        Self::with_half(bits)
    }
    fn sum(terms: impl Iterator<Item = Self> + Clone) -> Self {
        Self::summed(terms)
    }
}
