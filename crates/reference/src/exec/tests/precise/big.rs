//! Numbers of 320 bits, for checking f64.

use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// So many bits that the rounding of a few operations is invisible in f64, even if sums cancel.
const BITS: usize = 320;
const TO_EVEN: RoundingMode = RoundingMode::ToEven;

thread_local! {
    static CONSTANTS: RefCell<Consts> = RefCell::new(Consts::new().expect("memory"));
}

/// A number, which may be infinite or NaN.
#[derive(Clone, Debug)]
pub(super) struct Big(BigFloat);

/// A function of `astro-float`.
type Function = fn(&BigFloat, usize, RoundingMode, &mut Consts) -> BigFloat;

impl Big {
    /// Exactly this value.
    pub(super) fn of(value: f64) -> Self {
        Self(BigFloat::from_f64(value, BITS))
    }

    /// A function of this number.
    pub(super) fn map(&self, function: Function) -> Self {
        CONSTANTS.with_borrow_mut(|constants| Self(function(&self.0, BITS, TO_EVEN, constants)))
    }

    /// `self` to the power `exponent`, for positive `self`. The crate's own function does not terminate if the result
    /// is exact.
    pub(super) fn pow(&self, exponent: &Self) -> Self {
        (&self.map(BigFloat::ln) * exponent).map(BigFloat::exp)
    }

    pub(super) fn pi() -> Self {
        // 4 atan(1)
        &Self::of(4.0) * &Self::of(1.0).map(BigFloat::atan)
    }

    pub(super) fn sqrt(&self) -> Self {
        Self(self.0.sqrt(BITS, TO_EVEN))
    }

    pub(super) fn floor(&self) -> Self {
        Self(self.0.floor())
    }

    pub(super) fn abs(&self) -> Self {
        Self(self.0.abs())
    }

    pub(super) fn is_negative(&self) -> bool {
        self.0.is_negative() && !self.0.is_zero()
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    /// The value as f64, to a few of its roundings.
    pub(super) fn approx(&self) -> f64 {
        if self.0.is_nan() {
            return f64::NAN;
        }
        let sign = if self.0.is_negative() { -1.0 } else { 1.0 };
        if self.0.is_inf() {
            return sign * f64::INFINITY;
        }
        let Some((words, _, given, exponent, _)) = self.0.as_raw_parts() else { return f64::NAN };
        debug_assert_eq!(given == Sign::Neg, sign < 0.0);
        // The number is 0.mantissa times 2^exponent, with the most significant word last.
        let top = words.last().map_or(0.0, |word| *word as f64 / 2.0_f64.powi(64));
        // In two steps, so that neither overflows alone.
        let half = exponent.clamp(-3000, 3000) / 2;
        sign * top * 2.0_f64.powi(half) * 2.0_f64.powi(exponent.clamp(-3000, 3000) - half)
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for &Big {
            type Output = Big;
            fn $method(self, other: &Big) -> Big {
                Big(self.0.$method(&other.0, BITS, TO_EVEN))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for &Big {
    type Output = Big;
    fn neg(self) -> Big {
        Big(BigFloat::neg(&self.0))
    }
}
