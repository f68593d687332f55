//! Compares translators by what their code draws: each stage of each scene, translated by glslang and naga, is drawn in
//! place of glisten's, and judged by the envelope.
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin translators -- fixtures/scenes [--list]
//! ```
//!
//! The arguments are scene files and folders, which are searched recursively. A stage counts as *translated* if a
//! translator writes a module for it, as *fitting* if its interface is the one that `glisten compile` gives, and then by
//! the verdict on its picture. glslang is `glslangValidator`, with the flags that help it with old sources (`-R --aml
//! --amb`); naga is `naga`, from SPIR-V to WGSL. `--list` prints each stage. It needs a Vulkan software adapter, both
//! programs, and `spirv-val`.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

use glisten::emit::{Conventions, Emitted, Target, emit};
use glisten::scene::{DiskFiles, Scene, load};
use glisten::verify::{Conclusion, Options};
use glisten::{Compiler, Gpu, Stage};
use glisten_gpu::{Foreign, Via};
use glisten_verify::scene::Draw;
use glisten_verify::verify::Expected;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// The stages that are translated.
const STAGES: [Stage; 2] = [Stage::Vertex, Stage::Fragment];

/// The fates of the stages of one translator.
#[derive(Default)]
struct Row {
    stages: u32,
    translated: u32,
    fitting: u32,
    holds: u32,
    inconclusive: u32,
    fails: u32,
}

/// A translator: its name, its form, and how it brings a stage to a module.
type Translator = (&'static str, Via, fn(&Draw, Stage, &Path) -> Option<Vec<u8>>);

static TRANSLATORS: &[Translator] = &[
    ("glisten, SPIR-V", Via::Spirv, glisten_spirv),
    ("glisten, WGSL", Via::Wgsl, glisten_wgsl),
    ("glslang, SPIR-V", Via::Spirv, glslang),
    ("glslang, then naga, WGSL", Via::Wgsl, glslang_and_naga),
];

fn main() -> ExitCode {
    let (mut files, mut list) = (Vec::new(), false);
    for word in std::env::args().skip(1) {
        match word.as_str() {
            "--list" => list = true,
            path => scene_files(Path::new(path), &mut files),
        }
    }
    if files.is_empty() {
        eprintln!("usage: translators SCENE|FOLDER... [--list]");
        return ExitCode::from(2);
    }
    files.sort();
    let gpu = match Gpu::new(Some("software")) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(3);
        }
    };
    let mut rows: Vec<Row> = TRANSLATORS.iter().map(|_| Row::default()).collect();
    for path in &files {
        let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Default::default()));
        let Some(scene) = loaded.scene else { continue };
        let options = Options::default();
        let Ok(mut expected) = Expected::new(&scene, &options) else { continue };
        for (translator, row) in TRANSLATORS.iter().zip(&mut rows) {
            for (number, stage) in stages(&scene) {
                let told = one(&gpu, &scene, (number, stage), translator, &mut expected, row);
                if list {
                    println!("{} draw {number} {}: {}: {told}", path.display(), stage.name(), translator.0);
                }
            }
        }
    }
    println!("| translator | stages | translated | fitting | holds | inconclusive | fails |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for ((name, ..), Row { stages, translated, fitting, holds, inconclusive, fails }) in TRANSLATORS.iter().zip(rows) {
        println!("| {name} | {stages} | {translated} | {fitting} | {holds} | {inconclusive} | {fails} |");
    }
    ExitCode::SUCCESS
}

/// The stages of all draws; equal programs once.
fn stages(scene: &Scene) -> Vec<(usize, Stage)> {
    let mut found = Vec::new();
    for (number, draw) in scene.draws.iter().enumerate() {
        let is_new =
            scene.draws.iter().take(number).all(|other| !std::sync::Arc::ptr_eq(&other.program, &draw.program));
        let own = STAGES.into_iter().filter(|stage| is_new && draw.program.stage(*stage).is_some());
        found.extend(own.map(|stage| (number, stage)));
    }
    found
}

/// Judges one stage of one draw.
fn one(
    gpu: &Gpu,
    scene: &Scene,
    (number, stage): (usize, Stage),
    (_, via, translate): &Translator,
    expected: &mut Expected<'_>,
    row: &mut Row,
) -> String {
    row.stages += 1;
    let Some(draw) = scene.draws.get(number) else { return "no such draw".to_owned() };
    let folder = tempfile::tempdir().expect("a folder for temporary files can be made");
    let Some(bytes) = translate(draw, stage, folder.path()) else { return "not translated".to_owned() };
    row.translated += 1;
    let drawn = Foreign::read(Some(number), stage, "module", &bytes, *via)
        .and_then(|module| gpu.prepare_foreign(scene, *via, &[module], &glisten_specialize::optimize))
        .and_then(|prepared| gpu.draw(&prepared));
    let picture = match drawn {
        Ok(rendered) => rendered.picture,
        Err(error) => return error.to_string().lines().next().unwrap_or_default().to_owned(),
    };
    row.fitting += 1;
    let Ok(verdict) = expected.compare(&picture) else { return "the reference cannot draw it".to_owned() };
    let conclusion = verdict.conclusion(&Options::default().demands);
    match conclusion {
        Conclusion::Holds => row.holds += 1,
        Conclusion::Inconclusive => row.inconclusive += 1,
        Conclusion::Fails => row.fails += 1,
    }
    format!("{conclusion:?}, {} outside, {} covered on one side", verdict.outside, verdict.coverage_mismatch)
}

fn glisten_spirv(draw: &Draw, stage: Stage, _: &Path) -> Option<Vec<u8>> {
    ours(draw, stage, Target::Spirv)
}

fn glisten_wgsl(draw: &Draw, stage: Stage, _: &Path) -> Option<Vec<u8>> {
    ours(draw, stage, Target::Wgsl)
}

fn ours(draw: &Draw, stage: Stage, target: Target) -> Option<Vec<u8>> {
    let conventions = Conventions {
        clip_distances: Some(draw.state.clip_distances),
        program_point_size: draw.state.program_point_size,
        ..Conventions::default()
    };
    match emit(&draw.program, stage, target, &conventions).ok()? {
        Emitted::Text(text) => Some(text.into_bytes()),
        Emitted::Words(words) => Some(words.iter().flat_map(|word| word.to_le_bytes()).collect()),
    }
}

fn glslang(draw: &Draw, stage: Stage, folder: &Path) -> Option<Vec<u8>> {
    std::fs::read(glslang_file(draw, stage, folder)?).ok()
}

fn glslang_and_naga(draw: &Draw, stage: Stage, folder: &Path) -> Option<Vec<u8>> {
    let (input, output) = (glslang_file(draw, stage, folder)?, folder.join("out.wgsl"));
    run(Command::new("naga").arg("--keep-coordinate-space").args([&input, &output]))?;
    std::fs::read(output).ok()
}

/// The SPIR-V that glslang makes of a stage's text.
fn glslang_file(draw: &Draw, stage: Stage, folder: &Path) -> Option<PathBuf> {
    let [text] = &draw.program.stage(stage)?.texts[..] else { return None };
    let (input, output) = (folder.join("in.glsl"), folder.join("out.spv"));
    std::fs::write(&input, text.as_bytes()).ok()?;
    let name = if stage == Stage::Vertex { "vert" } else { "frag" };
    run(Command::new("glslangValidator")
        .args(["-V", "-R", "--aml", "--amb", "-S", name, "-o"])
        .args([&output, &input]))?;
    Some(output)
}

fn run(command: &mut Command) -> Option<()> {
    let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status().ok()?;
    status.success().then_some(())
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
