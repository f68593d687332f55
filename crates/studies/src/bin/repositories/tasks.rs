//! Work of a process of its own: whether Mesa accepts texts, and whether the pictures of a scene agree.
//!
//! *In:* files. *Out:* lines on standard output; 0 if all is well, 1 if not, 3 if the machine lacks a driver.

use glisten::scene::{DiskFiles, load};
use glisten::verify::{Conclusion, OnGpu, OnOpenGl, Options, Runner, Verification, verify};
use glisten::{Compiler, Gl, Gpu, Stage};
use glisten_gpu::Via;
use glisten_reference::LineRule;
use std::process::ExitCode;

/// Whether Mesa accepts the texts of a program.
pub(crate) fn accept(files: &[String]) -> ExitCode {
    let stage = |file: &str| match file.rsplit('.').next() {
        Some("vert") => Stage::Vertex,
        Some("geom") => Stage::Geometry,
        _ => Stage::Fragment,
    };
    let texts: Vec<(Stage, String)> =
        files.iter().map(|file| (stage(file), std::fs::read_to_string(file).unwrap_or_default())).collect();
    let texts: Vec<(Stage, &str)> = texts.iter().map(|(stage, text)| (*stage, text.as_str())).collect();
    match Gl::new().and_then(|gl| gl.accept("a", &texts)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("{error}");
            ExitCode::from(if error.is_environment() { 3 } else { 1 })
        }
    }
}

/// Why a picture is inconclusive. Of what is empty, or undefined by the language, nobody could say more.
fn reason(verification: &Verification) -> String {
    let verdict = verification.runs.first().map(|run| &run.verdict);
    let [covered, undefined] = verdict.map_or([0; 2], |verdict| [verdict.covered, verdict.evidence.undefined]);
    if covered == 0 {
        return "nothing is covered".to_owned();
    }
    if let Some(first) = verification.undefined.first().filter(|_| 20 * undefined > covered) {
        return format!("undefined by the language: {}, line {}", first.what, first.line);
    }
    let Some(weakness) = &verification.weakness else { return "the envelope is wide".to_owned() };
    if weakness.class == "undefined" {
        return format!("undefined by the language: {} of {covered} pixels", weakness.pixels);
    }
    let from = weakness.contributions.first();
    let from = from.map(|one| format!(", by `{}` in line {}", one.operation, one.line));
    format!("{} of {covered} pixels are {}{}", weakness.pixels, weakness.class, from.unwrap_or_default())
}

/// Says that a picture was judged by what is known of the device (`verify --as-device`).
pub(crate) const AS_DEVICE: &str = "judged by what is known of the device";

/// Whether the pictures of a scene by Vulkan and by OpenGL agree with the reference.
pub(crate) fn draw(scene: &str) -> ExitCode {
    let loaded = load(scene, &DiskFiles, &Compiler::new(Default::default()));
    let Some(scene) = loaded.scene else {
        let first = loaded.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
        println!("scene: {}", first.map_or("it does not load", |first| first.message.as_str()));
        return ExitCode::FAILURE;
    };
    let (gpu, gl) = match (Gpu::new(Some("software")), Gl::new()) {
        (Ok(gpu), Ok(gl)) => (gpu, gl),
        (Err(error), _) => return lacking(&error.to_string()),
        (_, Err(error)) => return lacking(&error.to_string()),
    };
    let (spirv, gl) = (OnGpu::new(&gpu, Via::Spirv), OnOpenGl(&gl));
    let mut worst = Conclusion::Holds;
    for (runner, lines) in [(&spirv as &dyn Runner, LineRule::Vulkan), (&gl, LineRule::OpenGl)] {
        let options = Options { as_device: true, lines, ..Options::default() };
        match verify(&scene, &[runner], &options) {
            Ok(verification) => {
                let conclusion = verification.conclusion();
                worst = worst.max(conclusion);
                if verification.runs.iter().any(|run| run.verdict.as_device > 0) {
                    println!("{}: {AS_DEVICE}", runner.name());
                }
                if conclusion == Conclusion::Inconclusive {
                    println!("{}: inconclusive: {}", runner.name(), reason(&verification));
                } else if conclusion == Conclusion::Fails {
                    println!("{}", verification.to_string().lines().next().unwrap_or_default());
                }
            }
            Err(failure) => {
                let text = failure.to_string();
                let mut lines = text.lines();
                let shown = lines.by_ref().take(3).collect::<Vec<_>>().join(" ");
                println!("{}: not drawn: {shown}", runner.name());
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::from(u8::from(worst == Conclusion::Fails))
}

fn lacking(what: &str) -> ExitCode {
    println!("{what}");
    ExitCode::from(3)
}
