//! f64: the reference.

use super::Number;

/// `min` and `max` (§8.3): the second operand if it is beyond the first, else the first, so that of 0 and -0 the first comes back. A
/// NaN is dropped, as `minNum` and `maxNum` do.
macro_rules! extremum {
    ($a:expr, $b:expr, $op:tt) => {{
        let (a, b) = ($a, $b);
        if b $op a || a != a { b } else { a }
    }};
}
pub(super) use extremum;

impl Number for f64 {
    type Int = u32;
    type Wide = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
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
        f64::from(i8::from(self > 0.0) - i8::from(self < 0.0))
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
        1.0 / Self::sqrt(self)
    }
    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        if self < 0.0 { Self::NAN } else { self.powf(exponent) }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Self::exp(self)
    }
    #[inline(always)]
    fn log(self) -> Self {
        self.ln()
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        Self::exp2(self)
    }
    #[inline(always)]
    fn log2(self) -> Self {
        Self::log2(self)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        Self::sin(self)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        Self::cos(self)
    }
    #[inline(always)]
    fn tan(self) -> Self {
        Self::tan(self)
    }
    #[inline(always)]
    fn asin(self) -> Self {
        Self::asin(self)
    }
    #[inline(always)]
    fn acos(self) -> Self {
        Self::acos(self)
    }
    #[inline(always)]
    fn atan(self) -> Self {
        Self::atan(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::atan2(self, x)
    }
    #[inline(always)]
    fn sinh(self) -> Self {
        Self::sinh(self)
    }
    #[inline(always)]
    fn cosh(self) -> Self {
        Self::cosh(self)
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        Self::tanh(self)
    }
    #[inline(always)]
    fn asinh(self) -> Self {
        Self::asinh(self)
    }
    #[inline(always)]
    fn acosh(self) -> Self {
        // The standard library's loses half of the digits near 1.
        let above = self - 1.0;
        let root = (above * (self + 1.0)).sqrt();
        match above {
            ..0.0 => Self::NAN,
            _ if root.is_infinite() => self.ln() + std::f64::consts::LN_2,
            _ => (above + root).ln_1p(),
        }
    }
    #[inline(always)]
    fn atanh(self) -> Self {
        // The standard library's loses digits near -1, but not near 1.
        Self::atanh(self.abs()).copysign(self)
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
        f64::from(value as i32)
    }
    #[inline(always)]
    fn from_uint(value: u32) -> Self {
        f64::from(value)
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
