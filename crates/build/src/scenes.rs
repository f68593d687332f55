//! Programs of scenes.
//!
//! *In:* the path of a scene file. *Out:* the programs of its draws, on request without what its picture does not need.
//! *Holds:* draws with one program have one module; every file that the scene reads is remembered.

use super::files::Reads;
use super::found::Found;
use glisten_front::Compiler;
use glisten_front::hir::Stage;
use glisten_front::source::SourceMap;
use glisten_scene::DiskFiles;
use glisten_sources::stages::stem;
use glisten_verify::scene::{FileError, FileSource, Scene, load};
use glisten_verify::specialize::specialize_scene;
use std::path::Path;
use std::sync::Arc;

/// Files on disk that are remembered.
struct Remembered<'a>(&'a Reads);

impl FileSource for Remembered<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        self.0.add(Path::new(path));
        DiskFiles.read(path)
    }
}

/// Adds the programs of a scene.
pub(super) fn compile(path: &Path, specialized: bool, compiler: &Compiler, reads: &Reads, found: &mut Found) {
    let loaded = load(&path.to_string_lossy(), &Remembered(reads), compiler);
    if !found.hears(&loaded.sources, &loaded.diagnostics) {
        return;
    }
    let Some(scene) = loaded.scene else { return };
    let programs = if specialized { residuals(&scene, &loaded.sources) } else { originals(&scene, &loaded.sources) };
    let (stem, single) = (stem(path), programs.len() == 1);
    for (number, (program, sources)) in programs.into_iter().enumerate() {
        let name = if single { stem.clone() } else { format!("{stem}_{number}") };
        found.add(name, program, sources);
    }
}

type Programs = Vec<(glisten_front::Program, SourceMap)>;

/// Each program once.
fn originals(scene: &Scene, sources: &SourceMap) -> Programs {
    let mut seen = Vec::new();
    let mut programs = Programs::new();
    for draw in &scene.draws {
        let pointer = Arc::as_ptr(&draw.program);
        if !seen.contains(&pointer) {
            seen.push(pointer);
            programs.push(((*draw.program).clone(), sources.clone()));
        }
    }
    programs
}

/// Each residual once.
fn residuals(scene: &Scene, sources: &SourceMap) -> Programs {
    let specialized = specialize_scene(scene, sources, &[]);
    let mut seen: Vec<[String; 2]> = Vec::new();
    let mut programs = Programs::new();
    for (draw, told) in specialized.scene.draws.iter().zip(&specialized.draws) {
        let texts = [Stage::Vertex, Stage::Fragment].map(|stage| told.text(stage).to_owned());
        if !seen.contains(&texts) {
            seen.push(texts);
            let sources = if told.fault.is_some() { sources } else { &told.sources };
            programs.push(((*draw.program).clone(), sources.clone()));
        }
    }
    programs
}
