//! Lights with corners under a matrix: the tables are those that the example fits, and the lights are near the integral.

#[path = "../../../crates/studies/src/bin/ltc/errors.rs"]
pub(super) mod errors;
#[path = "../../../crates/studies/src/bin/ltc/fit.rs"]
#[expect(dead_code, reason = "the example writes the tables")]
mod fit;
#[path = "../../../crates/studies/src/bin/ltc/ggx.rs"]
mod ggx;

use super::{call, function};
use crate::support::root;

/// One smooth and one rough entry, fitted again.
#[test]
fn the_tables_are_fitted_here() {
    let text = std::fs::read_to_string(root().join("crates/scene/src/load/ltc.txt")).expect("the table is there");
    for (column, row) in [(7, 6), (18, 16)] {
        let line = text.lines().nth((row * fit::SIZE + column) as usize).expect("a texel");
        let stored: Vec<f64> = line.split(' ').map(|number| number.parse().expect("a number")).collect();
        let fitted = fit::entry(column, row);
        for (fitted, stored) in fitted.matrix.iter().chain(&fitted.albedo).zip(stored) {
            assert!((fitted - stored).abs() < 2e-4 * stored.abs().max(0.1), "{column} {row}: {fitted} and {stored}");
        }
    }
}

/// Rays in the directions of the model against the closed formula: what is left is the fit, and for diffuse surfaces nothing.
#[test]
fn lights_are_near_the_integral() {
    for row in errors::rows(1500, 8).expect("the module is called") {
        let told = row.to_string();
        // Larger lights and grazing eyes have larger errors.
        for ([mean, most], bounds) in row.mirrored.into_iter().zip([[0.02, 0.08], [0.06, 0.2], [0.15, 0.4]]) {
            assert!(mean < bounds[0] && most < bounds[1], "{told}");
        }
        assert!(row.diffuse[0] < 0.006 && row.diffuse[1] < 0.03, "{told}");
    }
}

/// A part of the bent cosine is below the horizon for eyes at a grazing angle, unless the surface is as rough as can be.
#[test]
fn the_whole_sky_is_all_of_the_cosine_from_above_alone() {
    for (roughness, parts) in errors::skies().expect("the module is called") {
        let [first, last] = [parts[0], parts[errors::SEEN.len() - 1]];
        let is_bent = roughness > 0.2 && roughness < 0.8;
        assert!((first - 1.0).abs() < 1e-3 && (last < 0.97 || !is_bent), "{roughness}: {parts:?}");
        assert!(parts.iter().all(|part| (0.7..1.001).contains(part)), "{roughness}: {parts:?}");
    }
}

