//! Energy and published values of the models of today: albedo against integration, densities that integrate to 1, reciprocity, Filament's
//! formulas, the hemisphere as spherical harmonics, color spaces by their primaries.

use super::{call, function};
use glam::{DMat3, DVec3};
use glisten::evaluate::Evaluator;
use std::f64::consts::{PI, TAU};

type V = [f32; 3];

fn wrapped(module: &str, signature: &str) -> Evaluator {
    function(module, signature, &[(0, "normalize"), (1, "normalize"), (2, "normalize")])
}

/// A direction by its cosine to z and its azimuth.
fn direction(cos: f64, azimuth: f64) -> V {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    [(sin * azimuth.cos()) as f32, (sin * azimuth.sin()) as f32, cos as f32]
}

const UP: V = [0.0, 0.0, 1.0];

/// The directional albedo of factors, pi f N.L, for the eye at a cosine: their mean over the half sphere, for the first channel.
fn albedo(factor: &Evaluator, eye: f64, more: &[f32]) -> f64 {
    const HEIGHTS: u32 = 96;
    const TURNS: u32 = 40;
    let mut rows = Vec::new();
    let mut weights = Vec::new();
    for height in 0..HEIGHTS {
        // Denser towards the horizon, where the factors are steep: cos = x^2.
        let x = (f64::from(height) + 0.5) / f64::from(HEIGHTS);
        for turn in 0..TURNS {
            let light = direction(x * x, (f64::from(turn) + 0.5) / f64::from(TURNS) * PI);
            rows.extend(UP.into_iter().chain(light).chain(direction(eye, 0.0)).chain(more.iter().copied()));
            weights.push(2.0 * x / f64::from(HEIGHTS) * 2.0 / f64::from(TURNS));
        }
    }
    call(factor, &rows).iter().zip(weights).map(|(result, weight)| result[0] * weight).sum()
}

/// A white furnace: a white surface returns all light, whatever its roughness; the model of 1994 does not.
#[test]
fn eon_keeps_energy_and_the_model_of_1994_loses_it() {
    let eon = wrapped("oren_nayar", "eonFactor(vec3,vec3,vec3,vec3,float)");
    for roughness in [0.0, 0.5, 1.0] {
        for eye in [0.15, 0.6, 1.0] {
            let returned = albedo(&eon, eye, &[1.0, 1.0, 1.0, roughness]);
            assert!((returned - 1.0).abs() < 2e-3, "roughness {roughness}, cosine {eye}: {returned}");
        }
    }
    let old = wrapped("oren_nayar", "orenNayarFactor(vec3,vec3,vec3,float)");
    assert!(albedo(&old, 1.0, &[1.0]) < 0.8);
    let burley = wrapped("burley", "burleyFactor(vec3,vec3,vec3,float)");
    let most = albedo(&burley, 0.15, &[1.0]);
    assert!(most > 1.05 && most < 1.4, "Burley's diffuse reflection returns too much: {most}");
}

/// Karis' fit of what a rough surface mirrors of white surroundings, against the integral.
#[test]
fn the_albedo_of_ggx_is_near_the_integral() {
    let factor = wrapped("ggx", "ggxFactor(vec3,vec3,vec3,float)");
    let fit = function("ggx", "ggxAlbedo(float,float,vec3)", &[]);
    for roughness in [0.5_f32, 0.75, 1.0] {
        for eye in [0.3, 0.6, 1.0] {
            // With F_0 = 1, Schlick's term is 1.
            let integral = albedo(&factor, eye, &[roughness * roughness]);
            let fitted = call(&fit, &[eye as f32, roughness, 1.0, 1.0, 1.0])[0][0];
            assert!(integral <= 1.0 + 1e-3, "roughness {roughness}, cosine {eye}: {integral}");
            let apart = (integral - fitted).abs();
            assert!(apart < 0.2, "roughness {roughness}, cosine {eye}: {integral} and {fitted}");
        }
    }
}

