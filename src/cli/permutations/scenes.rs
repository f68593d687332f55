//! Scenes among permutations: each draw's program without what its scene does not need.
//!
//! *In:* a scene file. *Out:* for each draw, the outputs of the residual program, as an entry of the index. *Holds:* the same
//! residuals as `glisten specialize` writes ([`crate::specialize`]). *Not done here:* no cache holds them, since a scene reads
//! meshes and pictures, too.

use super::Run;
use super::axes::Variant;
use super::file::SceneTable;
use super::index::Entry;
use crate::cli::depfile::{self, Made};
use crate::cli::exit::{Exit, Failure};
use crate::cli::guard;
use crate::cli::inputs::{Group, Input};
use crate::cli::outputs::Output;
use crate::cli::session::Unit;
use crate::scene::{self, DiskFiles};
use crate::sources::stages;
use crate::specialize::{Contract, SpecializedScene, specialize_scene_by};
use std::path::{Path, PathBuf};

impl Run<'_> {
    /// Adds the draws of a scene. Returns the exit code.
    pub(super) fn scene(&mut self, table: &SceneTable) -> Result<Exit, Failure> {
        let name = Path::new(&table.file).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        if self.made.iter().any(|made| made.program == name) {
            let message = format!("the scene `{}` and something else are both named `{name}`", table.file);
            return Err(Failure::usage(message).help("give the program a `name`, or rename the scene"));
        }
        let loaded = guard::guarded(|| scene::load(&table.file, &DiskFiles, self.session.compiler()));
        let loaded = loaded.map_err(|panic| Failure::new(Exit::Content, format!("internal error: {panic}")))?;
        let mut unit = Unit::new(Group { name: name.clone(), inputs: Vec::new() });
        unit.batch.sources = loaded.sources;
        self.session.read_configuration(&table.file);
        self.session.add(&mut unit.batch, loaded.diagnostics);
        let mut exit = unit.exit();
        if loaded.io_error {
            exit = exit.max(Exit::Usage);
        }
        if let Some(scene) = loaded.scene.filter(|_| exit == Exit::Ok) {
            let special = specialize_scene_by(Contract::default(), &scene, &unit.batch.sources, &table.dynamic);
            self.residuals(&name, &special, &mut unit)?;
            exit = unit.exit();
        } else {
            exit = exit.max(Exit::Content);
        }
        let sources = depfile::files_read(&unit.group, &unit.batch.sources);
        self.made.push(Made { program: name, outputs: Vec::new(), sources });
        self.units.push(unit);
        Ok(exit)
    }

    fn residuals(&mut self, name: &str, special: &SpecializedScene, unit: &mut Unit) -> Result<(), Failure> {
        let mut emitted: Vec<(Group, Vec<Output>)> = Vec::new();
        for (draw, residual) in special.scene.draws.iter().zip(&special.draws) {
            if let Some(fault) = &residual.fault {
                let message = format!("internal error: a residual of `{name}` does not read back: {fault}");
                return Err(Failure::new(Exit::Content, message).help("please report it with the scene"));
            }
            let stem = draw.program.name.clone();
            let input = |stage| {
                let file = format!("{stem}.{}", stages::extension(stage));
                Input { path: Some(PathBuf::from(&file)), name: file, stage, part: None }
            };
            let inputs = draw.program.stages.iter().map(|shader| input(shader.stage)).collect();
            let group = Group { name: stem.clone(), inputs };
            match self.plan.emit(&group, &draw.program, &residual.sources) {
                Ok(outputs) => emitted.push((group, outputs)),
                Err(errors) => {
                    let why = errors.first().map_or_else(String::new, |error| error.message.clone());
                    let message = format!("a draw of `{name}` cannot be written: {why}");
                    return Err(Failure::new(Exit::Content, message).help("name other targets with `--target`"));
                }
            }
        }
        self.variants += emitted.len();
        unit.group.name = name.to_owned();
        let entries = emitted.iter().enumerate().map(|(draw, (group, outputs))| Entry {
            defines: Variant::new(),
            draw: Some(draw),
            group,
            outputs,
        });
        self.shaders += self.index.add(name, &self.plan, entries);
        Ok(())
    }
}