const UP: [f32; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A ceiling without end is the whole sky, one that stands on the surface half of it; in its own plane a light has no size.
#[test]
fn the_horizon_cuts_lights() {
    let rectangle = function("ltc", "ltcRectangle(mat3,vec3,vec3,vec3)", &[]);
    let e = |lamp: [f32; 9]| call(&rectangle, &[UP, lamp].concat())[0][0];
    assert!((e([0.0, 0.0, 1.0, 1e6, 0.0, 0.0, 0.0, 1e6, 0.0]) - 1.0).abs() < 1e-5);
    assert!((e([1.0, 0.0, 0.0, 0.0, 1e6, 0.0, 0.0, 0.0, 1e6]) - 0.5).abs() < 1e-5);
    assert_eq!(e([2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), 0.0);
    assert_eq!(e([0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), 0.0);
    // Lambert's own example: a wall of 2 by 1 on the surface, at the distance 1 from its middle.
    let wall = e([0.0, 1.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0, 0.5]);
    let (a, b) = (1.0_f64, 1.0_f64);
    let root = (1.0 + b * b).sqrt();
    let closed = 2.0 / std::f64::consts::TAU * (a.atan() - (a / root).atan() / root);
    assert!((wall - closed).abs() < 1e-12, "{wall} {closed}");
    let sphere = function("ltc", "ltcSphere(mat3,vec3,float)", &[]);
    // (r / d)^2 N.L above the horizon, within the sixteen corners.
    let found = call(&sphere, &[UP.as_slice(), &[0.6, 0.0, 0.8, 0.25]].concat())[0][0];
    assert!((found - 0.0625 * 0.8).abs() < 1e-3, "{found}");
}

/// The light of a tube by its surface: the side and both ends, piece by piece.
fn tube_by_pieces(a: [f64; 3], b: [f64; 3], radius: f64) -> f64 {
    use ggx::{add, cross, dot, scale, unit};
    let (length, along) = (dot(add(b, scale(-1.0, a)), add(b, scale(-1.0, a))).sqrt(), unit(add(b, scale(-1.0, a))));
    let x = unit(cross(along, if along[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
    let y = cross(along, x);
    // What a piece of the size 1 gives: N is z, and the piece shines along its own normal.
    let gives = |at: [f64; 3], normal: [f64; 3]| {
        let far = dot(at, at);
        (-dot(at, normal)).max(0.0) * at[2].max(0.0) / (far * far * std::f64::consts::PI)
    };
    const AROUND: usize = 360;
    const STEPS: usize = 200;
    let (part, step, turn) = (length / STEPS as f64, radius / STEPS as f64, std::f64::consts::TAU / AROUND as f64);
    let mut sum = 0.0;
    for around in 0..AROUND {
        let (sin, cos) = (turn * (around as f64 + 0.5)).sin_cos();
        let out = add(scale(cos, x), scale(sin, y));
        for at in (0..STEPS).map(|at| at as f64 + 0.5) {
            sum += part * radius * turn * gives(add(a, add(scale(part * at, along), scale(radius, out))), out);
            for (end, normal) in [(a, scale(-1.0, along)), (b, along)] {
                sum += step * (step * at) * turn * gives(add(end, scale(step * at, out)), normal);
            }
        }
    }
    sum
}

/// Thin and thick tubes, above and across the horizon, from their side, before an end, and nearly so.
#[test]
fn tubes_of_any_radius_are_near_the_integral() {
    let tube = function("ltc", "ltcTube(mat3,vec3,vec3,float)", &[]);
    let e = |a: [f64; 3], b: [f64; 3], radius: f64| {
        let numbers = a.into_iter().chain(b).chain([radius]).map(|number| number as f32);
        call(&tube, &UP.into_iter().chain(numbers).collect::<Vec<_>>())[0][0]
    };
    for (a, b, radius) in [
        ([-1.0, 0.0, 2.0], [1.0, 0.0, 2.0], 0.0625),
        ([-1.0, 0.0, 2.0], [1.0, 0.0, 2.0], 1.0),
        ([-1.25, 0.375, 2.0], [0.375, -0.9375, 1.5], 0.625),
        ([-1.125, 1.0625, 1.9375], [0.0625, -1.9375, 1.5625], 0.625),
        ([-3.0, 0.0, 2.0], [3.0, 0.0, 2.0], 1.5),
        ([1.0, 0.0, 1.0], [1.0, 0.0, 3.0], 0.25),
        ([0.25, 0.0, 1.0], [0.25, 0.0, 3.0], 0.1875),
        ([0.25, 0.0, 1.0], [0.25, 0.0, 3.0], 0.28125),
        ([0.0, 0.0, 1.0], [0.0, 0.0, 3.0], 0.5),
        ([0.0, 0.0, 3.0], [0.0, 0.0, 1.0], 0.5),
        ([1.0, 0.5, -1.0], [1.5, 0.25, 2.0], 0.5),
        ([-1.0, 1.0, 0.25], [2.0, 1.0, -0.25], 0.75),
        ([2.0, 0.0, 0.5], [1.0, 0.0, 0.5], 0.75),
    ] {
        let (found, wanted) = (e(a, b, radius), tube_by_pieces(a, b, radius));
        assert!((found - wanted).abs() < 1e-3, "{a:?} {b:?} {radius}: {found} {wanted}");
        assert!((e(b, a, radius) - found).abs() < 1e-12, "the ends change places");
    }
    assert_eq!(e([0.0, 0.0, 1.0], [0.0, 0.0, 3.0], 0.0), 0.0, "a line has no area");
    assert_eq!(e([1.0, 0.0, 1.0], [1.0, 0.0, 1.0], 0.5), 0.0, "nor has a tube without length a side");
    assert_eq!(e([-1.0, 0.0, 0.25], [1.0, 0.0, 0.25], 0.5), 1.0, "inside");
}

/// The directional albedo by the table of Heitz, Dupuy, Hill and Neubelt (selfshadow/ltc_code, ltc.js):
/// roughness, cosine, the light that a white mirror returns, and the part of Schlick's term. They have few samples a texel.
#[test]
fn the_albedo_is_that_of_the_published_table() {
    const PUBLISHED: &[[f64; 4]] = &[
        [32.0 / 63.0, 1.0, 0.912293, 3.11924e-5],
        [32.0 / 63.0, 0.742001, 0.88238, 0.00296637],
        [32.0 / 63.0, 0.370118, 0.843912, 0.0454447],
        [32.0 / 63.0, 0.152431, 0.855767, 0.112969],
        [44.0 / 63.0, 1.0, 0.700375, 4.77335e-5],
        [44.0 / 63.0, 0.742001, 0.691396, 0.00207127],
        [44.0 / 63.0, 0.370118, 0.732555, 0.0202841],
        [44.0 / 63.0, 0.152431, 0.830842, 0.0514838],
        [1.0, 1.0, 0.306974, 3.39596e-5],
        [1.0, 0.742001, 0.366732, 0.000672483],
        [1.0, 0.370118, 0.515819, 0.00590506],
        [1.0, 0.152431, 0.700191, 0.0179113],
    ];
    let albedo = function("ltc", "ltcAlbedo(sampler2D,vec3,vec3,float,vec3)", &[]);
    let table = &errors::tables().expect("the scene is good")[1..];
    for [roughness, cosine, all, grazing] in PUBLISHED {
        let eye = [(1.0 - cosine * cosine).max(0.0).sqrt() as f32, 0.0, *cosine as f32];
        let row = [&[0.0, 0.0, 1.0][..], &eye, &[*roughness as f32, 1.0, 0.0, 0.5]].concat();
        let found = albedo.reference(&row, table, glisten_reference::Precision::F64).expect("it is called").remove(0);
        for (found, wanted) in found.iter().zip([*all, *grazing, 0.5 * (all + grazing)]) {
            assert!((found - wanted).abs() < 1e-2, "{roughness} {cosine}: {found} {wanted}");
        }
    }
}