/// The integral of D N.H over all half vectors is 1, down to a roughness of 0.03.
#[test]
fn densities_integrate_to_one() {
    let two = |module, signature| function(module, signature, &[(0, "normalize"), (1, "normalize")]);
    let densities =
        [two("ggx", "ggxDistribution(vec3,vec3,float)"), two("beckmann", "beckmannDistribution(vec3,vec3,float)")];
    for (density, alpha) in densities.iter().flat_map(|density| [1e-3_f64, 0.05, 0.5].map(|alpha| (density, alpha))) {
        // By the logarithm of the squared sine, from far inside of the highlight to the horizon.
        const STEPS: u32 = 600;
        let (low, high): (f64, f64) = ((alpha * alpha * 1e-7).ln(), 0.0);
        let step = (high - low) / f64::from(STEPS);
        let squares: Vec<f64> = (0..STEPS).map(|i| (low + (f64::from(i) + 0.5) * step).exp()).collect();
        let rows: Vec<f32> = squares
            .iter()
            .flat_map(|square| {
                let half = [square.sqrt() as f32, 0.0, (1.0 - square).sqrt() as f32];
                UP.into_iter().chain(half).chain([alpha as f32])
            })
            .collect();
        let sum: f64 = call(density, &rows).iter().zip(&squares).map(|(d, square)| d[0] * PI * square * step).sum();
        assert!((sum - 1.0).abs() < 1e-3, "{alpha}: {sum}");
    }
}

/// f(L, V) = f(V, L) for factors pi f N.L.
#[test]
fn reflection_is_reciprocal() {
    for (module, signature, more) in [
        ("ggx", "ggxFactor(vec3,vec3,vec3,float)", &[0.09_f32][..]),
        ("beckmann", "beckmannFactor(vec3,vec3,vec3,float)", &[0.3]),
        ("sheen", "sheenFactor(vec3,vec3,vec3,float)", &[0.2]),
        ("oren_nayar", "eonFactor(vec3,vec3,vec3,vec3,float)", &[0.8, 0.5, 0.2, 0.7]),
        ("oren_nayar", "orenNayarFactor(vec3,vec3,vec3,float)", &[0.6]),
        ("burley", "burleyFactor(vec3,vec3,vec3,float)", &[0.6]),
    ] {
        let factor = wrapped(module, signature);
        let mut rows = Vec::new();
        let mut cosines = Vec::new();
        for i in 0..40 {
            let (a, b) = (0.02 + 0.024 * f64::from(i), 0.97 - 0.021 * f64::from(i));
            let (light, eye) = (direction(a, 0.3), direction(b, 0.3 + 0.15 * f64::from(i)));
            rows.extend([UP, light, eye].concat().into_iter().chain(more.iter().copied()));
            rows.extend([UP, eye, light].concat().into_iter().chain(more.iter().copied()));
            cosines.extend([a, b]);
        }
        let values: Vec<f64> =
            call(&factor, &rows).iter().zip(cosines).map(|(value, cosine)| value[0] / cosine).collect();
        for pair in values.chunks(2) {
            assert!((pair[0] - pair[1]).abs() <= 1e-5 * pair[0].abs().max(1e-3), "{signature}: {pair:?}");
        }
    }
}

/// Filament's document, sections 4.4.1 and 4.4.2: the terms as its shaders compute them.
#[test]
fn ggx_is_that_of_filament() {
    let density = function("ggx", "ggxDistribution(vec3,vec3,float)", &[(0, "normalize"), (1, "normalize")]);
    let visibility = function("ggx", "ggxVisibility(float,float,float)", &[]);
    for roughness in [0.2_f32, 0.5, 1.0] {
        let alpha = f64::from(roughness * roughness);
        for (a, b) in [(1.0, 0.7), (0.9, 0.2), (0.5, 0.5), (0.1, 0.95)] {
            let half = direction(a, 0.7);
            let found = call(&density, &UP.into_iter().chain(half).chain([roughness * roughness]).collect::<Vec<_>>());
            let k = alpha / (1.0 - a * a + (a * alpha).powi(2));
            assert!((found[0][0] / (k * k / PI) - 1.0).abs() < 1e-5, "D: {roughness} {a}");
            let found = call(&visibility, &[a as f32, b as f32, roughness * roughness])[0][0];
            let side = |x: f64, y: f64| x * (y * y * (1.0 - alpha * alpha) + alpha * alpha).sqrt();
            assert!((found / (0.5 / (side(a, b) + side(b, a))) - 1.0).abs() < 1e-5, "V: {roughness} {a} {b}");
        }
    }
}

