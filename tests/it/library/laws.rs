//! Properties of the models beyond their values: symmetry, limits, poles, peaks, rates.

use super::{call, function};
use glisten::evaluate::Evaluator;
use glisten_reference::Precision;
use glisten_verify::evaluate::table;
use glisten_verify::scene::Filter;
use std::sync::Arc;

type V = [f32; 3];

/// Directions spread over the sphere, normalized in f32.
fn sphere(count: u32) -> impl Iterator<Item = V> {
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (r, a) = ((1.0 - y * y).sqrt(), f64::from(i) * 2.399_963_229_728_653);
        [(r * a.cos()) as f32, y as f32, (r * a.sin()) as f32]
    })
}

fn dot(a: V, b: V) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(b)).sum()
}

/// A rotation that is exact in f32: it permutes the axes cyclically and inverts two of them.
fn turned(v: V) -> V {
    [-v[1], v[2], -v[0]]
}

fn mirror(n: V, l: V) -> V {
    let twice = 2.0 * dot(n, l);
    std::array::from_fn(|i| (twice * f64::from(n[i]) - f64::from(l[i])) as f32)
}

fn factor(module: &str, name: &str, extra: usize) -> Evaluator {
    let signature = format!("{name}(vec3,vec3,vec3{})", ",float".repeat(extra));
    function(module, &signature, &[(0, "normalize"), (1, "normalize"), (2, "normalize")])
}

/// The specular factors with an exponent.
fn specular() -> Vec<(&'static str, Evaluator)> {
    vec![
        ("Phong", factor("phong", "phongFactor", 1)),
        ("Blinn", factor("blinn_phong", "blinnPhongFactor", 1)),
        ("Schlick on R.V", factor("schlick", "schlickPhongFactor", 1)),
        ("Schlick on N.H", factor("schlick", "schlickBlinnFactor", 1)),
    ]
}

fn specular_row(n: V, l: V, v: V, k: f32) -> impl Iterator<Item = f32> {
    n.into_iter().chain(l).chain(v).chain([k])
}

#[test]
fn factors_depend_on_angles_alone() {
    let two = |module, signature| function(module, signature, &[(0, "normalize"), (1, "normalize")]);
    let mut pairs = vec![
        ("lambertFactor", two("lambert", "lambertFactor(vec3,vec3)")),
        ("halfLambertFactor", two("half_lambert", "halfLambertFactor(vec3,vec3)")),
        ("hemisphereWeight", two("hemisphere", "hemisphereWeight(vec3,vec3)")),
    ];
    pairs.extend(specular());
    pairs.push(("quartic", factor("quartic", "quarticFactor", 0)));
    let directions: Vec<V> = sphere(60).collect();
    for (name, evaluator) in pairs {
        let row = |step: usize, turn: fn(V) -> V| {
            let vectors = [step, step * 7 + 3, step * 13 + 11].map(|i| directions[i % directions.len()]);
            let mut row: Vec<f32> = vectors.iter().flat_map(|v| turn(*v)).chain([9.0]).collect();
            row.truncate(evaluator.inputs());
            row
        };
        let rows = |turn: fn(V) -> V| (0..directions.len()).flat_map(|step| row(step, turn)).collect::<Vec<f32>>();
        for (before, after) in call(&evaluator, &rows(|v| v)).iter().zip(call(&evaluator, &rows(turned))) {
            assert!((before[0] - after[0]).abs() < 1e-14, "{name}: {before:?} {after:?}");
        }
    }
}

#[test]
fn light_from_behind_gives_no_direct_light() {
    let lambert = function("lambert", "lambertFactor(vec3,vec3)", &[]);
    let normal = [0.0, 0.0, 1.0];
    let behind: Vec<V> = sphere(100).filter(|light| light[2] <= 0.0).chain([[1.0, 0.0, 0.0]]).collect();
    let rows: Vec<f32> = behind.iter().flat_map(|light| [normal, *light].concat()).collect();
    assert!(call(&lambert, &rows).iter().all(|result| *result == [0.0]));
    for (name, evaluator) in specular() {
        let eyes = |light: &V| [normal, *light, mirror(normal, *light)];
        let row = |light: &V, eye: V| specular_row(normal, *light, eye, 0.5);
        let rows: Vec<f32> =
            behind.iter().flat_map(|light| eyes(light).into_iter().flat_map(move |eye| row(light, eye))).collect();
        assert!(call(&evaluator, &rows).iter().all(|result| *result == [0.0]), "{name}");
    }
}

