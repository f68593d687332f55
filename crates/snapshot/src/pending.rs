//! Pending snapshots: pictures `NAME.new.png`, and texts of insta, in a folder `snapshots`.
//!
//! *In:* a folder. *Out:* the pending snapshots below it, in the order of their names; pictures that are accepted take the place of
//! the stored ones. *Holds:* hidden folders, `target` and links are passed over. Texts are found and not changed: they are insta's.

use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The ends of the names of a pending picture, and of the picture of its differences.
pub const NEW: &str = ".new.png";
/// See [`NEW`].
pub const DIFFERENCE: &str = ".difference.png";

/// The end of the name of the file that tells why a picture is pending.
pub const REFUSAL: &str = ".new.json";
/// The ends of the names of a pending text of insta: one of a file, those that are in a test's source.
const TEXT: &str = ".snap.new";
const INLINE: &str = ".pending-snap";

/// How deep folders are searched.
const MAX_DEPTH: usize = 64;

/// Why a picture no longer fits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Refusal {
    /// The reason as a sentence without its first capital letter.
    pub because: String,
    /// The criterion: `exact`, `flip`, `envelope`, `size`, or `unseen` if nothing is stored.
    pub criterion: String,
    /// The limit of the criterion, if it has one.
    pub limit: Option<f64>,
    /// The number that is beyond the limit.
    pub found: Option<f64>,
    /// The number of pixels that differ.
    pub pixels: u64,
    /// The number of all pixels.
    pub of: u64,
    /// By how many steps of 8 bits they differ at most.
    pub steps: u8,
}

/// A text that waits for a decision.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PendingText {
    /// The name, without the folder and the end.
    pub name: String,
    /// The path of the new text.
    pub path: PathBuf,
}

impl PendingText {
    /// The stored text and the new one, without what insta writes above them; `None` for texts in the source of a test.
    pub fn texts(&self) -> Option<[String; 2]> {
        let file = self.path.file_name()?.to_str()?;
        let stored = self.path.with_file_name(file.strip_suffix(".new")?);
        let contents = |path: &Path| fs::read_to_string(path).map(|text| without_head(&text).to_owned());
        Some([contents(&stored).unwrap_or_default(), contents(&self.path).ok()?])
    }
}

/// The text after the lines between `---` with which a snapshot of insta begins.
fn without_head(text: &str) -> &str {
    let body = text.strip_prefix("---\n").and_then(|rest| rest.split_once("\n---\n"));
    body.map_or(text, |(_, body)| body)
}

/// All that is pending below a folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AllPending {
    /// Pictures.
    pub pictures: Vec<Pending>,
    /// Texts.
    pub texts: Vec<PendingText>,
}

impl AllPending {
    /// The number of snapshots.
    pub fn count(&self) -> usize {
        self.pictures.len() + self.texts.len()
    }
}

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

    /// The path of the file that tells why it is pending.
    pub fn refusal_file(&self) -> PathBuf {
        self.folder.join(format!("{}{REFUSAL}", self.name))
    }

    /// Why it is pending, if the test left that.
    pub fn refusal(&self) -> Option<Refusal> {
        serde_json::from_slice(&fs::read(self.refusal_file()).ok()?).ok()
    }

    /// Makes the new picture the stored one.
    ///
    /// # Errors
    /// A file cannot be renamed or removed.
    pub fn accept(&self) -> io::Result<()> {
        fs::rename(self.new_picture(), self.stored())?;
        removed(&self.refusal_file())?;
        removed(&self.difference())
    }

    /// Removes the new picture.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn reject(&self) -> io::Result<()> {
        removed(&self.new_picture())?;
        removed(&self.refusal_file())?;
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
    Ok(find_all(folder)?.pictures)
}

/// All pending snapshots below a folder.
///
/// # Errors
/// The folder cannot be read.
pub fn find_all(folder: &Path) -> io::Result<AllPending> {
    let mut found = AllPending::default();
    search(folder, 0, &mut found)?;
    found.pictures.sort();
    found.texts.sort();
    Ok(found)
}

fn search(folder: &Path, depth: usize, found: &mut AllPending) -> io::Result<()> {
    let is_snapshots = folder.file_name().is_some_and(|name| name == "snapshots");
    for entry in fs::read_dir(folder)?.filter_map(Result::ok) {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Ok(kind) = entry.file_type() else { continue };
        if kind.is_dir() && depth < MAX_DEPTH && !name.starts_with('.') && name != "target" {
            // A folder that cannot be read has nothing to show.
            let _ = search(&entry.path(), depth + 1, found);
        } else if kind.is_file() {
            let text = || name.strip_suffix(TEXT).filter(|_| is_snapshots);
            let inline = || name.strip_suffix(INLINE).map(|name| name.trim_start_matches('.'));
            if let Some(name) = name.strip_suffix(NEW).filter(|_| is_snapshots) {
                found.pictures.push(Pending::new(folder, name));
            } else if let Some(name) = text().or_else(inline) {
                found.texts.push(PendingText { name: name.to_owned(), path: entry.path() });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{find, find_all, without_head};
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

    #[test]
    fn texts_are_found_and_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("tests/snapshots")).expect("made");
        let head = "---\nsource: a.rs\nexpression: \"b\"\n---\n";
        for (name, text) in [
            ("tests/snapshots/a__code.snap", format!("{head}one\n")),
            ("tests/snapshots/a__code.snap.new", format!("{head}other\n")),
            ("tests/.a.rs.pending-snap", String::new()),
            ("tests/b.snap.new", String::new()),
        ] {
            fs::write(path(name), text).expect("written");
        }
        let found = find_all(folder.path()).expect("found");
        let names: Vec<&str> = found.texts.iter().map(|text| text.name.as_str()).collect();
        assert_eq!((names, found.count()), (vec!["a.rs", "a__code"], 2));
        assert_eq!(found.texts[1].texts(), Some(["one\n".into(), "other\n".into()]));
        assert_eq!(found.texts[0].texts(), None);
        assert_eq!(without_head("no head\n---\n"), "no head\n---\n");
    }
}
