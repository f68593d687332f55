//! Leaves out of the programs of scenes what their pictures do not need, and proves it: a table for a folder of scenes.
//!
//! `cargo run --release --example specialize -- FOLDER...` prints a row for each scene of the folders: SPIR-V instructions
//! and lines of GLSL of all draws before and after, the operations that the reference counts, whether the reference draws
//! the same bytes in f32, and whether `verify` holds for the residual against the original on the first software adapter.
//! It exits with 1 if a picture changes.

#![expect(clippy::print_stdout, reason = "an example prints")]

use glisten::scene::{DiskFiles, Scene, load};
use glisten::specialize::{Account, SpecializedScene, account, specialize_scene};
use glisten::verify::{Drawn, Failure, OnGpu, Options, Runner, verify};
use glisten::{Compiler, Gpu, Precision, RenderOptions, render};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Draws the residual in the place of the original.
struct Instead<'a> {
    runner: &'a dyn Runner,
    scene: &'a Scene,
}

impl Runner for Instead<'_> {
    fn name(&self) -> &'static str {
        self.runner.name()
    }

    fn draw(&self, _: &Scene) -> Result<Drawn, Failure> {
        self.runner.draw(self.scene)
    }
}

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let folders: Vec<String> = std::env::args().skip(1).collect();
    if folders.is_empty() {
        return Err("name a folder of scenes".into());
    }
    let gpu = Gpu::new(Some("software"))?;
    println!(
        "| scene | SPIR-V | | lines | | operations | | bytes | verify |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    );
    let mut all_hold = true;
    for path in scenes(&folders)? {
        let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Default::default()));
        let Some(scene) = loaded.scene else {
            let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
            return Err(format!("{}: {}", path.display(), messages.join("; ")).into());
        };
        let specialized = specialize_scene(&scene, &loaded.sources, &[]);
        let names = vec![[const { String::new() }; 3]; scene.draws.len()];
        let account = account("", &scene, &specialized, &names).map_err(told)?;
        let same = bytes(&scene)? == bytes(&specialized.scene)?;
        let runners = OnGpu::both(&gpu);
        let runners = runners.each_ref().map(|runner| Instead { runner, scene: &specialized.scene });
        let runners = [&runners[0] as &dyn Runner, &runners[1]];
        let holds = !verify(&scene, &runners, &Options::default())?.fails();
        all_hold &= same && holds;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        println!("| `{name}` | {} |", row(&scene, &specialized, &account, (same, holds)));
    }
    Ok(if all_hold { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The scene files of the folders, in order.
fn scenes(folders: &[String]) -> std::io::Result<Vec<PathBuf>> {
    let mut scenes = Vec::new();
    for folder in folders {
        for entry in std::fs::read_dir(Path::new(folder))? {
            scenes.push(entry?.path());
        }
    }
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes.sort();
    Ok(scenes)
}

fn told(found: Vec<glisten::Diagnostic>) -> String {
    found.into_iter().map(|found| found.message).collect::<Vec<_>>().join("; ")
}

/// The bits of the picture by the reference in f32.
fn bytes(scene: &Scene) -> Result<Vec<u64>, String> {
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    let picture = render(scene, &options).map_err(told)?;
    Ok(picture.attachments.iter().flatten().flatten().map(|value| value.to_bits()).collect())
}

/// The figures of all draws together.
fn row(scene: &Scene, specialized: &SpecializedScene, account: &Account, (same, holds): (bool, bool)) -> String {
    let (mut before, mut after) = ([0, 0], [0, 0]);
    for draw in &account.draws {
        for (sum, one) in [(&mut before, &draw.before), (&mut after, &draw.after)] {
            sum[0] += one.spirv_instructions;
            sum[1] += one.vertex_operations + one.fragment_operations;
        }
    }
    let originals = scene.draws.iter().flat_map(|draw| {
        let types = &draw.program.types;
        draw.program.stages.iter().map(|shader| glisten_front::hir::print(types, shader).lines().count())
    });
    let originals: usize = originals.sum();
    let residuals: usize =
        specialized.draws.iter().flat_map(|draw| &draw.texts).map(|(_, text)| without_comments(text)).sum();
    let yes = |good: bool| if good { "the same" } else { "**differ**" };
    let verdict = if holds { "holds" } else { "**fails**" };
    let [[spirv, operations], [fewer, less]] = [before, after];
    let each = [originals.to_string(), residuals.to_string(), operations.to_string(), less.to_string()];
    format!("{spirv} | {fewer} | {} | {} | {verdict}", each.join(" | "), yes(same))
}

/// The lines of a text that are not comments alone, as the original's are counted.
fn without_comments(text: &str) -> usize {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).count()
}
