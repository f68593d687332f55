//! [`Disk`]: who reads the files that sources include.

use std::path::Path;
use std::sync::Arc;

/// Reads files, and is told what else a source depends on.
pub(crate) trait Disk: Send + Sync {
    /// The text of a file; an empty file has an empty text.
    ///
    /// # Errors
    /// A sentence that names the file.
    fn text(&self, path: &Path) -> Result<Arc<str>, String>;
    /// It matters whether there is a file.
    fn looked_for(&self, path: &Path);
    /// A whole tree of folders was searched.
    fn searched(&self);
}

/// Reads files and remembers nothing.
#[cfg(test)]
pub(super) struct Plain;

#[cfg(test)]
impl Disk for Plain {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        let is_folder = if path.is_dir() { "it is a folder" } else { "" };
        std::fs::read_to_string(path).map(Into::into).map_err(|error| format!("{error} ({is_folder})"))
    }

    fn looked_for(&self, _: &Path) {}

    fn searched(&self) {}
}
