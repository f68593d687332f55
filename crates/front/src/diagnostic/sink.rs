//! [`Diagnostics`] collects diagnostics, drops repetitions, and keeps to a limit.

use super::{Diagnostic, Severity};
use crate::source::Span;
use rustc_hash::FxHashSet;

/// The diagnostics of a compilation, in the order in which they were found.
///
/// The same code at the same place is kept once, so an error in a file that is included twice is reported once. Past
/// [`Diagnostics::LIMIT`], diagnostics are only counted.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    seen: FxHashSet<(&'static str, Span)>,
    errors: usize,
    dropped: usize,
}

impl Diagnostics {
    /// The largest number of diagnostics kept.
    pub const LIMIT: usize = 500;

    /// Adds a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if diagnostic.is_error() {
            self.errors += 1;
        }
        if self.list.len() >= Self::LIMIT {
            self.dropped += 1;
            return;
        }
        if self.seen.insert((diagnostic.code.id, diagnostic.primary.span)) || !diagnostic.primary.span.is_known() {
            self.list.push(diagnostic);
        }
    }

    /// Adds a diagnostic about something that has no place of its own: it is kept although there is another one of its
    /// code at its span.
    pub fn push_beside(&mut self, diagnostic: Diagnostic) {
        if !self.list.contains(&diagnostic) {
            self.seen.remove(&(diagnostic.code.id, diagnostic.primary.span));
            self.push(diagnostic);
        }
    }

    /// Whether there is an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// How many diagnostics past the limit were dropped.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Whether the limit is reached; a phase may stop then.
    pub fn is_full(&self) -> bool {
        self.list.len() >= Self::LIMIT
    }

    /// All diagnostics.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// The number of diagnostics kept.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// How many different diagnostics there have been, with those that are gone.
    pub(crate) fn seen(&self) -> usize {
        self.seen.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Keeps the diagnostics that `keep` wants, which may change their severity, and counts the errors again.
    pub fn retain_mut(&mut self, keep: impl FnMut(&mut Diagnostic) -> bool) {
        self.list.retain_mut(keep);
        self.errors = self.list.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count();
    }

    /// Adds the diagnostics of another phase.
    pub fn extend(&mut self, others: impl IntoIterator<Item = Diagnostic>) {
        for diagnostic in others {
            self.push(diagnostic);
        }
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter()
    }
}
