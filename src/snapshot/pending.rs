//! Pictures that wait for a decision: `NAME.new.png` in a folder `snapshots`.
//!
//! *In:* a folder. *Out:* the pending pictures below it, in the order of their names; accepted, they take the place of the stored
//! ones. *Holds:* hidden folders, `target` and links are passed over.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The ends of the names of a pending picture, and of the picture of its differences.
pub const NEW: &str = ".new.png";
/// See [`NEW`].
pub const DIFFERENCE: &str = ".difference.png";

/// How deep folders are searched.
const MAX_DEPTH: usize = 64;

/// A picture that waits for a decision.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pending {
    /// The name, without the folder and the end.
    pub name: String,
    folder: PathBuf,
}

impl Pending {
    /// The pending picture with a name in a folder, whether or not it exists.
    pub fn new(folder: &Path, name: &str) -> Self {
        Self { name: name.to_owned(), folder: folder.to_owned() }
    }

    /// The path of the new picture.
    pub fn new_picture(&self) -> PathBuf {
        self.folder.join(format!("{}{NEW}", self.name))
    }

    /// The path of the stored picture.
    pub fn stored(&self) -> PathBuf {
        self.folder.join(format!("{}.png", self.name))
    }

    /// The path of the picture of the differences.
    pub fn difference(&self) -> PathBuf {
        self.folder.join(format!("{}{DIFFERENCE}", self.name))
    }

    /// Makes the new picture the stored one.
    ///
    /// # Errors
    /// A file cannot be renamed or removed.
    pub fn accept(&self) -> io::Result<()> {
        fs::rename(self.new_picture(), self.stored())?;
        removed(&self.difference())
    }

    /// Removes the new picture.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn reject(&self) -> io::Result<()> {
        removed(&self.new_picture())?;
        removed(&self.difference())
    }
}

fn removed(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// All pending pictures below a folder.
///
/// # Errors
/// The folder cannot be read.
pub fn find(folder: &Path) -> io::Result<Vec<Pending>> {
    let mut found = Vec::new();
    search(folder, 0, &mut found)?;
    found.sort();
    Ok(found)
}

fn search(folder: &Path, depth: usize, found: &mut Vec<Pending>) -> io::Result<()> {
    let is_snapshots = folder.file_name().is_some_and(|name| name == "snapshots");
    for entry in fs::read_dir(folder)?.filter_map(Result::ok) {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Ok(kind) = entry.file_type() else { continue };
        if kind.is_dir() && depth < MAX_DEPTH && !name.starts_with('.') && name != "target" {
            // A folder that cannot be read has nothing to show.
            let _ = search(&entry.path(), depth + 1, found);
        } else if kind.is_file()
            && is_snapshots
            && let Some(name) = name.strip_suffix(NEW)
        {
            found.push(Pending::new(folder, name));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::find;
    use std::fs;

    #[test]
    fn pending_pictures_are_found_and_decided() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        for name in
            ["a/snapshots/x.new.png", "a/snapshots/x.difference.png", "a/snapshots/x.png", "a/snapshots/y.new.png"]
        {
            fs::create_dir_all(path(name).parent().expect("a folder")).expect("made");
            fs::write(path(name), name).expect("written");
        }
        for name in ["target/snapshots/z.new.png", "other/z.new.png"] {
            fs::create_dir_all(path(name).parent().expect("a folder")).expect("made");
            fs::write(path(name), name).expect("written");
        }
        let found = find(folder.path()).expect("found");
        assert_eq!(found.iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["x", "y"]);
        found[0].accept().expect("accepted");
        found[1].reject().expect("rejected");
        assert_eq!(fs::read_to_string(path("a/snapshots/x.png")).expect("stored"), "a/snapshots/x.new.png");
        assert!(!path("a/snapshots/x.difference.png").exists() && !path("a/snapshots/y.new.png").exists());
        assert!(find(folder.path()).expect("found").is_empty());
    }
}