/// Nine coefficients of a sky over a ground, by integration, give the article's hemisphere.
#[test]
fn the_hemisphere_is_the_first_two_bands() {
    let irradiance = function("irradiance", "irradiance(vec3,vec3[9])", &[]);
    let (sky, ground) = (0.75, 0.25);
    let (constant, linear) = (0.5 / PI.sqrt(), (3.0 / (4.0 * PI)).sqrt());
    // Half spheres: 2 pi times the mean, and half of 2 pi for the cosine.
    let mut coefficients = [[0.0_f32; 3]; 9];
    coefficients[0] = [(constant * TAU * (sky + ground)) as f32; 3];
    coefficients[2] = [(linear * PI * (sky - ground)) as f32; 3];
    for cos in [-1.0, -0.3, 0.0, 0.6, 1.0] {
        let rows: Vec<f32> = direction(cos, 0.4).into_iter().chain(coefficients.concat()).collect();
        let found = call(&irradiance, &rows)[0][0];
        let dome = 0.5 * (1.0 + cos) * sky + 0.5 * (1.0 - cos) * ground;
        assert!((found - dome).abs() < 2e-6, "{cos}: {found} {dome}");
    }
}

/// The columns of XYZ for primaries whose white is D65.
fn to_xyz(primaries: [[f64; 2]; 3]) -> DMat3 {
    let column = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let plain = DMat3::from_cols(column(primaries[0]), column(primaries[1]), column(primaries[2]));
    let shares = plain.inverse() * column([0.3127, 0.3290]);
    DMat3::from_cols(plain.x_axis * shares.x, plain.y_axis * shares.y, plain.z_axis * shares.z)
}

/// The matrices between color spaces follow from the primaries that the standards give.
#[test]
fn color_spaces_follow_from_their_primaries() {
    let rec709 = to_xyz([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]]);
    let p3 = to_xyz([[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]]);
    let rec2020 = to_xyz([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]]);
    for (name, matrix, digits) in [
        ("colorToP3(vec3)", p3.inverse() * rec709, 1e-6),
        ("colorFromP3(vec3)", rec709.inverse() * p3, 2e-6),
        // BT.2087 rounds to four digits, so its inverse does, too.
        ("colorToRec2020(vec3)", rec2020.inverse() * rec709, 6e-5),
        ("colorFromRec2020(vec3)", rec709.inverse() * rec2020, 2e-4),
    ] {
        let found = call(&function("color", name, &[]), &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        for (column, wanted) in found.iter().zip([matrix.x_axis, matrix.y_axis, matrix.z_axis]) {
            let error = (DVec3::from_slice(column) - wanted).abs().max_element();
            assert!(error < digits, "{name}: {column:?} {wanted}");
        }
    }
    // Ottosson's table: white, and the lightness of red.
    let lab = call(&function("color", "colorToOklab(vec3)", &[]), &[1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    assert!(
        (lab[0][0] - 1.0).abs() < 1e-6 && (lab[1][0] - 0.627_955).abs() < 1e-5 && (lab[1][1] - 0.224_863).abs() < 1e-5
    );
    // D65 is near 6504 K, and near gray.
    let day = call(&function("color", "colorTemperature(float)", &[]), &[6504.0])[0].clone();
    assert!(day.iter().all(|channel| (channel - 1.0).abs() < 0.05), "{day:?}");
}
