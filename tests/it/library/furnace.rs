//! The white furnace: white surfaces under light from everywhere return all of it, once further reflections are added.

use super::function;
use super::ltc::errors::tables;
use glisten::evaluate::Evaluator;
use glisten::scene::{MemoryFiles, load};
use glisten_reference::Precision;
use glisten_verify::scene::Texture;
use std::f64::consts::PI;
use std::io::Write;
use std::sync::Arc;

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// The slabs of OpenPBR that the library has, white, and blends of them: a metal, one by the cheaper factor, a dielectric over what its
/// mirror leaves, plaster, half of a metal and half of a dielectric; each under a coat; each under white or gray fibers; and fibers over a coat.
/// `a` is the table of microfacets, `f` that of fibers.
const BLENDS: &str = "#include <glisten/clearcoat.glsl>
#include <glisten/energy.glsl>
#include <glisten/oren_nayar.glsl>
#include <glisten/sheen.glsl>
vec3 metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return ggxFactor(N, L, V, r * r) + energyFactor(a, N, L, V, r, vec3(1.0)); }
vec3 cheap(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return ggxFactor(N, L, V, r * r) * energyCompensation(a, N, V, r, vec3(1.0)); }
vec3 dielectric(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{
    vec3 all = ltcAlbedo(a, N, V, r, vec3(0.04));
    vec3 F = fresnelSchlick(dot(V, halfVector(L, V)), vec3(0.04), vec3(1.0));
    return ggxFactor(N, L, V, r * r) * F + (1.0 - all) * eonFactor(N, L, V, vec3(1.0), r);
}
vec3 plaster(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r) { return eonFactor(N, L, V, vec3(1.0), r); }
vec3 half_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return 0.5 * metal(a, f, N, L, V, r) + 0.5 * dielectric(a, f, N, L, V, r); }
vec3 coat(vec3 base, sampler2D a, vec3 N, vec3 L, vec3 V, float strength)
{
    float w = clearcoatWeight(N, V, strength);
    return (1.0 - w) * base + w * ggxFactor(N, L, V, 0.25) * energyCompensation(a, N, V, 0.5, vec3(1.0));
}
vec3 fuzz(vec3 base, sampler2D f, vec3 N, vec3 L, vec3 V, float r, float strength)
{ return sheen(f, base, N, L, V, r, vec3(strength), vec3(1.0)); }
vec3 coated_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return coat(metal(a, f, N, L, V, r), a, N, L, V, 1.0); }
vec3 coated_dielectric(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return coat(dielectric(a, f, N, L, V, r), a, N, L, V, 1.0); }
vec3 coated_plaster(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return coat(plaster(a, f, N, L, V, r), a, N, L, V, 1.0); }
vec3 half_coated_half_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return coat(half_metal(a, f, N, L, V, r), a, N, L, V, 0.5); }
vec3 fuzzy_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(metal(a, f, N, L, V, r), f, N, L, V, r, 1.0); }
vec3 fuzzy_dielectric(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(dielectric(a, f, N, L, V, r), f, N, L, V, r, 1.0); }
vec3 fuzzy_plaster(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(plaster(a, f, N, L, V, r), f, N, L, V, r, 1.0); }
vec3 half_fuzzy_plaster(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(plaster(a, f, N, L, V, r), f, N, L, V, r, 0.5); }
vec3 half_fuzzy_half_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(half_metal(a, f, N, L, V, r), f, N, L, V, r, 0.5); }
vec3 fuzzy_coated_dielectric(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(coated_dielectric(a, f, N, L, V, r), f, N, L, V, r, 1.0); }
vec3 fuzzy_coated_metal(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return fuzz(coated_metal(a, f, N, L, V, r), f, N, L, V, r, 1.0); }
vec3 brushed(vec3 T, vec3 N, vec3 L, vec3 V, float r, float s) { return vec3(ggxFactor(N, T, L, V, ggxBrushed(r, s))); }
vec3 kept(sampler2D a, vec3 T, vec3 N, vec3 L, vec3 V, float r, float s)
{ return brushed(T, N, L, V, r, s) + energyFactor(a, N, L, V, energyRoughness(ggxBrushed(r, s)), vec3(1.0)); }
vec3 brushed_along(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return brushed(vec3(1.0, 0.0, 0.0), N, L, V, r, 0.6); }
vec3 brushed_across(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return brushed(vec3(0.0, 1.0, 0.0), N, L, V, r, 0.6); }
vec3 kept_along(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return kept(a, vec3(1.0, 0.0, 0.0), N, L, V, r, 0.6); }
vec3 kept_across(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return kept(a, vec3(0.0, 1.0, 0.0), N, L, V, r, 0.6); }
";

/// The parameters of a blend: the tables, normal, light and eye, roughness.
pub(super) const TABLED: &str = "(sampler2D,sampler2D,vec3,vec3,vec3,float)";

