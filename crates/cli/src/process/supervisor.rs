//! Draws in a child process and watches over it: a driver that crashes costs one scene, not the command.
//!
//! *In:* the work of a command. *Out:* its exit code; if a driver crashed, an error that names the driver, the signal and what was
//! drawn. *Holds:* the child is a copy of this process, made before there is any other thread, so it starts at once and prints and
//! writes as ever. A command that [resumes](Supervised::resumes) goes on after a crash, in another copy, which has the
//! [`journal`](crate::process::journal) of all copies before it. Only the program does this, never the library.

use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::process::child::{Ended, Side, fork};
use crate::process::journal::{Journal, Note, State};
use crate::process::memory::{self, EXHAUSTED};

/// A command that draws by a driver.
pub(crate) struct Supervised {
    /// Whether the command leaves out the work at which a driver crashed, and goes on.
    pub(crate) resumes: bool,
}

/// The signals of crashes.
const CRASHES: [(i32, &str); 7] =
    [(4, "SIGILL"), (5, "SIGTRAP"), (6, "SIGABRT"), (7, "SIGBUS"), (8, "SIGFPE"), (11, "SIGSEGV"), (31, "SIGSYS")];
/// The signal that nothing can catch.
const KILLED: i32 = 9;
/// The way out of a crash.
const HELP: &str = "its input was valid, so this is a fault of the driver: `glisten render --backend cpu` draws without it, and \
                    `--adapter NAME` chooses another";

impl Supervised {
    /// Runs work in a child, or in this process where there can be none.
    pub(crate) fn run(&self, console: &Console, work: &dyn Fn() -> Exit) -> Exit {
        let Some(journal) = Journal::open() else { return work() };
        loop {
            match fork() {
                Side::Alone => return work(),
                Side::Child => {
                    memory::in_a_copy();
                    let exit = work();
                    journal.note(&Note::Done(exit as u8));
                    return exit;
                }
                Side::Parent(child) => {
                    let ended = child.wait();
                    match self.next(ended, &journal.notes()) {
                        Next::Exit(code) => return Exit::of_code(code),
                        Next::Raise(signal) => return raise(signal),
                        Next::Tell(failure) => {
                            console.clear_line();
                            return crate::end(Err(failure), console);
                        }
                        Next::Resume(note) => journal.note(&note),
                    }
                }
            }
        }
    }

    /// The next step after the end of a child.
    fn next(&self, ended: Ended, notes: &[Note]) -> Next {
        let state = State::of(notes);
        let crash = match (ended, state.done) {
            // All was done: a driver that crashes while it is closed changes no result.
            (Ended::Signal(signal), Some(code)) if name_of(signal).is_some() => return Next::Exit(code),
            (Ended::Exited(code), _) if state.done.is_some() || state.work.is_none() => return Next::Exit(code),
            (Ended::Exited(code), _) if code == Exit::Interrupted as u8 => return Next::Exit(code),
            (Ended::Exited(EXHAUSTED), _) => return Next::Exit(Exit::Content as u8),
            (Ended::Exited(code), _) => format!("ended the program (exit code {code})"),
            (Ended::Signal(KILLED), _) => return Next::Tell(killed(&state)),
            (Ended::Signal(signal), _) => match name_of(signal) {
                Some(name) => format!("crashed ({name})"),
                None => return Next::Raise(signal),
            },
        };
        let Some(work) = state.work else {
            let failure = Failure::new(Exit::Content, format!("internal error: the program {crash}"));
            return Next::Tell(failure.help("this is a fault of glisten; please report it with the input"));
        };
        let driver = state.driver.map_or("a driver".to_owned(), |name| format!("the driver {name}"));
        let what = format!("{driver} {crash} while {work}");
        let is_known = notes.iter().any(|note| matches!(note, Note::Crash { work: known, .. } if *known == work));
        if self.resumes && !is_known {
            Next::Resume(Note::Crash { work, what })
        } else {
            Next::Tell(Failure::new(Exit::Machine, what).help(HELP))
        }
    }
}

