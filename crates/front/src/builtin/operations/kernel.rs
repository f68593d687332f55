//! The operations on f64 numbers, for constant folding and for checking the reference's f64 domain.
//!
//! These cases are defined here because GLSL leaves them undefined: `min` and `max` drop a NaN if the other operand
//! is not one (IEEE 754-2008 `minNum`, as on GPUs); `sign` of NaN is 0; `pow` of a negative base is NaN (§8.2; GPUs
//! compute `exp2(y * log2(x))`), `pow(0, 0)` is 1; `round` goes to the even neighbor at halves.

use std::f64::consts::{LN_2, PI};

/// §8.1: `x * (pi / 180)`, rounded once.
#[inline(always)]
pub fn radians(x: f64) -> f64 {
    x * (PI / 180.0)
}

/// §8.1
#[inline(always)]
pub fn degrees(x: f64) -> f64 {
    x * (180.0 / PI)
}

/// §8.3
#[inline(always)]
pub fn sign(x: f64) -> f64 {
    f64::from(i8::from(x > 0.0) - i8::from(x < 0.0))
}

/// §8.1. The standard library's function loses half of the digits near 1.
#[inline(always)]
pub fn acosh(x: f64) -> f64 {
    let above = x - 1.0;
    let root = (above * (x + 1.0)).sqrt();
    match above {
        ..0.0 => f64::NAN,
        _ if root.is_infinite() => x.ln() + LN_2,
        _ => (above + root).ln_1p(),
    }
}

/// §8.1. The standard library's function loses digits near -1, but not near 1.
#[inline(always)]
pub fn atanh(x: f64) -> f64 {
    x.abs().atanh().copysign(x)
}

/// §8.2
#[inline(always)]
pub fn pow(x: f64, y: f64) -> f64 {
    if x < 0.0 { f64::NAN } else { x.powf(y) }
}

/// §8.3: the first of two that are equal, 0.0 and -0.0 among them. A NaN is dropped (`minNum`).
#[inline(always)]
pub fn min(a: f64, b: f64) -> f64 {
    if b < a || a.is_nan() { b } else { a }
}

/// §8.3: the first of two that are equal, 0.0 and -0.0 among them. A NaN is dropped (`maxNum`).
#[inline(always)]
pub fn max(a: f64, b: f64) -> f64 {
    if b > a || a.is_nan() { b } else { a }
}

/// `x - y * floor(x / y)` (§8.3)
#[inline(always)]
pub fn modulo(x: f64, y: f64) -> f64 {
    x - y * (x / y).floor()
}

/// §8.3
#[inline(always)]
pub fn step(edge: f64, x: f64) -> f64 {
    if x < edge { 0.0 } else { 1.0 }
}

/// `x (1 - a) + y a` (§8.3)
#[inline(always)]
pub fn mix(x: f64, y: f64, a: f64) -> f64 {
    x * (1.0 - a) + y * a
}

/// `min(max(x, least), most)` (§8.3)
#[inline(always)]
pub fn clamp(x: f64, least: f64, most: f64) -> f64 {
    min(max(x, least), most)
}

/// `t t (3 - 2 t)` with `t = clamp((x - edge0) / (edge1 - edge0), 0, 1)` (§8.3)
#[inline(always)]
pub fn smoothstep(edge0: f64, edge1: f64, x: f64) -> f64 {
    let t = clamp((x - edge0) / (edge1 - edge0), 0.0, 1.0);
    t * t * (3.0 - t * 2.0)
}
