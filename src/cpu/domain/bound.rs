//! The bound domain: an f64 value and how far, to first order, a conforming f32 GPU may be from it.
//!
//! *Holds:* `error` is at least 0 or infinite, never NaN; infinite says "anything". Each operation carries the
//! operands' errors on by its derivative (by its hull where it bends) and adds its own rule of [`rules`].
//! Comparisons of overlapping operands are not sure; an unsure condition that selects widens the result, one that
//! branches makes the lane undecided (the executor's part).

use super::rules::{self, FLUSH, ulp};
use super::{Integer, Number};

/// A `float` with its bound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundFloat {
    /// The exact value.
    pub value: f64,
    /// The bound on the distance.
    pub error: f64,
}

/// An `int` with whether it is sure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundInt {
    /// The bits that exact arithmetic gives.
    pub bits: u32,
    /// Whether every conforming GPU gets them.
    pub sure: bool,
}

impl Default for BoundInt {
    fn default() -> Self {
        Self { bits: 0, sure: true }
    }
}

impl Integer for BoundInt {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self { bits, sure: true }
    }
    fn with_doubt(bits: u32, doubt: bool) -> Self {
        Self { bits, sure: !doubt }
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.bits
    }
    #[inline(always)]
    fn sure(self) -> bool {
        self.sure
    }
    #[inline(always)]
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self {
        Self { bits: f(self.bits), sure: self.sure }
    }
    #[inline(always)]
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        Self { bits: f(self.bits, other.bits), sure: self.sure && other.sure }
    }
    /// Of `bool`s: a sure false decides.
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        let decided = (self.sure && self.bits == 0) || (other.sure && other.bits == 0);
        Self { bits: self.bits & other.bits, sure: decided || (self.sure && other.sure) }
    }
    /// Of `bool`s: a sure true decides (only there: all bits of an `int` must be set for that).
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let decided = (self.sure && self.bits == u32::MAX) || (other.sure && other.bits == u32::MAX);
        let booleans = self.bits <= 1 && other.bits <= 1;
        let decided = decided || (booleans && ((self.sure && self.bits == 1) || (other.sure && other.bits == 1)));
        Self { bits: self.bits | other.bits, sure: decided || (self.sure && other.sure) }
    }
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        let chosen = if self.is_true() { yes } else { no };
        Self { bits: chosen.bits, sure: chosen.sure && (self.sure || (yes.bits == no.bits && yes.sure && no.sure)) }
    }
}

/// Whether a number is 2^n for an n from -126 to 126, or the negative of such.
#[inline(always)]
fn is_power_of_two(value: f64) -> bool {
    const MANTISSA: u64 = (1 << 52) - 1;
    value.to_bits() & MANTISSA == 0 && (FLUSH..=1.0 / FLUSH).contains(&value.abs())
}

impl BoundFloat {
    /// A value and a bound; a bound that is no number says "anything".
    #[inline(always)]
    pub fn new(value: f64, error: f64) -> Self {
        Self { value, error: if error >= 0.0 { error } else { f64::INFINITY } }
    }

    /// Adds the rule's error and what flushing and overflow do.
    #[inline(always)]
    fn ruled(value: f64, carried: f64, rule: f64) -> Self {
        let flushed = if value.abs() < FLUSH { value.abs() } else { 0.0 };
        let overflow = if value.abs() > f64::from(f32::MAX) { f64::INFINITY } else { 0.0 };
        Self::new(value, carried + rule + flushed + overflow)
    }

    /// A correctly rounded operation: where nothing was carried in and the result is a float as it stands, every
    /// conforming GPU gives that float.
    #[inline(always)]
    fn rounded(value: f64, carried: f64, rule: f64) -> Self {
        let representable = f64::from(value as f32) == value && (value == 0.0 || value.abs() >= FLUSH);
        if carried == 0.0 && representable { Self::exact(value) } else { Self::ruled(value, carried, rule) }
    }

    /// A function that is monotonic between `value - error` and `value + error`.
    #[inline(always)]
    fn monotonic(self, f: impl Fn(f64) -> f64, rule: impl Fn(f64) -> f64) -> Self {
        let value = f(self.value);
        let carried = if self.error == 0.0 {
            0.0
        } else {
            let (low, high) = (f(self.value - self.error), f(self.value + self.error));
            (low - value).abs().max((high - value).abs())
                + if low.is_nan() || high.is_nan() { f64::INFINITY } else { 0.0 }
        };
        Self::ruled(value, carried, rule(value))
    }