/// The step after the end of a child.
#[derive(Debug, PartialEq)]
enum Next {
    /// This process ends with the same code.
    Exit(u8),
    /// This process ends by the same signal.
    Raise(i32),
    /// A failure is told.
    Tell(Failure),
    /// Another child goes on, after this note.
    Resume(Note),
}

fn name_of(signal: i32) -> Option<&'static str> {
    CRASHES.iter().find(|(number, _)| *number == signal).map(|(_, name)| *name)
}

fn killed(state: &State) -> Failure {
    let at = state.work.as_ref().map_or(String::new(), |work| format!(" while {work}"));
    Failure::new(Exit::Machine, format!("the program was killed (SIGKILL){at}"))
        .help("the system does that when memory runs out")
}

/// Ends this process by a signal, so that a shell sees what it would have seen of the child.
fn raise(signal: i32) -> Exit {
    // Signals that end nothing do not end children either.
    let _ = signal_hook::low_level::emulate_default_handler(signal);
    Exit::Content
}

#[cfg(test)]
mod tests {
    use super::{Ended, Exit, Failure, Next, Note, Supervised};

    fn begun() -> Vec<Note> {
        vec![Note::Driver("llvmpipe".to_owned()), Note::Begin("drawing `a.toml`".to_owned())]
    }

    fn next(resumes: bool, ended: Ended, notes: &[Note]) -> Next {
        Supervised { resumes }.next(ended, notes)
    }

    #[test]
    fn a_crash_names_the_driver_the_signal_and_the_scene() {
        let Next::Tell(Failure { exit, message, help }) = next(false, Ended::Signal(11), &begun()) else {
            panic!("a crash is told");
        };
        assert_eq!(exit, Exit::Machine);
        assert_eq!(message, "the driver llvmpipe crashed (SIGSEGV) while drawing `a.toml`");
        assert!(help.is_some_and(|help| help.contains("--backend cpu")));
        let Next::Tell(Failure { message, .. }) = next(false, Ended::Exited(1), &begun()) else {
            panic!("a driver must not end the program");
        };
        assert!(message.contains("ended the program (exit code 1)"), "{message}");
    }

    #[test]
    fn a_scan_goes_on_once_for_each_crash() {
        let mut notes = begun();
        let Next::Resume(note) = next(true, Ended::Signal(6), &notes) else { panic!("the scan goes on") };
        let what = "the driver llvmpipe crashed (SIGABRT) while drawing `a.toml`".to_owned();
        assert_eq!(note, Note::Crash { work: "drawing `a.toml`".to_owned(), what });
        notes.extend([note, Note::Begin("drawing `b.toml`".to_owned())]);
        assert!(matches!(next(true, Ended::Signal(6), &notes), Next::Resume(_)));
        notes.extend([Note::End, Note::Begin("drawing `a.toml`".to_owned())]);
        assert!(matches!(next(true, Ended::Signal(6), &notes), Next::Tell(_)), "the same crash again ends the scan");
    }

    #[test]
    fn all_else_ends_as_the_child_did() {
        assert_eq!(next(true, Ended::Exited(1), &[]), Next::Exit(1));
        assert_eq!(next(true, Ended::Exited(130), &begun()), Next::Exit(130));
        assert_eq!(next(true, Ended::Signal(2), &begun()), Next::Raise(2));
        let mut done = begun();
        done.push(Note::Done(0));
        assert_eq!(next(true, Ended::Signal(11), &done), Next::Exit(0));
        let Next::Tell(Failure { exit, message, .. }) = next(true, Ended::Signal(11), &[]) else {
            panic!("a crash without a driver is told");
        };
        assert!(exit == Exit::Content && message.contains("internal error"), "{message}");
        let Next::Tell(Failure { exit, .. }) = next(true, Ended::Signal(9), &begun()) else {
            panic!("a killed child is told");
        };
        assert_eq!(exit, Exit::Machine);
    }
}
