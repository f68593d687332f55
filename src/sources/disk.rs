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
#[cfg(any(test, feature = "reference"))]
pub(super) struct Plain;

#[cfg(any(test, feature = "reference"))]
impl Disk for Plain {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        if path.is_dir() {
            return Err(format!("`{}` cannot be read: it is a folder", path.display()));
        }
        let bytes = std::fs::read(path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))?;
        Ok(String::from_utf8_lossy(&bytes).into())
    }

    fn looked_for(&self, _: &Path) {}

    fn searched(&self) {}
}
