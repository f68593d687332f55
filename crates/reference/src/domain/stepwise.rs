//! The f32 side of the [shadow domain](super::Shadow) alone: the arithmetic of an f32 GPU, several times as fast.
//!
//! *In:* f32 values. *Out:* the results of f32 arithmetic, in which built-in functions that are formulas round each step.
//!
//! *Holds:* bit for bit the numbers of the shadow domain's f32 side, as a test compares on random programs. Numbers are stored
//! as f64, since a result of f64 arithmetic that is rounded to f32 is the correctly rounded one for +, -, *, / and `sqrt`.

use super::shadow::{passing_nan, rounded, steps};
use super::{Element, Number, WIDTH};

/// A `float`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepFloat(f64);

impl Element for StepFloat {
    const PLAIN: bool = true;
    type Block = [Self; WIDTH];
}

macro_rules! functions_of_one {
    ($($name:ident)*) => { $(
        #[inline(always)]
        fn $name(self) -> Self {
            Self(rounded(<f64 as Number>::$name(self.0)))
        }
    )* };
}

macro_rules! functions_by_steps {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            Self(steps::$name(self.0))
        }
    )* };
}

macro_rules! functions_of_two {
    ($($name:ident)*) => { $(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            Self(rounded(<f64 as Number>::$name(self.0, other.0)))
        }
    )* };
}

macro_rules! limits {
    ($($name:ident)*) => { $(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            Self(passing_nan(<f64 as Number>::$name)(self.0, other.0))
        }
    )* };
}

macro_rules! answers {
    ($($name:ident($($other:ident)?))*) => { $(
        #[inline(always)]
        fn $name(self $(, $other: Self)?) -> u32 {
            <f64 as Number>::$name(self.0 $(, $other.0)?)
        }
    )* };
}

impl Number for StepFloat {
    type Int = u32;
    type Wide = Self;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(rounded(value))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.0
    }
    #[inline(always)]
    fn widen(self) -> Self {
        self
    }
    #[inline(always)]
    fn narrow(wide: Self) -> Self {
        wide
    }
    functions_of_two! { add sub mul div atan2 }
    limits! { min max }
    functions_of_one! {
        neg abs sign floor ceil trunc round sqrt inversesqrt exp2 log2 sin cos asin acos atan tanh
    }
    functions_by_steps! { exp log tan sinh cosh asinh acosh atanh }
    fn pow(self, exponent: Self) -> Self {
        Self(steps::pow(self.0, exponent.0))
    }
    answers! { less(other) less_equal(other) equal(other) isnan() isinf() to_int() to_uint() }
    #[inline(always)]
    fn select(condition: u32, yes: Self, no: Self) -> Self {
        if condition != 0 { yes } else { no }
    }
    #[inline(always)]
    fn from_int(value: u32) -> Self {
        Self(rounded(f64::from(value as i32)))
    }
    #[inline(always)]
    fn from_uint(value: u32) -> Self {
        Self(rounded(f64::from(value)))
    }
}
