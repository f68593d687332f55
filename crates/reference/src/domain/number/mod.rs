//! [`Number`]: the `float` of a domain, with each operation of the language.

mod block;

pub use block::{Answers, NumberBlock};

use super::{Element, Integer};
use glisten_front::builtin::operations::{from_half, to_half};
use glisten_scene::picture::Interval;

/// A row and a column of a quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Corner {
    /// The row that is lower in the picture.
    pub lower: bool,
    /// The column to the right.
    pub right: bool,
}

/// A part of the error of a result in f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorPart {
    /// All of it: the result is that of exact operands, not rounded.
    All,
    /// All of it, and what is too large for f32 is limited to a large number that still leaves room.
    Limited,
    /// The part that the operation itself adds: the result is that of its f32 operands, not rounded.
    Own,
    /// The part that is lost where f32 has 0 and exact arithmetic has not: such a result alone is that of exact operands.
    Vanished,
}

/// A `float`. Methods without a comment are the operation or built-in function of that name (GLSL 1.50 §5.9, §8.1 to §8.3).
///
/// These cases are defined here because GLSL leaves them undefined: `min` and `max` drop a NaN if the other operand
/// is not one (IEEE 754-2008 `minNum`, as on GPUs); `sign` of NaN is 0; `pow` of a negative base is NaN, `pow(0, 0)`
/// is 1; conversions to integers saturate and convert NaN to 0; `round` goes to the even neighbor at halves.
pub trait Number: Element<Block: NumberBlock<Self>> {
    /// The result type of comparisons.
    type Int: Integer;
    /// The type in which built-in functions are computed before rounding.
    type Wide: Number<Int = Self::Int>;

    /// Whether a number may represent several values of conforming GPUs.
    const HAS_INTERVALS: bool = false;
    /// Whether there is a second value. Values that leave the domain's arithmetic, such as a texture's coordinates,
    /// are then followed for both.
    const PAIRED: bool = false;
    /// Whether [`sum`](Self::sum) has an order of its own.
    const SUMS_BY_CHOICE: bool = false;

    /// The nearest number.
    fn from_f64(value: f64) -> Self;
    /// The nearest number, with the interval of a GPU's values; domains without envelopes ignore the interval.
    #[inline(always)]
    fn with_interval(value: f64, interval: Interval) -> Self {
        let _ = interval;
        Self::from_f64(value)
    }
    /// An integer with the interval of a GPU's values, whose bounds need not be f32 numbers.
    #[inline(always)]
    fn integer_with_interval(value: f64, interval: Interval) -> Self {
        Self::with_interval(value, interval)
    }
    /// The nearest number, from which a GPU's may differ by `error`.
    #[inline(always)]
    fn with_error(value: f64, error: f64) -> Self {
        Self::with_interval(value, Interval::around(value, error))
    }
    /// The value.
    fn value(self) -> f64;
    /// The second value.
    #[inline(always)]
    fn second(self) -> f64 {
        self.value()
    }
    /// The nearest numbers to two values; domains with one value ignore the second.
    #[inline(always)]
    fn paired(value: f64, second: f64) -> Self {
        let _ = second;
        Self::from_f64(value)
    }
    /// The interval of a conforming GPU's values; only the value in domains without envelopes.
    #[inline(always)]
    fn interval(self) -> Interval {
        Interval::point(self.value())
    }
    /// The largest difference of a conforming GPU from the value; 0 in domains without envelopes.
    #[inline(always)]
    fn error(self) -> f64 {
        if Self::HAS_INTERVALS { self.interval().reach(self.value()) } else { 0.0 }
    }
    /// The interval widened by `error` on both sides.
    #[inline(always)]
    fn widened(self, error: f64) -> Self {
        let Interval { low, high, may_be_nan } = self.interval();
        Self::with_interval(self.value(), Interval { low: low - error, high: high + error, may_be_nan })
    }
    /// The hull of both, with this one's value.
    #[inline(always)]
    fn joined(self, other: Self) -> Self {
        let _ = other;
        self
    }
    /// The number without this part of the error of f32 arithmetic, in a domain that follows it; otherwise unchanged.
    #[inline(always)]
    fn corrected(self, part: ErrorPart) -> Self {
        let _ = part;
        self
    }
    /// The number in the type for built-in functions.
    fn widen(self) -> Self::Wide;
    /// The single rounding at the end of a built-in function.
    fn narrow(wide: Self::Wide) -> Self;

