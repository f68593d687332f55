//! The programs of a build.
//!
//! *In:* pairs of files, folders, scenes. *Out:* [`Found`] programs, in the order in which they were given, those of a folder
//! in the order of their paths; the errors and warnings of all. *Holds:* no two programs have the same name as a Rust module.

use super::error::BuildError;
use super::files::Reads;
use super::found::{Found, stem};
#[cfg(feature = "reference")]
use super::scenes;
use super::{repeated, rust};
use glisten_front::{Compilation, Compiler, Source, Stage};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A program as it was given.
#[derive(Clone, Debug)]
pub(super) enum Given {
    /// A pair of files.
    Pair(Named),
    /// All programs of a folder.
    Folder(PathBuf),
    /// The programs of a scene.
    #[cfg(feature = "reference")]
    Scene { path: PathBuf, specialized: bool },
}

/// A pair of files with a name.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) vertex: PathBuf,
    pub(super) fragment: PathBuf,
}

/// Extensions, with their stages.
const EXTENSIONS: [(&str, Stage); 6] = [
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
];
/// Folders in folders deeper than this are not searched: they are links in a circle.
const DEEPEST: usize = 32;

impl Named {
    /// The texts of both stages.
    pub(super) fn sources(&self, reads: &Reads) -> Result<[Source; 2], BuildError> {
        let source = |path: &Path, stage| {
            Ok(Source { name: path.to_string_lossy().into_owned(), text: reads.text(path)?, stage })
        };
        Ok([source(&self.vertex, Stage::Vertex)?, source(&self.fragment, Stage::Fragment)?])
    }
}

/// The stage that the name of a file tells.
fn stage(path: &Path) -> Option<Stage> {
    let name = path.file_name()?.to_str()?;
    let (_, extension) = name.strip_suffix(".glsl").unwrap_or(name).rsplit_once('.')?;
    EXTENSIONS.iter().find(|(known, _)| *known == extension).map(|(_, stage)| *stage)
}

fn compile_one(found: &mut Found, named: &Named, compiler: &Compiler, reads: &Reads) -> Result<(), BuildError> {
    let Compilation { program, sources, diagnostics, .. } = compiler.compile(&named.sources(reads)?);
    match (found.hears(&sources, &diagnostics), program) {
        (true, Some(program)) => found.add(named.name.clone(), program, sources),
        _ => found.names.push(named.name.clone()),
    }
    Ok(())
}

/// Compiles all programs.
pub(super) fn compile(given: &[Given], compiler: &Compiler, reads: &Reads) -> Result<Found, BuildError> {
    let mut found = Found::default();
    for one in given {
        match one {
            Given::Pair(named) => compile_one(&mut found, named, compiler, reads)?,
            Given::Folder(folder) => {
                for named in of_folder(folder, reads)? {
                    compile_one(&mut found, &named, compiler, reads)?;
                }
            }
            #[cfg(feature = "reference")]
            Given::Scene { path, specialized } => scenes::compile(path, *specialized, compiler, reads, &mut found),
        }
    }
    let modules: Vec<String> = found.names.iter().map(|name| rust::module_name(name)).collect();
    match repeated(modules.iter().map(String::as_str)) {
        Some(name) => Err(BuildError::SameName(name.to_owned())),
        None => Ok(found),
    }
}

fn of_folder(folder: &Path, reads: &Reads) -> Result<Vec<Named>, BuildError> {
    let mut files = Vec::new();
    search(folder, 0, reads, &mut files)?;
    files.sort();
    let mut found: BTreeMap<PathBuf, [Option<PathBuf>; 2]> = BTreeMap::new();
    for file in files {
        let Some(stage) = stage(&file) else { continue };
        let key = file.with_file_name(stem(&file));
        let [vertex, fragment] = found.entry(key).or_default();
        *(if stage == Stage::Vertex { vertex } else { fragment }) = Some(file);
    }
    if found.is_empty() {
        return Err(BuildError::NoProgram(folder.to_owned()));
    }
    let named = found.into_values().filter_map(|pair| match pair {
        [Some(vertex), Some(fragment)] => Some(Ok(Named { name: stem(&vertex), vertex, fragment })),
        [Some(lone), None] | [None, Some(lone)] => Some(Err(BuildError::NoPartner(lone))),
        [None, None] => None,
    });
    named.collect()
}

/// Adds the files of a folder and of those below it. The folders themselves are remembered, too: a new file changes them.
fn search(folder: &Path, depth: usize, reads: &Reads, files: &mut Vec<PathBuf>) -> Result<(), BuildError> {
    let failed = |error| BuildError::File { path: folder.to_owned(), error };
    reads.add(folder);
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if !path.is_dir() {
            files.push(path);
        } else if depth < DEEPEST {
            search(&path, depth + 1, reads, files)?;
        }
    }
    Ok(())
}
