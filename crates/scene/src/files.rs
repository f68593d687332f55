//! The sources of scene files, shaders, meshes and images.
//!
//! *In:* a path. *Out:* the bytes of the file, or one of the few reasons for failure that matter to a user. *Holds:*
//! the loader itself does no I/O. It asks a [`FileSource`], so tests and pages supply files from memory, and the
//! program uses [`DiskFiles`].

use std::collections::BTreeMap;
use std::fmt;
use std::io::ErrorKind;

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// There is no such file.
    Missing,
    /// The path is a folder.
    Folder,
    /// The file exists but cannot be read; the text is the system's reason.
    Unreadable(String),
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("there is no such file"),
            Self::Folder => f.write_str("it is a folder, not a file"),
            Self::Unreadable(reason) => write!(f, "it cannot be read: {reason}"),
        }
    }
}

/// Supplies files to the loader.
pub trait FileSource {
    /// The bytes of the file at `path`.
    ///
    /// # Errors
    /// The reason for the failure.
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError>;
}

/// The files of the file system, relative to the working directory.
#[derive(Clone, Copy, Debug, Default)]
pub struct DiskFiles;

impl FileSource for DiskFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        std::fs::read(path).map_err(|error| match error.kind() {
            ErrorKind::NotFound => FileError::Missing,
            ErrorKind::IsADirectory => FileError::Folder,
            _ => FileError::Unreadable(error.to_string()),
        })
    }
}

/// Files in memory, by path.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles(pub BTreeMap<String, Vec<u8>>);

impl MemoryFiles {
    /// Files from a list of paths and texts.
    pub fn new<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Self(files.into_iter().map(|(path, text)| (path.to_owned(), text.as_bytes().to_vec())).collect())
    }
}

impl FileSource for MemoryFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        self.0.get(path).cloned().ok_or(FileError::Missing)
    }
}

/// The path of a file that the file at `from` refers to: relative to its folder, unless it is absolute.
pub(crate) fn relative_to(from: &str, path: &str) -> String {
    match std::path::Path::new(from).parent() {
        Some(folder) => folder.join(path).to_string_lossy().into_owned(),
        None => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_relative_to_the_naming_file() {
        assert_eq!(relative_to("scenes/a.toml", "a.vert"), "scenes/a.vert");
        assert_eq!(relative_to("a.toml", "a.vert"), "a.vert");
        assert_eq!(relative_to("scenes/a.toml", "/b/a.vert"), "/b/a.vert");
    }

    #[test]
    fn the_disk_tells_missing_files_from_folders() {
        let folder = env!("CARGO_MANIFEST_DIR");
        assert_eq!(DiskFiles.read(folder), Err(FileError::Folder));
        assert_eq!(DiskFiles.read(&format!("{folder}/no such file")), Err(FileError::Missing));
    }
}
