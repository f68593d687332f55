//! [`Survey`]: the programs in files and folders as the commands see them, for the tools of this repository.
//!
//! *In:* arguments as those of `glisten lint`. *Out:* each program, compiled, with the texts that a driver gets. *Holds:* a panic is a
//! message; nothing is printed.

use crate::arguments::args::{BindingArgs, ProgramArgs, SourceArgs};
use crate::arguments::engine::Engines;
use crate::exit::Failure;
use crate::fullscreen;
use crate::inputs::{self, Group};
use crate::process::guard;
use crate::session;
use clap::Parser;
use glisten_front::compiler::{Compilation, Compiler};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_verify::scene::{self, DiskFiles, Scene};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// The arguments.
#[derive(Debug, Parser)]
#[command(name = "survey", no_binary_name = true)]
struct SurveyArgs {
    files: Vec<PathBuf>,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
}

/// Programs to compile.
pub struct Survey {
    compiler: Compiler,
    groups: Vec<Group>,
}

/// A program.
pub struct Surveyed {
    /// Its files, each with its stage.
    pub files: Vec<(String, Stage)>,
    /// The compilation, or the message of a panic.
    pub compiled: Result<Compilation, String>,
    /// The time of the compilation.
    pub time: Duration,
}

impl Survey {
    /// The programs that these arguments name.
    ///
    /// # Errors
    /// The arguments are wrong, or a folder cannot be read.
    pub fn new(arguments: &[String]) -> Result<Self, String> {
        let args = SurveyArgs::try_parse_from(arguments).map_err(|error| error.to_string())?;
        let engines = Engines::new(&args.sources).map_err(told)?;
        let groups = inputs::collect(&args.files, &args.programs, &args.sources, true).map_err(told)?.groups;
        Ok(Self { compiler: session::compiler(&args.sources, &BindingArgs::default(), &engines), groups })
    }

    /// At most so many of the programs, evenly chosen.
    #[must_use]
    pub fn sampled(self, most: usize) -> Self {
        let (count, most) = (self.groups.len(), self.groups.len().min(most).max(1));
        // Evenly: the index enters a new one of `most` parts.
        let is_kept = |index: usize| index == 0 || index * most / count != (index - 1) * most / count;
        let groups = self.groups.into_iter().enumerate().filter(|(index, _)| is_kept(*index)).map(|(_, group)| group);
        Self { compiler: self.compiler, groups: groups.collect() }
    }

    /// Compiles the programs, one after the other. Files that cannot be read are left out.
    pub fn programs(self) -> impl Iterator<Item = Surveyed> {
        let Self { compiler, groups } = self;
        groups.into_iter().map(move |group| {
            let sources: Vec<_> = group.inputs.iter().filter_map(|input| session::read(input).ok()).collect();
            let files = sources.iter().map(|source| (source.name.clone(), source.stage)).collect();
            let start = Instant::now();
            let compiled = guard::guarded(|| compiler.compile(&sources));
            Surveyed { files, compiled, time: start.elapsed() }
        })
    }
}

/// A vertex shader that draws a triangle over the window for a program with a fragment stage alone.
///
/// # Errors
/// The fragment stage reads what such a triangle has no values for.
pub fn covering(program: &Program) -> Result<String, String> {
    let fragment = program.stage(Stage::Fragment).ok_or("there is no fragment stage")?;
    fullscreen::vertex_shader(&program.types, fragment).map_err(told)
}

/// The scene of a file, as the commands load it.
#[must_use]
pub fn scene(path: &str) -> Option<Scene> {
    let args = SurveyArgs::try_parse_from(std::iter::empty::<String>()).ok()?;
    let engines = Engines::new(&args.sources).ok()?;
    scene::load(path, &DiskFiles, &session::compiler(&args.sources, &BindingArgs::default(), &engines)).scene
}

fn told(failure: Failure) -> String {
    failure.message
}
