//! The shadow domain: the arithmetic of an f32 GPU and exact arithmetic side by side, so that the error of f32 can be
//! attributed to operations.
//!
//! *In:* f32 values. *Out:* three results for each operation: in f32 on the operands of f32 arithmetic, exactly on these
//! operands, exactly on exact operands. The first two differ by the error that the operation adds, the last two by what it
//! makes of its operands' errors. "Exactly" is f64.
//!
//! *Holds:* the f32 side decides conditions and indices, as on a GPU; the exact side follows it through branches, and
//! selects by its own conditions where nothing branches. An [`Integer`] that is not [decided](Integer::is_decided) is one
//! on which the two sides disagree. On the f32 side, built-in functions that are formulas (`normalize`, `mix`, `pow` as
//! `exp2(y log2(x))`) round each step, as GPUs do, and the others round once; subnormal numbers are flushed to 0; `min` and
//! `max` pass a NaN on, as they may (GLSL leaves it undefined).

use super::{Element, ErrorPart, Integer, Number, WIDTH};

/// A `float`.
pub type ShadowFloat = Shadowed<false>;

/// A number on both sides. `INSIDE` a built-in function, the result on f32 operands continues from step to step without
/// rounding; outside, each operation starts again from its f32 operands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadowed<const INSIDE: bool> {
    /// The result of f32 arithmetic: an f32, unless an [`Exactly`](crate::exec::Exactly) leaves out its rounding.
    pub single: f64,
    /// The last operation's result in f64 on the operands of f32 arithmetic.
    pub exact: f64,
    /// The result of exact arithmetic.
    pub wide: f64,
}

/// An `int`, `uint` or `bool`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowInt {
    /// The bits that follow from f32 arithmetic, which decide.
    pub bits: u32,
    /// The bits that follow from exact arithmetic.
    pub wide: u32,
}

impl Element for ShadowInt {
    type Block = [Self; WIDTH];
}

impl<const INSIDE: bool> Element for Shadowed<INSIDE> {
    type Block = [Self; WIDTH];
}

impl Integer for ShadowInt {
    fn from_bits(bits: u32) -> Self {
        Self { bits, wide: bits }
    }
    fn bits(self) -> u32 {
        self.bits
    }
    fn second(self) -> u32 {
        self.wide
    }
    fn paired(bits: u32, second: u32) -> Self {
        Self { bits, wide: second }
    }
    fn is_decided(self) -> bool {
        self.bits == self.wide
    }
    fn corrected(self) -> Self {
        Self { bits: self.wide, ..self }
    }
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self {
        Self { bits: f(self.bits), wide: f(self.wide) }
    }
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        Self { bits: f(self.bits, other.bits), wide: f(self.wide, other.wide) }
    }
}

/// The nearest f32 of a GPU that flushes subnormal numbers to 0.
#[inline(always)]
pub fn rounded(value: f64) -> f64 {
    let single = value as f32;
    f64::from(if single.is_subnormal() { 0.0 * single } else { single })
}

impl<const INSIDE: bool> Shadowed<INSIDE> {
    /// The error that the last operation added: the difference between its f32 result and the exact one on the same
    /// operands.
    pub fn added(self) -> f64 {
        (self.single - self.exact).abs()
    }

    /// The total difference between f32 and exact arithmetic.
    pub fn error(self) -> f64 {
        (self.single - self.wide).abs()
    }

    fn begun(self) -> Self {
        if INSIDE { self } else { Self { exact: self.single, ..self } }
    }

    /// An operation whose f32 result is the rounded result of f64 arithmetic. Where a result of f64 is rounded to f32, the
    /// result of +, -, *, / and `sqrt` is the correctly rounded one, since f64 has more than twice the bits.
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let a = self.begun();
        Self { single: rounded(f(a.single)), exact: f(a.exact), wide: f(a.wide) }
    }

    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.begun(), other.begun());
        Self { single: rounded(f(a.single, b.single)), exact: f(a.exact, b.exact), wide: f(a.wide, b.wide) }
    }

    /// An operation whose f32 result has steps of its own.
    fn by_steps(self, single: impl Fn(f64) -> f64, f: impl Fn(f64) -> f64) -> Self {
        let a = self.begun();
        Self { single: single(a.single), exact: f(a.exact), wide: f(a.wide) }
    }
}

/// A large number that can still be multiplied and added to.
const LARGE: f64 = 1e18;

