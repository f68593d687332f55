//! Shadows of a map, measured: how much light leaks through two moments where casters overlap, and how half shadows grow.

use crate::support::compiler;
use glisten::evaluate::Evaluator;
use glisten::library::{Embedded, scenes};
use glisten_reference::Precision;
use glisten_verify::evaluate::table;
use glisten_verify::scene::{Filter, Texture};
use std::sync::Arc;

/// The light that arrives by comparisons and by moments over one disk, and the mean depth there.
const FUNCTIONS: &str = "#include <glisten/shadow.glsl>
vec3 both(sampler2D map, float x, float depth, float radius, float cut)
{
    vec2 moments = vec2(0.0);
    for (int i = 0; i < 64; ++i)
        moments += texture(map, vec2(x, 0.5) + radius * shadowTap(i, 64, 0.0)).gb / 64.0;
    vec3 place = vec3(x, 0.5, depth);
    return vec3(shadowPercentageCloser(map, place, vec2(0.0), radius, 64, 0.0), shadowVariance(moments, depth, 0.0, cut), moments.x + 0.5);
}";

fn evaluator(signature: &str) -> Evaluator {
    let compiler = compiler().with_includes(Embedded);
    Evaluator::new(&compiler, FUNCTIONS, signature, &[]).unwrap_or_else(|error| panic!("{signature}: {error}"))
}

/// A map whose left part has one depth and whose right part another.
fn edge(left: f32, right: f32) -> Arc<Texture> {
    let texel = |depth: f32| [depth, depth - 0.5, (depth - 0.5) * (depth - 0.5), 1.0];
    Arc::new(table((0..256).map(|at| texel(if at < 128 { left } else { right })).collect(), Filter::Nearest))
}

/// The most that arrives across an edge between two casters, by comparisons and by moments.
fn leak(near: f32, far: f32, receiver: f32, cut: f32) -> [f64; 2] {
    let rows: Vec<f32> = (0..256).flat_map(|at| [0.35 + at as f32 * 0.3 / 255.0, receiver, 0.1, cut]).collect();
    let results =
        evaluator("both(sampler2D,float,float,float,float)").reference(&rows, &[edge(near, far)], Precision::F64);
    let results = results.expect("it is called");
    [0, 1].map(|channel| results.iter().map(|row| row[channel]).fold(0.0, f64::max))
}

/// Of casters that are `k` times as far from each other as the farther one is from the surface, Chebyshev's inequality lets through
/// s (1 - s) k^2 / (1 + s k (2 + k)) where the nearer one takes the part s.
fn bound(k: f64) -> f64 {
    let at = |s: f64| s * (1.0 - s) * k * k / (1.0 + s * k * (2.0 + k));
    (0..=1000).map(|s| at(f64::from(s) / 1000.0)).fold(0.0, f64::max)
}

#[test]
fn moments_leak_where_casters_overlap_and_a_cut_takes_it_away() {
    let text = scenes().iter().find(|scene| scene.name == "shadows").expect("it is there").text;
    let docs = include_str!("../../../docs/library.md");
    let mut told = Vec::new();
    for k in [1.0_f32, 4.0, 9.0] {
        let (far, receiver) = (0.8, 0.85);
        let near = far - k * (receiver - far);
        let [exact, open] = leak(near, far, receiver, 0.0);
        assert_eq!(exact, 0.0, "all of it is in the shadow");
        let expected = bound(f64::from(k));
        assert!(open <= expected + 2e-3 && open > expected - 0.02, "{k}: {open} for {expected}");
        let [_, cut] = leak(near, far, receiver, 0.5);
        let left = ((open - 0.5) / 0.5).max(0.0);
        assert!((cut - left).abs() < 2e-3, "{k}: {cut} for {left}");
        let row = format!("| {k} | {exact} | {open:.2} | {cut:.2} |");
        assert!(docs.contains(&row), "docs/library.md lacks {row}");
        told.push((open, cut));
    }
    let [one, four, nine] = told[..] else { panic!("three casters") };
    let sentence = format!("{:.2}, {:.2} and {:.2} of the light", one.0, four.0, nine.0);
    assert!(text.contains(&sentence), "{sentence}");
    let sentence = format!("a cut of a half leaves {:.2} of the last", nine.1);
    assert!(text.contains(&sentence), "{sentence}");
}

/// A half plane above a surface: the half shadow of Fernando's filter is as wide as similar triangles have it.
#[test]
fn half_shadows_grow_with_the_distance_of_the_caster() {
    let soft = evaluator("shadowSoftSun(sampler2D,vec3,vec2,float,int,float)");
    let fixed = evaluator("shadowPercentageCloser(sampler2D,vec3,vec2,float,int,float)");
    let width = |evaluator: &Evaluator, caster: f32, last: f32| {
        let row = |at: i32| [at as f32 / 2000.0, 0.5, 0.9, 0.0, 0.0, last, 64.0, 0.0];
        let rows: Vec<f32> = (0..=2000).flat_map(row).collect();
        let found = evaluator.reference(&rows, &[edge(caster, 1.0)], Precision::F64).expect("it is called");
        let lit: Vec<f64> = found.iter().map(|row| row[0]).collect();
        lit.iter().filter(|lit| (0.02..0.98).contains(*lit)).count() as f64 / 2000.0
    };
    // Of a disk, 0.02 to 0.98 is the middle 0.866 of its breadth or a little less.
    for caster in [0.1_f32, 0.5, 0.7, 0.85] {
        let found = width(&soft, caster, 0.2);
        let expected = 2.0 * 0.2 * f64::from(0.9 - caster);
        assert!(found > 0.75 * expected - 0.002 && found < expected + 0.01, "{caster}: {found} of {expected}");
        let same = width(&fixed, caster, 0.05);
        assert!((0.08..=0.11).contains(&same), "{caster}: {same}");
    }
}
