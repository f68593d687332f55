//! [`NewFolder`]: the files of the new folder.
//!
//! *In:* the old folder, what replaces its files, what comes besides. *Out:* bytes by name; which of them differ from a folder on disk.
//! *Holds:* hidden folders, such as that of a repository, are left out, and so is the account of an earlier port.

use super::ACCOUNT;
use crate::exit::Failure;
use crate::files;
use crate::search;
use ignore::{DirEntry, WalkBuilder};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// The files of a folder by their names, with slashes.
#[derive(Default)]
pub(super) struct NewFolder {
    files: BTreeMap<String, Vec<u8>>,
    n_replaced: usize,
}

impl NewFolder {
    /// The files of the old folder.
    ///
    /// # Errors
    /// A file or folder that cannot be read.
    pub(super) fn read(root: &Path) -> Result<Self, Failure> {
        let mut new = Self::default();
        let mut walk = WalkBuilder::new(root);
        let is_kept = |entry: &DirEntry| {
            let name = entry.file_name().to_string_lossy();
            // A folder, or the file that stands for one in a work tree.
            let is_hidden = name.starts_with('.') && entry.file_type().is_some_and(|kind| kind.is_dir());
            entry.depth() == 0 || !is_hidden && name != ".git"
        };
        walk.hidden(false).git_ignore(false).ignore(false).require_git(false).filter_entry(is_kept);
        let walk = walk.build();
        for entry in walk {
            let entry = entry.map_err(|error| search::cannot_read(root, &error))?;
            if !entry.file_type().is_some_and(|kind| kind.is_file()) {
                continue;
            }
            let Some(name) = entry.path().strip_prefix(root).ok().map(named) else { continue };
            if ACCOUNT.contains(&name.as_str()) {
                continue;
            }
            let bytes = files::read(&entry.path().to_string_lossy(), entry.path())
                .map_err(|error| Failure::usage(error.message))?;
            new.files.insert(name, bytes);
        }
        Ok(new)
    }

    /// The name of a file of the old folder.
    pub(super) fn place(&self, root: &Path, path: &Path) -> Option<String> {
        let whole = |path: &Path| std::path::absolute(path).ok();
        let relative = whole(path)?.strip_prefix(whole(root)?).ok().map(Path::to_owned)?;
        Some(named(&relative))
    }

    /// The text of a file.
    pub(super) fn text(&self, name: &str) -> Option<String> {
        self.files.get(name).map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    }

    /// The names of all files.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Replaces a file, which may get a new name.
    pub(super) fn replace(&mut self, old: &str, new: &str, bytes: Vec<u8>) {
        if self.files.remove(old).is_some() {
            self.n_replaced += 1;
        }
        self.files.insert(new.to_owned(), bytes);
    }

    /// Takes a file away.
    pub(super) fn remove(&mut self, name: &str) {
        if self.files.remove(name).is_some() {
            self.n_replaced += 1;
        }
    }

    /// Adds a file.
    pub(super) fn add(&mut self, name: &str, bytes: Vec<u8>) {
        self.files.insert(name.to_owned(), bytes);
    }

    /// How many files are those of the old folder.
    pub(super) fn copied(&self) -> usize {
        self.files.len().saturating_sub(self.n_replaced)
    }

    /// The bytes of a file.
    pub(super) fn bytes(&self, name: &str) -> &[u8] {
        self.files.get(name).map_or(&[], Vec::as_slice)
    }

    /// The files that a folder on disk lacks, or has with other bytes.
    pub(super) fn differing(&self, folder: &Path) -> Vec<String> {
        let is_same = |name: &str, bytes: &[u8]| std::fs::read(folder.join(name)).is_ok_and(|there| there == bytes);
        self.files.iter().filter(|(name, bytes)| !is_same(name, bytes)).map(|(name, _)| name.clone()).collect()
    }
}

/// A path with slashes.
fn named(path: &Path) -> String {
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// The folder of a name, and its stem.
pub(super) fn folder_and_stem(name: &str) -> (PathBuf, String) {
    let path = Path::new(name);
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    (path.parent().map(Path::to_owned).unwrap_or_default(), stem)
}