/// The functions of one number that Vulkan's precision rules define by other functions, each step rounded.
pub(super) mod steps {
    use super::rounded;
    use crate::domain::Number;

    /// `exp2(x log2(e))`
    pub(in crate::domain) fn exp(x: f64) -> f64 {
        rounded(Number::exp2(rounded(x * rounded(std::f64::consts::LOG2_E))))
    }
    /// `log2(x) ln(2)`
    pub(in crate::domain) fn log(x: f64) -> f64 {
        rounded(rounded(Number::log2(x)) * rounded(std::f64::consts::LN_2))
    }
    /// `sin(x) / cos(x)`
    pub(in crate::domain) fn tan(x: f64) -> f64 {
        rounded(rounded(Number::sin(x)) / rounded(Number::cos(x)))
    }
    /// `(exp(x) - exp(-x)) / 2`
    pub(in crate::domain) fn sinh(x: f64) -> f64 {
        rounded(rounded(exp(x) - exp(-x)) * 0.5)
    }
    /// `(exp(x) + exp(-x)) / 2`
    pub(in crate::domain) fn cosh(x: f64) -> f64 {
        rounded(rounded(exp(x) + exp(-x)) * 0.5)
    }
    /// `log(x + sqrt(x x + 1))`
    pub(in crate::domain) fn asinh(x: f64) -> f64 {
        log(rounded(x + rounded(rounded(rounded(x * x) + 1.0).sqrt())))
    }
    /// `log(x + sqrt(x x - 1))`
    pub(in crate::domain) fn acosh(x: f64) -> f64 {
        log(rounded(x + rounded(rounded(rounded(x * x) - 1.0).sqrt())))
    }
    /// `log((1 + x) / (1 - x)) / 2`
    pub(in crate::domain) fn atanh(x: f64) -> f64 {
        rounded(log(rounded(rounded(1.0 + x) / rounded(1.0 - x))) * 0.5)
    }
    /// `exp2(y log2(x))`
    pub(in crate::domain) fn pow(base: f64, exponent: f64) -> f64 {
        rounded(Number::exp2(rounded(exponent * rounded(Number::log2(base)))))
    }
}

/// `min` or `max` of a GPU that passes a NaN on.
#[inline(always)]
pub(super) fn passing_nan(f: impl Fn(f64, f64) -> f64) -> impl Fn(f64, f64) -> f64 {
    move |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { f(a, b) }
}

macro_rules! functions_of_one {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            self.map(<f64 as Number>::$name)
        }
    )* };
}

macro_rules! functions_by_steps {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            self.by_steps(steps::$name, <f64 as Number>::$name)
        }
    )* };
}

macro_rules! functions_of_two {
    ($($name:ident)*) => { $(
        fn $name(self, other: Self) -> Self {
            self.zip(other, <f64 as Number>::$name)
        }
    )* };
}

macro_rules! limits {
    ($($name:ident)*) => { $(
        fn $name(self, other: Self) -> Self {
            let (a, b) = (self.begun(), other.begun());
            let f = <f64 as Number>::$name;
            Self { single: passing_nan(f)(a.single, b.single), exact: f(a.exact, b.exact), wide: f(a.wide, b.wide) }
        }
    )* };
}

macro_rules! answers {
    ($($name:ident($($other:ident)?))*) => { $(
        fn $name(self $(, $other: Self)?) -> ShadowInt {
            ShadowInt {
                bits: <f64 as Number>::$name(self.single $(, $other.single)?),
                wide: <f64 as Number>::$name(self.wide $(, $other.wide)?),
            }
        }
    )* };
}

impl<const INSIDE: bool> Number for Shadowed<INSIDE> {
    const PAIRED: bool = true;
    type Int = ShadowInt;
    type Wide = Shadowed<true>;

