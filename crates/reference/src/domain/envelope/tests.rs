//! Compares values with envelopes, function by function.

use super::EnvelopeFloat;
use crate::domain::{Integer, Number};
use glisten_scene::picture::Interval;

fn exact(value: f32) -> EnvelopeFloat {
    EnvelopeFloat::from_f64(f64::from(value))
}

fn between(low: f32, high: f32) -> EnvelopeFloat {
    let middle = f64::from(low) / 2.0 + f64::from(high) / 2.0;
    EnvelopeFloat::with_interval(middle, Interval { low: f64::from(low), high: f64::from(high), may_be_nan: false })
}

/// Random numbers from a seed, the same in every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of any size that occurs in shaders, sometimes a whole number.
    fn number(&mut self) -> f32 {
        let sign = if self.unit() < 0.3 { -1.0 } else { 1.0 };
        // The sign of a zero may be ignored (Vulkan, Precision and Operation), so there is no -0.
        match (self.unit() * 4.0) as u32 {
            0 => (sign * (self.unit() * 9.0).floor()) as f32 + 0.0,
            1 => (sign * self.unit()) as f32,
            2 => (sign * (self.unit() * 40.0 - 20.0).exp2()) as f32,
            _ => (sign * self.unit() * 10.0) as f32,
        }
    }

    /// An interval of such numbers, often a point or a few ULPs wide.
    fn interval(&mut self) -> (f32, f32) {
        let a = self.number();
        let b = match (self.unit() * 3.0) as u32 {
            0 => a,
            1 => a * (1.0 + (self.unit() * 1e-6) as f32),
            _ => self.number(),
        };
        (a.min(b), a.max(b))
    }

    fn inside(&mut self, (low, high): (f32, f32)) -> f32 {
        match (self.unit() * 4.0) as u32 {
            0 => low,
            1 => high,
            _ => (f64::from(low) + (f64::from(high) - f64::from(low)) * self.unit()) as f32,
        }
    }
}

