//! Ambient occlusion against the integral that it stands for.

use super::{call, function};
use std::f64::consts::{FRAC_PI_2, PI};

/// The light of a slice between two horizons by its integral: cos(x - n) |sin x|, as far as the surface sees it.
fn slice(low: f64, high: f64, n: f64) -> f64 {
    const STEPS: i32 = 20_000;
    let step = (high - low) / f64::from(STEPS);
    let at = |index: i32| low + (f64::from(index) + 0.5) * step;
    (0..STEPS).map(|index| (at(index) - n).cos().max(0.0) * at(index).sin().abs() * step).sum()
}

/// Also where a horizon hides the direction of the normal.
#[test]
fn a_slice_has_the_integral_between_its_horizons() {
    let evaluator = function("ao", "aoSlice(float,float,float)", &[]);
    let steps = |from: f64, to: f64| (0..=6).map(move |at| from + (to - from) * f64::from(at) / 6.0);
    for n in steps(-1.5, 1.5) {
        for low in steps(-PI, 0.0) {
            for high in steps(0.0, PI) {
                let found = call(&evaluator, &[low as f32, high as f32, n as f32])[0][0];
                let expected = slice(low, high, n);
                assert!((found - expected).abs() < 1e-6, "{low} {high} {n}: {found} for {expected}");
            }
        }
    }
}

/// Over all slices, what a surface sees of an open sky is all of it, from wherever it is seen.
#[test]
fn an_open_sky_gives_all_of_its_light() {
    let evaluator = function("ao", "aoSlice(float,float,float)", &[]);
    for tilt in [0.0_f64, 0.4, 0.9, 1.5] {
        let slices = 720;
        let sum: f64 = (0..slices)
            .map(|at| {
                // The normal is tilted from the eye's direction in the first slice.
                let turn = PI * (f64::from(at) + 0.5) / f64::from(slices);
                let (along, across) = (tilt.sin() * turn.cos(), tilt.cos());
                let n = along.atan2(across).clamp(-FRAC_PI_2, FRAC_PI_2);
                along.hypot(across) * call(&evaluator, &[-PI as f32, PI as f32, n as f32])[0][0]
            })
            .sum();
        assert!((sum / f64::from(slices) - 1.0).abs() < 1e-5, "{tilt}: {}", sum / f64::from(slices));
    }
}
