//! [`Criteria`]: what decides which findings are told, and how jobs are guarded.
//!
//! *In:* files and diagnostics. *Out:* findings. *Holds:* the server asks `glisten.toml` and survives panics; a page that computes by itself has
//! the levels of the rules.

use glisten_front::diagnostic::write::Finding;
use glisten_front::diagnostic::{Diagnostic, Levels};
use glisten_front::source::SourceMap;

/// Decides which findings are told.
pub trait Criteria {
    /// The levels of a file.
    fn levels_of(&mut self, name: &str) -> Levels;

    /// The findings that are told of these diagnostics, in the order in which they are told.
    fn findings(&mut self, sources: &SourceMap, found: Vec<Diagnostic>) -> Vec<Finding>;

    /// Runs a job. A panic in it is returned as its message, where panics can be caught.
    ///
    /// # Errors
    /// The message of a panic.
    fn guarded<R>(&self, job: impl FnOnce() -> R) -> Result<R, String> {
        Ok(job())
    }
}

/// The messages of diagnostics, a line each.
pub fn told<'a>(diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> String {
    let lines: Vec<&str> = diagnostics.into_iter().map(|diagnostic| diagnostic.message.as_str()).collect();
    lines.join("\n")
}
