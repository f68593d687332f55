//! Measures the CPU reference's time for the Blinn-Phong sphere, as a ratio to lavapipe's for the same scene.
//!
//! The scene has 512x512 pixels and a mesh of 64x32; both sides run in turns, without start-up and compilation:
//! `RAYON_NUM_THREADS=2 cargo bench --bench reference`. The goal is 3 for f64 and 2 for f32, 8 times f64 for the
//! envelope, and twice f32 for a simulated GPU. Ratios are of medians; the A/A row compares lavapipe with itself.

use glisten::scene::{MemoryFiles, Scene, load};
use glisten_front::{Compiler, Options};
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions, render, simulate};
use std::time::Instant;

const ROUNDS: usize = 25;
const PRECISIONS: [Precision; 3] = [Precision::F64, Precision::F32, Precision::Envelope];

fn scene() -> Scene {
    let root = env!("CARGO_MANIFEST_DIR");
    let read = |path: &str| std::fs::read_to_string(format!("{root}/fixtures/{path}")).expect("a fixture");
    let text =
        read("scenes/blinn_phong.toml").replace("width = 256", "width = 512").replace("height = 256", "height = 512");
    let (vertex, fragment) = (read("programs/blinn_phong.vert"), read("programs/blinn_phong.frag"));
    let text = text.replace("../programs/", "");
    let files = MemoryFiles::new([
        ("sphere.toml", text.as_str()),
        ("blinn_phong.vert", vertex.as_str()),
        ("blinn_phong.frag", fragment.as_str()),
    ]);
    load("sphere.toml", &files, &Compiler::new(Options::default())).scene.expect("the scene is right")
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

#[expect(clippy::print_stdout, reason = "this is a program that prints figures")]
fn main() {
    let scene = scene();
    let gpu = Gpu::new(None).expect("this needs Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers");
    let prepared = gpu.prepare(&scene, Via::Spirv).expect("it can be drawn");
    let names = ["lavapipe", "lavapipe (A/A)", "f64", "f32", "envelope", "simulated"];
    let mut rows = names.map(|name| (name, Vec::new()));
    for round in 0..ROUNDS + 2 {
        for (index, (_, times)) in rows.iter_mut().enumerate() {
            let start = Instant::now();
            let options = RenderOptions { lines: LineRule::OpenGl, mark_edges: false, ..RenderOptions::default() };
            let time = match PRECISIONS.get(index.wrapping_sub(2)) {
                _ if index < 2 => gpu.draw(&prepared).expect("it draws").milliseconds,
                Some(precision) => {
                    render(&scene, &RenderOptions { precision: *precision, ..options }).expect("it draws");
                    start.elapsed().as_secs_f64() * 1e3
                }
                // Each of the population in turn.
                None => {
                    simulate(&scene, &options, (1, round as u32)).expect("it draws");
                    start.elapsed().as_secs_f64() * 1e3
                }
            };
            // The first rounds compile and warm up.
            if round >= 2 {
                times.push(time);
            }
        }
    }
    let [lavapipe, f64] = [0, 2].map(|row: usize| median(rows[row].1.clone()));
    for (name, times) in rows {
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        let middle = median(times);
        println!(
            "{name:16} median {middle:8.2} ms, best {least:8.2} ms, of lavapipe {:6.2}, of f64 {:6.2}",
            middle / lavapipe,
            middle / f64
        );
    }
}
