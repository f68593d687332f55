//! Folders whose files a job may read, and files elsewhere that it may read, too.
//!
//! *In:* folders, and work that reads files by [`crate::files`]. *Out:* the files outside that it read, or asked for in vain. *Holds:*
//! what is read from the disk is asked about here, in every thread of the process; texts in place of files are not. A file that does not
//! exist may be looked for anywhere. Outside of [`held`] and [`learned`], all is open, and a look-up costs one atomic read.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Files by their canonical paths.
pub(crate) type Files = BTreeSet<PathBuf>;

/// The state of the gate.
struct Gate {
    folders: Vec<PathBuf>,
    /// The files outside that may be read; all of them if there is no list.
    known: Option<Files>,
    /// The files outside that were asked for, and are not known.
    outside: Files,
}

static IS_SHUT: AtomicBool = AtomicBool::new(false);
static GATE: Mutex<Option<Gate>> = Mutex::new(None);

/// Whether the file at a path may be read.
pub(crate) fn may_read(path: &Path) -> bool {
    if !IS_SHUT.load(Ordering::Acquire) {
        return true;
    }
    let Ok(own) = std::fs::canonicalize(path) else { return true };
    let mut gate = GATE.lock().unwrap_or_else(PoisonError::into_inner);
    gate.as_mut().is_none_or(|gate| gate.may_read(own))
}

impl Gate {
    fn may_read(&mut self, own: PathBuf) -> bool {
        let is_inside = self.folders.iter().any(|folder| own.starts_with(folder));
        if is_inside || self.known.as_ref().is_some_and(|known| known.contains(&own)) {
            return true;
        }
        self.outside.insert(own);
        self.known.is_none()
    }
}

/// Does some work that may read the files of some folders, and those that are `known`. Its result, and what it was refused.
pub(crate) fn held<R>(folders: &[PathBuf], known: &Files, work: impl FnOnce() -> R) -> (R, Files) {
    with(Gate { folders: folders.to_vec(), known: Some(known.clone()), outside: Files::new() }, work)
}

/// Does some work, and tells which files outside of some folders it read.
pub(crate) fn learned<R>(folders: &[PathBuf], work: impl FnOnce() -> R) -> (R, Files) {
    with(Gate { folders: folders.to_vec(), known: None, outside: Files::new() }, work)
}

fn with<R>(gate: Gate, work: impl FnOnce() -> R) -> (R, Files) {
    set(Some(gate));
    // The work may panic.
    let opened = Opened;
    let result = work();
    drop(opened);
    (result, set(None).map(|gate| gate.outside).unwrap_or_default())
}

/// Opens the gate when it goes.
struct Opened;

impl Drop for Opened {
    fn drop(&mut self) {
        IS_SHUT.store(false, Ordering::Release);
    }
}

fn set(gate: Option<Gate>) -> Option<Gate> {
    IS_SHUT.store(gate.is_some(), Ordering::Release);
    std::mem::replace(&mut *GATE.lock().unwrap_or_else(PoisonError::into_inner), gate)
}

#[cfg(test)]
mod tests {
    use super::{Files, Gate};

    #[test]
    fn files_outside_are_known_or_refused() {
        let mut gate =
            Gate { folders: vec!["/in".into()], known: Some(["/out/a".into()].into()), outside: Files::new() };
        assert!(gate.may_read("/in/x".into()) && gate.may_read("/out/a".into()));
        assert!(!gate.may_read("/out/b".into()) && !gate.may_read("/inside".into()));
        assert_eq!(gate.outside, ["/inside".into(), "/out/b".into()].into());
        let mut learning = Gate { known: None, ..gate };
        assert!(learning.may_read("/out/c".into()) && learning.outside.contains(std::path::Path::new("/out/c")));
    }
}
