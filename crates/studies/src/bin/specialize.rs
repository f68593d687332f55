//! Leaves out of the programs of scenes what their pictures do not need, and proves it: a table for a folder of scenes.
//!
//! `cargo run --release -p glisten-studies --bin specialize -- FOLDER...` prints a row for each scene of the folders: SPIR-V instructions
//! and lines of GLSL of all draws before and after, the operations that the reference counts, whether the reference draws
//! the same bytes in f32, and whether `verify` holds for the residual against the original on the first software adapter.
//! It exits with 1 if a picture changes.
//!
//! `--survey FOLDER...` takes all scenes below the folders, each in a process of its own, and prints how many have the same
//! bytes, how many residuals are smaller and larger, and each exception. A residual counts as wrong on a GPU if `verify` fails for
//! it and not for the original, by SPIR-V, WGSL or OpenGL. `repositories --keep DIR` leaves such scenes in `DIR`.

#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "repositories/tools.rs"]
mod tools;

use glisten::scene::{DiskFiles, Scene, load};
use glisten::specialize::specialize_scene;
use glisten::verify::{Conclusion, OnGpu, OnOpenGl, Options, Runner, verify};
use glisten::{Compiler, Gl, Gpu, Precision, RenderOptions, render};
use glisten_verify::specialize::{Account, SpecializedScene, account};
use glisten_verify::verify::{Drawn, Failure};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

/// How long one scene of a survey may take.
const LIMIT: Duration = Duration::from_secs(60);

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
    match folders.split_first() {
        None => return Err("name a folder of scenes".into()),
        Some((word, folders)) if word == "--survey" => return survey(folders),
        Some((word, [scene])) if word == "--one" => return one(scene),
        Some(_) => {}
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

/// Counts the results of all scenes below the folders.
fn survey(folders: &[String]) -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut scenes = Vec::new();
    for folder in folders {
        below(Path::new(folder), &mut scenes)?;
    }
    scenes.sort();
    let (own, work) = (std::env::current_exe()?, tempfile::tempdir()?);
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for scene in &scenes {
        let ended = tools::run(Command::new(&own).arg("--one").arg(scene), work.path(), LIMIT);
        let facts = ended.text().lines().filter_map(|line| Some(line.strip_prefix("= ")?.to_owned()));
        let mut found: Vec<String> = facts.collect();
        if !ended.is_well() {
            found.push(format!("not done: {}", ended.text().lines().last().unwrap_or_default()));
        }
        for what in found {
            let (class, detail) = what.split_once(": ").unwrap_or((&what, ""));
            if !detail.is_empty() {
                println!("{class}\t{}\t{detail}", scene.display());
            }
            *counts.entry(class.to_owned()).or_default() += 1;
        }
    }
    println!("{} scenes", scenes.len());
    counts.iter().for_each(|(class, count)| println!("{count:6} {class}"));
    Ok(if counts.contains_key("differs") { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// All scene files below a folder.
fn below(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            below(&path, found)?;
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
    Ok(())
}

/// Prints the results of one scene, a line for each.
fn one(path: &str) -> Result<ExitCode, Box<dyn std::error::Error>> {
    let loaded = load(path, &DiskFiles, &Compiler::new(Default::default()));
    let Some(scene) = loaded.scene else {
        println!("= not a scene");
        return Ok(ExitCode::SUCCESS);
    };
    let specialized = specialize_scene(&scene, &loaded.sources, &[]);
    let names = vec![[const { String::new() }; 3]; scene.draws.len()];
    let account = account("", &scene, &specialized, &names).map_err(told)?;
    let size = |before: bool| -> u64 {
        account.draws.iter().map(|draw| if before { draw.before } else { draw.after }.spirv_instructions).sum()
    };
    println!("= {}", size_class(size(true), size(false)));
    let same = bytes(&scene)? == bytes(&specialized.scene)?;
    println!("= {}", if same { "the same bytes" } else { "differs: by the reference in f32" });
    let (gpu, gl) = (Gpu::new(Some("software"))?, Gl::new()?);
    let [spirv, wgsl] = OnGpu::both(&gpu);
    let gl = OnOpenGl(&gl);
    let runners: [&dyn Runner; 3] = [&spirv, &wgsl, &gl];
    let residuals = runners.map(|runner| Instead { runner, scene: &specialized.scene });
    let residuals = residuals.each_ref().map(|runner| runner as &dyn Runner);
    match verify(&scene, &residuals, &Options::default()) {
        Ok(all) => all.runs.iter().zip(runners).for_each(|(run, runner)| {
            let fails = || verify(&scene, &[runner], &Options::default()).is_ok_and(|one| one.fails());
            println!(
                "= {}",
                match run.verdict.conclusion(&all.demands) {
                    Conclusion::Holds => format!("holds by {}", runner.name()),
                    Conclusion::Inconclusive => format!("inconclusive by {}", runner.name()),
                    Conclusion::Fails if fails() => format!("fails as the original does by {}", runner.name()),
                    Conclusion::Fails => format!("differs: beyond the original's envelope by {}", runner.name()),
                }
            );
        }),
        Err(_) if verify(&scene, &runners, &Options::default()).is_err() => {
            println!("= not drawn, nor is the original")
        }
        Err(failure) => println!("= differs: not drawn, but the original is: {failure}"),
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether a residual is smaller than its original, in SPIR-V instructions.
fn size_class(before: u64, after: u64) -> String {
    match after.cmp(&before) {
        std::cmp::Ordering::Less => "smaller".to_owned(),
        std::cmp::Ordering::Equal => "as large as before".to_owned(),
        std::cmp::Ordering::Greater => format!("larger: {before} to {after}"),
    }
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
