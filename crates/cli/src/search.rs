//! Searches a folder for shaders.
//!
//! *In:* a folder. *Out:* the shaders in it and in its subfolders, and the files that look like shaders and were not taken, each with
//! the reason. *Holds:* both are in the order of their names. What `.gitignore` or the `exclude` of a configuration names is in
//! neither, nor is a `.glsl` file that is there to be included.

use crate::arguments::config::{self, Nearest};
use crate::arguments::engine::Engines;
use crate::exit::Failure;
use crate::files;
use crate::inputs;
use glisten_sources::stages;
use ignore::WalkBuilder;
use ignore::gitignore::Gitignore;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A file that a search saw and did not take.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Left {
    /// The file.
    pub(crate) path: PathBuf,
    /// The reason.
    pub(crate) why: Why,
}

/// Why a search does not take a file that looks like a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Why {
    /// Its name tells a stage, and it has no `main`: it is there to be included.
    NoMain,
    /// It is in the assembly language of ARB_vertex_program.
    Assembly,
    /// It has a `main`, and neither its name nor its text tells its stage.
    NoStage,
    /// Macros of its language make shaders of their arguments.
    Macros,
    /// Its stage is none that glisten reads.
    Stage(&'static str),
}

/// The result of a search.
#[derive(Debug, Default)]
pub(crate) struct Search {
    /// The shaders.
    pub(crate) found: Vec<PathBuf>,
    /// The files that were not taken.
    pub(crate) left: Vec<Left>,
    /// The folders in it that cannot be read.
    pub(crate) unreadable: Vec<PathBuf>,
}

impl Search {
    /// Takes the files whose names tell no stage, because the command line tells it.
    pub(crate) fn take_without_stage(&mut self) {
        let is_taken = |left: &mut Left| left.why == Why::NoStage;
        self.found.extend(self.left.extract_if(.., is_taken).map(|left| left.path));
        self.found.sort();
    }
}

/// The files and folders that a walk through a folder finds.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    /// The files that look like shaders.
    pub(crate) files: Vec<PathBuf>,
    /// The folders that cannot be read. A command that reads them as files tells so, as for any other file.
    pub(crate) unreadable: Vec<PathBuf>,
}

/// Searches a folder. Hidden folders are skipped, and links to folders are not followed, so that a cycle of links does no harm.
///
/// # Errors
/// A folder that cannot be read.
pub(crate) fn folder(root: &Path, engines: &Engines) -> Result<Search, Failure> {
    let walk = files(root)?;
    let mut search = Search { unreadable: walk.unreadable, ..Search::default() };
    for path in walk.files {
        match classify(&path, engines) {
            Some(Ok(())) => search.found.push(path),
            Some(Err(why)) => search.left.push(Left { path, why }),
            None => {}
        }
    }
    search.found.sort();
    search.left.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(search)
}

/// The sources in a folder that have a style: all shaders, and what is there to be included. Folders that cannot be read are among them.
///
/// # Errors
/// A folder that cannot be read.
pub(crate) fn texts(root: &Path) -> Result<Vec<PathBuf>, Failure> {
    let is_source = |path: &PathBuf| {
        let named = stages::by_name(path).is_some() || stages::unread(path).is_some() || stages::may_be_included(path);
        named && !stages::is_assembly(path)
    };
    let walk = files(root)?;
    let mut found: Vec<PathBuf> = walk.files.into_iter().filter(is_source).chain(walk.unreadable).collect();
    found.sort();
    Ok(found)
}

