//! [`Journal`]: what a process that draws is doing, for the process that watches over it.
//!
//! *In:* notes of the commands: the driver, each piece of work for it, results that are final. *Out:* the same, read by the
//! [`supervisor`](super::supervisor) when a driver took the process down, and by the process that goes on. *Holds:* without a
//! supervisor, notes cost nothing; a note is one write to a file without a name, so it stays whatever happens afterwards.

use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::sync::{Mutex, OnceLock};

/// The journal of this process, if there is a supervisor.
static CURRENT: OnceLock<Journal> = OnceLock::new();

/// A note.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Note {
    /// The driver that draws from now on.
    Driver(String),
    /// The driver begins this.
    Begin(String),
    /// It has done it.
    End,
    /// A result that need not be computed again.
    Result(serde_json::Value),
    /// The driver crashed in this work, with the sentence that says so.
    Crash {
        /// The work.
        work: String,
        /// The sentence.
        what: String,
    },
    /// The command has done everything, with this exit code.
    Done(u8),
}

/// A file of notes that several processes share.
#[derive(Debug)]
pub(crate) struct Journal {
    file: Mutex<File>,
}

/// The state at the last note.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct State {
    /// The driver.
    pub(crate) driver: Option<String>,
    /// The work that the driver has begun and not ended.
    pub(crate) work: Option<String>,
    /// The exit code, if everything was done.
    pub(crate) done: Option<u8>,
}

impl Journal {
    /// The journal of this process and of those that it starts from now on. `None` if the system has no room for one.
    pub(crate) fn open() -> Option<&'static Self> {
        let file = tempfile::tempfile().ok()?;
        Some(CURRENT.get_or_init(|| Self { file: Mutex::new(file) }))
    }

    /// Adds a note. A note that cannot be written is left out: drawing goes on.
    pub(crate) fn note(&self, note: &Note) {
        if let (Ok(mut file), Ok(line)) = (self.file.lock(), serde_json::to_string(note)) {
            let _ = file.seek(SeekFrom::End(0)).and_then(|_| file.write_all((line + "\n").as_bytes()));
        }
    }

    /// All notes so far.
    pub(crate) fn notes(&self) -> Vec<Note> {
        let mut text = String::new();
        if let Ok(mut file) = self.file.lock() {
            // What was not written whole is no note.
            let _ = file.seek(SeekFrom::Start(0)).and_then(|_| file.read_to_string(&mut text));
        }
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
    }
}

impl State {
    /// The state after notes.
    pub(crate) fn of(notes: &[Note]) -> Self {
        let mut state = Self::default();
        for note in notes {
            match note {
                Note::Driver(name) => state.driver = Some(name.clone()),
                Note::Begin(work) => state.work = Some(work.clone()),
                Note::End | Note::Crash { .. } => state.work = None,
                Note::Done(exit) => state.done = Some(*exit),
                Note::Result(_) => {}
            }
        }
        state
    }
}

/// Adds a note to the journal of this process, if it has one.
pub(crate) fn note(note: &Note) {
    if let Some(journal) = CURRENT.get() {
        journal.note(note);
    }
}

/// All notes in the journal of this process, those of processes before it included.
pub(crate) fn notes() -> Vec<Note> {
    CURRENT.get().map(Journal::notes).unwrap_or_default()
}

/// The name of the work on a scene or a test.
pub(crate) fn drawing(name: &str) -> String {
    format!("drawing `{name}`")
}

/// Notes that the driver works on something until the value is dropped.
#[must_use]
pub(crate) fn at_work(work: &str) -> AtWork {
    if CURRENT.get().is_some() {
        note(&Note::Begin(work.to_owned()));
    }
    AtWork
}

/// See [`at_work`].
pub(crate) struct AtWork;

impl Drop for AtWork {
    fn drop(&mut self) {
        note(&Note::End);
    }
}

#[cfg(test)]
mod tests {
    use super::{Journal, Note, State};
    use std::sync::Mutex;

    #[test]
    fn the_state_is_that_of_the_last_notes() {
        let journal = Journal { file: Mutex::new(tempfile::tempfile().expect("a file")) };
        assert_eq!(State::of(&journal.notes()), State::default());
        journal.note(&Note::Driver("llvmpipe".to_owned()));
        journal.note(&Note::Begin("`a.toml`".to_owned()));
        journal.note(&Note::End);
        journal.note(&Note::Begin("`b.toml`\nand more".to_owned()));
        let notes = journal.notes();
        assert_eq!(notes.len(), 4);
        let state = State::of(&notes);
        assert_eq!(state.driver.as_deref(), Some("llvmpipe"));
        assert_eq!((state.work.as_deref(), state.done), (Some("`b.toml`\nand more"), None));
        journal.note(&Note::Crash { work: "`b.toml`\nand more".to_owned(), what: "it crashed".to_owned() });
        journal.note(&Note::Done(1));
        let state = State::of(&journal.notes());
        assert_eq!((state.work, state.done), (None, Some(1)));
    }
}
