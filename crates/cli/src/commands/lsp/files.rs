//! Which files of a workspace the language server looks at: those that may include a header, and the scenes.
//!
//! *In:* folders. *Out:* files. *Holds:* folders are searched as `glisten lint` searches them, once until something changes.

use crate::files;
use crate::search;
use glisten_sources::stages;
use ignore::WalkBuilder;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest number of files of a folder that are looked at.
const MAX_FILES: usize = 20_000;
/// The largest scene file that is looked at.
const MAX_SCENE: u64 = 1 << 20;
/// The largest file that is looked at because an include may name it: stems are those of textures and meshes, too.
const MAX_HEADER: u64 = 1 << 20;

/// The names in the include directives of the files of some folders.
#[derive(Debug, Default)]
pub(crate) struct Includes {
    /// The stems of the included names, for each file.
    names: BTreeMap<PathBuf, BTreeSet<String>>,
    folders: BTreeSet<PathBuf>,
}

impl Includes {
    /// Reads the files of a folder, unless that has been done.
    pub(crate) fn add(&mut self, folder: &Path) {
        if self.folders.iter().any(|known| folder.starts_with(known)) || !self.folders.insert(folder.to_owned()) {
            return;
        }
        let Ok(walk) = search::files(folder) else { return };
        let is_source = |path: &PathBuf| stages::by_name(path).is_some() || stages::may_be_combined(path);
        let (mut next, mut others): (Vec<PathBuf>, Vec<PathBuf>) = walk.files.into_iter().partition(is_source);
        next.truncate(MAX_FILES);
        // What these include is a source whatever its name ends in.
        while !next.is_empty() {
            let mut wanted: BTreeSet<String> = BTreeSet::new();
            for path in next {
                if let Ok(bytes) = files::read(&path.to_string_lossy(), &path) {
                    let names = included(&String::from_utf8_lossy(&bytes));
                    wanted.extend(names.iter().cloned());
                    self.names.insert(path, names);
                }
            }
            (next, others) = others.into_iter().partition(|path| wanted.contains(&stem(path)));
            next.retain(|path| path.metadata().is_ok_and(|metadata| metadata.len() <= MAX_HEADER));
        }
    }

    /// Notes the text of a file that is open.
    pub(crate) fn set(&mut self, file: &Path, text: &str) {
        self.names.insert(file.to_owned(), included(text));
    }

    /// All files.
    pub(crate) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.names.keys()
    }

    /// The files that may include a file, directly or not; those that name it themselves first.
    pub(crate) fn of(&self, file: &Path) -> Vec<PathBuf> {
        let mut found: Vec<PathBuf> = Vec::new();
        let mut known: BTreeSet<PathBuf> = BTreeSet::new();
        let mut wanted: BTreeSet<String> = [stem(file)].into();
        let mut seen = wanted.clone();
        while !wanted.is_empty() {
            let fits = |(path, names): &(&PathBuf, &BTreeSet<String>)| !names.is_disjoint(&wanted) && *path != file;
            let next: Vec<PathBuf> = self.names.iter().filter(fits).map(|(path, _)| path.clone()).collect();
            wanted = next.iter().map(|path| stem(path)).filter(|stem| seen.insert(stem.clone())).collect();
            for path in next {
                if known.insert(path.clone()) {
                    found.push(path);
                }
            }
        }
        found
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The stems of the names in the include directives of a text, whatever the engine calls them.
fn included(text: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for line in text.lines() {
        let Some(directive) = line.trim_start().strip_prefix('#') else { continue };
        if !directive.contains("include") && !directive.contains("import") {
            continue;
        }
        let Some(start) = directive.find(['"', '<']) else { continue };
        let rest = directive.get(start + 1..).unwrap_or("");
        let name = rest.split(['"', '>']).next().unwrap_or("");
        names.insert(stem(Path::new(name)));
    }
    names
}

/// The scene files in folders and below them, with their texts.
pub(crate) fn scenes(folders: &[PathBuf]) -> Vec<(PathBuf, Arc<str>)> {
    let mut found: BTreeMap<PathBuf, Arc<str>> = BTreeMap::new();
    for folder in folders {
        for entry in WalkBuilder::new(folder).build().filter_map(Result::ok).take(MAX_FILES) {
            let is_toml = entry.path().extension().is_some_and(|extension| extension == "toml");
            if !is_toml || entry.metadata().is_ok_and(|metadata| metadata.len() > MAX_SCENE) {
                continue;
            }
            let text = files::read(&entry.path().to_string_lossy(), entry.path()).ok();
            let text = text.and_then(|bytes| String::from_utf8(bytes).ok());
            if let Some(text) = text.filter(|text| text.contains("[[draw]]")) {
                found.insert(entry.path().to_owned(), text.into());
            }
        }
    }
    found.into_iter().collect()
}

/// The names of the files and folders (with a `/`) in a folder that an include could name.
pub(crate) fn listed(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok().filter(|name| !name.starts_with('.'))?;
            if entry.path().is_dir() {
                return Some(format!("{name}/"));
            }
            let path = entry.path();
            let is_text = stages::may_be_included(&path) || stages::by_name(&path).is_some() || name.ends_with(".h");
            is_text.then_some(name)
        })
        .take(MAX_FILES)
        .collect();
    names.sort();
    names
}
