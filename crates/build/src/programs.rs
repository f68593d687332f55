//! The programs of a build.
//!
//! *In:* pairs of files, folders, scenes. *Out:* [`Found`] programs, in the order in which they were given, those of a folder
//! in the order of their paths; the errors and warnings of all. *Holds:* no two programs have the same name as a Rust module.

use super::error::BuildError;
use super::files::Reads;
use super::found::Found;
#[cfg(feature = "reference")]
use super::scenes;
use super::{repeated, rust};
use glisten_front::{Compilation, Compiler, Source, Stage};
use glisten_sources::engines::Member;
use glisten_sources::{members, stages};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
    /// The index of the program in its file, if the file has several.
    pub(super) member: Option<usize>,
}

/// Folders in folders deeper than this are not searched: they are links in a circle.
const DEEPEST: usize = 32;

impl Named {
    /// The texts of both stages.
    fn sources(&self, reads: &Reads) -> Result<[Source; 2], BuildError> {
        let source = |path: &Path, stage| {
            let text = reads.text(path)?;
            Ok(Source { name: path.to_string_lossy().into_owned(), text: self.part(path, &text, stage), stage })
        };
        Ok([source(&self.vertex, Stage::Vertex)?, source(&self.fragment, Stage::Fragment)?])
    }

    /// The text of a stage, where the file has several programs; otherwise the whole text.
    fn part(&self, path: &Path, text: &Arc<str>, stage: Stage) -> Arc<str> {
        let Some(index) = self.member else { return Arc::clone(text) };
        let members = members(Some(path), text);
        let part = members.get(index).and_then(|member| member.part(stage));
        part.map_or_else(|| Arc::clone(text), |part| part.text(text))
    }
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
    let own = ["glisten_memory".to_owned()].into_iter();
    let modules: Vec<String> = found.names.iter().map(|name| rust::module_name(name)).chain(own).collect();
    match repeated(modules.iter().map(String::as_str)) {
        Some(name) => Err(BuildError::SameName(name.to_owned())),
        None => Ok(found),
    }
}

/// The programs of a folder: pairs of files, and files of several stages.
fn of_folder(folder: &Path, reads: &Reads) -> Result<Vec<Named>, BuildError> {
    let mut files = Vec::new();
    search(folder, 0, reads, &mut files)?;
    files.sort();
    let mut pairs: BTreeMap<PathBuf, [Option<PathBuf>; 2]> = BTreeMap::new();
    let mut named = Vec::new();
    for file in files {
        match stages::by_name(&file) {
            _ if stages::is_part(&file) || stages::is_assembly(&file) => {}
            Some(Stage::Geometry) => return Err(BuildError::Geometry(file)),
            Some(stage) => {
                let [vertex, fragment] = pairs.entry(file.with_file_name(stages::stem(&file))).or_default();
                *(if stage == Stage::Vertex { vertex } else { fragment }) = Some(file);
            }
            None if stages::may_be_combined(&file) => named.extend(of_file(&file, reads)?),
            None => {}
        }
    }
    for pair in pairs.into_values() {
        match pair {
            [Some(vertex), Some(fragment)] => {
                named.push(Named { name: stages::stem(&vertex), vertex, fragment, member: None });
            }
            [Some(lone), None] | [None, Some(lone)] => return Err(BuildError::NoPartner(lone)),
            [None, None] => {}
        }
    }
    if named.is_empty() {
        return Err(BuildError::NoProgram(folder.to_owned()));
    }
    named.sort_by(|a, b| a.vertex.cmp(&b.vertex));
    Ok(named)
}

/// The programs of a file of several stages.
fn of_file(file: &Path, reads: &Reads) -> Result<Vec<Named>, BuildError> {
    let members = members(Some(file), &reads.text(file)?);
    let program = |(index, member): (usize, Member)| {
        let has = |stage| member.part(stage).is_some();
        (has(Stage::Vertex) && has(Stage::Fragment)).then(|| Named {
            member: member.name.is_some().then_some(index),
            name: member.name.unwrap_or_else(|| stages::stem(file)),
            vertex: file.to_owned(),
            fragment: file.to_owned(),
        })
    };
    Ok(members.into_iter().enumerate().filter_map(program).collect())
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
