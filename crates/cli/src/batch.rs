//! [`Batch`]: diagnostics with the texts that they refer to.

use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::SourceMap;

/// Diagnostics with the texts that they refer to.
#[derive(Debug, Default)]
pub(super) struct Batch {
    /// The texts.
    pub(super) sources: SourceMap,
    /// The diagnostics.
    pub(super) diagnostics: Vec<Diagnostic>,
}
