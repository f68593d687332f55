//! [`Error`]: why there is no plan.

use glisten_front::diagnostic::Diagnostic;
use std::fmt;

/// Why a scene cannot be drawn by WebGPU.
#[derive(Clone, Debug)]
pub enum Error {
    /// WebGPU lacks what it needs.
    Unsupported(String),
    /// A program cannot be emitted.
    Emit(Vec<Diagnostic>),
    /// Nothing can be made of it.
    Refused(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported(what) => write!(f, "WebGPU lacks {what}"),
            Self::Emit(diagnostics) => {
                f.write_str(diagnostics.first().map_or("a program cannot be emitted", |first| &first.message))
            }
            Self::Refused(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}
