//! The pattern `sheen_albedo`: the part of the light from everywhere that the fibers of the library's module `sheen` return.
//!
//! *In:* a cosine and a roughness. *Out:* a number from 0 to 1. *Holds:* the integral of Estevez' and Kulla's density with Neubelt's and
//! Pettineo's visibility over the half sphere, by midpoints, denser towards the horizon. Fibers of small roughness return more than arrives
//! at grazing angles; there it is 1.

use std::f64::consts::{PI, TAU};

/// The steps over the height of the light and over half of a turn.
const HEIGHTS: u32 = 96;
const TURNS: u32 = 64;
/// Smaller roughness has this one's number.
const LEAST_ROUGHNESS: f64 = 0.1;

/// The part for the cosine of the eye.
pub(super) fn albedo(eye: f64, roughness: f64) -> f64 {
    let power = roughness.max(LEAST_ROUGHNESS).powi(-2);
    let height = |step: u32| {
        let x = (f64::from(step) + 0.5) / f64::from(HEIGHTS);
        // cos = x^2, whose change is 2 x.
        2.0 * x / f64::from(HEIGHTS) * at_height(eye, x * x, power)
    };
    (0..HEIGHTS).map(height).sum::<f64>().min(1.0)
}

/// The integral over all turns of a light at a height, times the cosine.
fn at_height(eye: f64, light: f64, power: f64) -> f64 {
    let flat = ((1.0 - eye * eye) * (1.0 - light * light)).max(0.0).sqrt();
    let visibility = light / (4.0 * (light + eye - light * eye));
    let density = |step: u32| {
        let turn = PI * (f64::from(step) + 0.5) / f64::from(TURNS);
        // The half vector's height, from the length of the sum of both directions.
        let square = 2.0 + 2.0 * (eye * light + flat * turn.cos());
        let height = (eye + light).powi(2) / square.max(f64::MIN_POSITIVE);
        (2.0 + power) / TAU * (1.0 - height).max(0.0).powf(power / 2.0)
    };
    visibility * (0..TURNS).map(density).sum::<f64>() * TAU / f64::from(TURNS)
}

#[cfg(test)]
mod tests {
    use super::albedo;

    /// Of a roughness of 1 the density is 3 sin / (2 pi); seen from above, the half vector is at half of the light's angle, and the
    /// integral over the light's height alone, here by a finer sum.
    #[test]
    fn seen_from_above_it_is_an_integral_over_the_height() {
        let step = |at: i32| {
            let light = (f64::from(at) + 0.5) / 1e6;
            3.0 * ((1.0 - light) / 2.0).sqrt() * light / 4.0 / 1e6
        };
        let expected: f64 = (0..1_000_000).map(step).sum();
        assert!((albedo(1.0, 1.0) - expected).abs() < 2e-4, "{} for {expected}", albedo(1.0, 1.0));
    }

    #[test]
    fn fibers_return_more_towards_the_rim_and_never_more_than_all() {
        for roughness in [0.0, 0.1, 0.3, 0.6, 1.0] {
            let column: Vec<f64> = (0..=20).map(|at| albedo(f64::from(at) / 20.0, roughness)).collect();
            assert!(column.iter().all(|part| (0.0..=1.0).contains(part)), "{roughness}: {column:?}");
            assert!(column.is_sorted_by(|a, b| a >= b), "{roughness}: {column:?}");
        }
    }
}
