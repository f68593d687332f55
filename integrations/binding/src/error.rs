//! [`Error`]: what a host did wrong, or what glisten did wrong ([`guarded`]).

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The kind of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An argument is wrong: an unknown word, a stage that is not there.
    Argument,
    /// A shader or a scene has errors. Its diagnostics say which.
    Content,
    /// A file cannot be read.
    File,
    /// A fault of glisten.
    Internal,
}

/// Why a call has no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The kind.
    pub kind: Kind,
    /// A sentence for people, without a full stop.
    pub message: String,
    /// The file that cannot be read, if it is about one.
    pub file: Option<Unreadable>,
    /// What is wrong in a source, as JSON, if a diagnostic says it.
    pub diagnostics: Option<String>,
}

/// A file that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unreadable {
    /// Its path.
    pub path: String,
    /// The number of the system's error.
    pub errno: Option<i32>,
}

impl Error {
    /// An error in an argument.
    pub fn argument(message: impl Into<String>) -> Self {
        Self { kind: Kind::Argument, message: message.into(), file: None, diagnostics: None }
    }

    /// An error in a shader or a scene.
    pub fn content(message: impl Into<String>) -> Self {
        Self { kind: Kind::Content, message: message.into(), file: None, diagnostics: None }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// Runs a call. A panic in it becomes an error, since it must not unwind into another language.
pub fn guarded<R>(call: impl FnOnce() -> Result<R, Error>) -> Result<R, Error> {
    // What the call worked on is dropped or immutable; nothing examines a half-changed state again.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|payload| {
        let message = format!("internal error: {}; please report it with the input", text_of(payload.as_ref()));
        Err(Error { kind: Kind::Internal, message, file: None, diagnostics: None })
    })
}

fn text_of(payload: &(dyn Any + Send)) -> &str {
    let owned = payload.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic without a message")
}

#[cfg(test)]
mod tests {
    use super::{Kind, guarded};

    #[test]
    fn a_panic_is_an_error() {
        let error = guarded::<()>(|| panic!("it broke")).expect_err("it panics");
        assert_eq!(error.kind, Kind::Internal);
        assert!(error.message.contains("it broke"));
        assert_eq!(guarded(|| Ok(3)), Ok(3));
    }
}
