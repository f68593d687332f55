//! The texts that the page shows of a scene: findings, texts, controls, reflection, the programs in another language.
//!
//! *In:* a scene that was read. *Out:* one JSON object. *Holds:* the findings are those of `glisten lint` for the same programs, in
//! the form of its `--format json`; each program of the scene is told once.

use super::super::batch::Batch;
use super::super::guard;
use super::super::optimize;
use super::super::session::Session;
use super::controls::controls;
use crate::scene::{Loaded, Scene};
use crate::specialize::{SpecializedScene, specialize_scene};
use glisten_emit::{Conventions, Emitted, Target, emit, reflect};
use glisten_front::diagnostic::{Code, Levels, write};
use glisten_front::link::Program;
use glisten_front::lint::check_some;
use glisten_front::source::SourceMap;
use serde_json::{Value, json};
use std::sync::Arc;

/// How the programs are shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// The language.
    pub(super) target: Target,
    /// Whether they are without what the picture does not need.
    pub(super) leaves_out: bool,
}

/// The answer for a scene file, with the scene if there is one.
pub(super) fn look(session: &mut Session<'_>, name: &str, loaded: Loaded, shown: Shown) -> (Value, Option<Scene>) {
    let Loaded { scene, sources, diagnostics, .. } = loaded;
    session.read_configuration(name);
    let programs = scene.as_ref().map(programs).unwrap_or_default();
    let mut found: Vec<_> = diagnostics.into_iter().collect();
    for program in &programs {
        found.extend(lints(session, program, &sources));
    }
    let mut batch = Batch { sources, diagnostics: Vec::new() };
    session.add(&mut batch, found);
    let findings: Value = serde_json::from_str(&write::json(&session.findings(&batch), None)).unwrap_or_default();
    let sources = &batch.sources;
    let text = sources.files().next().map(|(_, file)| file.text().to_owned()).unwrap_or_default();
    let residual = scene.as_ref().filter(|_| shown.leaves_out).map(|scene| specialize_scene(scene, sources, &[]));
    let answer = json!({
        "findings": findings,
        "files": files(sources),
        "controls": controls(&text),
        "programs": translations(&programs, residual.as_ref(), shown.target),
        "size": scene.as_ref().map(|scene| [scene.framebuffer.width, scene.framebuffer.height]),
    });
    (answer, scene)
}

/// The programs of a scene, each once.
fn programs(scene: &Scene) -> Vec<Arc<Program>> {
    let mut programs: Vec<Arc<Program>> = Vec::new();
    for draw in &scene.draws {
        if !programs.iter().any(|program| Arc::ptr_eq(program, &draw.program)) {
            programs.push(Arc::clone(&draw.program));
        }
    }
    programs
}

fn lints(
    session: &mut Session<'_>,
    program: &Program,
    sources: &SourceMap,
) -> Vec<glisten_front::diagnostic::Diagnostic> {
    let levels: Vec<Levels> = sources.files().map(|(_, file)| session.levels_of(file.name())).collect();
    let wanted = |code: &Code| levels.iter().any(|levels| levels.may_report(code));
    guard::guarded(|| check_some(program, sources, wanted)).unwrap_or_default()
}

/// The texts that were read, the scene file first.
fn files(sources: &SourceMap) -> Vec<Value> {
    let file =
        |(_, file): (_, &glisten_front::source::SourceFile)| json!({ "name": file.name(), "text": &**file.text() });
    sources.files().map(file).collect()
}

/// Each program in the language, with its reflection.
fn translations(programs: &[Arc<Program>], residual: Option<&SpecializedScene>, target: Target) -> Vec<Value> {
    let of_residual = residual.map(|residual| self::programs(&residual.scene));
    let programs = of_residual.as_deref().unwrap_or(programs);
    programs.iter().map(|program| translation(program, target)).collect()
}

fn translation(program: &Program, target: Target) -> Value {
    let conventions = Conventions::default();
    let made = guard::guarded(|| {
        let optimized = optimize::optimized(program, true);
        let mut reflection = reflect(&optimized, &conventions);
        let stage = |stage| match emit(&optimized, stage, target, &conventions) {
            Ok(Emitted::Text(text)) => json!({ "stage": stage.name(), "text": text }),
            Ok(Emitted::Words(words)) => json!({ "stage": stage.name(), "n_words": words.len() }),
            Err(errors) => json!({ "stage": stage.name(), "error": super::pictures::told(&errors) }),
        };
        let stages: Vec<Value> = optimized.stages.iter().map(|shader| stage(shader.stage)).collect();
        reflection.compact();
        json!({ "name": program.name, "stages": stages, "reflection": reflection })
    });
    made.unwrap_or_else(
        |panic| json!({ "name": program.name, "stages": [], "error": format!("internal error: {panic}") }),
    )
}
