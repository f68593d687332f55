//! [`Number`]: the `float` of a domain, and what each operation of the language does to it.

use super::Integer;
use std::fmt::Debug;

/// A `float`. Methods without a comment are the operation or built-in function of that name (GLSL 1.50 §5.9, §8.1 to §8.3).
///
/// Defined here where GLSL is not: `min` and `max` drop a NaN where one operand is none (IEEE 754-2008 `minNum`, and what
/// GPUs do); `sign` of NaN is 0; `pow` of a negative base is NaN, `pow(0, 0)` is 1; conversions to integers saturate and
/// take NaN to 0; `round` goes to the even neighbor at halves.
pub trait Number: Copy + Default + Send + Sync + Debug + 'static {
    /// What comparisons give.
    type Int: Integer;
    /// What built-in functions are computed in before they are rounded to this.
    type Wide: Number<Int = Self::Int>;

    /// The nearest.
    fn from_f64(value: f64) -> Self;
    /// The nearest, which a GPU may miss by `error`; domains without bounds forget the error.
    fn with_error(value: f64, error: f64) -> Self;
    /// The value.
    fn value(self) -> f64;
    /// How far a conforming GPU may be from the value; 0 in domains without bounds.
    fn error(self) -> f64;
    /// To compute a built-in function in.
    fn widen(self) -> Self::Wide;
    /// The one rounding at a built-in function's end.
    fn narrow(wide: Self::Wide) -> Self;

    /// `a + b`
    fn add(self, other: Self) -> Self;
    /// `a - b`
    fn sub(self, other: Self) -> Self;
    /// `a * b`
    fn mul(self, other: Self) -> Self;
    /// `a / b`
    fn div(self, other: Self) -> Self;
    /// `-a`
    fn neg(self) -> Self;
    /// §8.3
    fn abs(self) -> Self;
    /// §8.3
    fn sign(self) -> Self;
    /// §8.3
    fn floor(self) -> Self;
    /// §8.3
    fn ceil(self) -> Self;
    /// §8.3
    fn trunc(self) -> Self;
    /// `round` and `roundEven`, §8.3
    fn round(self) -> Self;
    /// §8.3
    fn min(self, other: Self) -> Self;
    /// §8.3
    fn max(self, other: Self) -> Self;
    /// §8.2
    fn sqrt(self) -> Self;
    /// §8.2
    fn inversesqrt(self) -> Self;
    /// §8.2
    fn pow(self, exponent: Self) -> Self;
    /// §8.2
    fn exp(self) -> Self;
    /// §8.2
    fn log(self) -> Self;
    /// §8.2
    fn exp2(self) -> Self;
    /// §8.2
    fn log2(self) -> Self;
    /// §8.1
    fn sin(self) -> Self;
    /// §8.1
    fn cos(self) -> Self;
    /// §8.1
    fn tan(self) -> Self;
    /// §8.1
    fn asin(self) -> Self;
    /// §8.1
    fn acos(self) -> Self;
    /// `atan(a)`, §8.1
    fn atan(self) -> Self;
    /// `atan(y, x)` with `y` this, §8.1
    fn atan2(self, x: Self) -> Self;
    /// §8.1
    fn sinh(self) -> Self;
    /// §8.1
    fn cosh(self) -> Self;
    /// §8.1
    fn tanh(self) -> Self;
    /// §8.1
    fn asinh(self) -> Self;
    /// §8.1
    fn acosh(self) -> Self;
    /// §8.1
    fn atanh(self) -> Self;

    /// `a < b`
    fn less(self, other: Self) -> Self::Int;
    /// `a <= b`
    fn less_equal(self, other: Self) -> Self::Int;
    /// `a == b`
    fn equal(self, other: Self) -> Self::Int;
    /// §8.3
    fn isnan(self) -> Self::Int;
    /// §8.3
    fn isinf(self) -> Self::Int;
    /// `c ? a : b`
    fn select(condition: Self::Int, yes: Self, no: Self) -> Self;
    /// `float(int)`
    fn from_int(value: Self::Int) -> Self;
    /// `float(uint)`
    fn from_uint(value: Self::Int) -> Self;
    /// `int(float)`: toward zero.
    fn to_int(self) -> Self::Int;
    /// `uint(float)`: toward zero.
    fn to_uint(self) -> Self::Int;
}