    /// A function whose slope is at most `slope`.
    fn lipschitz(self, f: impl Fn(f64) -> f64, slope: f64, rule: rules::Rule) -> Self {
        let value = f(self.value);
        Self::ruled(value, self.error * slope, rule.allowance.at(value, self.value))
    }

    /// A function that is constant but for jumps.
    #[inline(always)]
    fn stepped(self, f: impl Fn(f64) -> f64) -> Self {
        let value = f(self.value);
        if self.error == 0.0 {
            return Self::new(value, 0.0);
        }
        let (low, high) = (f(self.value - self.error), f(self.value + self.error));
        Self::new(value, (low - value).abs().max((high - value).abs()))
    }

    #[inline(always)]
    fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// Sure if every pair within the bounds gives the same answer as the values.
    #[inline(always)]
    fn compared(self, other: Self, answer: bool) -> BoundInt {
        let apart = (self.value - other.value).abs() > self.error + other.error;
        let same = self.error == 0.0 && other.error == 0.0;
        BoundInt { bits: u32::from(answer), sure: apart || same }
    }

    fn to_bits_of(self, convert: impl Fn(f64) -> u32) -> BoundInt {
        let bits = convert(self.value);
        let sure =
            self.error == 0.0 || (convert(self.value - self.error) == bits && convert(self.value + self.error) == bits);
        BoundInt { bits, sure }
    }
}