    fn from_f64(value: f64) -> Self {
        Self { single: rounded(value), exact: value, wide: value }
    }
    fn value(self) -> f64 {
        self.single
    }
    fn second(self) -> f64 {
        self.wide
    }
    fn paired(value: f64, second: f64) -> Self {
        Self { single: rounded(value), exact: value, wide: second }
    }
    fn corrected(self, part: ErrorPart) -> Self {
        let single = match part {
            // Where exact arithmetic has no number either, any number shows whether the picture depends on it.
            ErrorPart::All if !self.wide.is_finite() => 0.0,
            ErrorPart::All => self.wide,
            ErrorPart::Limited if self.wide.is_nan() => 0.0,
            ErrorPart::Limited => self.wide.clamp(-LARGE, LARGE),
            ErrorPart::Own => self.exact,
            ErrorPart::Vanished if self.single == 0.0 && self.wide.is_finite() => self.wide,
            ErrorPart::Vanished => self.single,
        };
        Self { single, ..self }
    }
    fn widen(self) -> Shadowed<true> {
        let Self { single, exact, wide } = self.begun();
        Shadowed { single, exact, wide }
    }
    fn narrow(Shadowed { single, exact, wide }: Shadowed<true>) -> Self {
        Self { single, exact, wide }
    }
    functions_of_two! { add sub mul div atan2 }
    limits! { min max }
    functions_of_one! {
        neg abs sign floor ceil trunc round sqrt inversesqrt exp2 log2 sin cos asin acos atan tanh
    }
    functions_by_steps! { exp log tan sinh cosh asinh acosh atanh }
    fn pow(self, exponent: Self) -> Self {
        let (a, b) = (self.begun(), exponent.begun());
        let single = steps::pow(a.single, b.single);
        Self { single, exact: Number::pow(a.exact, b.exact), wide: Number::pow(a.wide, b.wide) }
    }
    answers! { less(other) less_equal(other) equal(other) isnan() isinf() to_int() to_uint() }
    fn select(condition: ShadowInt, yes: Self, no: Self) -> Self {
        let f32_side = if condition.bits != 0 { yes } else { no };
        Self { wide: if condition.wide != 0 { yes.wide } else { no.wide }, ..f32_side }
    }
    fn from_int(value: ShadowInt) -> Self {
        let as_wide = |bits: u32| f64::from(bits as i32);
        let exact = as_wide(value.bits);
        Self { single: rounded(exact), exact, wide: as_wide(value.wide) }
    }
    fn from_uint(value: ShadowInt) -> Self {
        let exact = f64::from(value.bits);
        Self { single: rounded(exact), exact, wide: f64::from(value.wide) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64) -> ShadowFloat {
        Number::from_f64(value)
    }

    #[test]
    fn an_operation_adds_its_own_rounding_and_carries_the_rest() {
        let third = of(1.0).div(of(3.0));
        assert!(third.added() > 0.0 && third.added() == third.error(), "the operands were exact");
        let again = third.mul(of(2.0));
        assert_eq!(again.added(), 0.0, "twice is exact");
        assert_eq!(again.error(), 2.0 * third.error());
    }

    #[test]
    fn f32_decides_and_the_disagreement_is_kept() {
        // 1 + 2^-30 is 1 in f32.
        let near = of(1.0).add(of(2f64.powi(-30)));
        let answer = of(1.0).less(near);
        assert_eq!((answer.bits, answer.wide, answer.is_decided()), (0, 1, false));
        let selected = Shadowed::select(answer, of(5.0), of(7.0));
        assert_eq!((selected.single, selected.wide), (7.0, 5.0), "each side selects by its own condition");
        let both = answer.and(ShadowInt::from_bits(0));
        assert!(both.is_decided(), "a false on both sides ends the disagreement");
    }

    #[test]
    fn results_are_those_of_f32() {
        let values = [1.0f32, 0.1, 3.7e-5, 1e20, 16_777_217.0, -0.3];
        for a in values {
            for b in values {
                let (x, y) = (of(f64::from(a)), of(f64::from(b)));
                assert_eq!(x.add(y).single, f64::from(a + b));
                assert_eq!(x.mul(y).single, f64::from(a * b));
                assert_eq!(x.div(y).single, f64::from(a / b));
            }
            assert_eq!(of(f64::from(a.abs())).sqrt().single, f64::from(a.abs().sqrt()));
        }
        assert_eq!(of(1e-30).mul(of(1e-9)).single, 0.0, "a subnormal result is flushed");
        assert!(of(f64::NAN).max(of(0.0)).single.is_nan());
        assert_eq!(of(f64::NAN).max(of(0.0)).wide, 0.0);
    }

    #[test]
    fn pow_rounds_its_logarithm() {
        let (base, exponent) = (of(f64::from(0.999f32)), of(10_000.0));
        let power = base.pow(exponent);
        let once = (rounded(power.exact) - power.exact).abs();
        assert!(power.added() > 4.0 * once, "{} {once}", power.added());
        assert!(of(0.0).pow(of(0.0)).single.is_nan(), "undefined (GLSL 1.50 §8.2)");
        assert_eq!(of(0.0).pow(of(2.0)).single, 0.0);
    }
}