#[test]
fn the_hemisphere_has_its_two_colors_at_the_poles_and_their_mean_at_the_equator() {
    let hemisphere = function("hemisphere", "hemisphere(vec3,vec3,vec3,vec3)", &[]);
    let (axis, sky, ground) = ([0.0, 1.0, 0.0], [0.25, 0.5, 1.0], [0.5, 0.25, 1e-30]);
    let at = |normals: Vec<V>| {
        let rows: Vec<f32> = normals.into_iter().flat_map(|normal| [normal, axis, sky, ground].concat()).collect();
        call(&hemisphere, &rows)
    };
    let named = at(vec![[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]);
    assert_eq!(named[0], sky.map(f64::from));
    assert_eq!(named[1], ground.map(f64::from));
    assert_eq!(named[2], [0.375, 0.375, 0.5 + 0.5 * f64::from(1e-30_f32)]);
    // Over the whole sphere, both kinds occur equally often.
    let count = 400;
    let sum: f64 = at(sphere(count).collect()).iter().map(|color| color[0]).sum();
    assert!((sum / f64::from(count) - 0.375).abs() < 1e-6);
}

#[test]
fn attenuation_has_its_three_named_cases() {
    let weighted = function("attenuation", "attenuation(float,vec3)", &[]);
    let square = function("attenuation", "attenuationInverseSquare(float)", &[]);
    let distances: Vec<f32> = (-60..=60).map(|exponent| 1.25 * 2.0_f32.powi(exponent)).collect();
    let with = |s: V| call(&weighted, &distances.iter().flat_map(|r| [*r, s[0], s[1], s[2]]).collect::<Vec<f32>>());
    assert!(with([1.0, 0.0, 0.0]).iter().all(|d| *d == [1.0]));
    for (d, r) in with([0.0, 1.0, 0.0]).iter().zip(&distances) {
        assert_eq!(*d, [1.0 / f64::from(*r)]);
    }
    for (ours, theirs) in with([0.0, 0.0, 1.0]).iter().zip(call(&square, &distances)) {
        assert!((ours[0] / theirs[0] - 1.0).abs() < 1e-15, "{ours:?} {theirs:?}");
    }
}

#[test]
fn highlights_peak_at_the_mirror_direction_with_the_value_1() {
    let normal = [0.0, 0.0, 1.0];
    let lights: Vec<V> = sphere(30).filter(|light| light[2] > 0.2).collect();
    let eyes: Vec<V> = sphere(60).collect();
    for (name, evaluator) in specular() {
        for k in [1.0, 10.0, 1000.0] {
            for light in &lights {
                let peak = mirror(normal, *light);
                let seen = std::iter::once(peak).chain(eyes.iter().copied().filter(|eye| dot(*eye, peak) < 0.999));
                let rows: Vec<f32> = seen.flat_map(|eye| specular_row(normal, *light, eye, k)).collect();
                let results = call(&evaluator, &rows);
                let most = results[0][0];
                assert!((most - 1.0).abs() < 1e-9, "{name}, k = {k}: {most}");
                assert!(results[1..].iter().all(|other| (0.0..most).contains(&other[0])), "{name}, k = {k}");
            }
        }
    }
}

#[test]
fn light_and_eye_may_change_places() {
    let normal = [0.0, 0.0, 1.0];
    let above: Vec<V> = sphere(40).filter(|v| v[2] > 0.05).collect();
    let eye = |index: usize| above[(index * 5 + 2) % above.len()];
    let pairs = || above.iter().enumerate().map(|(index, light)| (*light, eye(index)));
    let there: Vec<f32> = pairs().flat_map(|(l, v)| specular_row(normal, l, v, 20.0)).collect();
    let back: Vec<f32> = pairs().flat_map(|(l, v)| specular_row(normal, v, l, 20.0)).collect();
    for (name, evaluator) in specular() {
        for (there, back) in call(&evaluator, &there).iter().zip(call(&evaluator, &back)) {
            assert!((there[0] - back[0]).abs() < 1e-13, "{name}: {there:?} {back:?}");
        }
    }
}

#[test]
fn sharper_highlights_are_smaller() {
    let normal = [0.0, 0.0, 1.0];
    let light = [0.0, 0.6, 0.8];
    for (name, evaluator) in specular() {
        let exponents = [0.0, 1.0, 4.0, 32.0, 1e4, 1e30];
        let eyes = sphere(40);
        let rows: Vec<f32> =
            eyes.flat_map(|eye| exponents.into_iter().flat_map(move |k| specular_row(normal, light, eye, k))).collect();
        for values in call(&evaluator, &rows).chunks(exponents.len()) {
            assert!(values.windows(2).all(|pair| pair[0][0] >= pair[1][0]), "{name}: {values:?}");
        }
    }
}

#[test]
fn a_table_comes_near_the_power_at_the_rate_of_its_square() {
    let lookup = function("lut", "lutColor(sampler2D,float)", &[]);
    let xs: Vec<f32> = (0..4096u16).map(|i| f32::from(i) / 4095.0).collect();
    for k in [4, 32] {
        for n in [256u16, 512, 1024] {
            let texel = |i: u16| [(f64::from(i) / f64::from(n - 1)).powi(k) as f32; 4];
            let texels = Arc::new(table((0..n).map(texel).collect(), Filter::Linear));
            let results = lookup.reference(&xs, &[texels], Precision::F64).expect("it runs");
            let error = xs
                .iter()
                .zip(results)
                .fold(0.0_f64, |most, (x, result)| most.max((f64::from(*x).powi(k) - result[0]).abs()));
            let expected = (f64::from(k) / f64::from(n)).powi(2) / 8.0;
            let ratio = error / expected;
            // The second derivative is k (k - 1), and rounding the texels to f32 adds half a unit.
            assert!((0.6..1.05).contains(&ratio), "k = {k}, n = {n}: {error:e} is {ratio} of (k/n)^2/8");
        }
    }
}

/// A byte that is decoded and encoded again is itself, and the curve rises.
#[test]
fn the_transfer_function_goes_there_and_back() {
    let encode = function("srgb", "srgbEncode(float)", &[]);
    let decode = function("srgb", "srgbDecode(float)", &[]);
    let bytes: Vec<f32> = (0..=255u8).map(|byte| f32::from(byte) / 255.0).collect();
    let linear: Vec<f32> = call(&decode, &bytes).iter().map(|row| row[0] as f32).collect();
    assert!(linear.is_sorted_by(|a, b| a < b));
    for (byte, back) in bytes.iter().zip(call(&encode, &linear)) {
        assert!((f64::from(*byte) - back[0]).abs() < 1e-6, "{byte}: {}", back[0]);
    }
}
