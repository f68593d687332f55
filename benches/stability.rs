//! Measures what `glisten stability` costs compared with the reference's picture in f64, without causes: both pictures,
//! the trace of every expression, and the command on a scene that is stable, where no trace is needed.
//!
//! All rows run in turns: `cargo bench --bench stability --features cli`. The goal is 10. Ratios are of medians; the A/A
//! column compares the reference with itself.

use glisten::library::Embedded;
use glisten::scene::{DiskFiles, Scene, load};
use glisten::stability::{ExamineOptions, examine, trace};
use glisten_front::{Compiler, Options};
use glisten_reference::{RenderOptions, render};
use glisten_stability::{BOUND, errors_of};
use std::time::Instant;

const ROUNDS: usize = 15;

const SCENES: [&str; 5] = [
    "fixtures/scenes/blinn_phong.toml",
    "shader_lib/scenes/spot.toml",
    "shader_lib/scenes/hemi_knot.toml",
    "fixtures/stability/sound/02_ray_sphere_perpendicular.toml",
    "fixtures/stability/sound/11_road_station_partial.toml",
];

fn scene(path: &str) -> Option<Scene> {
    let path = format!("{}/{path}", env!("CARGO_MANIFEST_DIR"));
    load(&path, &DiskFiles, &Compiler::new(Options::default()).with_includes(Embedded)).scene
}

fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

#[expect(clippy::print_stdout, reason = "this is a program that prints figures")]
fn main() {
    println!("{:55} {:>8} {:>6} {:>9} {:>6} {:>8}", "scene", "f64", "A/A", "pictures", "trace", "command");
    for path in SCENES {
        let Some(scene) = scene(path) else {
            println!("{path:55} does not load");
            continue;
        };
        let options = RenderOptions::default();
        let draw = |row: usize| match row {
            0 | 1 => render(&scene, &options).map(drop),
            2 => errors_of(&scene).map(drop),
            3 => trace(&scene, &options).map(drop),
            _ => examine(
                &scene,
                &mut ExamineOptions {
                    bound: BOUND,
                    bound_relative: 0.0,
                    all: false,
                    figures: false,
                    progress: &mut |_, _| true,
                },
            )
            .map(drop),
        };
        let mut rows: [Vec<f64>; 5] = Default::default();
        for round in 0..ROUNDS + 2 {
            for (row, times) in rows.iter_mut().enumerate() {
                let start = Instant::now();
                draw(row).expect("it draws");
                // The first rounds warm up.
                if round >= 2 {
                    times.push(start.elapsed().as_secs_f64() * 1e3);
                }
            }
        }
        let f64_time = median(&rows[0]);
        let ratio = |row: usize| median(&rows[row]) / f64_time;
        println!(
            "{path:55} {f64_time:>5.1} ms {:>6.2} {:>9.1} {:>6.1} {:>8.1}",
            ratio(1),
            ratio(2),
            ratio(3),
            ratio(4)
        );
    }
}
