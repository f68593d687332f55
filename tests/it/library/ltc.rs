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
        assert!(row.mirrored[0] < 0.01 && row.mirrored[1] < 0.04, "{told}");
        assert!(row.diffuse[0] < 0.003 && row.diffuse[1] < 0.01, "{told}");
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
