//! What is wrong with a source, as data.
//!
//! *In:* facts that a phase found. *Out:* [`Diagnostic`]s, each with a stable [`Code`] of the one registry,
//! a primary label, further labels, a help text and the section of the specification it rests on.
//! The writers (human, JSON, SARIF, GitHub) know nothing of rules; they are under [`mod@write`].
//!
//! *Holds:* a phase reports and goes on; nothing here prints.

pub mod codes;
mod levels;
mod sink;
pub mod write;

pub use codes::{Code, Example};
pub use levels::{Level, Levels};
pub use sink::Diagnostics;

use crate::source::Span;
use std::fmt;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Legal, or forgiven, and likely to hurt.
    Warning,
    /// The input is wrong.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

/// A place with a word about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// Why here; may be empty for the primary label.
    pub message: String,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which rule.
    pub code: &'static Code,
    /// How bad; starts as the code's own severity.
    pub severity: Severity,
    /// One sentence without a full stop that names the construct.
    pub message: String,
    /// The offending tokens.
    pub primary: Label,
    /// Further places: the other stage's declaration, the earlier definition, the macro.
    pub secondary: Vec<Label>,
    /// Facts that need no place.
    pub notes: Vec<String>,
    /// What to do.
    pub help: Option<String>,
    /// The line that a `#line` directive gave the place, if one did.
    pub presented_line: Option<u32>,
}

impl Diagnostic {
    /// A finding of `code` at `span`.
    #[must_use]
    pub fn new(code: &'static Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity,
            message: message.into(),
            primary: Label { span, message: String::new() },
            secondary: Vec::new(),
            notes: Vec::new(),
            help: None,
            presented_line: None,
        }
    }

    /// Says at the primary place why here.
    #[must_use]
    pub fn here(mut self, message: impl Into<String>) -> Self {
        self.primary.message = message.into();
        self
    }

    /// Shows a further place.
    #[must_use]
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Self {
        self.secondary.push(Label { span, message: message.into() });
        self
    }

    /// Adds a fact.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Says what to do.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Says what to do, if there is something to say.
    #[must_use]
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    /// Whether this is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// The name among `candidates` nearest to `name`, if one is near enough to be a slip of the pen:
/// at most a third of the letters wrong, capitals counting for less.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A longer name is no slip of the pen, and comparing it would take long.
    const LONGEST: usize = 64;
    if name.len() > LONGEST {
        return None;
    }
    let allowed = (name.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| *candidate != name && candidate.len().abs_diff(name.len()) <= allowed)
        .filter_map(|candidate| {
            let same_but_for_case = candidate.eq_ignore_ascii_case(name);
            let distance = if same_but_for_case { 0 } else { strsim::damerau_levenshtein(name, candidate) };
            (distance <= allowed).then_some((distance, candidate))
        })
        .min()
        .map(|(_, candidate)| candidate)
}
