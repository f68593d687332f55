//! [`errors`]: how far the module's lookups are from integrals over the panorama, in f64.
//!
//! *In:* a panorama and what was made of it. *Out:* for each quantity the mean and the largest [`Deviation`] over some directions, as
//! parts of the panorama's mean radiance. *Holds:* the integrals take the panorama itself, by many more rays than the maps.

use super::harmonics::functions;
use super::lobe::{Ray, frame, mirrored, placed, reflected};
use super::panorama::Panorama;
use super::prefilter::Prefiltered;
use super::split::SplitSum;
use crate::measure::Random;
use crate::measure::vector::{V, add, dot, scale};
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::PI;

/// The number of directions, and of rays for each.
const DIRECTIONS: usize = 24;
const RAYS: usize = 1 << 15;

/// The roughnesses of the table: between those of the maps.
const ROUGHNESSES: [f64; 5] = [0.1, 0.25, 0.45, 0.7, 1.0];

/// Differences from an integral.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Of which quantity.
    pub of: &'static str,
    /// At which roughness, if it has one.
    pub roughness: Option<f64>,
    /// The mean difference.
    pub mean: f64,
    /// The largest difference.
    pub most: f64,
}

/// The differences.
pub fn errors(panorama: &Panorama, maps: &Prefiltered, coefficients: &[V; 9], split: &SplitSum) -> Vec<Deviation> {
    let mut random = Random::new(7);
    let directions: Vec<(V, f64)> = (0..DIRECTIONS).map(|_| (random.direction(), random.range(0.1, 1.0))).collect();
    let scale_of = panorama.mean().max(f64::from(f32::MIN_POSITIVE));
    let told = |of: &'static str, roughness: Option<f64>, pairs: Vec<(V, V)>| {
        let far = |(a, b): &(V, V)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale_of;
        let all: Vec<f64> = pairs.iter().map(far).collect();
        let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
        Deviation { of, roughness, mean, most: all.iter().copied().fold(0.0, f64::max) }
    };
    let mut found = Vec::new();
    for roughness in ROUGHNESSES {
        let lobe = mirrored(roughness * roughness, RAYS);
        let pairs =
            directions.par_iter().map(|(d, _)| (maps.radiance(*d, roughness), integral(panorama, &lobe, &frame(*d))));
        found.push(told("radiance", Some(roughness), pairs.collect()));
    }
    for roughness in ROUGHNESSES {
        let pairs = directions.par_iter().map(|(normal, cosine)| {
            let lobe = reflected(*cosine, roughness * roughness, RAYS);
            let axes = frame(*normal);
            let eye = placed(&axes, [(1.0 - cosine * cosine).sqrt(), 0.0, *cosine]);
            let mirror = add(scale(2.0 * cosine, *normal), scale(-1.0, eye));
            let mirror = dominant(*normal, mirror, roughness);
            let white = split.white(*cosine, roughness);
            (maps.radiance(mirror, roughness).map(|channel| white * channel), integral(panorama, &lobe, &axes))
        });
        found.push(told("split sum", Some(roughness), pairs.collect()));
    }
    let pairs =
        directions.par_iter().map(|(normal, _)| (irradiance(coefficients, *normal), lambert(panorama, *normal)));
    found.push(told("irradiance", None, pairs.collect()));
    found
}

/// The direction from which a rough surface mirrors most, between the normal and the mirror direction.
fn dominant(normal: V, mirror: V, roughness: f64) -> V {
    let smooth = 1.0 - roughness * roughness;
    let share = smooth * (smooth.sqrt() + roughness * roughness);
    add(scale(share, mirror), scale(1.0 - share, normal))
}

/// The sum of a panorama's radiance over rays of a frame.
fn integral(panorama: &Panorama, lobe: &[Ray], axes: &[V; 3]) -> V {
    lobe.iter().fold([0.0; 3], |sum, ray| add(sum, scale(ray.weight, panorama.radiance(placed(axes, ray.light), 0.0))))
}

/// Irradiance over pi by the coefficients: each band times the cosine's.
fn irradiance(coefficients: &[V; 9], normal: V) -> V {
    let bands = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    let parts = coefficients.iter().zip(functions(normal)).zip(bands);
    parts.fold([0.0; 3], |sum, ((l, value), band)| add(sum, scale(value * band, *l)))
}

/// Irradiance over pi by the panorama.
fn lambert(panorama: &Panorama, normal: V) -> V {
    panorama
        .parts(512)
        .fold([0.0; 3], |sum, (d, solid, radiance)| add(sum, scale(solid * dot(d, normal).max(0.0) / PI, radiance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::coefficients;
    use glisten_scene::picture::Image;

    /// In a white room nothing is lost by the split: the two factors are those of the integral.
    #[test]
    fn a_white_room_has_no_errors() {
        let image = Image { width: 32, height: 16, pixels: vec![[1.0; 4]; 512] };
        let panorama = Panorama::new(&image).expect("twice as wide");
        let maps = Prefiltered::new(&panorama, 5, 3, 64);
        let split = SplitSum::new().expect("the pattern");
        for deviation in errors(&panorama, &maps, &coefficients(&panorama), &split) {
            assert!(deviation.most < 3e-3, "{deviation:?}");
        }
    }

    /// A sky that is brighter on one side, with a lamp.
    #[test]
    fn the_maps_are_near_to_the_integrals() {
        let (width, height) = (128_u32, 64_u32);
        let pixels = (0..width * height).map(|k| {
            let (s, t) = (f64::from(k % width) / f64::from(width), f64::from(k / width) / f64::from(height));
            let lamp = if (s - 0.3).abs() < 0.05 && (t - 0.4).abs() < 0.08 { 12.0 } else { 0.0 };
            let sky = 1.0 + 0.5 * (std::f64::consts::TAU * s).sin() - 0.6 * t;
            [(sky + lamp) as f32, sky as f32, (0.5 * sky + 0.5 * lamp) as f32, 1.0]
        });
        let image = Image { width, height, pixels: pixels.collect() };
        let panorama = Panorama::new(&image).expect("twice as wide");
        let maps = Prefiltered::new(&panorama, 33, 6, 256);
        let split = SplitSum::new().expect("the pattern");
        let found = errors(&panorama, &maps, &coefficients(&panorama), &split);
        assert_eq!(found.len(), 11);
        for deviation in &found {
            let allowed = match (deviation.of, deviation.roughness) {
                ("radiance", Some(roughness)) if roughness > 0.2 => 0.08,
                ("irradiance", _) => 0.08,
                // A lamp's edge between texels; and the split sum's own error at grazing angles.
                _ => 1.0,
            };
            assert!(deviation.mean <= allowed, "{deviation:?}");
        }
    }
}
