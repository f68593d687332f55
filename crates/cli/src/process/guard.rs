//! Handles internal errors: a panic in a job becomes a sentence to report, never a raw message, and never ends the
//! other jobs.

use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general::INTERNAL;
use glisten_front::source::Span;
use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Mutex;

/// The messages and positions of panics so far. A job may panic on a thread that it started itself, so the position
/// is found by the message.
static SEEN: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Keeps panics from being printed; [`guarded`] reports them.
pub(crate) fn silence_panics() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        if let Ok(mut seen) = SEEN.lock() {
            seen.push((text_of(info.payload()), place));
        }
    }));
}

/// Runs a job. A panic in it is returned as its message and position.
pub(crate) fn guarded<R>(job: impl FnOnce() -> R) -> Result<R, String> {
    // A job that panicked is dropped; nothing examines its state again.
    panic::catch_unwind(AssertUnwindSafe(job)).map_err(|payload| {
        let message = text_of(payload.as_ref());
        let seen = SEEN.lock().ok();
        let place = seen.and_then(|seen| seen.iter().rev().find(|(other, _)| *other == message).cloned());
        match place {
            Some((_, place)) => format!("{message} ({place})"),
            None => message,
        }
    })
}

/// The diagnostic for a panic in the compilation of the text at `span`.
pub(crate) fn diagnostic(what: &str, span: Span) -> Diagnostic {
    let first = what.lines().next().unwrap_or_default();
    Diagnostic::new(&INTERNAL, span, format!("internal error: {first}"))
        .help("this is a fault of glisten; please report it with the source")
}

fn text_of(payload: &(dyn Any + Send)) -> String {
    payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| payload.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without a message".to_owned())
}
