//! The files that a command reads or looks for, told to the `watch` that runs it.
//!
//! *In:* [`note`], called where files are read, and where it matters that one is not there. *Out:* a file of their names, each followed by a
//! NUL; the environment names it. *Holds:* without that, nothing is kept. Processes that the command starts add to the same file.

use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};

/// The variable of the environment that names the file to tell them to, which is there.
pub(crate) const LIST: &str = "GLISTEN_FILES_READ";

/// The file.
static TOLD: LazyLock<Option<PathBuf>> = LazyLock::new(|| std::env::var_os(LIST).map(PathBuf::from));
/// The names.
static SEEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Notes that a file is read, or looked for.
pub(crate) fn note(path: &Path) {
    if TOLD.is_some() {
        SEEN.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
    }
}

/// Adds the names to the file.
pub(crate) fn tell() {
    let Some(list) = TOLD.as_deref() else { return };
    let seen = std::mem::take(&mut *SEEN.lock().unwrap_or_else(PoisonError::into_inner));
    let text: String = seen.iter().map(|path| format!("{}\0", path.display())).collect();
    // `watch` then knows the folders of the arguments only.
    let _ = OpenOptions::new().append(true).open(list).and_then(|mut file| file.write_all(text.as_bytes()));
}

/// The names in such a file.
///
/// # Errors
/// It cannot be read.
pub(crate) fn told(list: &Path) -> io::Result<BTreeSet<PathBuf>> {
    let text = std::fs::read(list)?;
    let names = text.split(|byte| *byte == 0).filter(|name| !name.is_empty());
    Ok(names.map(|name| PathBuf::from(String::from_utf8_lossy(name).into_owned())).collect())
}
