//! [`Scope`]: what a run looked at, and what it left unchecked.

use super::{Finding, Region};
use crate::diagnostic::Severity;

/// A file that a run found and did not check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotChecked {
    /// The place in it that shows why; its first character if the file as a whole does.
    pub region: Region,
    /// The reason, without a full stop.
    pub because: String,
    /// Whether the user wants an error for it.
    pub is_denied: bool,
}

/// The files of a run: how many it checked, and those that it did not check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scope {
    /// The number of files that were checked.
    pub files: usize,
    /// The number of programs of several stages among them.
    pub programs: usize,
    /// The files that were not checked.
    pub not_checked: Vec<NotChecked>,
}

/// How many findings there are of each severity: errors, warnings, notes.
pub(super) fn counts(findings: &[Finding]) -> [usize; 3] {
    [Severity::Error, Severity::Warning, Severity::Note]
        .map(|severity| findings.iter().filter(|finding| finding.severity == severity).count())
}