    /// §8.1
    #[inline(always)]
    fn radians(self) -> Self {
        Self::narrow(self.widen().mul(Self::Wide::from_f64(std::f64::consts::PI / 180.0)))
    }
    /// §8.1
    #[inline(always)]
    fn degrees(self) -> Self {
        Self::narrow(self.widen().mul(Self::Wide::from_f64(180.0 / std::f64::consts::PI)))
    }
    /// `a + b`
    fn add(self, other: Self) -> Self;
    /// `a - b`
    fn sub(self, other: Self) -> Self;
    /// `a * b`
    fn mul(self, other: Self) -> Self;
    /// `a a`, which is never negative.
    #[inline(always)]
    fn square(self) -> Self {
        self.mul(self)
    }
    /// A sum, from left to right; with an envelope, in any order.
    #[inline(always)]
    fn sum(terms: impl Iterator<Item = Self> + Clone) -> Self {
        terms.reduce(Self::add).unwrap_or_default()
    }
    /// `a / b`
    fn div(self, other: Self) -> Self;
    /// `a - a`: 0 unless it may be infinite or NaN.
    fn less_itself(self) -> Self {
        self.sub(self)
    }
    /// `a / a`: 1 with the error of a division, unless it may be 0, infinite or NaN.
    fn over_itself(self) -> Self {
        self.div(self)
    }
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
    /// The number as a component of a unit vector: at most 1, apart from the ULPs that normalizing may add.
    #[inline(always)]
    fn cosine_at_most(self) -> Self {
        self
    }
    /// The reciprocal of a vector's length, from its square.
    #[inline(always)]
    fn unit_scale(self) -> Self {
        self.inversesqrt()
    }
    /// A component of a vector times its [`unit_scale`](Self::unit_scale).
    #[inline(always)]
    fn scaled(self, scale: Self) -> Self {
        self.mul(scale)
    }
    /// `clamp`: `min(max(x, least), most)` (§8.3). Undefined if `least > most`.
    #[inline(always)]
    fn limited(self, least: Self, most: Self) -> Self {
        self.max(least).min(most)
    }
    /// A quotient by this divisor with all of the error that the rule of `/` allows, also if the divisor is a power of
    /// two, where [`div`](Self::div) has none.
    #[inline(always)]
    fn loosened(self, divisor: Self) -> Self {
        let _ = divisor;
        self
    }
    /// [`modulo`](Self::modulo) with a [loosened](Self::loosened) quotient.
    #[inline(always)]
    fn modulo_loosened(self, y: Self) -> Self {
        self.modulo(y)
    }
    /// [`smoothstep`](Self::smoothstep) with a [loosened](Self::loosened) quotient.
    #[inline(always)]
    fn smoothstep_loosened(edge0: Self, edge1: Self, x: Self) -> Self {
        Self::smoothstep(edge0, edge1, x)
    }
    /// `x - floor(x)` (§8.3)
    #[inline(always)]
    fn fract(self) -> Self {
        let x = self.widen();
        Self::narrow(x.sub(x.floor()))
    }
    /// `x - y floor(x / y)` (§8.3)
    #[inline(always)]
    fn modulo(self, y: Self) -> Self {
        let (x, y) = (self.widen(), y.widen());
        Self::narrow(x.sub(y.mul(x.div(y).floor())))
    }
    /// `x (1 - a) + y a` (§8.3)
    #[inline(always)]
    fn mix(self, y: Self, a: Self) -> Self {
        let (x, y, a) = (self.widen(), y.widen(), a.widen());
        Self::narrow(x.mul(Self::Wide::from_f64(1.0).sub(a)).add(y.mul(a)))
    }
    /// `t t (3 - 2 t)` with `t = clamp((x - edge0) / (edge1 - edge0), 0, 1)` (§8.3)
    #[inline(always)]
    fn smoothstep(edge0: Self, edge1: Self, x: Self) -> Self {
        let constant = Self::Wide::from_f64;
        let (low, high, x) = (edge0.widen(), edge1.widen(), x.widen());
        let t = x.sub(low).div(high.sub(low)).max(constant(0.0)).min(constant(1.0));
        Self::narrow(t.mul(t).mul(constant(3.0).sub(t.mul(constant(2.0)))))
    }
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
    /// `atan(y, x)`, where `y` is this (§8.1).
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
    /// `int(float)`, rounding toward zero.
    fn to_int(self) -> Self::Int;
    /// `uint(float)`, rounding toward zero.
    fn to_uint(self) -> Self::Int;
    /// `a * b + c`, rounded once or twice (GLSL 4.00 §8.3).
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        let (x, y, z) = (self.widen(), b.widen(), c.widen());
        Self::narrow(x.mul(y).add(z))
    }
    /// `floatBitsToInt` (GLSL 3.30 §8.3): the bits of the nearest f32.
    fn to_bits(self) -> Self::Int {
        let bits = |value: f64| (value as f32).to_bits();
        Self::Int::paired(bits(self.value()), bits(self.second()))
    }
    /// `intBitsToFloat` (GLSL 3.30 §8.3)
    fn from_bits(bits: Self::Int) -> Self {
        let value = |bits: u32| f64::from(f32::from_bits(bits));
        Self::paired(value(bits.bits()), value(bits.second()))
    }
    /// The bits of the nearest 16-bit float.
    fn to_half(self) -> Self::Int {
        Self::Int::paired(to_half(self.value()), to_half(self.second()))
    }
    /// The number that the bits of a 16-bit float mean.
    fn from_half(bits: Self::Int) -> Self {
        Self::paired(from_half(bits.bits() & 0xffff), from_half(bits.second() & 0xffff))
    }
    /// The row and the column of the quad whose differences are those of all four; none if each has its own (§8.8 lets a
    /// GPU choose).
    #[inline(always)]
    fn corner() -> Option<Corner> {
        None
    }
}
