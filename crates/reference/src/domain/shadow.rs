//! The shadow domain: an f32 and an f64 side by side, so that the error of f32 arithmetic can be attributed to
//! operations.
//!
//! *In:* f32 values. *Out:* three results for each operation: on the f32 operands in f32, on the f32 operands in f64,
//! on the f64 operands in f64. The first two differ by the error that the operation adds, the last two by what it
//! makes of its operands' errors.
//!
//! *Holds:* both sides take the path of f64, whose results decide conditions and indices. An [`Integer`] that is not
//! [decided](Integer::is_decided) is one on which the two disagree. Built-in functions that are formulas (`normalize`, `mix`,
//! `pow` as `exp2(y log2(x))`) round each step in f32, as GPUs do; the others round once. Subnormal f32 numbers are
//! kept, not flushed to 0.

use super::{Element, Integer, Number, WIDTH};

/// A `float`.
pub type ShadowFloat = Shadowed<false>;

/// A number in both precisions. `INSIDE` a built-in function, the exact result continues from step to step; outside,
/// each operation starts again from its f32 operands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadowed<const INSIDE: bool> {
    /// The result of f32 arithmetic.
    pub single: f32,
    /// The last operation's result in f64 on the operands of f32 arithmetic.
    pub exact: f64,
    /// The result of f64 arithmetic.
    pub wide: f64,
}

/// An `int`, `uint` or `bool`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowInt {
    /// The bits that follow from f64 arithmetic, which decide.
    pub bits: u32,
    /// The bits that follow from f32 arithmetic.
    pub single: u32,
}

impl Element for ShadowInt {
    type Block = [Self; WIDTH];
}

impl<const INSIDE: bool> Element for Shadowed<INSIDE> {
    type Block = [Self; WIDTH];
}

impl Integer for ShadowInt {
    fn from_bits(bits: u32) -> Self {
        Self { bits, single: bits }
    }
    fn bits(self) -> u32 {
        self.bits
    }
    fn second(self) -> u32 {
        self.single
    }
    fn paired(bits: u32, second: u32) -> Self {
        Self { bits, single: second }
    }
    fn is_decided(self) -> bool {
        self.bits == self.single
    }
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self {
        Self { bits: f(self.bits), single: f(self.single) }
    }
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        Self { bits: f(self.bits, other.bits), single: f(self.single, other.single) }
    }
}

impl<const INSIDE: bool> Shadowed<INSIDE> {
    /// The error that the last operation added: the difference between its f32 result and the exact one on the same
    /// operands.
    pub fn added(self) -> f64 {
        (f64::from(self.single) - self.exact).abs()
    }

    /// The total difference between f32 and f64 arithmetic.
    pub fn error(self) -> f64 {
        (f64::from(self.single) - self.wide).abs()
    }

    fn begun(self) -> Self {
        if INSIDE { self } else { Self { exact: f64::from(self.single), ..self } }
    }

    fn map(self, single: impl Fn(f32) -> f32, wide: impl Fn(f64) -> f64) -> Self {
        let a = self.begun();
        Self { single: single(a.single), exact: wide(a.exact), wide: wide(a.wide) }
    }

    fn zip(self, other: Self, single: impl Fn(f32, f32) -> f32, wide: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.begun(), other.begun());
        Self { single: single(a.single, b.single), exact: wide(a.exact, b.exact), wide: wide(a.wide, b.wide) }
    }
}

/// `exp2(y log2(x))` with each step rounded, as Vulkan's precision rules define `pow`.
fn pow_by_steps(base: f32, exponent: f32) -> f32 {
    Number::exp2(exponent * Number::log2(base))
}

macro_rules! functions_of_one {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            self.map(<f32 as Number>::$name, <f64 as Number>::$name)
        }
    )* };
}

macro_rules! functions_of_two {
    ($($name:ident)*) => { $(
        fn $name(self, other: Self) -> Self {
            self.zip(other, <f32 as Number>::$name, <f64 as Number>::$name)
        }
    )* };
}

macro_rules! answers {
    ($($name:ident($($other:ident)?))*) => { $(
        fn $name(self $(, $other: Self)?) -> ShadowInt {
            ShadowInt {
                bits: <f64 as Number>::$name(self.wide $(, $other.wide)?),
                single: <f32 as Number>::$name(self.single $(, $other.single)?),
            }
        }
    )* };
}

impl<const INSIDE: bool> Number for Shadowed<INSIDE> {
    const PAIRED: bool = true;
    type Int = ShadowInt;
    type Wide = Shadowed<true>;

    fn from_f64(value: f64) -> Self {
        Self { single: value as f32, exact: value, wide: value }
    }
    fn value(self) -> f64 {
        self.wide
    }
    fn second(self) -> f64 {
        self.single.into()
    }
    fn paired(value: f64, second: f64) -> Self {
        Self { single: second as f32, exact: second, wide: value }
    }
    fn widen(self) -> Shadowed<true> {
        let Self { single, exact, wide } = self.begun();
        Shadowed { single, exact, wide }
    }
    fn narrow(Shadowed { single, exact, wide }: Shadowed<true>) -> Self {
        Self { single, exact, wide }
    }
    functions_of_two! { add sub mul div min max atan2 }
    functions_of_one! {
        neg abs sign floor ceil trunc round sqrt inversesqrt exp log exp2 log2 sin cos tan asin acos atan sinh cosh tanh
        asinh acosh atanh
    }
    fn pow(self, exponent: Self) -> Self {
        self.zip(exponent, pow_by_steps, Number::pow)
    }
    answers! { less(other) less_equal(other) equal(other) isnan() isinf() to_int() to_uint() }
    fn select(condition: ShadowInt, yes: Self, no: Self) -> Self {
        if condition.is_true() { yes } else { no }
    }
    fn from_int(value: ShadowInt) -> Self {
        let as_wide = |bits: u32| f64::from(bits as i32);
        Self { single: value.single as i32 as f32, exact: as_wide(value.single), wide: as_wide(value.bits) }
    }
    fn from_uint(value: ShadowInt) -> Self {
        Self { single: value.single as f32, exact: value.single.into(), wide: value.bits.into() }
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
    fn both_sides_take_the_way_of_f64_and_their_quarrel_is_kept() {
        // 1 + 2^-30 is 1 in f32.
        let near = of(1.0).add(of(2f64.powi(-30)));
        let answer = of(1.0).less(near);
        assert_eq!((answer.bits, answer.single, answer.is_decided()), (1, 0, false));
        assert_eq!(Shadowed::select(answer, of(5.0), of(7.0)).single, 5.0);
        let both = answer.and(ShadowInt::from_bits(0));
        assert!(both.is_decided(), "a false on both sides ends the quarrel");
    }

    #[test]
    fn pow_rounds_its_logarithm() {
        let (base, exponent) = (of(f64::from(0.999f32)), of(10_000.0));
        let power = base.pow(exponent);
        let once = (power.exact as f32 as f64 - power.exact).abs();
        assert!(power.added() > 4.0 * once, "{} {once}", power.added());
        assert!(of(0.0).pow(of(0.0)).single.is_nan(), "undefined (GLSL 1.50 §8.2)");
        assert_eq!(of(0.0).pow(of(2.0)).single, 0.0);
    }
}
