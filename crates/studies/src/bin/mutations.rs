//! Plants faults in the code that glisten emits for scenes, draws each one, and counts how many `verify` catches.
//!
//! ```text
//! cargo run --release -p glisten-studies --bin mutations -- fixtures/scenes [--each N] [--seed N] [--list] [--legal | --no-legal]
//! ```
//!
//! The arguments are scene files and folders, which are searched recursively. For each kind of fault and each class of
//! scenes, it prints how many change the picture, and how many of those `verify` and a tolerance of 1/255 catch; then the
//! legal changes that `verify` fails; then each fault that passes, with the width and the class of the envelope. `--each`
//! tries at most N faults of each kind per scene and form; `--list` prints the outcome of every fault; `--legal` tries
//! legal changes alone, `--no-legal` faults alone. It needs a Vulkan software adapter and `spirv-val`.

#[path = "../../../../tests/it/mutation/mod.rs"]
mod mutation;

use glisten::scene::{DiskFiles, Scene, load};
use glisten_front::{Compiler, Options};
use glisten_gpu::Gpu;
use mutation::{Choice, Parts, Study};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

struct Arguments {
    paths: Vec<PathBuf>,
    choice: Choice,
    parts: Parts,
    list: bool,
}

fn arguments() -> Option<Arguments> {
    let parts = Parts { faults: true, legal: true };
    let mut parsed = Arguments { paths: Vec::new(), choice: Choice { each: None, seed: 0 }, parts, list: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--each" => parsed.choice.each = Some(words.next()?.parse().ok()?),
            "--seed" => parsed.choice.seed = words.next()?.parse().ok()?,
            "--list" => parsed.list = true,
            "--legal" => parsed.parts.faults = false,
            "--no-legal" => parsed.parts.legal = false,
            _ => parsed.paths.push(word.into()),
        }
    }
    (!parsed.paths.is_empty()).then_some(parsed)
}

fn scene_files(path: &Path, found: &mut Vec<PathBuf>) {
    if !path.is_dir() {
        return found.push(path.to_owned());
    }
    for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_symlink() {
            // The library's scenes, which the library's own tests draw.
            continue;
        }
        if path.is_dir() || path.extension().is_some_and(|extension| extension == "toml") {
            scene_files(&path, found);
        }
    }
}

fn scene(path: &Path) -> Result<(String, Scene), String> {
    let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Options::default()));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    loaded.scene.map(|scene| (name, scene)).ok_or_else(|| format!("{}: {}", path.display(), told.join("; ")))
}

#[expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]
fn main() -> ExitCode {
    let Some(Arguments { paths, choice, parts, list }) = arguments() else {
        eprintln!("usage: mutations SCENE|FOLDER... [--each N] [--seed N] [--list] [--legal | --no-legal]");
        return ExitCode::from(2);
    };
    let mut files = Vec::new();
    paths.iter().for_each(|path| scene_files(path, &mut files));
    files.sort();
    let scenes = match files.iter().map(|path| scene(path)).collect::<Result<Vec<_>, _>>() {
        Ok(scenes) => scenes,
        Err(why) => {
            eprintln!("{why}");
            return ExitCode::FAILURE;
        }
    };
    let gpu = match Gpu::new(Some("software")) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(3);
        }
    };
    let study = Study::of(&gpu, &scenes, (choice, parts), &mut |name, faults| eprintln!("{name}: {faults} faults"));
    if list {
        study.trials.iter().for_each(|trial| println!("{trial}"));
    }
    print!("{study}");
    ExitCode::SUCCESS
}
