//! Light that travels in a ball against the convolution that it stands for, and rough mirrors in few harmonics against integrals.

use super::{call, function};
use std::f64::consts::PI;

/// Normalized diffusion on a ball of radius 1, times 2 pi r: of chords r.
fn profile(d: f64, r: f64) -> f64 {
    ((-r / d).exp() + (-r / (3.0 * d)).exp()) / (4.0 * d)
}

/// The light of a point at the angle `a` from the lamp: the mean of its neighbors' light by the profile (Penner and Borshukov, on the ball
/// instead of on a ring).
fn convolved(d: f64, a: f64) -> f64 {
    const CHORDS: u32 = 400;
    const TURNS: u32 = 200;
    let (mut sum, mut all) = (0.0, 0.0);
    for k in 0..CHORDS {
        // Denser near the point.
        let x = (f64::from(k) + 0.5) / f64::from(CHORDS);
        let r = 2.0 * x * x;
        let weight = profile(d, r) * 4.0 * x / f64::from(CHORDS);
        let (sin, cos) = (2.0 * (r / 2.0).asin()).sin_cos();
        let ring: f64 = (0..TURNS)
            .map(|turn| {
                let phi = PI * (f64::from(turn) + 0.5) / f64::from(TURNS);
                (a.cos() * cos + a.sin() * sin * phi.cos()).max(0.0)
            })
            .sum();
        sum += weight * ring / f64::from(TURNS);
        all += weight;
    }
    sum / all
}

/// The factor is near the convolution at every angle. With `BODY_TABLE=1` the
/// differences are printed.
#[test]
fn a_lit_ball_is_the_mean_of_its_neighbors() {
    let bands = function("subsurface", "subsurfaceBands(float)", &[]);
    let factor = function("subsurface", "subsurfaceLit(float,float,float)", &[]);
    let mut table = String::new();
    for d in [0.001, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0, 100.0] {
        let [a, b] = call(&bands, &[d as f32])[0][..] else { panic!("two bands") };
        let (mut most, mut sums) = (0.0_f64, [[0.0; 3]; 2]);
        for k in 0..60 {
            let angle = PI * (f64::from(k) + 0.5) / 60.0;
            let cos = angle.cos();
            let found = call(&factor, &[cos as f32, a as f32, b as f32])[0][0];
            let wanted = convolved(d, angle);
            most = most.max((found - wanted).abs());
            for (sums, value) in sums.iter_mut().zip([found, wanted]) {
                for (sum, function) in sums.iter_mut().zip([1.0, cos, (3.0 * cos * cos - 1.0) / 2.0]) {
                    *sum += value * function * angle.sin() * PI / 120.0;
                }
            }
        }
        table += &format!("| {d} | {a:.4} | {b:.4} | {most:.4} |\n");
        assert!(most < 0.026, "{table}");
        // Its mean is that of Lambert's ball, and the next harmonics are those of the convolution.
        let [ours, theirs] = sums;
        assert!((ours[0] - 0.25).abs() < 1e-3, "{d}: {ours:?}");
        for (ours, theirs) in ours.into_iter().zip(theirs) {
            assert!((ours - theirs).abs() < 1e-3, "{d}: {ours:?} {theirs:?}");
        }
    }
    if std::env::var_os("BODY_TABLE").is_some() {
        std::io::Write::write_all(&mut std::io::stderr(), table.as_bytes()).expect("standard error can be written to");
    }
}

/// The bands of a rough mirror, by the integral over the light that it shows for N = V = R.
#[test]
fn rough_mirrors_keep_as_much_of_each_band_as_the_integral() {
    let lobe = function("irradiance", "irradianceLobe(float)", &[]);
    for roughness in [0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0] {
        let alpha: f64 = roughness * roughness;
        let (mut all, mut bands) = (0.0, [0.0; 2]);
        const STEPS: u32 = 4000;
        for k in 0..STEPS {
            // By the tangent of half of the angle, over alpha.
            let s = (f64::from(k) + 0.5) / f64::from(STEPS) * (1.0 / alpha).asinh();
            let t2 = (alpha * s.sinh()).powi(2);
            let cos = (1.0 - t2) / (1.0 + t2);
            let weight = cos * s.sinh() * s.cosh() / (1.0 + s.sinh().powi(2)).powi(2);
            all += weight;
            for (band, value) in bands.iter_mut().zip([cos, (3.0 * cos * cos - 1.0) / 2.0]) {
                *band += weight * value;
            }
        }
        let found = &call(&lobe, &[roughness as f32])[0];
        for (found, band) in found.iter().zip(bands) {
            assert!((found - band / all).abs() < 1e-3, "{roughness}: {found} {}", band / all);
        }
    }
}
