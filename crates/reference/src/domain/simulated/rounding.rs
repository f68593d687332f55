//! The rounding of operations whose rule is "correctly rounded", which means either neighbor.
//!
//! *In:* exact results. *Out:* the f32 numbers to which a GPU rounds. *Holds:* no function here branches on a number, so that
//! a loop over lanes is a few vector instructions; one number and a lane of eight are rounded alike.

use crate::domain::WIDTH;
use half::f16;

/// The kind of rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rounding {
    Nearest,
    TowardZero,
    /// Up or down, by the digits that are lost.
    Either,
}

/// A kind of rounding with the seed of its chances, and whether subnormal results are flushed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounder {
    pub(super) rounding: Rounding,
    pub(super) seed: u32,
    pub(super) flushes: bool,
}

impl Rounder {
    /// The f32 to which it rounds a number.
    #[inline(always)]
    pub(super) fn one(self, exact: f64) -> f64 {
        let single = match self.rounding {
            Rounding::Nearest => exact as f32,
            Rounding::TowardZero => toward_zero(exact),
            Rounding::Either => either(exact, self.seed),
        };
        if self.flushes { flushed(single) } else { f64::from(single) }
    }

    /// The f32 to which it rounds the number of each lane.
    #[inline(always)]
    pub(super) fn all(self, exact: &[f64; WIDTH]) -> [f64; WIDTH] {
        // Loops, because a closure that an iterator calls would not be compiled for the vector unit.
        let mut singles = [0.0; WIDTH];
        match self.rounding {
            Rounding::Nearest => {
                for lane in 0..WIDTH {
                    singles[lane] = exact[lane] as f32;
                }
            }
            Rounding::TowardZero => {
                for lane in 0..WIDTH {
                    singles[lane] = toward_zero(exact[lane]);
                }
            }
            Rounding::Either => {
                for lane in 0..WIDTH {
                    singles[lane] = either(exact[lane], self.seed);
                }
            }
        }
        let mut out = [0.0; WIDTH];
        for lane in 0..WIDTH {
            out[lane] = if self.flushes { flushed(singles[lane]) } else { f64::from(singles[lane]) };
        }
        out
    }
}

/// The neighbor of smaller size.
#[inline(always)]
fn toward_zero(exact: f64) -> f32 {
    let nearest = exact as f32;
    let is_beyond = (f64::from(nearest).abs() > exact.abs()) & nearest.is_finite();
    f32::from_bits(nearest.to_bits().wrapping_sub(u32::from(is_beyond)))
}

impl Rounder {
    /// The 16-bit float to which it rounds a number that is stored.
    pub(super) fn half(self, exact: f64) -> f64 {
        let nearest = f16::from_f64(exact);
        let back = f64::from(nearest);
        if back == exact || exact.is_nan() {
            return back;
        }
        let is_beyond = back.abs() > exact.abs();
        let is_moved = match self.rounding {
            Rounding::Nearest => false,
            Rounding::TowardZero => is_beyond,
            Rounding::Either => chance(exact, self.seed),
        };
        if !is_moved {
            return back;
        }
        // The size of a float grows with its bits, and 0 has the sign of the number.
        let bits = nearest.to_bits();
        f64::from(f16::from_bits(if is_beyond { bits - 1 } else { bits + 1 }))
    }
}

/// The nearest neighbor, or the other one, by the digits that are lost.
#[inline(always)]
fn either(exact: f64, seed: u32) -> f32 {
    let nearest = exact as f32;
    let back = f64::from(nearest);
    // The size of an f32 grows with its bits.
    let step = if back.abs() > exact.abs() { u32::MAX } else { 1 };
    let is_moved = (back != exact) & nearest.is_finite() & chance(exact, seed);
    f32::from_bits(nearest.to_bits().wrapping_add(if is_moved { step } else { 0 }))
}

/// Half of all numbers, by a hash of 32 bits, which vector units multiply fast.
#[inline(always)]
fn chance(exact: f64, seed: u32) -> bool {
    let bits = exact.to_bits();
    let mut hash = (bits as u32 ^ ((bits >> 32) as u32).rotate_left(13) ^ seed).wrapping_mul(0x9e37_79b1);
    hash = (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b);
    hash >> 31 == 1
}

/// 0 for a subnormal number.
#[inline(always)]
fn flushed(single: f32) -> f64 {
    let is_small = single.abs() < f32::MIN_POSITIVE;
    f64::from(if is_small { 0.0 * single } else { single })
}
