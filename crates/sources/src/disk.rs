//! [`Disk`]: who reads the files that sources include.

use glisten_front::source::line_end_length;
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
    /// Whether a file is there, but is no text. [`Self::text`] says so in words.
    fn is_binary(&self, _path: &Path) -> bool {
        false
    }
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

/// The text of a file, with a line feed for each carriage return that ends a line alone (GLSL 1.50 §3.1), so that whatever reads lines
/// sees them. Offsets stay.
pub fn with_line_feeds(text: String) -> String {
    let mut bytes = text.into_bytes();
    let mut at = 0;
    while let Some(rest) = bytes.get(at..).filter(|rest| !rest.is_empty()) {
        let length = line_end_length(rest);
        if length == 1
            && let Some(byte) = bytes.get_mut(at)
        {
            *byte = b'\n';
        }
        at += length.max(1);
    }
    // One sign of ASCII for another leaves the text valid.
    String::from_utf8(bytes).unwrap_or_default()
}

/// Reads files and remembers nothing.
pub(super) struct Plain;

impl Disk for Plain {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        if path.is_dir() {
            return Err(format!("`{}` cannot be read: it is a folder", path.display()));
        }
        let bytes = read_bounded(path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))?;
        Ok(with_line_feeds(String::from_utf8_lossy(&bytes).into_owned()).into())
    }

    fn looked_for(&self, _: &Path) {}

    fn searched(&self) {}
}

#[cfg(test)]
mod tests {
    use super::with_line_feeds;

    #[test]
    fn lines_end_with_line_feeds() {
        assert_eq!(with_line_feeds("a\rb\r\nc\r\r\né\r".to_owned()), "a\nb\r\nc\n\r\né\n");
        assert_eq!(with_line_feeds("a\n\rb\n\r\n\r".to_owned()), "a\n\rb\n\r\n\n");
    }
}
