//! The simulated domain: the arithmetic of one conforming GPU, which [`Gpu`] describes.
//!
//! *In:* f32 values. *Out:* results that the [rules] allow: each differs from the exact one as this GPU's
//! may. *Holds:* a picture in this domain is inside of the picture in envelopes, as a test checks over the fixtures. The
//! thread knows the GPU ([`Gpu::enter`]), so that a number is one machine number.
//!
//! A product is kept exact until something reads it, because a GPU may add it without rounding it first.

mod block;
mod functions;
mod gpu;
mod levels;
mod llvmpipe;
mod rounding;

pub use gpu::{Gpu, Planes};

use super::{Corner, FixedPoint, Number, rules};
use gpu::{Form, Function, Gpu as Current};
use smallvec::SmallVec;

/// A `float`: an f32, or the exact product of two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimulatedFloat(f64);

impl SimulatedFloat {
    /// The f32.
    #[inline(always)]
    fn read(self, gpu: &Current) -> f64 {
        if gpu.fuses { gpu.rounded(self.0) } else { self.0 }
    }

    /// A sum. One of the terms may be a product that is not rounded.
    #[inline(always)]
    fn plus(self, other: Self, sign: f64) -> Self {
        let gpu = Current::current();
        let other = if gpu.fuses { addends(self.0, other.0, gpu.rounded(other.0)) } else { other.0 };
        Self(gpu.rounded(self.0 + sign * other))
    }

    /// A function whose result is an f32 if its operand is one.
    #[inline(always)]
    fn exactly(self, f: impl Fn(f64) -> f64) -> Self {
        Self(f(self.read(&Current::current())))
    }

    fn limit(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let gpu = Current::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        if gpu.passes_nan && (a.is_nan() || b.is_nan()) { Self(f64::NAN) } else { Self(f(a, b)) }
    }
}

/// The second term of a sum of terms of which one may be a product that is not rounded: rounded if the first one is such
/// a product as well.
#[inline(always)]
fn addends(first: f64, second: f64, rounded: f64) -> f64 {
    let is_product = (f64::from(first as f32) != first) & first.is_finite();
    if is_product { rounded } else { second }
}

/// The smaller one; a NaN is dropped.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if (a < b) | b.is_nan() { a } else { b }
}

/// The larger one; a NaN is dropped.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if (a > b) | b.is_nan() { a } else { b }
}

macro_rules! exact_functions {
    ($($name:ident)*) => { $(
        #[inline(always)]
        fn $name(self) -> Self {
            self.exactly(<f64 as Number>::$name)
        }
    )* };
}

macro_rules! functions {
    ($($name:ident $function:ident $rule:ident)*) => { $(
        fn $name(self) -> Self {
            self.by_rule(&rules::$rule, Function::$function, <f64 as Number>::$name)
        }
    )* };
}

macro_rules! answers {
    ($($name:ident($($other:ident)?))*) => { $(
        #[inline(always)]
        fn $name(self $(, $other: Self)?) -> u32 {
            let gpu = Current::current();
            <f64 as Number>::$name(self.read(&gpu) $(, $other.read(&gpu))?)
        }
    )* };
}

impl Number for SimulatedFloat {
    const SUMS_BY_CHOICE: bool = true;
    type Int = u32;
    type Wide = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(Current::current().rounded(value))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.read(&Current::current())
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
    fn joined(self, other: Self) -> Self {
        // A formula with two forms: this GPU has one of them.
        if Current::current().has_second(Form::Rule) { other } else { self }
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.plus(other, 1.0)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.plus(other, -1.0)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let gpu = Current::current();
        let exact = self.read(&gpu) * other.read(&gpu) + gpu.zero;
        Self(if gpu.fuses { exact } else { gpu.rounded(exact) })
    }
    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
    fn sum(terms: impl Iterator<Item = Self> + Clone) -> Self {
        if !Current::current().sums_backward {
            return terms.reduce(Self::add).unwrap_or_default();
        }
        let all: SmallVec<[Self; 4]> = terms.collect();
        all.into_iter().rev().reduce(Self::add).unwrap_or_default()
    }
    exact_functions! { neg abs sign floor ceil trunc }
    fn round(self) -> Self {
        let gpu = Current::current();
        let x = self.read(&gpu);
        Self(if gpu.has_second(Form::Half) { x.round() } else { x.round_ties_even() })
    }
    fn mix(self, y: Self, a: Self) -> Self {
        let one = Self(1.0);
        if Current::current().has_second(Form::Mix) {
            return self.add(y.sub(self).mul(a));
        }
        self.mul(one.sub(a)).add(y.mul(a))
    }
    fn min(self, other: Self) -> Self {
        self.limit(other, smaller)
    }
    fn max(self, other: Self) -> Self {
        self.limit(other, larger)
    }
    functions! {
        inversesqrt Inversesqrt INVERSESQRT
        exp Exp EXP
        exp2 Exp2 EXP
        log Log LOG
        log2 Log2 LOG
        sin Sin SIN
        cos Cos SIN
        tan Tan TAN
        asin Asin ASIN
        acos Acos ACOS
        atan Atan ATAN
        sinh Sinh SINH
        cosh Cosh COSH
        tanh Tanh TANH
        asinh Asinh ASINH
        acosh Acosh ACOSH
        atanh Atanh ATANH
    }
    fn sqrt(self) -> Self {
        self.root()
    }
    fn pow(self, exponent: Self) -> Self {
        self.power(exponent)
    }
    fn atan2(self, x: Self) -> Self {
        self.angle(x)
    }
    answers! { less(other) less_equal(other) equal(other) isnan() isinf() to_int() to_uint() }
    #[inline(always)]
    fn select(condition: u32, yes: Self, no: Self) -> Self {
        if condition != 0 { yes } else { no }
    }
    #[inline(always)]
    fn from_int(value: u32) -> Self {
        Self::from_f64(f64::from(value as i32))
    }
    #[inline(always)]
    fn from_uint(value: u32) -> Self {
        Self::from_f64(f64::from(value))
    }
    #[inline(always)]
    fn corner() -> Option<Corner> {
        Current::current().corner
    }
}

/// A conforming GPU, simulated.
#[derive(Clone, Copy, Debug)]
pub struct Simulated;

impl super::Domain for Simulated {
    type Float = SimulatedFloat;
    type Int = u32;
    const NAME: &'static str = "simulated";
    const CHOOSES: bool = true;

    fn undefined(defined: u32) -> u32 {
        Current::current().undefined(defined)
    }

    fn enter(gpu: Gpu) {
        gpu.enter();
    }
    fn planes() -> Planes {
        Current::current().planes
    }
    fn positions() -> Option<FixedPoint> {
        Current::current().positions
    }
    fn weights() -> Option<FixedPoint> {
        Current::current().weights
    }
    fn stored_half(exact: f64) -> f64 {
        Current::current().halves(exact)
    }
    fn point_size_share() -> f64 {
        Current::swing_of(Function::PointSize).at(0.0)
    }
    fn level(steps: [[f64; 3]; 2]) -> f64 {
        Current::current().levels.of(steps)
    }
    fn stepped_level(level: f64) -> f64 {
        Current::current().levels.stepped(level)
    }
    fn level_corner() -> Option<Corner> {
        Current::current().levels.corner
    }
}
