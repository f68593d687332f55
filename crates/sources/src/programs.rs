//! [`ProgramFiles`]: the programs that files of JSON next to shaders describe, as Minecraft has them.
//!
//! *In:* a source. *Out:* the macros of its program. *Holds:* the files of a folder are read once.

use super::disk::Disk;
use crate::engines::GameProgram;
use glisten_front::compiler::Source;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Programs by the names of their files, without the extension.
type Programs = Arc<BTreeMap<String, GameProgram>>;

/// The programs of each folder so far.
#[derive(Clone, Debug, Default)]
pub struct ProgramFiles(Arc<Mutex<BTreeMap<PathBuf, Programs>>>);

impl ProgramFiles {
    /// The macros of the program that a source belongs to: of several, the one with its name, otherwise the first.
    pub(super) fn macros(&self, source: &Source, disk: &dyn Disk) -> Vec<(String, String)> {
        let path = Path::new(&source.name);
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let programs = known.entry(folder.to_owned()).or_insert_with(|| Arc::new(programs_in(folder, disk)));
        let programs = Arc::clone(programs);
        drop(known);
        if !programs.is_empty() {
            // The result depends on which files there are.
            disk.searched();
        }
        let own = path.file_stem().and_then(|stem| programs.get(&*stem.to_string_lossy()));
        let fits = |program: &&GameProgram| program.has(source.stage, path);
        let program = own.filter(fits).or_else(|| programs.values().find(fits));
        program.map(|program| program.defines().collect()).unwrap_or_default()
    }
}

/// The programs with macros that files of JSON in a folder describe.
fn programs_in(folder: &Path, disk: &dyn Disk) -> BTreeMap<String, GameProgram> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut programs = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).filter(|_| is_json);
        let Some(stem) = stem else { continue };
        let program = disk.text(&path).ok().and_then(|text| GameProgram::read(&text));
        if let Some(program) = program.filter(GameProgram::has_defines) {
            programs.insert(stem, program);
        }
    }
    programs
}
