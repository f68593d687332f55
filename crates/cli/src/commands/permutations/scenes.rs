//! Scenes among permutations: each draw's program without what its scene does not need.
//!
//! *In:* a scene file. *Out:* for each draw, the outputs of the residual program, as an entry of the index. *Holds:* the same
//! residuals as `glisten specialize` writes ([`glisten_verify::specialize`]); a cache keeps the outputs of all draws of a scene as one
//! result, which depends on every file that the scene reads: shaders, meshes and pictures.

use super::Run;
use super::file::SceneTable;
use super::index::Entry;
use crate::cache::Kept;
use crate::depfile::{self, Made};
use crate::digest::Digest;
use crate::exit::{Exit, Failure};
use crate::files::SceneFiles;
use crate::inputs::{Group, Input};
use crate::outputs::Output;
use crate::process::guard;
use crate::session::Unit;
use crate::trace;
use crate::variants::Variant;
use glisten_front::hir::Stage;
use glisten_front::source::SourceMap;
use glisten_sources::stages;
use glisten_verify::scene::{self, Scene};
use glisten_verify::specialize::{Contract, SpecializedDraw, SpecializedScene, specialize_scene_by};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The draws of a scene, each with the outputs of its program.
type Draws = Vec<(Group, Vec<Output>)>;

/// The result of a scene.
struct Done {
    draws: Draws,
    /// The files that were read.
    files: Vec<String>,
    exit: Exit,
}

/// A draw, for the cache: what its outputs are of.
#[derive(Serialize, Deserialize)]
struct KeptDraw {
    program: String,
    /// The names of its stages.
    stages: Vec<String>,
    /// How many of the outputs it has.
    outputs: usize,
}

impl Run<'_> {
    /// Adds the draws of a scene. Returns the exit code.
    pub(super) fn scene(&mut self, table: &SceneTable) -> Result<Exit, Failure> {
        let name = Path::new(&table.file).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        if self.made.iter().any(|made| made.program == name) {
            let message = format!("the scene `{}` and something else are both named `{name}`", table.file);
            return Err(Failure::usage(message).help("give the program a `name`, or rename the scene"));
        }
        let mut unit = Unit::new(Group::new(name.clone(), Vec::new()));
        self.session.read_configuration(&table.file);
        let (kept, key) = self.recall.scene(&table.file, &format!("{:?}", table.dynamic));
        let known = kept.and_then(|kept| Some((recalled(&kept)?, kept)));
        let done = match known {
            Some((done, kept)) => {
                unit.batch.sources = kept.sources;
                self.session.add(&mut unit.batch, kept.diagnostics);
                done
            }
            None => self.specialized(table, key, &mut unit)?,
        };
        let exit = unit.exit().max(done.exit);
        if exit == Exit::Ok {
            self.add_draws(&name, &done.draws);
        }
        self.made.push(Made { program: name, outputs: Vec::new(), sources: done.files });
        self.units.push(unit);
        Ok(exit)
    }

    /// Specializes a scene, and keeps the result.
    fn specialized(&mut self, table: &SceneTable, key: Option<Digest>, unit: &mut Unit) -> Result<Done, Failure> {
        let load = || scene::load(&table.file, &SceneFiles, self.session.compiler());
        let (loaded, trace) = trace::recorded(|| guard::guarded(load));
        let loaded = loaded.map_err(|panic| Failure::new(Exit::Content, format!("internal error: {panic}")))?;
        unit.batch.sources = loaded.sources;
        let diagnostics = loaded.diagnostics.clone().into_iter().collect();
        self.session.add(&mut unit.batch, loaded.diagnostics);
        let texts = depfile::files_read(&unit.group, &unit.batch.sources);
        let files: BTreeSet<&str> = texts.iter().map(String::as_str).chain(trace.files()).collect();
        let files: Vec<String> = files.into_iter().map(str::to_owned).collect();
        let Some(scene) = loaded.scene.filter(|_| unit.exit() == Exit::Ok && !loaded.io_error) else {
            let exit = if loaded.io_error { Exit::Usage } else { Exit::Content };
            return Ok(Done { draws: Draws::new(), files, exit });
        };
        let draws = self.residuals(&unit.group.name, &scene, &table.dynamic, &unit.batch.sources)?;
        let sources = unit.batch.sources.clone();
        let kept = Kept { outputs: kept_outputs(&draws, &files), sources, diagnostics, ..Kept::default() };
        self.recall.keep_scene(key, &trace, &kept);
        Ok(Done { draws, files, exit: Exit::Ok })
    }

    fn residuals(&self, name: &str, scene: &Scene, dynamic: &[String], sources: &SourceMap) -> Result<Draws, Failure> {
        let special: SpecializedScene = specialize_scene_by(Contract::default(), scene, sources, dynamic);
        let emit = |(draw, residual): (&scene::Draw, &SpecializedDraw)| {
            if let Some(fault) = &residual.fault {
                let message = format!("internal error: a residual of `{name}` does not read back: {fault}");
                return Err(Failure::new(Exit::Content, message).help("please report it with the scene"));
            }
            let group = group(&draw.program.name, draw.program.stages.iter().map(|shader| shader.stage));
            let outputs = self.plan.emit(&group, &draw.program, &residual.sources).map_err(|errors| {
                let why = errors.first().map_or_else(String::new, |error| error.message.clone());
                let message = format!("a draw of `{name}` cannot be written: {why}");
                Failure::new(Exit::Content, message).help("name other targets with `--target`")
            })?;
            Ok((group, outputs))
        };
        special.scene.draws.iter().zip(&special.draws).map(emit).collect()
    }

    fn add_draws(&mut self, name: &str, draws: &Draws) {
        self.variants += draws.len();
        let entries = draws.iter().enumerate().map(|(draw, (group, outputs))| Entry {
            defines: Variant::new(),
            draw: Some(draw),
            group,
            outputs,
        });
        self.shaders += self.index.add(name, &self.plan, entries);
    }
}

