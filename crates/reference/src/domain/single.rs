//! f32: a strict GPU. Operators round once; built-in functions are f64's, rounded once.

use super::Number;
use super::wide::extremum;

impl Number for f32 {
    type Int = u32;
    type Wide = f64;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn value(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn widen(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn narrow(wide: f64) -> Self {
        wide as f32
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self / other
    }
    #[inline(always)]
    fn neg(self) -> Self {
        -self
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn sign(self) -> Self {
        f32::from(i8::from(self > 0.0) - i8::from(self < 0.0))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Self::floor(self)
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Self::ceil(self)
    }
    #[inline(always)]
    fn trunc(self) -> Self {
        Self::trunc(self)
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        extremum!(self, other, <)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        extremum!(self, other, >)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn inversesqrt(self) -> Self {
        Number::inversesqrt(f64::from(self)) as f32
    }
    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        Number::pow(f64::from(self), f64::from(exponent)) as f32
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Number::exp(f64::from(self)) as f32
    }
    #[inline(always)]
    fn log(self) -> Self {
        Number::log(f64::from(self)) as f32
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        Number::exp2(f64::from(self)) as f32
    }
    #[inline(always)]
    fn log2(self) -> Self {
        Number::log2(f64::from(self)) as f32
    }
    #[inline(always)]
    fn sin(self) -> Self {
        Number::sin(f64::from(self)) as f32
    }
    #[inline(always)]
    fn cos(self) -> Self {
        Number::cos(f64::from(self)) as f32
    }
    #[inline(always)]
    fn tan(self) -> Self {
        Number::tan(f64::from(self)) as f32
    }
    #[inline(always)]
    fn asin(self) -> Self {
        Number::asin(f64::from(self)) as f32
    }
    #[inline(always)]
    fn acos(self) -> Self {
        Number::acos(f64::from(self)) as f32
    }
    #[inline(always)]
    fn atan(self) -> Self {
        Number::atan(f64::from(self)) as f32
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::from(self).atan2(f64::from(x)) as f32
    }
    #[inline(always)]
    fn sinh(self) -> Self {
        Number::sinh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn cosh(self) -> Self {
        Number::cosh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        Number::tanh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn asinh(self) -> Self {
        Number::asinh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn acosh(self) -> Self {
        Number::acosh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn atanh(self) -> Self {
        Number::atanh(f64::from(self)) as f32
    }
    #[inline(always)]
    fn less(self, other: Self) -> u32 {
        u32::from(self < other)
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> u32 {
        u32::from(self <= other)
    }
    #[inline(always)]
    fn equal(self, other: Self) -> u32 {
        u32::from(self == other)
    }
    #[inline(always)]
    fn isnan(self) -> u32 {
        u32::from(self.is_nan())
    }
    #[inline(always)]
    fn isinf(self) -> u32 {
        u32::from(self.is_infinite())
    }
    #[inline(always)]
    fn select(condition: u32, yes: Self, no: Self) -> Self {
        if condition != 0 { yes } else { no }
    }
    #[inline(always)]
    fn from_int(value: u32) -> Self {
        value as i32 as f32
    }
    #[inline(always)]
    fn from_uint(value: u32) -> Self {
        value as f32
    }
    #[inline(always)]
    fn to_int(self) -> u32 {
        self as i32 as u32
    }
    #[inline(always)]
    fn to_uint(self) -> u32 {
        self as u32
    }
}