impl Number for BoundFloat {
    type Int = BoundInt;
    type Wide = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::exact(value)
    }
    #[inline(always)]
    fn with_error(value: f64, error: f64) -> Self {
        Self::new(value, error)
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn error(self) -> f64 {
        self.error
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
        let value = self.value + other.value;
        Self::rounded(value, self.error + other.error, rules::ADD.allowance.at(value, 0.0))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let carried =
            scaled(other.error, self.value) + scaled(self.error, other.value) + scaled(self.error, other.error);
        Self::rounded(value, carried, rules::MUL.allowance.at(value, 0.0))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.value.abs() - other.error;
        let carried = if self.error == 0.0 && other.error == 0.0 {
            0.0
        } else if least > 0.0 {
            (self.error + scaled(other.error, value)) / least
        } else {
            f64::INFINITY
        };
        if carried == 0.0 && is_power_of_two(other.value) {
            // The reciprocal is a float, so that every way to divide is one correctly rounded multiplication.
            return Self::rounded(value, 0.0, rules::MUL.allowance.at(value, 0.0));
        }
        let rule = rules::DIV.allowance.at(value, 0.0);
        // Outside these the specification promises nothing.
        let wild = if other.value.abs() < FLUSH || other.value.abs() > 1.0 / FLUSH { f64::INFINITY } else { 0.0 };
        Self::ruled(value, carried, rule + if other.value == 0.0 { 0.0 } else { wild })
    }
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        self.stepped(Number::sign)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.stepped(f64::floor)
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        self.stepped(f64::ceil)
    }
    #[inline(always)]
    fn trunc(self) -> Self {
        self.stepped(f64::trunc)
    }
    #[inline(always)]
    fn round(self) -> Self {
        let rounded = self.stepped(f64::round_ties_even);
        // Halves may go either way (§8.3).
        let half = (self.value - self.value.trunc()).abs() == 0.5;
        Self { value: rounded.value, error: if half { rounded.error.max(1.0) } else { rounded.error } }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        hull(Number::min(self.value, other.value), self, other, f64::min)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        hull(Number::max(self.value, other.value), self, other, f64::max)
    }
    fn sqrt(self) -> Self {
        // Inherited from 1 / inversesqrt.
        self.monotonic(f64::sqrt, |root| {
            (rules::INVERSESQRT.allowance.at(root, 0.0)) + rules::DIV.allowance.at(root, 0.0)
        })
    }
    fn inversesqrt(self) -> Self {
        self.monotonic(|x| 1.0 / x.sqrt(), |root| rules::INVERSESQRT.allowance.at(root, 0.0))
    }
    fn pow(self, exponent: Self) -> Self {
        // Inherited from exp2(y * log2(x)).
        let value = Number::pow(self.value, exponent.value);
        if self.value - self.error < 0.0 || (self.value == 0.0 && exponent.value <= 0.0) {
            return Self::new(value, f64::INFINITY);
        }
        let power = exponent.mul(Number::log2(self));
        if self.value == 0.0 && self.error == 0.0 {
            return Self::new(value, 0.0);
        }
        let Self { error, .. } = if power.error.is_finite() { power.exp2() } else { self.pow_by_hull(exponent) };
        Self::new(value, error + rules::MUL.allowance.at(value, 0.0))
    }
    fn exp(self) -> Self {
        self.monotonic(f64::exp, |y| rules::EXP.allowance.at(y, self.value))
    }
    fn log(self) -> Self {
        self.monotonic(f64::ln, |y| log_rule(self.value, y))
    }
    fn exp2(self) -> Self {
        self.monotonic(f64::exp2, |y| rules::EXP.allowance.at(y, self.value))
    }
    fn log2(self) -> Self {
        self.monotonic(f64::log2, |y| log_rule(self.value, y))
    }
    fn sin(self) -> Self {
        self.reduced().lipschitz(|_| self.value.sin(), 1.0, rules::SIN)
    }
    fn cos(self) -> Self {
        self.reduced().lipschitz(|_| self.value.cos(), 1.0, rules::SIN)
    }
    fn tan(self) -> Self {
        // Inherited from sin / cos.
        let quotient = self.sin().div(self.cos());
        Self::new(self.value.tan(), quotient.error)
    }
    fn asin(self) -> Self {
        self.monotonic(f64::asin, |y| rules::ASIN.allowance.at(y, 0.0))
    }
    fn acos(self) -> Self {
        self.monotonic(f64::acos, |y| rules::ASIN.allowance.at(y, 0.0))
    }
    fn atan(self) -> Self {
        self.lipschitz(f64::atan, 1.0, rules::ATAN)
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let radius = self.value.hypot(x.value) - self.error.hypot(x.error);
        let carried = if self.error == 0.0 && x.error == 0.0 {
            0.0
        } else if radius > 0.0 {
            self.error.hypot(x.error) / radius
        } else {
            f64::INFINITY
        };
        // The cut along negative x, and the origin, where GLSL leaves it undefined.
        let cut = x.value <= 0.0 && self.value.abs() <= self.error;
        let undefined = self.value == 0.0 && x.value == 0.0;
        let jump = if undefined || (cut && self.error > 0.0) { f64::INFINITY } else { 0.0 };
        Self::ruled(value, carried + jump, rules::ATAN.allowance.at(value, 0.0))
    }
    fn sinh(self) -> Self {
        // Inherited from (exp(x) - exp(-x)) / 2.
        let difference = self.exp().sub(self.neg().exp());
        Self::new(self.value.sinh(), difference.error * 0.5)
    }
    fn cosh(self) -> Self {
        let sum = self.exp().add(self.neg().exp());
        Self::new(self.value.cosh(), sum.error * 0.5)
    }
    fn tanh(self) -> Self {
        // Inherited from sinh / cosh; no more than 2 off in any case.
        let quotient = self.sinh().div(self.cosh());
        Self::new(self.value.tanh(), quotient.error.min(2.0))
    }
    fn asinh(self) -> Self {
        // Inherited from log(x + sqrt(x x + 1)).
        let formula = self.add(self.mul(self).add(Self::exact(1.0)).sqrt()).log();
        Self::new(self.value.asinh(), formula.error)
    }
    fn acosh(self) -> Self {
        let formula = self.add(self.mul(self).sub(Self::exact(1.0)).sqrt()).log();
        Self::new(self.value.acosh(), formula.error)
    }
    fn atanh(self) -> Self {
        let one = Self::exact(1.0);
        let formula = one.add(self).div(one.sub(self)).log();
        Self::new(self.value.atanh(), formula.error * 0.5)
    }
    #[inline(always)]
    fn less(self, other: Self) -> BoundInt {
        self.compared(other, self.value < other.value)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> BoundInt {
        self.compared(other, self.value <= other.value)
    }
    #[inline(always)]
    fn equal(self, other: Self) -> BoundInt {
        self.compared(other, self.value == other.value)
    }
    #[inline(always)]
    fn isnan(self) -> BoundInt {
        BoundInt { bits: u32::from(self.value.is_nan()), sure: self.error.is_finite() }
    }
    #[inline(always)]
    fn isinf(self) -> BoundInt {
        BoundInt { bits: u32::from(self.value.is_infinite()), sure: self.error.is_finite() }
    }
    #[inline(always)]
    fn select(condition: BoundInt, yes: Self, no: Self) -> Self {
        let (chosen, other) = if condition.bits != 0 { (yes, no) } else { (no, yes) };
        if condition.sure {
            return chosen;
        }
        Self::new(chosen.value, chosen.error.max((chosen.value - other.value).abs() + other.error))
    }
    #[inline(always)]
    fn from_int(value: BoundInt) -> Self {
        converted(f64::from(value.bits as i32), value.sure)
    }
    #[inline(always)]
    fn from_uint(value: BoundInt) -> Self {
        converted(f64::from(value.bits), value.sure)
    }
    fn to_int(self) -> BoundInt {
        self.to_bits_of(Number::to_int)
    }
    fn to_uint(self) -> BoundInt {
        self.to_bits_of(Number::to_uint)
    }
}

