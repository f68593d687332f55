//! [`Jitter`]: moves inputs by an ULP of f32, to see what that changes.
//!
//! *In:* numbers, a seed, and the place of each. *Out:* the numbers, each moved up or down by chance. *Holds:* the chance depends on the seed
//! and the place alone.
//!
//! A number that is far away moves no more than what it varies by would: a program can keep the distance apart, so its last digit is no
//! part of the problem.

use crate::domain::Number;

/// How the varyings of a draw move.
#[derive(Clone, Debug)]
pub(super) struct Jitter {
    pub(super) seed: u64,
    /// For each float varying, by how much it varies over the vertices; 1 at least.
    reaches: Vec<f64>,
}

impl Jitter {
    /// Of the varyings of vertices, so many for each of them.
    pub(super) fn new<N: Number>(seed: u64, floats: &[N], count: usize) -> Self {
        let mut bounds = vec![[f64::INFINITY, f64::NEG_INFINITY]; count];
        for vertex in floats.chunks(count.max(1)) {
            for ([low, high], value) in bounds.iter_mut().zip(vertex).filter(|(_, value)| value.value().is_finite()) {
                *low = low.min(value.value());
                *high = high.max(value.value());
            }
        }
        Self { seed, reaches: bounds.into_iter().map(|[low, high]| (high - low).max(1.0)).collect() }
    }

    /// How far from 0 an ULP of a varying still grows.
    pub(super) fn reach(&self, varying: usize) -> f64 {
        self.reaches.get(varying).copied().unwrap_or(1.0)
    }
}

/// A number moved up or down by chance, by an ULP of f32 (2^-23 of it), or of `reach` if that is smaller.
pub(crate) fn jittered(value: f64, reach: f64, seed: u64, place: [u64; 3]) -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for part in place {
        state = (state ^ part).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state ^= state >> 29;
    }
    let step = f64::from(f32::EPSILON) * value.abs().min(reach);
    let is_up = (state >> 40 & 1 == 0) == (value >= 0.0);
    if is_up { value + step } else { value - step }
}

#[cfg(test)]
mod tests {
    use super::{Jitter, jittered};

    #[test]
    fn a_far_number_moves_as_one_that_is_near() {
        let step = |value: f64, reach: f64| (jittered(value, reach, 1, [2, 3, 4]) - value).abs();
        assert_eq!(step(0.5, f64::INFINITY), 0.5 * f64::from(f32::EPSILON));
        assert_eq!(step(-1024.0, f64::INFINITY), 1024.0 * f64::from(f32::EPSILON));
        assert_eq!(step(1024.0, 2.0), 2.0 * f64::from(f32::EPSILON));
    }

    #[test]
    fn the_reach_of_a_varying_is_what_it_varies_by() {
        assert_eq!(Jitter::new::<f64>(1, &[], 2).reach(0), 1.0);
        let floats = [1e6, 0.25, 1e6 + 8.0, 0.5, f64::INFINITY, 0.75];
        let jitter = Jitter::new(1, &floats, 2);
        assert_eq!([jitter.reach(0), jitter.reach(1)], [8.0, 1.0]);
    }
}
