//! Thin films against the exact interference of all reflections, integrated over the wave numbers of light.

use super::{call, function};
use std::f64::consts::{PI, TAU};

/// The four normal distributions of the sensitivities: their part of X, Y and Z, mean and factor of the square of the path, per micrometer.
const WAVES: [(usize, f64, f64, f64); 4] = [
    (0, 0.846_590_002, 1.6810, 0.170_854_696),
    (1, 1.000_221_89, 1.7953, 0.367_330_884),
    (2, 1.001_122_49, 2.2084, 0.261_035_245),
    (0, 0.153_868_307, 2.2399, 0.178_766_171),
];

/// The constants as Belcour and Barla publish them: amplitude, mean and variance, by meter and radian.
const PUBLISHED: [[f64; 3]; 4] = [
    [5.4856e-13, 1.6810e6, 4.3278e9],
    [4.4201e-13, 1.7953e6, 9.3046e9],
    [5.2481e-13, 2.2084e6, 6.6121e9],
    [9.7470e-14, 2.2399e6, 4.5282e9],
];

fn schlick(normal: f64, cos: f64) -> f64 {
    normal + (1.0 - normal) * (1.0 - cos).powi(5)
}

#[test]
fn the_constants_are_the_published_ones() {
    for ((_, size, wave, decay), [amplitude, mean, variance]) in WAVES.into_iter().zip(PUBLISHED) {
        let norm = amplitude * (TAU * variance).sqrt() / 1.0685e-7;
        assert!((size / norm - 1.0).abs() < 1e-7 && (wave / (mean * 1e-6) - 1.0).abs() < 1e-12, "{size} {norm}");
        assert!((decay / (TAU * TAU * variance * 1e-12) - 1.0).abs() < 1e-7, "{decay}");
    }
}

/// Airy's sum of all reflections in the film, over the wave numbers. The module has its first two harmonics.
#[test]
fn a_film_is_the_interference_of_all_its_reflections() {
    let film = function("iridescence", "iridescenceFresnel(float,float,float,float,vec3)", &[]);
    for (cos, index, thickness, f0) in [
        (1.0_f64, 1.3_f64, 250.0_f64, 0.04_f64),
        (0.8, 1.3, 400.0, 0.04),
        (0.6, 2.0, 700.0, 0.04),
        (0.9, 1.5, 120.0, 0.3),
        (0.7, 1.4, 1000.0, 0.6),
        (1.0, 1.33, 330.0, 0.0),
    ] {
        let row = [cos, 1.0, index, thickness, f0, f0, f0].map(|number| number as f32);
        let found = &call(&film, &row)[0];
        let cos2 = (1.0 - (1.0 - cos * cos) / (index * index)).sqrt();
        let r12 = schlick(((index - 1.0) / (index + 1.0)).powi(2), cos);
        let base = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
        let r23 = schlick(((base - index) / (base + index)).powi(2), cos2);
        let shift = PI + if base < index { PI } else { 0.0 };
        let path = 2.0 * index * thickness * 1e-3 * cos2;
        let both = (r12 * r23).sqrt();
        let mirrored = |wave: f64| {
            let turn = (TAU * wave * path + shift).cos();
            (r12 + r23 - 2.0 * both * turn) / (1.0 + both * both - 2.0 * both * turn)
        };
        // The mean of all phases is white: only what differs from it is colored.
        let mean_of_all = (r12 + r23 - 2.0 * both * both) / (1.0 - both * both);
        let mut xyz = [0.0; 3];
        for (channel, size, mean, decay) in WAVES {
            const STEPS: i32 = 2000;
            let deviation = (decay / 2.0).sqrt() / PI;
            for step in -STEPS..STEPS {
                let x = 8.0 * (f64::from(step) + 0.5) / f64::from(STEPS);
                let density = (-x * x / 2.0).exp() / TAU.sqrt() * 8.0 / f64::from(STEPS);
                xyz[channel] += size * density * (mirrored(mean + deviation * x) - mean_of_all);
            }
        }
        let [x, y, z] = xyz;
        let rgb = [
            3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
            -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
            0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
        ];
        // The third harmonic and all after it, in any channel.
        let rest = 8.0 * both.powi(3) / (1.0 - both) + 1e-5;
        for (found, wanted) in found.iter().zip(rgb) {
            // What is below 0 is outside of the colors that a screen has.
            let wanted = (wanted + mean_of_all).max(0.0);
            assert!((found - wanted).abs() < rest, "{cos} {index} {thickness} {f0}: {found} {wanted} {rest}");
        }
    }
}

#[test]
fn a_film_has_limits() {
    let film = function("iridescence", "iridescenceFresnel(float,float,float,float,vec3)", &[]);
    // Without thickness, seen from straight above, the surface mirrors what it does in air.
    let found = &call(&film, &[1.0, 1.0, 1.5, 0.0, 0.04, 0.5, 1.0])[0];
    for (found, wanted) in found.iter().zip([0.04_f32, 0.5, 1.0]) {
        assert!((found - f64::from(wanted)).abs() < 1e-6, "{found} {wanted}");
    }
    // From inside of glass, a film of air reflects all light at flat angles.
    assert_eq!(call(&film, &[0.1, 1.5, 1.0, 400.0, 0.04, 0.04, 0.04])[0], [1.0; 3]);
    // Over a mirror there is no index of refraction.
    let mirror = &call(&film, &[0.7, 1.0, 1.5, 300.0, 1.0, 1.0, 1.0])[0];
    assert!(mirror.iter().all(|channel| (0.0..2.0).contains(channel)), "{mirror:?}");
    // Far apart, waves of all lengths are there alike.
    let wave = function("iridescence", "iridescenceSensitivity(float,vec3)", &[]);
    assert!(call(&wave, &[30000.0, 0.0, 0.0, 0.0])[0].iter().all(|channel| channel.abs() < 1e-9));
}

#[test]
fn the_normal_reflectance_of_a_film_is_that_of_schlick() {
    let normal = function("iridescence", "iridescenceNormal(vec3,float)", &[]);
    for cos in [0.2_f64, 0.5, 0.9] {
        let f = [0.04, 0.4, 1.0].map(|f0| schlick(f0, cos));
        let found = &call(&normal, &[f[0] as f32, f[1] as f32, f[2] as f32, cos as f32])[0];
        for (found, wanted) in found.iter().zip([0.04, 0.4, 1.0]) {
            assert!((found - wanted).abs() < 1e-5, "{found} {wanted}");
        }
    }
}
