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
        ("artistic", "minnaertFactor(vec3,vec3,vec3,float)", &[1.4]),
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

/// Brushed surfaces with their tangent are reciprocal, and so are thin walls for a light behind them, mirrored to the eye's side.
#[test]
fn brushed_surfaces_and_walls_are_reciprocal() {
    let tangent = [0.8, 0.6, 0.0];
    let brushed = |module: &str, signature: &str| {
        function(module, signature, &[(0, "normalize"), (1, "normalize"), (2, "normalize"), (3, "normalize")])
    };
    let factors = [
        brushed("ggx", "ggxFactor(vec3,vec3,vec3,vec3,vec2)"),
        brushed("ward", "wardFactor(vec3,vec3,vec3,vec3,vec2)"),
    ];
    let wall = wrapped("transmission", "transmissionFactor(vec3,vec3,vec3,float)");
    let near = |there: f64, back: f64| (there - back).abs() <= 1e-5 * there.abs().max(1e-3);
    for i in 0..40 {
        let (a, b) = (0.02 + 0.024 * f64::from(i), 0.97 - 0.021 * f64::from(i));
        let (light, eye) = (direction(a, 0.3), direction(b, 0.3 + 0.15 * f64::from(i)));
        for factor in &factors {
            let row = |l: V, v: V| [UP, tangent, l, v].concat().into_iter().chain([0.5, 0.2]).collect::<Vec<f32>>();
            let (there, back) = (call(factor, &row(light, eye))[0][0] / a, call(factor, &row(eye, light))[0][0] / b);
            assert!(near(there, back), "{i}: {there} {back}");
        }
        let behind = |v: V| [v[0], v[1], -v[2]];
        let row = |l: V, v: V| [UP, behind(l), v].concat().into_iter().chain([0.3]).collect::<Vec<f32>>();
        let (there, back) = (call(&wall, &row(light, eye))[0][0] / a, call(&wall, &row(eye, light))[0][0] / b);
        assert!(near(there, back), "{i}: {there} {back}");
    }
}

/// The formulas of Khronos' sample renderer (brdf.glsl, ibl.glsl, punctual.glsl): GGX with its anisotropic form, Charlie's fibers, the falloff
/// and the cone of lamps, and the roughness of light that passes.
#[test]
fn the_models_are_those_of_khronos_sample_renderer() {
    let near = |found: f64, wanted: f64| (found - wanted).abs() <= 2e-5 * wanted.abs().max(1e-3);
    let brushed = function("ggx", "ggxFactor(vec3,vec3,vec3,vec3,vec2)", &[]);
    let fibers = function("sheen", "sheenFactor(vec3,vec3,vec3,float)", &[]);
    for (i, (along, across)) in [(0.5_f32, 0.1_f32), (0.9, 0.4), (0.3, 0.3)].into_iter().enumerate() {
        let (l, v) = (direction(0.8, 0.3 + i as f64), direction(0.45, 2.0));
        let unit = |a: V| DVec3::new(a[0].into(), a[1].into(), a[2].into());
        let (light, eye) = (unit(l), unit(v));
        let h = (light + eye).normalize();
        let (at, ab) = (f64::from(along), f64::from(across));
        // D_GGX_anisotropic and V_GGX_anisotropic.
        let a2 = at * ab;
        let f = DVec3::new(ab * h.x, at * h.y, a2 * h.z);
        let d = a2 * (a2 / f.dot(f)).powi(2) / PI;
        let ggx_v = light.z * DVec3::new(at * eye.x, ab * eye.y, eye.z).length();
        let ggx_l = eye.z * DVec3::new(at * light.x, ab * light.y, light.z).length();
        let wanted = PI * d * 0.5 / (ggx_v + ggx_l) * light.z;
        let row = [UP, [1.0, 0.0, 0.0], l, v].concat().into_iter().chain([along, across]).collect::<Vec<f32>>();
        let found = call(&brushed, &row)[0][0];
        assert!(near(found, wanted), "{found} {wanted}");
        // D_Charlie, with the visibility of Neubelt and Pettineo.
        let (inverse, sine2) = (1.0 / at, 1.0 - h.z * h.z);
        let d = (2.0 + inverse) * sine2.powf(inverse * 0.5) / TAU;
        let wanted = PI * d / (4.0 * (light.z + eye.z - light.z * eye.z)) * light.z;
        let found = call(&fibers, &[UP, l, v].concat().into_iter().chain([along]).collect::<Vec<f32>>())[0][0];
        assert!(near(found, wanted), "{found} {wanted}");
    }
    let falloff = function("punctual", "punctualFalloff(float,float)", &[]);
    for (r, range) in [(0.5_f64, 2.0_f64), (1.9, 2.0), (3.0, 2.0)] {
        let wanted = (1.0 - (r / range).powi(4)).clamp(0.0, 1.0) / (r * r);
        let found = call(&falloff, &[r as f32, range as f32])[0][0];
        // KHR_lights_punctual has the window once, Karis and this library its square.
        let window = (1.0 - (r / range).powi(4)).clamp(0.0, 1.0);
        assert!(near(found, wanted * window), "{r}: {found} {wanted}");
    }
    let blur = function("transmission", "transmissionRoughness(float,float)", &[]);
    for (roughness, ior) in [(0.5_f32, 1.0_f32), (0.5, 1.25), (0.5, 1.5), (0.8, 2.4)] {
        let wanted = f64::from(roughness) * (f64::from(ior) * 2.0 - 2.0).clamp(0.0, 1.0);
        assert!(near(call(&blur, &[roughness, ior])[0][0], wanted), "{roughness} {ior}");
    }
}

