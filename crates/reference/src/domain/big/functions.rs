//! The operations of the language on [`Big`].
//!
//! *In:* numbers of 192 bits. *Out:* the same. *Holds:* no operation goes through f64, but for the rules about zeros,
//! infinities and NaNs, which are f64's.

use super::{BITS, Big, Class, TO_EVEN};
use crate::domain::Number;
use astro_float_num::{BigFloat, Consts, RoundingMode};
use std::cell::RefCell;
use std::cmp::Ordering;

/// The bits with which functions are computed before they are rounded.
const INNER: usize = BITS + 64;

/// `astro-float` would try again with more bits until it can round, which never ends if the result is a tie.
const UNROUNDED: RoundingMode = RoundingMode::None;

thread_local! {
    static CONSTANTS: RefCell<Option<Consts>> = const { RefCell::new(None) };
}

/// Calls a function with the constants of this thread.
fn with_constants<R>(f: impl FnOnce(&mut Consts) -> R) -> Option<R> {
    CONSTANTS.with_borrow_mut(|known| {
        if known.is_none() {
            *known = Consts::new().ok();
        }
        known.as_mut().map(f)
    })
}

/// A function of `astro-float`.
type Function = fn(&BigFloat, usize, RoundingMode, &mut Consts) -> BigFloat;

/// A function with more bits than a number has.
fn inner(x: &BigFloat, function: Function) -> BigFloat {
    with_constants(|constants| function(x, INNER, UNROUNDED, constants)).unwrap_or_default()
}

fn pi() -> BigFloat {
    with_constants(|constants| constants.pi(INNER, UNROUNDED)).unwrap_or_default()
}

fn ln_2() -> BigFloat {
    with_constants(|constants| constants.ln_2(INNER, UNROUNDED)).unwrap_or_default()
}

fn constant(value: f64) -> BigFloat {
    BigFloat::from_f64(value, INNER)
}

macro_rules! inner_operations {
    ($($name:ident)*) => { $(
        fn $name(a: &BigFloat, b: &BigFloat) -> BigFloat {
            a.$name(b, INNER, UNROUNDED)
        }
    )* };
}
inner_operations! { add sub mul div }

impl Big {
    fn exact(self, other: Self, f: fn(&BigFloat, &BigFloat, usize, RoundingMode) -> BigFloat) -> Self {
        Self::rounded(&f(&self.wide(), &other.wide(), BITS, TO_EVEN))
    }

    /// A function that is 0 at 0 with the sign of its argument.
    fn odd(self, function: Function) -> Self {
        match self.class {
            Class::Finite => Self::rounded(&inner(&self.wide(), function)),
            _ => self,
        }
    }

    /// A special argument, by f64's rule.
    fn by_rule(self, f: fn(f64) -> f64) -> Self {
        Self::of(f(self.token()))
    }

    fn is_less(self, value: f64) -> bool {
        self.order(Self::of(value)) == Some(Ordering::Less)
    }

    fn is_above(self, value: f64) -> bool {
        self.order(Self::of(value)) == Some(Ordering::Greater)
    }

    /// The number without its digits after the point.
    fn whole(self) -> Self {
        if self.is_special() || self.exponent >= BITS as i32 {
            return self;
        }
        if self.exponent <= 0 {
            return Self::default().signed(self.negative);
        }
        let mut drop = BITS - self.exponent as usize;
        let mut words = self.words;
        for word in &mut words {
            let here = drop.min(64);
            *word = if here == 64 { 0 } else { *word >> here << here };
            drop -= here;
        }
        Self { words, ..self }
    }

    fn is_odd(self) -> bool {
        let place = BITS as i32 - self.exponent;
        let bit = |place: usize| self.words.get(place / 64).is_some_and(|word| word >> (place % 64) & 1 == 1);
        self.class == Class::Finite && (0..BITS as i32).contains(&place) && bit(place as usize)
    }