impl BoundFloat {
    /// An argument of `sin` or `cos`: beyond pi its reduction loses what rounding an f32 of that size loses.
    fn reduced(self) -> Self {
        let beyond = self.value.abs() > std::f64::consts::PI;
        Self { value: self.value, error: self.error + if beyond { ulp(self.value) } else { 0.0 } }
    }

    /// `pow` where the base may be 0: the logarithm has no bound there, the power has.
    fn pow_by_hull(self, exponent: Self) -> Self {
        let high = Number::pow(self.value + self.error, exponent.value - exponent.error);
        let higher = Number::pow(self.value + self.error, exponent.value + exponent.error);
        let value = Number::pow(self.value, exponent.value);
        // Down to 0 on the one side; the rule of exp2 at the far end on the other.
        let top = high.max(higher);
        let rule = rules::EXP.allowance.at(top, exponent.value * top.max(f64::MIN_POSITIVE).log2() / exponent.value);
        Self::new(value, value.max(top - value) + rule)
    }
}

fn log_rule(argument: f64, result: f64) -> f64 {
    let rule = if (0.5..=2.0).contains(&argument) { rules::LOG_NEAR_ONE } else { rules::LOG };
    rule.allowance.at(result, argument)
}

fn converted(value: f64, sure: bool) -> BoundFloat {
    let exact = f64::from(value as f32) == value;
    let rule = if exact { 0.0 } else { rules::CONVERT.allowance.at(value, 0.0) };
    BoundFloat::new(value, if sure { rule } else { f64::INFINITY })
}

/// `error * |factor|` with 0 times anything 0, as no error is none.
#[inline(always)]
fn scaled(error: f64, factor: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error * factor.abs() }
}

/// `min` and `max`: the farthest that the ends of both intervals give.
#[inline(always)]
fn hull(value: f64, a: BoundFloat, b: BoundFloat, f: impl Fn(f64, f64) -> f64) -> BoundFloat {
    let low = f(a.value - a.error, b.value - b.error);
    let high = f(a.value + a.error, b.value + b.error);
    BoundFloat::new(value, (value - low).abs().max((high - value).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn b(value: f64, error: f64) -> BoundFloat {
        BoundFloat::new(value, error)
    }

    #[test]
    fn a_clear_comparison_is_sure_and_an_overlap_is_not() {
        assert!(b(1.0, 0.1).less(b(2.0, 0.1)).sure);
        assert!(!b(1.0, 0.6).less(b(2.0, 0.6)).sure);
        assert!(b(0.0, 0.0).less(b(0.0, 0.0)).sure, "exact operands leave nothing open");
    }

    #[test]
    fn an_unsure_selection_covers_both_sides() {
        let picked = BoundFloat::select(BoundInt { bits: 1, sure: false }, b(1.0, 0.0), b(3.0, 0.5));
        assert_eq!((picked.value, picked.error), (1.0, 2.5));
    }

    #[test]
    fn max_against_zero_keeps_the_bound() {
        let dot = b(0.5, 1e-6).max(b(0.0, 0.0));
        assert!((dot.error - 1e-6).abs() < 1e-15);
        assert_eq!(b(-0.5, 1e-6).max(b(0.0, 0.0)).error, 0.0);
    }

    #[test]
    fn strict_f32_stays_within_the_bound() {
        for (x, y) in [(0.3f32, 32.0f32), (0.999, 128.0), (1.5, -3.5), (1e-3, 2.0), (0.75, 0.5)] {
            let (bx, by) = (b(f64::from(x), 0.0), b(f64::from(y), 0.0));
            for (name, single, bound) in [
                ("add", Number::add(x, y), bx.add(by)),
                ("mul", Number::mul(x, y), bx.mul(by)),
                ("div", Number::div(x, y), bx.div(by)),
                ("pow", Number::pow(x, y), bx.pow(by)),
                ("exp", Number::exp(x), bx.exp()),
                ("log2", Number::log2(x), bx.log2()),
                ("sqrt", Number::sqrt(x), bx.sqrt()),
                ("sin", Number::sin(y), by.sin()),
                ("asinh", Number::asinh(y), by.asinh()),
            ] {
                assert!((f64::from(single) - bound.value).abs() <= bound.error, "{name}({x}, {y})");
                assert!(bound.error.is_finite(), "{name}({x}, {y})");
            }
        }
    }
}
