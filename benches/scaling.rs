//! Measures whether the CPU reference's time grows in proportion: to the pixels of the Blinn-Phong sphere, and to the
//! length of its fragment shader, whose lighting is repeated.
//!
//! `cargo bench --no-default-features --features reference --bench scaling`; set `RAYON_NUM_THREADS` as for drawing.
//! Figures are the best of the rounds of one second, at least three. The row without lighting shows the cost of
//! everything but the shader: mesh, rasterization, interpolation, picture.

use glisten::scene::{MemoryFiles, Scene, load};
use glisten_front::{Compiler, Options};
use glisten_reference::{Precision, RenderOptions};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(1);
const LEAST_ROUNDS: usize = 3;

/// The sphere on a square of `side` pixels, lit `repeats` times from slightly different positions.
fn scene(side: u32, repeats: u32) -> Scene {
    let root = env!("CARGO_MANIFEST_DIR");
    let read = |path: &str| std::fs::read_to_string(format!("{root}/fixtures/{path}")).expect("a fixture");
    let text = read("scenes/blinn_phong.toml")
        .replace("width = 256", &format!("width = {side}"))
        .replace("height = 256", &format!("height = {side}"))
        .replace("../programs/", "");
    let lit: String = (0..repeats).map(|i| format!(" + illumination(ve + {i}.0 * 1e-3, normalize(vn))")).collect();
    let fragment =
        read("programs/blinn_phong.frag").replace("illumination(ve, normalize(vn))", &format!("vn + ve{lit}"));
    let vertex = read("programs/blinn_phong.vert");
    let uniforms = text.find("[draw.uniforms]").expect("the scene sets uniforms");
    // A uniform that no light uses is not declared.
    let text = if repeats == 0 { &text[..uniforms] } else { &text[..] };
    let files =
        MemoryFiles::new([("sphere.toml", text), ("blinn_phong.vert", &vertex), ("blinn_phong.frag", &fragment)]);
    load("sphere.toml", &files, &Compiler::new(Options::default())).scene.expect("the scene is right")
}

/// The best time in milliseconds.
fn best(scene: &Scene, precision: Precision) -> f64 {
    let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
    let begin = Instant::now();
    let mut best = f64::INFINITY;
    for round in 0.. {
        if round >= LEAST_ROUNDS && begin.elapsed() > PATIENCE {
            break;
        }
        let start = Instant::now();
        glisten_reference::render(scene, &options).expect("it draws");
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    best
}

#[expect(clippy::print_stdout, reason = "this is a program that prints figures")]
fn main() {
    for (name, precision) in [("f64", Precision::F64), ("f32", Precision::F32), ("envelope", Precision::Envelope)] {
        let mut first = None;
        for side in [256, 512, 1024] {
            let time = best(&scene(side, 1), precision);
            let each = time / f64::from(side * side);
            let ratio = each / *first.get_or_insert(each);
            println!("{name:8} {side:4} x {side:4}: {time:8.2} ms, {:6.1} ns a pixel, ratio {ratio:5.2}", each * 1e6);
        }
        let without = best(&scene(512, 0), precision);
        println!("{name:8} without lighting: {without:8.2} ms");
        let mut first = None;
        for repeats in [1, 2, 4, 8] {
            let time = best(&scene(512, repeats), precision);
            let each = (time - without) / f64::from(repeats);
            let ratio = each / *first.get_or_insert(each);
            println!("{name:8} lit {repeats} times: {time:8.2} ms, {each:6.2} ms more each, ratio {ratio:5.2}");
        }
    }
}