/// The files in a folder, but for those that are excluded.
///
/// # Errors
/// The folder itself cannot be read.
pub(crate) fn files(root: &Path) -> Result<Walk, Failure> {
    let mut excludes = Excludes::default();
    let mut walk = WalkBuilder::new(root);
    // Without a repository, `.gitignore` says as much about what is generated.
    walk.hidden(false).require_git(false).filter_entry(|entry| entry.depth() == 0 || !is_hidden_folder(entry));
    let mut found = Walk::default();
    // `./a.frag` is `a.frag` to services that show findings.
    let shown = |path: &Path| path.strip_prefix(".").unwrap_or(path).to_owned();
    for entry in walk.build() {
        let entry = match entry {
            Ok(entry) => entry,
            Err(error) => {
                let folder = unread_below(&error, root).ok_or_else(|| cannot_read(root, &error))?;
                if !excludes.has(folder, true) {
                    found.unreadable.push(shown(folder));
                }
                continue;
            }
        };
        if !entry.file_type().is_some_and(|kind| kind.is_dir()) && may_end(&entry) && !excludes.has(entry.path(), false)
        {
            found.files.push(shown(entry.path()));
        }
    }
    Ok(found)
}

/// The failure to read a folder: the root of a walk, or one below it.
pub(crate) fn cannot_read(root: &Path, error: &ignore::Error) -> Failure {
    let folder = unread_below(error, root).unwrap_or(root).display();
    let reason = error.io_error().map_or_else(|| error.to_string(), ToString::to_string);
    Failure::usage(format!("cannot read the folder `{folder}`: {reason}"))
}

/// The folder below the root that an error of a walk is about.
fn unread_below<'e>(error: &'e ignore::Error, root: &Path) -> Option<&'e Path> {
    match error {
        ignore::Error::WithPath { path, .. } => Some(path.as_path()).filter(|path| *path != root),
        ignore::Error::WithDepth { err, .. } | ignore::Error::WithLineNumber { err, .. } => unread_below(err, root),
        _ => None,
    }
}

/// Whether a search takes a file: its name tells its stage, or its engine does, or it contains several stages. `None` for a file
/// that does not look like a shader.
pub(crate) fn classify(path: &Path, engines: &Engines) -> Option<Result<(), Why>> {
    if engines.is_part(path) {
        return None;
    }
    if let Some(stage) = stages::unread(path) {
        return Some(Err(Why::Stage(stage)));
    }
    let is_whole = stages::by_name(path).is_some() || engines.stage(path).is_some() && stages::may_be_included(path);
    if is_whole {
        return Some(match () {
            () if stages::is_part(path) => Err(Why::NoMain),
            () if stages::is_assembly(path) => Err(Why::Assembly),
            () => Ok(()),
        });
    }
    if stages::may_be_combined(path) && !inputs::parts(path).is_empty() {
        return Some(Ok(()));
    }
    (stages::may_be_included(path) && !stages::is_part(path)).then_some(Err(Why::NoStage))
}

/// Whether an entry is a file, or a link to one or to nothing. Pipes and devices may never end.
fn may_end(entry: &ignore::DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| kind.is_file())
        || entry.path().metadata().map_or(true, |there| there.is_file())
}

fn is_hidden_folder(entry: &ignore::DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| kind.is_dir()) && entry.file_name().to_string_lossy().starts_with('.')
}

/// The patterns that configurations exclude.
#[derive(Default)]
struct Excludes {
    nearest: Nearest,
    by_file: HashMap<PathBuf, Option<Gitignore>>,
}

impl Excludes {
    /// Whether the nearest configuration excludes a file or folder, or a folder that it is in.
    fn has(&mut self, path: &Path, is_folder: bool) -> bool {
        let Some(file) = self.nearest.of(path.parent().unwrap_or(Path::new(""))) else { return false };
        let patterns = self.by_file.entry(file).or_insert_with_key(|file| config::excluded(file));
        patterns.as_ref().is_some_and(|patterns| is_excluded(patterns, &files::real(path), is_folder))
    }
}

/// Whether patterns exclude a file or folder, or one of the folders that it is in, of which none brings it back: "It is not possible to
/// re-include a file if a parent directory of that file is excluded" (gitignore).
fn is_excluded(patterns: &Gitignore, path: &Path, is_folder: bool) -> bool {
    let Ok(below) = path.strip_prefix(patterns.path()) else { return false };
    let mut ancestors: Vec<&Path> = below.ancestors().filter(|part| !part.as_os_str().is_empty()).collect();
    ancestors.reverse();
    ancestors.iter().any(|part| patterns.matched(part, is_folder || *part != below).is_ignore())
}
