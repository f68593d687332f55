//! Random programs, end to end: all judges accept the emitted code, and lavapipe's picture of it is the reference's.
//! The reference never sees the lowering, so a mistake in the lowering shows.
//!
//! Each program draws one point per pixel with its own inputs. `RANDOM_PROGRAMS=first..end` runs other seeds.

use crate::drawing::{compiler, strict, verified};
use crate::emit::Collected;
use glisten::scene::{MemoryFiles, Scene};
use glisten_emit::{Conventions, Target, emit};
use glisten_front::hir::Stage;
pub(crate) use glisten_fuzz::fragments::exact as text;
use glisten_gpu::Gpu;
use glisten_verify::scene;
use glisten_verify::verify;
use std::ops::Range;

const VERTEX: &str = "#version 150\nin vec2 place;\nin vec4 av;\nin ivec4 bv;\nflat out vec4 a;\nflat out ivec4 b;\n\
    void main() { a = av; b = bv; gl_Position = vec4(place, 0.0, 1.0); }\n";
const SIDE: usize = 8;

pub(crate) fn seeds() -> Range<u64> {
    let Ok(asked) = std::env::var("RANDOM_PROGRAMS") else { return 0..48 };
    let (first, end) = asked.split_once("..").expect("RANDOM_PROGRAMS=first..end");
    first.parse().expect("a number")..end.parse().expect("a number")
}

/// A scene that runs the fragment shader once per pixel.
pub(crate) fn scene(fragment: &str) -> Result<Scene, String> {
    let list = |values: Vec<f64>| format!("{values:?}");
    let pixels = || 0..SIDE * SIDE;
    let center = |index: usize| (index as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0;
    let floats = [0.0, 1.0, -1.0, 0.5, 2.25, -3.75, 7.0, -0.125];
    let text = format!(
        "framebuffer = {{ width = {SIDE}, height = {SIDE}, attachments = 2, clear = [0, 0, 0, 0] }}\n[[draw]]\n\
         vertex = \"r.vert\"\nfragment = \"r.frag\"\nprimitive = \"points\"\n[draw.attributes]\n\
         place = {{ size = 2, values = {} }}\nav = {{ size = 4, values = {} }}\nbv = {{ size = 4, values = {:?} }}\n\
         [draw.uniforms]\n\"Block.w\" = [0.5, -2.0, 3.0]\n\"Block.x\" = [1, 0.5, -1, 2, 0.25, 3]\n\"Block.y\" = [4, -9]\n",
        list(pixels().flat_map(|pixel| [center(pixel % SIDE), center(pixel / SIDE)]).collect()),
        list(pixels().flat_map(|pixel| (0..4).map(move |k| floats[(pixel * 3 + k * 5) % 8])).collect()),
        pixels().flat_map(|pixel| (0..4).map(move |k| (pixel * 7 + k * 3) as i32 % 23 - 9)).collect::<Vec<i32>>(),
    );
    let files = MemoryFiles::new([("r.toml", text.as_str()), ("r.vert", VERTEX), ("r.frag", fragment)]);
    let loaded = scene::load("r.toml", &files, &compiler());
    let messages: Vec<_> = loaded
        .diagnostics
        .iter()
        .filter(|found| found.is_error())
        .map(|found| format!("{}: {}", found.code, found.message))
        .collect();
    loaded.scene.ok_or_else(|| messages.join("; "))
}

/// The fragment shader of a seed, and a scene that draws it.
#[cfg(feature = "gl")]
pub(crate) fn program(seed: u64) -> (String, Scene) {
    let fragment = text::fragment(seed);
    let scene = scene(&fragment).unwrap_or_else(|messages| panic!("seed {seed} is refused: {messages}\n{fragment}"));
    (fragment, scene)
}

/// The message for a picture with differences, and the number of undecided pixels.
fn compare(gpu: &Gpu, seed: u64, scene: &Scene) -> (Option<String>, usize) {
    let options = verify::Options { allow_inconclusive: true, ..strict() };
    let verification = verified(&format!("random_{seed}"), gpu, scene, &options);
    let open = verification.reference.undecided.iter().filter(|undecided| **undecided).count();
    ((!verification.holds()).then(|| verification.to_string()), open)
}

#[test]
fn random_programs_are_accepted_and_drawn_as_the_reference_draws_them() {
    let gpu = crate::drawing::gpu();
    let mut collected = Collected::new();
    let mut wrong = Vec::new();
    let (mut undecided, mut drawn) = (0, 0);
    for seed in seeds() {
        let fragment = text::fragment(seed);
        let scene = match scene(&fragment) {
            Ok(scene) => scene,
            Err(messages) => {
                wrong.push(format!("seed {seed} is refused: {messages}\n{fragment}"));
                continue;
            }
        };
        let program = &scene.draws[0].program;
        for target in [Target::Wgsl, Target::Spirv] {
            match emit(program, Stage::Fragment, target, &Conventions::default()) {
                Ok(emitted) => collected.add(&format!("seed {seed}"), emitted),
                Err(found) => wrong.push(format!("seed {seed} as {}: {}", target.name(), found[0].message)),
            }
        }
        let (differences, open) = compare(&gpu, seed, &scene);
        wrong.extend(differences.into_iter().map(|what| format!("seed {seed} {what}\n{fragment}")));
        (undecided, drawn) = (undecided + open, drawn + SIDE * SIDE);
    }
    assert!(wrong.is_empty(), "{} of {:?}:\n{}", wrong.len(), seeds(), wrong.join("\n"));
    assert!(undecided * 5 < drawn, "{undecided} of {drawn} pixels could not be judged");
    collected.validate();
}
