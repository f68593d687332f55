//! Measures how well work predicts time: the work of the gallery's scenes, counted on the reference, against the time in which
//! the GPU draws them.
//!
//! `cargo bench --bench work` prints a table as Markdown, and for each of the weights the correlation of the logarithms of work
//! and time, that of their ranks, and the worst ratio: how far a scene's time is from the work times the median time of a
//! step. With names of scenes only these; `counts` prints the steps instead.
//! A time is the median over rounds in which all scenes are drawn in turns, less the time of an empty frame.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use glisten::scene::{DiskFiles, Scene, load};
use glisten::{Compiler, Options};
use glisten_gpu::{Gpu, Prepared, Via};
use glisten_report::{Weights, steps, work};
use std::path::{Path, PathBuf};

const ROUNDS: usize = 9;

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let scenes = scenes(&asked);
    if asked.iter().any(|asked| asked == "counts") {
        return scenes.iter().for_each(|(name, scene)| print_steps(name, scene));
    }
    let gpu = Gpu::new(None).expect("a Vulkan adapter: apt-get install mesa-vulkan-drivers");
    let times = times(&gpu, &scenes);
    let weights: Vec<Weights> = Weights::embedded().into_iter().filter_map(Weights::named).collect();
    let names: Vec<&str> = weights.iter().map(Weights::name).collect();
    println!("| scene | ms | {} |\n| --- | --- |{}", names.join(" | "), " --- |".repeat(names.len()));
    let works: Vec<Vec<f64>> = scenes.iter().map(|(_, scene)| sums(scene, &weights)).collect();
    for (((name, _), works), time) in scenes.iter().zip(&works).zip(&times) {
        let works: Vec<String> = works.iter().map(|work| format!("{work:.0}")).collect();
        println!("| `{name}` | {time:.3} | {} |", works.join(" | "));
    }
    println!("\nDrawn by {}.\n", gpu.adapter());
    println!("| weights | correlation | of the ranks | worst ratio | scene |\n| --- | --- | --- | --- | --- |");
    for (number, name) in names.iter().enumerate() {
        let work: Vec<f64> = works.iter().map(|works| works[number]).collect();
        let (worst, at) = worst(&work, &times);
        println!(
            "| {name} | {:.3} | {:.3} | {worst:.2} | `{}` |",
            correlation(&logs(&work), &logs(&times)),
            correlation(&ranks(&work), &ranks(&times)),
            scenes[at].0,
        );
    }
}

/// The scenes of the gallery by name.
fn scenes(asked: &[String]) -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shader_lib/scenes");
    let files = std::fs::read_dir(folder).expect("the gallery").filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|kind| kind == "toml")).collect();
    files.sort();
    let named =
        files.into_iter().map(|path| (path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), path));
    let all = asked.iter().all(|asked| asked == "counts");
    let wanted = named.filter(|(name, _)| all || asked.contains(name));
    wanted
        .map(|(name, path)| {
            let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Options::default()));
            (name, loaded.scene.expect("the scene is valid"))
        })
        .collect()
}

/// The operations of a scene by each of the weights.
fn sums(scene: &Scene, weights: &[Weights]) -> Vec<f64> {
    let counts = steps(scene).expect("the reference draws it");
    weights.iter().map(|weights| work(&counts, weights, glisten::emit::FloatWidth::Single).operations as f64).collect()
}

/// The steps of a scene, as tab-separated lines.
fn print_steps(name: &str, scene: &Scene) {
    for (step, count) in steps(scene).expect("the reference draws it") {
        println!("{name}\t{}\t{}\t{}\t{count}", step.name, step.results, step.argument);
    }
}

/// The median time of each scene in milliseconds, less that of an empty frame of the same size.
fn times(gpu: &Gpu, scenes: &[(String, Scene)]) -> Vec<f64> {
    let prepare = |scene: &Scene| {
        let prepared = gpu.prepare(scene, Via::Spirv).expect("it can be drawn");
        let frames = gpu.frames_for_a_stretch(&prepared).expect("it draws");
        (prepared, frames)
    };
    let empty = |scene: &Scene| Scene { draws: Vec::new(), ..scene.clone() };
    let drawn: Vec<[(Prepared, u32); 2]> =
        scenes.iter().map(|(_, scene)| [prepare(scene), prepare(&empty(scene))]).collect();
    let mut times = vec![[Vec::new(), Vec::new()]; scenes.len()];
    for _ in 0..ROUNDS {
        for (drawn, times) in drawn.iter().zip(&mut times) {
            for ((prepared, frames), times) in drawn.iter().zip(times) {
                times.push(gpu.measure(prepared, *frames).expect("it draws"));
            }
        }
    }
    let medians = times.into_iter().map(|times| times.map(median));
    medians.map(|[scene, empty]| (scene - empty).max(1e-3)).collect()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

fn logs(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value.ln()).collect()
}

fn ranks(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| values.iter().filter(|other| *other < value).count() as f64).collect()
}

/// Pearson's correlation.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let product =
        |x: &[f64], y: &[f64], mx: f64, my: f64| x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>();
    product(a, b, mean_a, mean_b) / (product(a, a, mean_a, mean_a) * product(b, b, mean_b, mean_b)).sqrt()
}

/// The largest ratio between a time and what the work predicts, either way, and where it is.
fn worst(work: &[f64], times: &[f64]) -> (f64, usize) {
    let each: Vec<f64> = times.iter().zip(work).map(|(time, work)| time / work).collect();
    let usual = median(each.clone());
    let off = each.iter().map(|each| (each / usual).max(usual / each)).enumerate();
    off.fold((1.0, 0), |(worst, at), (number, off)| if off > worst { (off, number) } else { (worst, at) })
}
