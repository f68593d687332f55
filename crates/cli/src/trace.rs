//! The trace of what a piece of work reads: files, and where it looked for files.
//!
//! *In:* [`read`], [`looked_for`] and the like, called where files are read. *Out:* of [`recorded`]: a [`Trace`], the places in
//! the order of their first use, each with what was found there. *Holds:* a trace belongs to the thread that works; without
//! [`recorded`], nothing is kept. The digests are of the bytes that the work saw: a file that changes later has another digest.

use crate::digest::Digest;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

/// A place on disk that a result depends on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Place {
    /// The bytes of a file, or that it cannot be read.
    File(String),
    /// Whether there is a file or a folder.
    Kind(String),
    /// The rules of `glisten.toml` for a folder.
    Rules(String),
    /// The settings of `lint` for a file, by `glisten.toml`.
    Settings(String),
}

/// The state of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// Nothing, or nothing that can be read.
    Nothing,
    /// A folder.
    Folder,
    /// A file, for those who ask for no more.
    File,
    /// The bytes of a file, or of several.
    Bytes(Digest),
    /// The content of `glisten.toml`. It is looked up once for all programs.
    Said,
}

impl Found {
    /// The state of a path.
    pub(crate) fn at(path: &Path) -> Self {
        match std::fs::metadata(path) {
            Ok(found) if found.is_dir() => Self::Folder,
            Ok(_) => Self::File,
            Err(_) => Self::Nothing,
        }
    }
}

/// All that a piece of work depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Trace {
    places: Vec<(Place, Found)>,
    seen: BTreeSet<Place>,
    /// Whether it depends on more than the places.
    beyond: bool,
}

impl Trace {
    /// The places, if they are all that the work depends on.
    pub(crate) fn places(&self) -> Option<&[(Place, Found)]> {
        (!self.beyond).then_some(&self.places)
    }

    /// The files that were read.
    pub(crate) fn files(&self) -> impl Iterator<Item = &str> {
        self.places.iter().filter_map(|place| match place {
            (Place::File(name), Found::Bytes(_)) => Some(name.as_str()),
            _ => None,
        })
    }

    /// This trace, and what another piece of work depends on.
    #[must_use]
    pub(crate) fn with(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.take(other);
        both
    }

    fn take(&mut self, other: &Self) {
        self.beyond |= other.beyond;
        other.places.iter().for_each(|(place, found)| self.add(place.clone(), || found.clone()));
    }

    fn add(&mut self, place: Place, found: impl FnOnce() -> Found) {
        if self.seen.insert(place.clone()) {
            self.places.push((place, found()));
        }
    }
}

thread_local! {
    /// The traces that are being recorded, the innermost last.
    static ACTIVE: RefCell<Vec<Trace>> = const { RefCell::new(Vec::new()) };
}

/// Runs a piece of work and records what it reads.
pub(crate) fn recorded<R>(work: impl FnOnce() -> R) -> (R, Trace) {
    /// Ends the recording even if the work panics.
    struct Ended;
    impl Drop for Ended {
        fn drop(&mut self) {
            ACTIVE.with_borrow_mut(|active| active.pop());
        }
    }
    ACTIVE.with_borrow_mut(|active| active.push(Trace::default()));
    let ended = Ended;
    let result = work();
    let trace = ACTIVE.with_borrow_mut(|active| active.last_mut().map(std::mem::take)).unwrap_or_default();
    drop(ended);
    (result, trace)
}

/// Notes that a file is read: its bytes, or `None` if it cannot be read.
pub(crate) fn read(path: &Path, bytes: Option<&[u8]>) {
    let found = || bytes.map_or(Found::Nothing, |bytes| Found::Bytes(Digest::of(bytes)));
    note(|| Place::File(path.to_string_lossy().into_owned()), found);
}

/// Notes that it matters whether there is a file.
pub(crate) fn looked_for(path: &Path) {
    note(|| Place::Kind(path.to_string_lossy().into_owned()), || Found::at(path));
}

/// Notes again what another piece of work has read.
pub(crate) fn again(trace: &Trace) {
    ACTIVE.with_borrow_mut(|active| {
        if let Some(own) = active.last_mut() {
            own.take(trace);
        }
    });
}

/// Notes that the rules of a folder matter.
pub(crate) fn rules_of(folder: &Path) {
    note(|| Place::Rules(folder.to_string_lossy().into_owned()), || Found::Said);
}

/// Notes that it matters what `lint` obeys for a file.
pub(crate) fn settings_of(name: &str) {
    note(|| Place::Settings(name.to_owned()), || Found::Said);
}

/// Notes that more matters than can be told.
pub(crate) fn beyond() {
    ACTIVE.with_borrow_mut(|active| {
        if let Some(trace) = active.last_mut() {
            trace.beyond = true;
        }
    });
}

fn note(place: impl FnOnce() -> Place, found: impl FnOnce() -> Found) {
    ACTIVE.with_borrow_mut(|active| {
        if let Some(trace) = active.last_mut() {
            trace.add(place(), found);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::{Found, Place, again, beyond, looked_for, read, recorded};
    use std::path::Path;

    #[test]
    fn places_are_kept_once_and_in_order() {
        read(Path::new("before"), None);
        let ((), outer) = recorded(|| {
            read(Path::new("a"), None);
            let ((), inner) = recorded(|| {
                read(Path::new("b"), Some(b""));
                beyond();
            });
            assert_eq!(inner.places(), None);
            looked_for(Path::new("c"));
            read(Path::new("a"), Some(b""));
        });
        let nothing = |place| (place, Found::Nothing);
        let places = [Place::File("a".into()), Place::Kind("c".into())].map(nothing);
        assert_eq!(outer.places(), Some(&places[..]));
        let ((), same) = recorded(|| {
            looked_for(Path::new("c"));
            again(&outer);
        });
        assert_eq!(same.places().map(<[_]>::len), Some(2));
    }
}