/// The files that a program of these stages would have.
fn group(program: &str, stages: impl Iterator<Item = Stage>) -> Group {
    let input = |stage| {
        let file = format!("{program}.{}", stages::extension(stage));
        Input { path: Some(PathBuf::from(&file)), name: file, stage, part: None }
    };
    Group::new(program, stages.map(input).collect())
}

/// The outputs of all draws for the cache; the first tells whose they are and what was read.
fn kept_outputs(draws: &Draws, files: &[String]) -> Vec<Output> {
    let told = |(group, outputs): &(Group, Vec<Output>)| KeptDraw {
        program: group.name.clone(),
        stages: group.inputs.iter().map(|input| input.stage.name().to_owned()).collect(),
        outputs: outputs.len(),
    };
    let head: (Vec<KeptDraw>, &[String]) = (draws.iter().map(told).collect(), files);
    // Only a map whose keys are no texts could fail.
    let head = serde_json::to_vec(&head).unwrap_or_default();
    let first: Output = ("draws".to_owned(), head.into());
    [first].into_iter().chain(draws.iter().flat_map(|(_, outputs)| outputs.iter().cloned())).collect()
}

/// Reads [`kept_outputs`] back.
fn recalled(kept: &Kept) -> Option<Done> {
    let ((_, head), outputs) = kept.outputs.split_first()?;
    let (told, files): (Vec<KeptDraw>, Vec<String>) = serde_json::from_slice(head).ok()?;
    let mut rest = outputs;
    let mut draws = Draws::new();
    for KeptDraw { program, stages, outputs } in told {
        let (own, others) = rest.split_at_checked(outputs)?;
        rest = others;
        let of = |word: &String| Stage::ALL.into_iter().find(|stage| stage.name() == word);
        let stages: Vec<Stage> = stages.iter().map(of).collect::<Option<_>>()?;
        draws.push((group(&program, stages.into_iter()), own.to_vec()));
    }
    Some(Done { draws, files, exit: Exit::Ok })
}
