//! Plain floats as domains: f64, the reference, and f32, a strict GPU, whose operators round once and whose built-in functions are
//! those of f64, rounded once.
//!
//! *In:* rows: a method of [`Number`], its operands, its value. *Out:* the two implementations.

use super::Number;

/// `min` and `max` (§8.3): the second operand if it is beyond the first, else the first, so that of 0 and -0 the first comes back. A
/// NaN is dropped, as `minNum` and `maxNum` do.
macro_rules! extremum {
    ($a:expr, $b:expr, $op:tt) => {{
        let (a, b) = ($a, $b);
        if b $op a || a != a { b } else { a }
    }};
}

/// Methods of one or two operands.
macro_rules! rows {
    ($($name:ident($x:ident $(, $y:ident)?) $(-> $result:ty)? = $value:expr;)*) => {
        $(
            #[inline(always)]
            fn $name(self $(, $y: Self)?) -> rows!(@result $($result)?) {
                let $x = self;
                $value
            }
        )*
    };
    (@result) => { Self };
    (@result $result:ty) => { $result };
}

/// Methods that each float has by itself.
macro_rules! own {
    ($float:ty) => {
        type Int = u32;
        type Wide = f64;

        rows! {
            add(a, b) = a + b;
            sub(a, b) = a - b;
            mul(a, b) = a * b;
            div(a, b) = a / b;
            neg(a) = -a;
            abs(a) = <$float>::abs(a);
            sign(a) = <$float>::from(i8::from(a > 0.0) - i8::from(a < 0.0));
            floor(a) = <$float>::floor(a);
            ceil(a) = <$float>::ceil(a);
            trunc(a) = <$float>::trunc(a);
            round(a) = a.round_ties_even();
            min(a, b) = extremum!(a, b, <);
            max(a, b) = extremum!(a, b, >);
            sqrt(a) = <$float>::sqrt(a);
            less(a, b) -> u32 = u32::from(a < b);
            less_equal(a, b) -> u32 = u32::from(a <= b);
            equal(a, b) -> u32 = u32::from(a == b);
            isnan(a) -> u32 = u32::from(a.is_nan());
            isinf(a) -> u32 = u32::from(a.is_infinite());
            to_int(a) -> u32 = a as i32 as u32;
            to_uint(a) -> u32 = a as u32;
            value(a) -> f64 = f64::from(a);
            widen(a) -> f64 = f64::from(a);
        }

        #[inline(always)]
        fn from_f64(value: f64) -> Self {
            value as $float
        }
        #[inline(always)]
        fn narrow(wide: f64) -> Self {
            wide as $float
        }
        #[inline(always)]
        fn select(condition: u32, yes: Self, no: Self) -> Self {
            if condition != 0 { yes } else { no }
        }
        #[inline(always)]
        fn from_int(value: u32) -> Self {
            value as i32 as $float
        }
        #[inline(always)]
        fn from_uint(value: u32) -> Self {
            value as $float
        }
    };
}

impl Number for f64 {
    own!(f64);

    rows! {
        inversesqrt(a) = 1.0 / f64::sqrt(a);
        pow(a, exponent) = if a < 0.0 { f64::NAN } else { a.powf(exponent) };
        exp(a) = f64::exp(a);
        log(a) = f64::ln(a);
        exp2(a) = f64::exp2(a);
        log2(a) = f64::log2(a);
        sin(a) = f64::sin(a);
        cos(a) = f64::cos(a);
        tan(a) = f64::tan(a);
        asin(a) = f64::asin(a);
        acos(a) = f64::acos(a);
        atan(a) = f64::atan(a);
        atan2(y, x) = f64::atan2(y, x);
        sinh(a) = f64::sinh(a);
        cosh(a) = f64::cosh(a);
        tanh(a) = f64::tanh(a);
        asinh(a) = f64::asinh(a);
        acosh(a) = acosh(a);
        // The standard library's loses digits near -1, but not near 1.
        atanh(a) = f64::atanh(a.abs()).copysign(a);
    }
}

/// The standard library's loses half of the digits near 1.
#[inline(always)]
fn acosh(a: f64) -> f64 {
    let above = a - 1.0;
    let root = (above * (a + 1.0)).sqrt();
    match above {
        ..0.0 => f64::NAN,
        _ if root.is_infinite() => a.ln() + std::f64::consts::LN_2,
        _ => (above + root).ln_1p(),
    }
}

/// Methods that f64 has, rounded.
macro_rules! rounded {
    ($($name:ident($x:ident $(, $y:ident)?),)*) => {
        rows! { $($name($x $(, $y)?) = Number::$name(f64::from($x) $(, f64::from($y))?) as f32;)* }
    };
}

impl Number for f32 {
    own!(f32);

    rounded! {
        inversesqrt(a), pow(a, exponent), exp(a), log(a), exp2(a), log2(a), sin(a), cos(a), tan(a), asin(a), acos(a), atan(a),
        atan2(y, x), sinh(a), cosh(a), tanh(a), asinh(a), acosh(a), atanh(a),
    }
}
