//! [`Folders`]: finds the files that `#include` names, for build scripts.
//!
//! *Holds:* `"x"` is searched next to the including file, then in the folders in order; `<x>` in the folders, then among the
//! modules of the library. A path that begins with `/` starts at a folder.

use super::files::Reads;
use crate::library::Embedded;
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::path::{Path, PathBuf};

/// Files on disk, then the library.
pub(super) struct Folders {
    folders: Vec<PathBuf>,
    library: Embedded,
    reads: Reads,
}

impl Folders {
    pub(super) fn new(folders: Vec<PathBuf>, library: Embedded, reads: Reads) -> Self {
        Self { folders, library, reads }
    }
}

impl IncludeResolver for Folders {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        if let (IncludeForm::Quoted, Some(module)) = (form, Embedded::find(path, form, from)) {
            return Ok(module);
        }
        let inner = path.trim_start_matches('/');
        let own = Path::new(from).parent().filter(|_| form == IncludeForm::Quoted && inner == path);
        let mut candidates =
            own.into_iter().chain(self.folders.iter().map(PathBuf::as_path)).map(|one| one.join(inner));
        let Some(found) = candidates.find(|candidate| candidate.is_file()) else {
            return self.library.resolve(path, form, from);
        };
        let text = self.reads.text(&found).map_err(|error| error.to_string())?;
        Ok(Included { name: found.to_string_lossy().into_owned(), text })
    }
}
