//! The sources of scene files, shaders, meshes and images.
//!
//! *In:* a path. *Out:* the bytes of the file, or one of the few reasons for failure that matter to a user. *Holds:*
//! the loader itself does no I/O. It asks a [`FileSource`], so tests and pages supply files from memory, and the
//! program uses [`DiskFiles`].

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

/// The largest file that is read: a model of the largest number of triangles as text fits.
pub const MAX_FILE_BYTES: u64 = 1 << 29;

/// The only folder whose files are read, if there is one.
static CONFINED_TO: OnceLock<PathBuf> = OnceLock::new();

/// From now on, this process reads only files in `folder`, where [`DiskFiles`] and [`is_allowed`] are asked. It cannot be undone, and
/// only the first call counts.
///
/// # Errors
/// The folder cannot be found.
pub fn confine_to(folder: &Path) -> io::Result<()> {
    let folder = folder.canonicalize()?;
    if !folder.is_dir() {
        return Err(io::Error::from(ErrorKind::NotADirectory));
    }
    CONFINED_TO.get_or_init(|| folder);
    Ok(())
}

/// The folder of [`confine_to`], if one was named.
pub fn confined_to() -> Option<&'static Path> {
    CONFINED_TO.get().map(PathBuf::as_path)
}

/// Whether the file at `path` may be read: its place after all links are in the folder of [`confine_to`], if one was named. A file that
/// does not exist may be looked for inside of that folder.
pub fn is_allowed(path: &Path) -> bool {
    CONFINED_TO.get().is_none_or(|folder| is_inside(path, folder))
}

/// Whether a path leads into a folder, which is a canonical path. What does not exist is where its nearest folder that exists is.
fn is_inside(path: &Path, folder: &Path) -> bool {
    let path = if path.is_absolute() { path.to_owned() } else { Path::new(".").join(path) };
    let Some((known, place)) = path.ancestors().find_map(|known| Some((known, known.canonicalize().ok()?))) else {
        return false;
    };
    let climbs = path.strip_prefix(known).is_ok_and(|rest| rest.components().any(|part| part == Component::ParentDir));
    !climbs && place.starts_with(folder)
}

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
            Self::Unreadable(reason) => f.write_str(reason),
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

/// The files of a source, with whether one of them could not be read.
pub(crate) struct Noting<'a> {
    files: &'a dyn FileSource,
    failed: Cell<bool>,
}

impl<'a> Noting<'a> {
    pub(crate) fn new(files: &'a dyn FileSource) -> Self {
        Self { files, failed: Cell::new(false) }
    }

    /// Whether a file that was asked for could not be read.
    pub(crate) fn has_failed(&self) -> bool {
        self.failed.get()
    }
}

impl FileSource for Noting<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        self.files.read(path).inspect_err(|_| self.failed.set(true))
    }
}

/// The files of the file system, relative to the working directory.
#[derive(Clone, Copy, Debug, Default)]
pub struct DiskFiles;

impl FileSource for DiskFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let path = Path::new(path);
        if !is_allowed(path) {
            return Err(FileError::Unreadable("it is outside of the sandbox".to_owned()));
        }
        let read = || -> io::Result<Option<Vec<u8>>> {
            if !may_end(path)? {
                return Err(io::Error::other("it is a pipe or a device, not a file"));
            }
            let file = std::fs::File::open(path)?;
            // The length of a pipe is not known before it is read.
            if file.metadata()?.len() > MAX_FILE_BYTES {
                return Ok(None);
            }
            let mut bytes = Vec::new();
            file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
            Ok((bytes.len() as u64 <= MAX_FILE_BYTES).then_some(bytes))
        };
        match read() {
            Ok(Some(bytes)) => Ok(bytes),
            Ok(None) => Err(FileError::Unreadable(format!("it is larger than {} MiB", MAX_FILE_BYTES >> 20))),
            Err(error) if error.kind() == ErrorKind::NotFound => Err(FileError::Missing),
            Err(error) if error.kind() == ErrorKind::IsADirectory => Err(FileError::Folder),
            Err(error) => Err(FileError::Unreadable(error.to_string())),
        }
    }
}

/// Whether a path leads to a file, or to a folder, which has an error of its own. A pipe may have no writer, and a device no end; a pipe
/// that the shell has opened for this process (`<(command)`, `/dev/stdin`) has a writer.
///
/// # Errors
/// There is nothing at the path.
pub fn may_end(path: &Path) -> io::Result<bool> {
    let kind = std::fs::metadata(path)?.file_type();
    let is_own = ["/dev/fd", "/dev/stdin", "/proc/self/fd"].iter().any(|own| path.starts_with(own));
    Ok(kind.is_file() || kind.is_dir() || is_own)
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
    match Path::new(from).parent() {
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
    fn links_are_followed_before_a_path_is_judged() {
        let outside = tempfile::tempdir().expect("a folder");
        let inside = outside.path().join("inside");
        std::fs::create_dir(&inside).expect("a folder");
        std::fs::write(outside.path().join("secret"), "x").expect("a file");
        std::fs::write(inside.join("open"), "x").expect("a file");
        let folder = inside.canonicalize().expect("it is there");
        assert!(is_inside(&inside.join("open"), &folder) && is_inside(&inside.join("no/missing"), &folder));
        assert!(!is_inside(&inside.join("../secret"), &folder) && !is_inside(&inside.join("../missing"), &folder));
        assert!(!is_inside(&inside.join("no/../../secret"), &folder) && !is_inside(Path::new("/dev/zero"), &folder));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("../secret", inside.join("link")).expect("a link");
            assert!(!is_inside(&inside.join("link"), &folder));
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_never_ends_is_not_read() {
        let Err(FileError::Unreadable(reason)) = DiskFiles.read("/dev/zero") else { panic!("it was read") };
        assert!(reason.contains("a device"), "{reason}");
    }

    #[test]
    fn the_disk_tells_missing_files_from_folders() {
        let folder = env!("CARGO_MANIFEST_DIR");
        assert_eq!(DiskFiles.read(folder), Err(FileError::Folder));
        assert_eq!(DiskFiles.read(&format!("{folder}/no such file")), Err(FileError::Missing));
    }
}