    /// e to a power of more bits.
    fn exp_of(x: &BigFloat) -> Self {
        // Beyond the range of exponents on either side: ln(2) 16384 is 11356.5.
        if x.abs_cmp(&constant(12_000.0)).is_some_and(|order| order > 0) {
            return Self::of(if x.is_negative() { 0.0 } else { f64::INFINITY });
        }
        Self::rounded(&inner(x, BigFloat::exp))
    }
}

/// sinh and cosh of a number with a larger exponent are infinite: ln(2) 16384 is below 2^14.
const HYPERBOLIC: i32 = 14;

impl Number for Big {
    type Int = u32;
    type Wide = Self;

    fn from_f64(value: f64) -> Self {
        Self::of(value)
    }
    fn value(self) -> f64 {
        self.nearest()
    }
    /// The part that [`Number::value`] has rounded away, so that two numbers with the same f64 can be told apart.
    fn second(self) -> f64 {
        let value = self.nearest();
        if value.is_finite() { self.sub(Self::of(value)).nearest() } else { value }
    }
    fn widen(self) -> Self {
        self
    }
    fn narrow(wide: Self) -> Self {
        wide
    }
    fn add(self, other: Self) -> Self {
        match (self.class, other.class) {
            (Class::Finite, Class::Finite) => {
                let sum = self.exact(other, BigFloat::add);
                if sum.class == Class::Zero { Self::default() } else { sum }
            }
            (Class::Finite, Class::Zero) => self,
            (Class::Zero, Class::Finite) => other,
            _ => Self::of(self.token() + other.token()),
        }
    }
    fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }
    fn mul(self, other: Self) -> Self {
        if self.is_special() || other.is_special() {
            return Self::of(self.token() * other.token());
        }
        self.exact(other, BigFloat::mul)
    }
    fn div(self, other: Self) -> Self {
        if self.is_special() || other.is_special() {
            return Self::of(self.token() / other.token());
        }
        self.exact(other, BigFloat::div)
    }
    fn neg(self) -> Self {
        self.signed(!self.negative)
    }
    fn abs(self) -> Self {
        self.signed(false)
    }
    fn sign(self) -> Self {
        match self.class {
            Class::Zero | Class::Nan => Self::default(),
            _ => Self::of(if self.negative { -1.0 } else { 1.0 }),
        }
    }
    fn floor(self) -> Self {
        let whole = self.whole();
        let below = self.negative && self.order(whole) == Some(Ordering::Less);
        if below { whole.sub(Self::of(1.0)) } else { whole }
    }
    fn ceil(self) -> Self {
        self.neg().floor().neg()
    }
    fn trunc(self) -> Self {
        self.whole()
    }
    fn round(self) -> Self {
        let whole = self.whole();
        let rest = self.sub(whole).abs();
        let step = Self::of(if self.negative { -1.0 } else { 1.0 });
        match rest.order(Self::of(0.5)) {
            Some(Ordering::Greater) => whole.add(step),
            Some(Ordering::Equal) if whole.is_odd() => whole.add(step),
            _ => whole,
        }
    }
    fn radians(self) -> Self {
        if self.is_special() { self } else { Self::rounded(&div(&mul(&self.wide(), &pi()), &constant(180.0))) }
    }
    fn degrees(self) -> Self {
        if self.is_special() { self } else { Self::rounded(&div(&mul(&self.wide(), &constant(180.0)), &pi())) }
    }
    fn min(self, other: Self) -> Self {
        if other.order(self) == Some(Ordering::Less) || self.class == Class::Nan { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.order(self) == Some(Ordering::Greater) || self.class == Class::Nan { other } else { self }
    }
    fn sqrt(self) -> Self {
        if self.is_special() || self.negative {
            return self.by_rule(f64::sqrt);
        }
        Self::rounded(&self.wide().sqrt(INNER, UNROUNDED))
    }
    fn inversesqrt(self) -> Self {
        if self.is_special() || self.negative {
            return self.by_rule(Number::inversesqrt);
        }
        Self::rounded(&div(&constant(1.0), &self.wide().sqrt(INNER, UNROUNDED)))
    }
    fn pow(self, exponent: Self) -> Self {
        let one = Self::of(1.0);
        if self.is_less(0.0) {
            return Self::NAN;
        }
        if exponent.class == Class::Zero || self.order(one) == Some(Ordering::Equal) {
            return one;
        }
        if self.is_special() || exponent.is_special() {
            // An infinite exponent depends on the side of 1.
            let side = match self.order(one) {
                Some(Ordering::Less) if self.class == Class::Finite => 0.5,
                Some(Ordering::Greater) if self.class == Class::Finite => 2.0,
                _ => self.token(),
            };
            return Self::of(side.powf(exponent.token()));
        }
        // The power's relative error is the exponent's size times that of the logarithm, which may be as large as 2^14.
        let wide =
            |x: &BigFloat| with_constants(|constants| x.ln(INNER + 64, UNROUNDED, constants)).unwrap_or_default();
        let product = wide(&self.wide()).mul(&exponent.wide(), INNER + 64, UNROUNDED);
        Self::exp_of(&product)
    }
    fn exp(self) -> Self {
        match self.class {
            Class::Finite => Self::exp_of(&self.wide()),
            _ => self.by_rule(f64::exp),
        }
    }
    fn log(self) -> Self {
        match self.class {
            Class::Finite if !self.negative => Self::rounded(&inner(&self.wide(), BigFloat::ln)),
            _ => self.by_rule(f64::ln),
        }
    }
    fn exp2(self) -> Self {
        match self.class {
            Class::Finite if self.order(self.whole()) == Some(Ordering::Equal) => {
                let exponent = self.nearest().clamp(-1e6, 1e6) as i32 + 1;
                Self { exponent, ..Self::of(1.0) }.limited()
            }
            Class::Finite => Self::exp_of(&mul(&self.wide(), &ln_2())),
            _ => self.by_rule(f64::exp2),
        }
    }
    fn log2(self) -> Self {
        match self.class {
            // A power of two, whose logarithm is whole.
            Class::Finite if !self.negative && self.words == Self::of(1.0).words => {
                Self::of(f64::from(self.exponent - 1))
            }
            Class::Finite if !self.negative => Self::rounded(&div(&inner(&self.wide(), BigFloat::ln), &ln_2())),
            _ => self.by_rule(f64::log2),
        }
    }
    fn sin(self) -> Self {
        if self.class == Class::Infinite { Self::NAN } else { self.odd(BigFloat::sin) }
    }
    fn cos(self) -> Self {
        match self.class {
            Class::Finite => Self::rounded(&inner(&self.wide(), BigFloat::cos)),
            _ => self.by_rule(f64::cos),
        }
    }
    fn tan(self) -> Self {
        if self.class == Class::Infinite { Self::NAN } else { self.odd(BigFloat::tan) }
    }
    fn asin(self) -> Self {
        if self.abs().is_above(1.0) { Self::NAN } else { self.odd(BigFloat::asin) }
    }
    fn acos(self) -> Self {
        match self.class {
            Class::Zero => Self::rounded(&div(&pi(), &constant(2.0))),
            Class::Finite if !self.abs().is_above(1.0) => {
                let one = Self::of(1.0);
                if self.order(one) == Some(Ordering::Equal) {
                    return Self::default();
                }
                Self::rounded(&inner(&self.wide(), BigFloat::acos))
            }
            _ => Self::NAN,
        }
    }
    fn atan(self) -> Self {
        match self.class {
            Class::Infinite => Self::rounded(&div(&pi(), &constant(2.0))).signed(self.negative),
            _ => self.odd(BigFloat::atan),
        }
    }
    fn atan2(self, x: Self) -> Self {
        if self.class == Class::Nan || x.class == Class::Nan {
            return Self::NAN;
        }
        let part = |numerator: f64, denominator: f64| {
            Self::rounded(&div(&mul(&pi(), &constant(numerator)), &constant(denominator))).signed(self.negative)
        };
        match (self.class, x.class) {
            (Class::Infinite, Class::Infinite) => part(if x.negative { 3.0 } else { 1.0 }, 4.0),
            (Class::Infinite, _) | (Class::Finite, Class::Zero) => part(1.0, 2.0),
            (Class::Zero, _) | (_, Class::Infinite) if x.negative => part(1.0, 1.0),
            (Class::Zero, _) | (_, Class::Infinite) => Self::default().signed(self.negative),
            _ => {
                let quotient = div(&self.wide(), &x.wide());
                let angle = inner(&quotient, BigFloat::atan);
                Self::rounded(&match (x.negative, self.negative) {
                    (false, _) => angle,
                    (true, false) => add(&angle, &pi()),
                    (true, true) => sub(&angle, &pi()),
                })
            }
        }
    }
    fn sinh(self) -> Self {
        match self.class {
            Class::Finite if self.exponent > HYPERBOLIC => Self::of(f64::INFINITY).signed(self.negative),
            _ => self.odd(BigFloat::sinh),
        }
    }
    fn cosh(self) -> Self {
        match self.class {
            Class::Finite if self.exponent > HYPERBOLIC => Self::of(f64::INFINITY),
            Class::Finite => Self::rounded(&inner(&self.wide(), BigFloat::cosh)),
            _ => self.by_rule(f64::cosh),
        }
    }
    fn tanh(self) -> Self {
        match self.class {
            // 1 - tanh(128) is below 2^-192.
            Class::Finite if self.exponent > 8 => Self::of(1.0).signed(self.negative),
            Class::Finite => self.odd(BigFloat::tanh),
            _ => self.by_rule(f64::tanh),
        }
    }
    fn asinh(self) -> Self {
        match self.class {
            Class::Finite => self.odd(BigFloat::asinh),
            _ => self,
        }
    }
    fn acosh(self) -> Self {
        match self.class {
            _ if self.is_less(1.0) => Self::NAN,
            Class::Finite if self.order(Self::of(1.0)) == Some(Ordering::Equal) => Self::default(),
            Class::Finite => Self::rounded(&inner(&self.wide(), BigFloat::acosh)),
            _ => self,
        }
    }
    fn atanh(self) -> Self {
        match self.abs().order(Self::of(1.0)) {
            Some(Ordering::Less) => self.odd(BigFloat::atanh),
            Some(Ordering::Equal) => Self::of(f64::INFINITY).signed(self.negative),
            _ => Self::NAN,
        }
    }
    fn less(self, other: Self) -> u32 {
        u32::from(self.order(other) == Some(Ordering::Less))
    }
    fn less_equal(self, other: Self) -> u32 {
        u32::from(matches!(self.order(other), Some(Ordering::Less | Ordering::Equal)))
    }
    fn equal(self, other: Self) -> u32 {
        u32::from(self.order(other) == Some(Ordering::Equal))
    }
    fn isnan(self) -> u32 {
        u32::from(self.class == Class::Nan)
    }
    fn isinf(self) -> u32 {
        u32::from(self.class == Class::Infinite)
    }
    fn select(condition: u32, yes: Self, no: Self) -> Self {
        if condition != 0 { yes } else { no }
    }
    fn from_int(value: u32) -> Self {
        Self::of(f64::from(value as i32))
    }
    fn from_uint(value: u32) -> Self {
        Self::of(f64::from(value))
    }
    fn to_int(self) -> u32 {
        self.whole().nearest() as i32 as u32
    }
    fn to_uint(self) -> u32 {
        self.whole().nearest() as u32
    }
}