type Unary = (&'static str, fn(EnvelopeFloat) -> EnvelopeFloat, fn(f64) -> f64, fn(f32) -> f32);

macro_rules! unary {
    ($($name:ident),*) => {
        &[$((stringify!($name), <EnvelopeFloat as Number>::$name, <f64 as Number>::$name, <f32 as Number>::$name)),*]
    };
}

const UNARY: &[Unary] = unary!(
    neg,
    abs,
    sign,
    floor,
    ceil,
    trunc,
    round,
    fract,
    sqrt,
    inversesqrt,
    exp,
    log,
    exp2,
    log2,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    asinh,
    acosh,
    atanh,
    square
);

type Binary =
    (&'static str, fn(EnvelopeFloat, EnvelopeFloat) -> EnvelopeFloat, fn(f64, f64) -> f64, fn(f32, f32) -> f32);

macro_rules! binary {
    ($($name:ident),*) => {
        &[$((stringify!($name), <EnvelopeFloat as Number>::$name, <f64 as Number>::$name, <f32 as Number>::$name)),*]
    };
}

const BINARY: &[Binary] = binary!(add, sub, mul, div, min, max, modulo, pow, atan2);

/// If the exact result is undefined, anything is allowed; and a driver's f32 may be infinite where f64 is not.
#[track_caller]
fn assert_holds(name: &str, found: EnvelopeFloat, values: [f64; 2], of: &dyn std::fmt::Debug) {
    assert!(found.low <= found.high, "{name} {of:?}: {found:?}");
    for value in values {
        assert!(found.interval().contains(value), "{name} {of:?}: {value:e} is not in {found:?}");
    }
}

#[test]
fn functions_of_one_number_hold_f64_and_f32_at_any_point_inside() {
    let mut random = Random(1);
    for _ in 0..4000 {
        let ends = random.interval();
        let x = random.inside(ends);
        for (name, envelope, wide, single) in UNARY {
            let found = envelope(between(ends.0, ends.1));
            assert_holds(name, found, [wide(f64::from(x)), f64::from(single(x))], &(ends, x));
        }
    }
}

#[test]
fn functions_of_two_numbers_hold_f64_and_f32_at_any_point_inside() {
    let mut random = Random(2);
    for _ in 0..6000 {
        let (a, b) = (random.interval(), random.interval());
        let (x, y) = (random.inside(a), random.inside(b));
        for (name, envelope, wide, single) in BINARY {
            let found = envelope(between(a.0, a.1), between(b.0, b.1));
            assert_holds(name, found, [wide(f64::from(x), f64::from(y)), f64::from(single(x, y))], &(a, b, x, y));
        }
    }
}

#[test]
fn functions_of_three_numbers_hold_f64_and_f32_at_any_point_inside() {
    let mut random = Random(3);
    for _ in 0..6000 {
        let (a, b, c) = (random.interval(), random.interval(), random.interval());
        let (x, y, z) = (random.inside(a), random.inside(b), random.inside(c));
        let of = (between(a.0, a.1), between(b.0, b.1), between(c.0, c.1));
        let wide = (f64::from(x), f64::from(y), f64::from(z));
        let told = (a, b, c, x, y, z);
        let mixed = [Number::mix(wide.0, wide.1, wide.2), f64::from(Number::mix(x, y, z))];
        assert_holds("mix", of.0.mix(of.1, of.2), mixed, &told);
        let naive = [f64::from(x * (1.0 - z) + y * z), f64::from((y - x).mul_add(z, x))];
        if a.0 >= 0.0 && b.0 >= 0.0 && c.0 >= 0.0 && c.1 <= 1.0 {
            assert_holds("mix", of.0.mix(of.1, of.2), naive, &told);
        }
        if x < y {
            let step = [Number::smoothstep(wide.0, wide.1, wide.2), f64::from(Number::smoothstep(x, y, z))];
            assert_holds("smoothstep", EnvelopeFloat::smoothstep(of.0, of.1, of.2), step, &told);
        }
        // Sums in any order.
        let terms = [of.0, of.1, of.2];
        let sum = EnvelopeFloat::sum(terms.into_iter());
        assert_holds("sum", sum, [f64::from(x + y + z), f64::from(z + y + x)], &told);
        assert_holds("sum", sum, [f64::from(x + z + y), wide.0 + wide.1 + wide.2], &told);
        // Contracted or not.
        let fused = [f64::from(x.mul_add(y, z)), f64::from(x * y + z)];
        assert_holds("a * b + c", of.0.mul(of.1).add(of.2), fused, &told);
    }
}

#[test]
fn exact_operations_stay_exact() {
    let (a, b) = (exact(0.75), exact(-3.0));
    for found in [a.add(b), a.sub(b), a.mul(b), b.div(exact(4.0)), a.max(b), b.abs(), b.square(), a.mix(b, exact(0.5))]
    {
        assert_eq!(found.low, found.high, "{found:?}");
        assert_eq!(found.value, found.low);
    }
    assert!(exact(1.0).div(exact(3.0)).interval().contains(f64::from(1.0f32 / 3.0)));
}

#[test]
fn a_clear_comparison_is_sure_and_an_overlap_is_not() {
    assert!(between(0.9, 1.1).less(between(1.9, 2.1)).is_decided());
    assert!(!between(0.4, 1.6).less(between(1.4, 2.6)).is_decided());
    assert!(exact(0.0).less(exact(0.0)).is_decided(), "exact operands leave nothing undecided");
    let nan = EnvelopeFloat::from_f64(f64::NAN);
    assert!(!nan.less(exact(1.0)).is_decided() && !nan.isnan().is_decided());
}

#[test]
fn selecting_covers_what_may_be_selected() {
    let undecided = between(0.9, 1.1).less(exact(1.0));
    let picked = EnvelopeFloat::select(undecided, exact(1.0), exact(3.0));
    assert_eq!((picked.low, picked.high), (1.0, 3.0));
    assert_eq!(between(-1.0, -0.5).max(exact(0.0)), EnvelopeFloat { value: 0.0, ..exact(0.0) });
}

#[test]
fn a_nan_may_be_dropped_or_not() {
    let unsure = EnvelopeFloat { may_be_nan: true, ..between(0.0, 2.0) };
    let limited = unsure.max(exact(-7.0));
    assert!(limited.may_be_nan && limited.low == -7.0, "either operand, or NaN: {limited:?}");
    assert!(!exact(1.0).max(exact(2.0)).may_be_nan);
}

#[test]
fn subnormal_numbers_may_be_flushed() {
    let tiny = EnvelopeFloat::from_f64(1e-40);
    assert_eq!((tiny.low, tiny.high), (0.0, 1e-40));
    assert!(!exact(0.0).less(tiny).is_decided());
    assert!(exact(1e-30).mul(exact(1e-10)).interval().contains(0.0));
    assert!(exact(1e30).mul(exact(1e10)).interval().contains(f64::INFINITY));
}

#[test]
fn functions_stay_within_what_they_can_give() {
    assert!(between(-3.0, 9.0).tanh().high <= 1.0 + 4e-5 && between(-3.0, 9.0).tanh().low >= -1.0);
    assert!(between(0.0, 1.0).sqrt().low >= 0.0);
    assert!(between(-0.1, 0.1).square().low >= 0.0);
    assert!(between(-100.0, 0.0).exp().low >= 0.0);
    let power = between(0.0, 1.0).pow(exact(32.0));
    assert!(power.low >= 0.0 && power.high < 1.0 + 1e-4 && !power.may_be_nan, "{power:?}");
    let rest = between(2.9, 3.1).modulo(exact(1.0));
    assert!(rest.low > -1e-5 && rest.high < 1.0 + 1e-5, "{rest:?}");
}

/// A result that GLSL leaves undefined may be anything, and the last argument with a meaning does not.
#[test]
fn what_is_undefined_may_be_anything() {
    let below = -f32::MIN_POSITIVE;
    let undefined = [
        ("sqrt", between(below, 1.0).sqrt()),
        ("inversesqrt", exact(0.0).inversesqrt()),
        ("log", exact(0.0).log()),
        ("log2", between(below, 1.0).log2()),
        ("pow of a negative number", between(below, 1.0).pow(exact(2.0))),
        ("pow(0, 0)", exact(0.0).pow(exact(0.0))),
        ("pow(0, -1)", exact(0.0).pow(exact(-1.0))),
        ("asin", between(0.5, 1.000_000_1).asin()),
        ("acos", between(-1.000_000_1, 0.5).acos()),
        ("atan(0, 0)", exact(0.0).atan2(exact(0.0))),
        ("acosh", exact(0.999).acosh()),
        ("atanh", exact(1.0).atanh()),
        ("1 / 0", exact(1.0).div(exact(0.0))),
        ("clamp with min > max", exact(0.5).limited(exact(1.0), exact(0.0))),
        ("smoothstep(1, 1, x)", EnvelopeFloat::smoothstep(exact(1.0), exact(1.0), exact(2.0))),
        ("smoothstep(1, 0, x)", EnvelopeFloat::smoothstep(exact(1.0), exact(0.0), exact(2.0))),
    ];
    for (name, found) in undefined {
        let is_anything = found.low == f64::NEG_INFINITY && found.high == f64::INFINITY && found.may_be_nan;
        assert!(is_anything, "{name}: {found:?}");
    }
    let defined = [
        ("sqrt", exact(0.0).sqrt()),
        ("pow", exact(0.0).pow(exact(1e-3))),
        ("asin", exact(1.0).asin()),
        ("acos", exact(-1.0).acos()),
        ("atan", exact(0.0).atan2(exact(1.0))),
        ("acosh", exact(1.0).acosh()),
        ("clamp", exact(0.5).limited(exact(1.0), exact(1.0))),
        ("smoothstep", EnvelopeFloat::smoothstep(exact(0.0), exact(1.0), exact(2.0))),
    ];
    for (name, found) in defined {
        assert!(!found.may_be_nan && (found.high - found.low).is_finite(), "{name}: {found:?}");
    }
}
