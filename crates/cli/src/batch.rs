//! [`Batch`]: diagnostics with the texts that they refer to.

use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::SourceMap;

/// Diagnostics with the texts that they refer to.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    /// The texts.
    pub(crate) sources: SourceMap,
    /// The diagnostics.
    pub(crate) diagnostics: Vec<Diagnostic>,
}