/// A ball by Snell's law at both sides, vector by vector, and the rainbow: for water, the light that turns least in a ball with one reflection
/// inside leaves it at 42 degrees (Descartes 1637).
#[test]
fn a_ball_bends_light_by_snell() {
    let of = |signature| function("transmission", signature, &[(0, "normalize"), (1, "normalize")]);
    let ball = of("transmissionSphere(vec3,vec3,float)");
    let path = of("transmissionPath(vec3,vec3,float)");
    let refract = |i: DVec3, n: DVec3, eta: f64| {
        let d = n.dot(i);
        let k = 1.0 - eta * eta * (1.0 - d * d);
        eta * i - (eta * d + k.sqrt()) * n
    };
    let mut least = f64::INFINITY;
    for i in 0..200 {
        let cos = (f64::from(i) + 0.5) / 200.0;
        let v = direction(cos, 0.7);
        let eye = DVec3::new(v[0].into(), v[1].into(), v[2].into()).normalize();
        for index in [1.0_f32, 1.333, 1.5, 2.4] {
            let n = f64::from(index);
            let inside = refract(-eye, DVec3::Z, 1.0 / n);
            // The ball's other side: the normal is turned by the chord.
            let far = DVec3::Z + 2.0 * -inside.z * inside;
            let out = refract(inside, -far, n);
            let row = [UP, v].concat().into_iter().chain([index]).collect::<Vec<f32>>();
            let found = DVec3::from_slice(&call(&ball, &row)[0]);
            assert!((found - out).length() < 2e-6, "{cos} {n}: {found} {out}");
            assert!((call(&path, &row)[0][0] + inside.z).abs() < 1e-6, "{cos} {n}");
            if index == 1.333 {
                // Twice refracted, 2 (a - b), and once mirrored, pi - 2 b more.
                let (a, b) = (eye.z.acos(), (-inside.z).acos());
                least = least.min(2.0 * (a - b) + PI - 2.0 * b);
            }
        }
    }
    assert!(((PI - least).to_degrees() - 42.0).abs() < 0.2, "{}", (PI - least).to_degrees());
}

/// Nine coefficients of any light, by integration over the sphere, against the integral of its cosine: what is left are the bands above.
#[test]
fn spherical_harmonics_are_near_the_integral() {
    let irradiance = function("irradiance", "irradiance(vec3,vec3[9])", &[]);
    let sphere: Vec<DVec3> = (0..20_000)
        .map(|i| {
            let y = 1.0 - (2.0 * f64::from(i) + 1.0) / 20_000.0;
            let (r, a) = ((1.0 - y * y).sqrt(), f64::from(i) * 2.399_963_229_728_653);
            DVec3::new(r * a.cos(), y, r * a.sin())
        })
        .collect();
    let weight = 4.0 * PI / 20_000.0;
    // A sky with a wide lamp and a colored horizon.
    let light = |d: DVec3| 0.3 + 0.2 * d.y + 2.0 * d.dot(DVec3::new(0.6, 0.64, 0.48)).max(0.0).powi(8);
    let basis = |d: DVec3| {
        let (s3, s15, s5) = ((3.0 / (4.0 * PI)).sqrt(), (15.0 / (4.0 * PI)).sqrt(), (5.0 / (16.0 * PI)).sqrt());
        [
            0.5 / PI.sqrt(),
            s3 * d.y,
            s3 * d.z,
            s3 * d.x,
            s15 * d.x * d.y,
            s15 * d.y * d.z,
            s5 * (3.0 * d.z * d.z - 1.0),
            s15 * d.x * d.z,
            0.5 * s15 * (d.x * d.x - d.y * d.y),
        ]
    };
    let mut coefficients = [[0.0_f32; 3]; 9];
    for (index, coefficient) in coefficients.iter_mut().enumerate() {
        let sum: f64 = sphere.iter().map(|d| light(*d) * basis(*d)[index] * weight).sum();
        *coefficient = [sum as f32; 3];
    }
    for n in sphere.iter().step_by(997) {
        let row: Vec<f32> = n.to_array().map(|x| x as f32).into_iter().chain(coefficients.concat()).collect();
        let found = call(&irradiance, &row)[0][0];
        let integral: f64 = sphere.iter().map(|d| light(*d) * d.dot(*n).max(0.0) * weight / PI).sum();
        // Ramamoorthi and Hanrahan 2001: an error of a few percent at most.
        assert!((found - integral).abs() < 0.03 * integral.max(0.3), "{n}: {found} {integral}");
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
