//! [`Disk`]: who reads the files that sources include.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

/// Reads files, and is told what else a source depends on.
pub trait Disk: Send + Sync {
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

/// The largest source that is read; the compiler has a smaller limit of its own for all texts of a shader.
const MAX_BYTES: u64 = 64 << 20;

/// The bytes of a file. What is longer than any source is an error, and so is a device, or a pipe, which may never end.
pub fn read_bounded(path: &Path) -> io::Result<Vec<u8>> {
    let kind = std::fs::metadata(path)?.file_type();
    if !kind.is_file() && !kind.is_dir() {
        return Err(io::Error::other("it is a pipe or a device, not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("it is larger than {} MiB", MAX_BYTES >> 20)));
    }
    Ok(bytes)
}

/// Reads files and remembers nothing.
pub(super) struct Plain;

impl Disk for Plain {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        if path.is_dir() {
            return Err(format!("`{}` cannot be read: it is a folder", path.display()));
        }
        let bytes = read_bounded(path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))?;
        Ok(String::from_utf8_lossy(&bytes).into())
    }

    fn looked_for(&self, _: &Path) {}

    fn searched(&self) {}
}
