//! Texts in place of files: what an editor shows, or what a fix made and nobody has written yet.
//!
//! *In:* a path and its text. *Out:* that text, to whoever reads the file in this process ([`crate::files::read`]). *Holds:* a
//! path is known by its canonical form, so every spelling of it gives the same text; without any buffer, a look-up costs one
//! atomic read.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

static ANY: AtomicBool = AtomicBool::new(false);
static BUFFERS: RwLock<BTreeMap<PathBuf, Arc<[u8]>>> = RwLock::new(BTreeMap::new());

/// Puts a text in place of a file.
pub(crate) fn put(path: &Path, bytes: impl Into<Arc<[u8]>>) {
    BUFFERS.write().unwrap_or_else(PoisonError::into_inner).insert(key(path), bytes.into());
    ANY.store(true, Ordering::Release);
}

/// Takes all texts away: files count again.
#[cfg(feature = "play")]
pub(crate) fn clear() {
    BUFFERS.write().unwrap_or_else(PoisonError::into_inner).clear();
    ANY.store(false, Ordering::Release);
}

/// The text in place of a file, if there is one.
pub(crate) fn get(path: &Path) -> Option<Arc<[u8]>> {
    if !ANY.load(Ordering::Acquire) {
        return None;
    }
    BUFFERS.read().unwrap_or_else(PoisonError::into_inner).get(&key(path)).cloned()
}

/// The canonical path; that of its folder for a file that is not there yet.
fn key(path: &Path) -> PathBuf {
    if let Ok(known) = fs::canonicalize(path) {
        return known;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (fs::canonicalize(folder), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}
