//! Measures how far the pictures of a driver are from the population of simulated GPUs, and how often sound pictures
//! would be suspected.
//!
//! `cargo run --release -p glisten-studies --bin population -- SCENE|FOLDER... [--members N] [--seed N] [--programs RANGE]
//! [--list]` draws each scene on the
//! first software adapter as SPIR-V and as WGSL, and with the population. It prints the pictures that `verify` would fail
//! for being far from the population (with `--list`, all of them), and the time of the population. `--programs FIRST..END`
//! adds random numeric programs.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

use glisten::scene::{DiskFiles, MemoryFiles, Scene, load};
use glisten::{Compiler, Gpu, Precision, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_fuzz::fragments::numeric;
use glisten_gpu::Via;
use glisten_reference::{LineRule, populate};
use glisten_scene::compare::evidence::Ruler;
use glisten_scene::compare::{Comparison, Gauge, Population, Written};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

struct Arguments {
    paths: Vec<PathBuf>,
    programs: Range<u64>,
    members: u32,
    seed: u64,
    list: bool,
}

fn arguments() -> Option<Arguments> {
    let mut found = Arguments { paths: Vec::new(), programs: 0..0, members: 32, seed: 1, list: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--members" => found.members = words.next()?.parse().ok()?,
            "--seed" => found.seed = words.next()?.parse().ok()?,
            "--programs" => {
                let words = words.next()?;
                let (first, end) = words.split_once("..")?;
                found.programs = first.parse().ok()?..end.parse().ok()?;
            }
            "--list" => found.list = true,
            _ => found.paths.push(word.into()),
        }
    }
    (!found.paths.is_empty() || !found.programs.is_empty()).then_some(found)
}

fn scene_files(path: &Path, to: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        entries.for_each(|entry| scene_files(&entry.path(), to));
    } else if path.extension().is_some_and(|extension| extension == "toml") {
        to.push(path.to_path_buf());
    }
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!("usage: population SCENE|FOLDER... [--members N] [--seed N] [--programs RANGE] [--list]");
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
    let (mut drawn, mut alarms) = (0, 0);
    println!("{:44} {:>7} {:>9} {:>7}", "scene", "covered", "ms", "suspect");
    let on_disk = files.iter().filter_map(|path| {
        let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Default::default()));
        Some((path.file_stem().unwrap_or_default().display().to_string(), loaded.scene?))
    });
    let random = arguments.programs.clone().filter_map(|seed| Some((format!("program {seed}"), program(seed)?)));
    for (name, scene) in on_disk.chain(random) {
        match lines(&scene, &gpu, &arguments) {
            Ok(lines) => {
                for Line { via, covered, suspect, is_alarm, milliseconds } in lines {
                    drawn += 1;
                    alarms += u32::from(is_alarm);
                    if arguments.list || is_alarm {
                        let (name, told) = (format!("{name} {}", via.name()), if is_alarm { "FAR" } else { "" });
                        println!("{name:44} {covered:7} {milliseconds:9.0} {suspect:7} {told}");
                    }
                }
            }
            Err(why) => println!("{name}: {why}"),
        }
    }
    println!("{drawn} pictures, {alarms} of them far from what {} simulated GPUs drew", arguments.members);
    ExitCode::SUCCESS
}

/// The scene of a random numeric program.
fn program(seed: u64) -> Option<Scene> {
    let text = numeric::SCENE.replace(" = 8\n", " = 32\n");
    let fragment = numeric::fragment(seed);
    let files = [("n.toml", text.as_str()), ("n.vert", numeric::VERTEX), ("n.frag", fragment.as_str())];
    load("n.toml", &MemoryFiles::new(files), &Compiler::new(Default::default())).scene
}

struct Line {
    via: Via,
    covered: u64,
    suspect: u64,
    is_alarm: bool,
    milliseconds: f64,
}

fn lines(scene: &Scene, gpu: &Gpu, arguments: &Arguments) -> Result<Vec<Line>, String> {
    let told = |found: Vec<Diagnostic>| found.first().map_or_else(String::new, |first| first.message.clone());
    let options = RenderOptions { lines: LineRule::Vulkan, ..RenderOptions::default() };
    let size = [scene.framebuffer.width, scene.framebuffer.height];
    let envelope = RenderOptions { precision: Precision::Envelope, ..options };
    let reference = glisten_reference::render(scene, &envelope).map_err(told)?;
    let written = Written::of(scene);
    // As `verify` does: where the language defines nothing, no picture is wrong.
    let undefined = glisten_reference::undefined(scene, &envelope).map_err(told)?;
    let undefined = undefined.map_or_else(Vec::new, |undefined| undefined.pixels);
    let gauge = Gauge::new(&Ruler::new(&reference, &written, None).without(&undefined));
    let mut population = Population::new(arguments.seed, size, scene.framebuffer.attachments).with_gauge(gauge);
    let started = Instant::now();
    populate(&mut population, scene, &options, 0..arguments.members).map_err(told)?;
    let milliseconds = started.elapsed().as_secs_f64() * 1e3;
    [Via::Spirv, Via::Wgsl]
        .into_iter()
        .map(|via| {
            let picture = gpu.render(scene, via).map_err(|error| error.to_string())?.picture;
            let comparison = Comparison {
                written: Some(&written),
                population: Some(&population),
                undefined: &undefined,
                ..Comparison::default()
            };
            let verdict = comparison.compare(&picture, &reference).verdict;
            let (covered, suspect) = (verdict.covered, verdict.suspect.unwrap_or(0));
            Ok(Line { via, covered, suspect, is_alarm: verdict.is_suspect(), milliseconds })
        })
        .collect()
}
