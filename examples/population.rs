//! Measures how far the pictures of a driver are from the population of simulated GPUs, and how often sound pictures
//! would be suspected.
//!
//! `cargo run --release --example population -- SCENE|FOLDER... [--members N] [--seed N] [--list]` draws each scene on the
//! first software adapter as SPIR-V and as WGSL, and with the population. For each scene it prints the largest distance
//! of a pixel from the population, in units of its spread, and the pixels that are farther than each of a few limits.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

use glisten::scene::{DiskFiles, Scene, load};
use glisten::verify::likely;
use glisten::{Compiler, Gpu, Precision, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_gpu::Via;
use glisten_reference::{LineRule, Population, population};
use glisten_scene::picture::Picture;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The limits that are tried, in units of the spread.
const LIMITS: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0];

struct Arguments {
    paths: Vec<PathBuf>,
    members: u32,
    seed: u64,
    list: bool,
}

fn arguments() -> Option<Arguments> {
    let mut found = Arguments { paths: Vec::new(), members: 32, seed: 1, list: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--members" => found.members = words.next()?.parse().ok()?,
            "--seed" => found.seed = words.next()?.parse().ok()?,
            "--list" => found.list = true,
            _ => found.paths.push(word.into()),
        }
    }
    (!found.paths.is_empty()).then_some(found)
}

fn scene_files(path: &Path, to: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        entries.for_each(|entry| scene_files(&entry.path(), to));
    } else if path.extension().is_some_and(|extension| extension == "toml") {
        to.push(path.to_path_buf());
    }
}

/// For each limit, the pixels of a picture that are farther from the population; and the largest distance.
fn beyond(picture: &Picture, reference: &Picture, population: &Population) -> ([u64; LIMITS.len()], f64) {
    let distances = likely::distances(picture, reference, population);
    let counts = LIMITS.map(|limit| distances.iter().filter(|distance| **distance > limit).count() as u64);
    (counts, distances.into_iter().fold(0.0, f64::max))
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!("usage: population SCENE|FOLDER... [--members N] [--seed N] [--list]");
        return ExitCode::from(2);
    };
    let mut files = Vec::new();
    arguments.paths.iter().for_each(|path| scene_files(path, &mut files));
    files.sort();
    let gpu = match Gpu::new(Some("software")) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(3);
        }
    };
    let mut alarms = [0; LIMITS.len()];
    let mut drawn = 0;
    println!("{:44} {:>7} {:>9} {:>9}  farther than {LIMITS:?}", "scene", "covered", "ms", "farthest");
    for path in &files {
        let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Default::default()));
        let Some(scene) = loaded.scene else { continue };
        for via in [Via::Spirv, Via::Wgsl] {
            match line(&scene, &gpu, via, &arguments) {
                Ok((covered, counts, most, milliseconds)) => {
                    drawn += 1;
                    for (alarm, count) in alarms.iter_mut().zip(counts) {
                        *alarm += u32::from(count >= 8 && count as f64 > 0.001 * covered as f64);
                    }
                    if arguments.list || counts[2] > 0 {
                        let name = format!("{} {}", path.file_stem().unwrap_or_default().display(), via.name());
                        println!("{name:44} {covered:7} {milliseconds:9.0} {most:9.2e}  {counts:?}");
                    }
                }
                Err(why) => println!("{}: {why}", path.display()),
            }
        }
    }
    println!("{drawn} pictures; suspected beyond {LIMITS:?}: {alarms:?}");
    ExitCode::SUCCESS
}

type Line = (usize, [u64; LIMITS.len()], f64, f64);

fn line(scene: &Scene, gpu: &Gpu, via: Via, arguments: &Arguments) -> Result<Line, String> {
    let picture = gpu.render(scene, via).map_err(|error| error.to_string())?.picture;
    let options = RenderOptions { lines: LineRule::Vulkan, ..RenderOptions::default() };
    let started = Instant::now();
    let population = population(scene, &options, (arguments.seed, 0..arguments.members), None)
        .map_err(|found| found.first().map_or_else(String::new, |first| first.message.clone()))?;
    let milliseconds = started.elapsed().as_secs_f64() * 1e3;
    let covered = picture.covered.iter().filter(|covered| **covered).count();
    let told = |found: Vec<Diagnostic>| found.first().map_or_else(String::new, |first| first.message.clone());
    let envelope = RenderOptions { precision: Precision::Envelope, ..options };
    let reference = glisten_reference::render(scene, &envelope).map_err(told)?;
    let (counts, most) = beyond(&picture, &reference, &population);
    Ok((covered, counts, most, milliseconds))
}
