//! The white furnace: white surfaces under light from everywhere return all of it, once further reflections are added.

use super::function;
use super::ltc::errors::tables;
use glisten::evaluate::Evaluator;
use glisten::scene::{MemoryFiles, Texture, load};
use glisten_reference::Precision;
use std::f64::consts::PI;
use std::sync::Arc;

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// A white metal, one by the cheaper factor, one under a coat that loses no energy either, a white dielectric over what its mirror leaves, and a
/// metal and plaster under white fibers.
const BLENDS: &str = "#include <glisten/clearcoat.glsl>
#include <glisten/energy.glsl>
#include <glisten/oren_nayar.glsl>
#include <glisten/sheen.glsl>
vec3 metal(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{ return ggxFactor(N, L, V, r * r) + energyFactor(a, N, L, V, r, vec3(1.0)); }
vec3 cheap(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{ return ggxFactor(N, L, V, r * r) * energyCompensation(a, N, V, r, vec3(1.0)); }
vec3 coated(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{
    float w = clearcoatWeight(N, V, 1.0);
    vec3 coat = ggxFactor(N, L, V, 0.25) * energyCompensation(a, N, V, 0.5, vec3(1.0));
    return (1.0 - w) * metal(a, N, L, V, r) + w * coat;
}
vec3 velvet(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{ return sheen(a, eonFactor(N, L, V, vec3(1.0), r), N, L, V, r, vec3(1.0), vec3(1.0)); }
vec3 gray_velvet(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{ return sheen(a, eonFactor(N, L, V, vec3(1.0), r), N, L, V, r, vec3(0.5), vec3(1.0)); }
vec3 dielectric(sampler2D a, vec3 N, vec3 L, vec3 V, float r)
{
    vec3 all = ltcAlbedo(a, N, V, r, vec3(0.04));
    vec3 F = fresnelSchlick(dot(V, halfVector(L, V)), vec3(0.04), vec3(1.0));
    return ggxFactor(N, L, V, r * r) * F + (1.0 - all) * eonFactor(N, L, V, vec3(1.0), r);
}
";

fn blend(name: &str) -> Evaluator {
    let compiler = crate::support::compiler().with_includes(glisten::library::Embedded);
    let signature = format!("{name}(sampler2D,vec3,vec3,vec3,float)");
    Evaluator::new(&compiler, BLENDS, &signature, &[]).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The texture of a pattern.
fn pattern(name: &str) -> Arc<Texture> {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
    let fragment = "#version 150\nuniform sampler2D a;\nout vec4 c;\nvoid main() { c = texture(a, vec2(0.5)); }\n";
    let scene = format!(
        "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\ntextures = {{ a = {{ pattern = \"{name}\" }} }}\n"
    );
    let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", vertex), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &crate::support::compiler());
    loaded.scene.expect("it is good").draws[0].textures[0].clone().expect("it has a texture")
}

/// The mean of pi f N.L over the half sphere.
fn returned(factor: &Evaluator, table: &Arc<Texture>, eye: f64, roughness: f32) -> f64 {
    const HEIGHTS: u32 = 256;
    const TURNS: u32 = 48;
    let direction = |cos: f64, turn: f64| {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        [(sin * turn.cos()) as f32, (sin * turn.sin()) as f32, cos as f32]
    };
    let (mut rows, mut weights) = (Vec::new(), Vec::new());
    for (height, turn) in (0..HEIGHTS).flat_map(|height| (0..TURNS).map(move |turn| (height, turn))) {
        // Denser towards the horizon, and along the azimuth of the mirror direction.
        let x = (f64::from(height) + 0.5) / f64::from(HEIGHTS);
        let y = (f64::from(turn) + 0.5) / f64::from(TURNS);
        let azimuth = PI * (1.0 - y * y);
        rows.extend([UP, direction(x * x, azimuth), direction(eye, 0.0)].concat().into_iter().chain([roughness]));
        weights.push(2.0 * x / f64::from(HEIGHTS) * 2.0 * 2.0 * y / f64::from(TURNS));
    }
    let found = factor.reference(&rows, &[Arc::clone(table)], Precision::F64).expect("it is called");
    found.iter().zip(weights).map(|(result, weight)| result[0] * weight).sum()
}

#[test]
fn white_surfaces_return_all_light() {
    let ggx = tables().expect("the scene is good").remove(1);
    let fibers = pattern("sheen_albedo");
    let blends = [
        ("metal", &ggx),
        ("cheap", &ggx),
        ("coated", &ggx),
        ("dielectric", &ggx),
        ("velvet", &fibers),
        ("gray_velvet", &fibers),
    ];
    for (name, table) in blends {
        let (factor, most) = (blend(name), 1e-3);
        for roughness in [0.5, 0.75, 1.0] {
            for eye in [0.15, 0.6, 1.0] {
                let off = returned(&factor, table, eye, roughness) - 1.0;
                assert!(off.abs() < most, "{name}, roughness {roughness}, cosine {eye}: {off:+.5}");
            }
        }
    }
}

/// Light and eye may change places in what all further reflections add.
#[test]
fn further_reflections_are_reciprocal() {
    let factor = function("energy", "energyFactor(sampler2D,vec3,vec3,vec3,float,vec3)", &[]);
    let tables = tables().expect("the scene is good");
    for turn in 0..40 {
        let x = f64::from(turn);
        let (a, b) = (0.03 + 0.024 * x, 0.97 - 0.021 * x);
        let at = |cos: f64, azimuth: f64| {
            let sin = (1.0 - cos * cos).sqrt();
            [(sin * azimuth.cos()) as f32, (sin * azimuth.sin()) as f32, cos as f32]
        };
        let (light, eye) = (at(a, 0.3), at(b, 0.1 * x));
        let more = [0.7, 0.9, 0.5, 0.1];
        let rows = [[UP, light, eye].concat(), more.to_vec(), [UP, eye, light].concat(), more.to_vec()].concat();
        let found = factor.reference(&rows, &tables[1..], Precision::F64).expect("it is called");
        let (there, back) = (found[0][0] / f64::from(light[2]), found[1][0] / f64::from(eye[2]));
        assert!((there - back).abs() < 1e-6 * there.max(1e-3), "{turn}: {there} {back}");
    }
}
