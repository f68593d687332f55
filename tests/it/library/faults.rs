//! Faults of published code: the module `naive` has them as they are published, and the library does not.

use super::furnace::{TABLED, pattern, returned};
use super::ltc::errors::tables;
use super::{call, function};
use glisten::evaluate::Evaluator;
use glisten_reference::Precision;

/// The heights and turns of lights for narrow highlights.
const NARROW: [u32; 2] = [768, 192];

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// The closed form of the albedo in EON's reference code divides 0 by 0 at a right angle to the normal, and takes the root of a negative number
/// where rounding makes a cosine larger than 1; the factor divides by 0 where both directions are at a right angle.
#[test]
fn the_reference_code_of_eon_is_no_number_at_grazing_angles() {
    let both = [Precision::F64, Precision::F32];
    let albedo = function("naive", "naiveEonExact(float,float)", &[]);
    let fit = function("oren_nayar", "eonSingle(float,float)", &[]);
    let above = f32::from_bits(1.0_f32.to_bits() + 1);
    for (cosine, roughness) in [(0.0, 0.3), (0.0, 1.0), (above, 0.3), (above, 1.0)] {
        for precision in both {
            let of = |of: &Evaluator| of.reference(&[cosine, roughness], &[], precision).expect("it is called")[0][0];
            assert!(of(&albedo).is_nan(), "{cosine} {roughness}");
            assert!((0.0..=1.001).contains(&of(&fit)), "{cosine} {roughness}: {}", of(&fit));
        }
    }
    let literal = function("naive", "naiveEon(vec3,vec3,vec3,vec3,float)", &[]);
    let ours = function("oren_nayar", "eonFactor(vec3,vec3,vec3,vec3,float)", &[]);
    let light = [0.6, 0.0, 0.8];
    for eye in [[1.0, 0.0, 0.0], [0.8, 0.6, 0.0]] {
        let row = [UP, [1.0, 0.0, 0.0], eye, [0.8, 0.5, 0.2]].concat();
        let row: Vec<f32> = row.into_iter().chain([0.5]).collect();
        for precision in both {
            let of = |of: &Evaluator| of.reference(&row, &[], precision).expect("it is called").remove(0);
            assert!(of(&literal).iter().any(|channel| channel.is_nan()), "{eye:?}: {:?}", of(&literal));
            assert_eq!(of(&ours), [0.0; 3], "{eye:?}");
        }
    }
    // Where it is a number, it is the same one: the fit of the albedo is what differs.
    let row = [UP, light, [0.0, 0.6, 0.8], [0.8, 0.5, 0.2], [0.7, 0.0, 0.0]].concat();
    let (found, literal) = (call(&ours, &row[..13]), call(&literal, &row[..13]));
    for (found, literal) in found[0].iter().zip(&literal[0]) {
        assert!((found - literal).abs() < 1e-3, "{found} {literal}");
    }
}

/// By the model of their sources, smooth fibers return more light than there is at grazing angles.
#[test]
fn smooth_fibers_return_more_light_than_there_is() {
    let both = [tables().expect("the scene is good").remove(1), pattern("sheen_albedo")];
    let text = "#include <glisten/sheen.glsl>
vec3 fibers(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return sheen(f, vec3(0.0), N, L, V, r, vec3(1.0), vec3(1.0)); }
";
    let compiler = crate::support::compiler().with_includes(glisten::library::Embedded);
    let factor = Evaluator::new(&compiler, text, &format!("fibers{TABLED}"), &[]).expect("it is called");
    for (roughness, eye, expected) in [(0.25, 0.05, 1.133), (0.25, 0.01, 1.497), (0.5, 0.05, 0.747)] {
        let found = returned(&factor, &both, eye, roughness, NARROW);
        assert!((found - expected).abs() < 2e-3, "{roughness} {eye}: {found}");
    }
}

/// In the direct light of three.js, the body gets what was mirrored, too: white plastic returns more light than there is. Its fibers take 0.157
/// of the light from what is below, whatever they return. With `FURNACE_TABLE=1` the figures are printed.
#[test]
fn three_js_returns_more_light_than_there_is() {
    let both = [tables().expect("the scene is good").remove(1), pattern("sheen_albedo")];
    let theirs = "#include <glisten/naive.glsl>
vec3 plastic(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r)
{ return naivePlastic(N, L, V, vec3(1.0), 0.04, r * r); }
vec3 fibers(sampler2D a, sampler2D f, vec3 N, vec3 L, vec3 V, float r) { return vec3(naiveSheen(N, L, V, r * r)); }
";
    let compiler = crate::support::compiler().with_includes(glisten::library::Embedded);
    let at = |name: &str, roughness: f32, eye: f64| {
        let signature = format!("{name}{TABLED}");
        let factor = Evaluator::new(&compiler, theirs, &signature, &[]).expect("it is called");
        returned(&factor, &both, eye, roughness, NARROW)
    };
    let mut table = String::new();
    let mut wrong = Vec::new();
    for (name, roughness, eye, low, high) in [
        ("plastic", 0.5, 1.0, 1.03, 1.06),
        ("plastic", 0.5, 0.15, 1.1, 1.5),
        ("plastic", 0.25, 0.15, 1.1, 1.6),
        ("fibers", 0.5, 0.15, 1.02, 1.5),
        ("fibers", 0.25, 0.15, 1.02, 1.8),
        ("fibers", 0.5, 1.0, 0.8, 0.95),
    ] {
        let found = at(name, roughness, eye);
        table += &format!("| {name} | {roughness} | {eye} | {found:.3} |\n");
        if found <= low || found >= high {
            wrong.push(name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}\n{table}");
    if std::env::var_os("FURNACE_TABLE").is_some() {
        std::io::Write::write_all(&mut std::io::stderr(), table.as_bytes()).expect("standard error can be written to");
    }
}
