//! [`Watch`]: what Cargo is told to watch.
//!
//! *In:* the files and folders that were read. *Out:* the paths for `cargo::rerun-if-changed`. *Holds:* no path is below another
//! one: Cargo looks at everything below a folder, however deep, and knows no other way to notice a new file.

use std::path::{Path, PathBuf};

/// The choice between folders and files.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Watch {
    /// The folders that were searched with all that is below them, and the other files that were read.
    #[default]
    Folders,
    /// The files that were read.
    Files,
}

impl Watch {
    /// The paths to watch.
    pub(super) fn paths(self, read: &[PathBuf]) -> Vec<&Path> {
        let folders: Vec<&PathBuf> = match self {
            Self::Folders => read.iter().filter(|path| path.is_dir()).collect(),
            Self::Files => Vec::new(),
        };
        let is_below = |path: &Path| folders.iter().any(|folder| path != *folder && path.starts_with(folder));
        let files = read.iter().filter(|path| folders.contains(path) || !path.is_dir());
        files.map(PathBuf::as_path).filter(|path| !is_below(path)).collect()
    }
}