fn blend(name: &str) -> Evaluator {
    let compiler = crate::support::compiler().with_includes(glisten::library::Embedded);
    let signature = format!("{name}{TABLED}");
    Evaluator::new(&compiler, BLENDS, &signature, &[]).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The texture of a pattern.
pub(super) fn pattern(name: &str) -> Arc<Texture> {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
    let fragment = "#version 150\nuniform sampler2D a;\nout vec4 c;\nvoid main() { c = texture(a, vec2(0.5)); }\n";
    let scene = format!(
        "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\ntextures = {{ a = {{ pattern = \"{name}\" }} }}\n"
    );
    let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", vertex), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &crate::support::compiler());
    loaded.scene.expect("it is good").draws[0].textures[0].clone().expect("it has a texture")
}

/// The heights and turns that are enough for roughnesses from 0.5 on.
const WIDE: [u32; 2] = [256, 48];

/// The mean of pi f N.L over the half sphere, of lights at so many heights and turns.
pub(super) fn returned(
    factor: &Evaluator,
    tables: &[Arc<Texture>],
    eye: f64,
    roughness: f32,
    [heights, turns]: [u32; 2],
) -> f64 {
    let direction = |cos: f64, turn: f64| {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        [(sin * turn.cos()) as f32, (sin * turn.sin()) as f32, cos as f32]
    };
    let (mut rows, mut weights) = (Vec::new(), Vec::new());
    for (height, turn) in (0..heights).flat_map(|height| (0..turns).map(move |turn| (height, turn))) {
        // Denser towards the horizon, and along the azimuth of the mirror direction.
        let x = (f64::from(height) + 0.5) / f64::from(heights);
        let y = (f64::from(turn) + 0.5) / f64::from(turns);
        let azimuth = PI * (1.0 - y * y);
        rows.extend([UP, direction(x * x, azimuth), direction(eye, 0.0)].concat().into_iter().chain([roughness]));
        weights.push(2.0 * x / f64::from(heights) * 2.0 * 2.0 * y / f64::from(turns));
    }
    let found = factor.reference(&rows, tables, Precision::F64).expect("it is called");
    found.iter().zip(weights).map(|(result, weight)| result[0] * weight).sum()
}

/// The names of the blends that return all light.
const WHITE: &[&str] = &[
    "metal",
    "cheap",
    "dielectric",
    "plaster",
    "half_metal",
    "coated_metal",
    "coated_dielectric",
    "coated_plaster",
    "half_coated_half_metal",
    "fuzzy_metal",
    "fuzzy_dielectric",
    "fuzzy_plaster",
    "half_fuzzy_plaster",
    "half_fuzzy_half_metal",
    "fuzzy_coated_dielectric",
    "fuzzy_coated_metal",
];

/// With `FURNACE_TABLE=1` the figures are printed, for `docs/library.md`.
#[test]
fn white_surfaces_return_all_light() {
    let both = [tables().expect("the scene is good").remove(1), pattern("sheen_albedo")];
    let mut table = String::new();
    let mut wrong = Vec::new();
    for name in WHITE {
        let (factor, mut most) = (blend(name), 0.0_f64);
        for roughness in [0.5, 0.75, 1.0] {
            for eye in [0.15, 0.6, 1.0] {
                let off = returned(&factor, &both, eye, roughness, WIDE) - 1.0;
                most = most.max(off.abs());
                if off.abs() >= 1e-3 {
                    wrong.push(format!("{name}, roughness {roughness}, cosine {eye}: {off:+.5}"));
                }
            }
        }
        table += &format!("| `{name}` | {most:.5} |\n");
    }
    if std::env::var_os("FURNACE_TABLE").is_some() {
        writeln!(std::io::stderr(), "{table}").expect("standard error can be written to");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Tables are by one roughness: an anisotropic surface never returns more than it gets, and loses less with that of
/// `energyRoughness()`. The brush is of strength 0.6. With `FURNACE_TABLE=1` the figures are printed.
#[test]
fn brushed_metals_keep_most_of_their_light() {
    let both = [tables().expect("the scene is good").remove(1), pattern("sheen_albedo")];
    let mut table = String::new();
    for (name, low, high) in [
        ("brushed_along", 0.7, 1e-3),
        ("brushed_across", 0.7, 1e-3),
        ("kept_along", 0.08, 0.05),
        ("kept_across", 0.08, 0.05),
    ] {
        let factor = blend(name);
        let (mut least, mut most, mut sum) = (0.0_f64, 0.0_f64, 0.0);
        for roughness in [0.5, 0.75, 1.0] {
            for eye in [0.15, 0.6, 1.0] {
                let off = returned(&factor, &both, eye, roughness, WIDE) - 1.0;
                (least, most, sum) = (least.min(off), most.max(off), sum + off.abs());
            }
        }
        table += &format!("| `{name}` | {least:+.4} | {most:+.4} | {:.4} |\n", sum / 9.0);
        assert!(least > -low && most < high, "{table}");
    }
    if std::env::var_os("FURNACE_TABLE").is_some() {
        writeln!(std::io::stderr(), "{table}").expect("standard error can be written to");
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
