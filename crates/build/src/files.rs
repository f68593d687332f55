//! Files of a build: [`Reads`] remembers which were read; [`write()`] leaves a file alone that is up to date.

use super::error::BuildError;
use glisten_sources::{Disk, read_bounded, with_line_feeds};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The files and folders that were read so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Reads(Arc<Mutex<BTreeSet<PathBuf>>>);

impl Reads {
    /// Remembers a file, or a folder that was searched.
    pub(super) fn add(&self, path: &Path) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }

    /// All of them, in order.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    /// The text of a file. Bytes that are not UTF-8 are replaced: they are legal in comments only.
    pub(super) fn text(&self, path: &Path) -> Result<Arc<str>, BuildError> {
        self.add(path);
        let bytes = read_bounded(path).map_err(|error| BuildError::File { path: path.to_owned(), error })?;
        Ok(with_line_feeds(String::from_utf8_lossy(&bytes).into_owned()).into())
    }
}

impl Disk for Reads {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        Self::text(self, path).map_err(|error| error.to_string())
    }

    /// Cargo would run a build script every time if it were told of a file that is not there.
    fn looked_for(&self, _: &Path) {}

    fn searched(&self) {}
}

/// Writes a file if that changes it. The text appears under its name at once, so that nobody reads a part of it.
pub(super) fn write(path: &Path, text: &str) -> Result<(), BuildError> {
    if fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    let failed = |error| BuildError::File { path: path.to_owned(), error };
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(failed)?;
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let unfinished = folder.join(name);
    fs::write(&unfinished, text).and_then(|()| fs::rename(&unfinished, path)).map_err(|error| {
        // What is left of it is of no use; that it cannot be removed changes nothing.
        let _ = fs::remove_file(&unfinished);
        failed(error)
    })
}
