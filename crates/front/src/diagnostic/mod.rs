//! Diagnostics: what is wrong with a source, as data.
//!
//! *In:* facts that a phase found. *Out:* [`Diagnostic`]s, each with a stable [`Code`] from the one registry, a
//! primary label, secondary labels, a help text, and the section of the specification. The writers (human, JSON,
//! SARIF, GitHub) know nothing about rules; they are in [`mod@write`].
//!
//! *Holds:* a phase reports and continues; nothing here prints.

mod advice;
pub mod codes;
mod fix;
pub mod group;
mod levels;
mod patch;
mod plural;
mod saved;
mod short;
mod sink;
pub mod write;

pub use advice::{Advice, Place};
pub use codes::{Area, Code, Example, Key};
pub use fix::{Applicability, Edit, Fix};
pub use group::{Fixable, Group, LintInfo};
pub(crate) use levels::allowed_lines;
pub use levels::{Level, Levels};
pub use patch::Patch;
pub(crate) use plural::plural;
pub use saved::Saved;
pub use short::{LONGEST, LONGEST_WORD, shortened};
pub use sink::Diagnostics;

use crate::language::Feature;
use crate::source::Span;
use std::fmt;

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Legal, or forgiven, and likely to cause trouble.
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

/// A span with a message about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The span.
    pub span: Span,
    /// The reason for this span; may be empty for the primary label.
    pub message: String,
}

/// One diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The code.
    pub code: &'static Code,
    /// The severity, initially that of the code.
    pub severity: Severity,
    /// One sentence without a full stop that names the construct.
    pub message: String,
    /// The offending tokens.
    pub primary: Label,
    /// Related spans: the other stage's declaration, the earlier definition, the macro.
    pub secondary: Vec<Label>,
    /// Facts that need no span.
    pub notes: Vec<String>,
    /// Advice: what to do about it.
    pub help: Option<String>,
    /// Changes of the text that remove it.
    pub fixes: Vec<Fix>,
    /// The line number that a `#line` directive gave to the primary span, if there is one.
    pub presented_line: Option<u32>,
    /// The feature that the version lacks, if the finding is about one.
    pub lacking: Option<Feature>,
}

impl Diagnostic {
    /// The most secondary labels of a diagnostic, and the most notes.
    pub const MOST: usize = 32;

    /// A diagnostic of `code` at `span`.
    #[must_use]
    pub fn new(code: &'static Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity,
            message: shortened(message),
            primary: Label { span, message: String::new() },
            secondary: Vec::new(),
            notes: Vec::new(),
            help: None,
            fixes: Vec::new(),
            presented_line: None,
            lacking: None,
        }
    }

    /// Sets the message of the primary label.
    #[must_use]
    pub fn here(mut self, message: impl Into<String>) -> Self {
        self.primary.message = shortened(message);
        self
    }

    /// Adds a secondary label, unless there are [`MOST`](Self::MOST) of them.
    #[must_use]
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Self {
        const MORE: &str = "more places are not shown";
        if self.secondary.len() < Self::MOST {
            self.secondary.push(Label { span, message: shortened(message) });
        } else if !self.notes.iter().any(|note| note == MORE) {
            self.notes.push(MORE.to_owned());
        }
        self
    }

    /// Adds a fact, unless there are [`MOST`](Self::MOST) of them.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        const MORE: &str = "more is not shown";
        if self.notes.len() < Self::MOST {
            self.notes.push(shortened(note));
        } else if !self.notes.iter().any(|note| note == MORE) {
            self.notes.push(MORE.to_owned());
        }
        self
    }

    /// Sets the help text and the fix, if the advice is a change of the text at the primary span. They replace earlier ones.
    #[must_use]
    pub fn help(mut self, advice: impl Into<Advice>) -> Self {
        let advice = advice.into();
        self.fixes = advice.fix(self.primary.span).into_iter().collect();
        self.help = Some(shortened(advice.sentence));
        self
    }

    /// Sets the help text, if there is one.
    #[must_use]
    pub fn maybe_help(self, advice: Option<impl Into<Advice>>) -> Self {
        match advice {
            Some(advice) => self.help(advice),
            None => self,
        }
    }

    /// Adds a change of the text that removes it.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fixes.push(Fix { title: shortened(fix.title), ..fix });
        self
    }

    /// Adds a change of the text that removes it, if there is one.
    #[must_use]
    pub fn maybe_fix(mut self, fix: Option<Fix>) -> Self {
        if let Some(fix) = fix {
            self = self.fix(fix);
        }
        self
    }

    /// Whether this is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// The name among `candidates` that is most similar to `name`, if it is similar enough to be what was meant: at most
/// a third of the letters differ, where a difference in case counts less.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A longer name is unlikely to be a misspelling, and comparing it would take long.
    const LONGEST: usize = 64;
    if name.len() > LONGEST {
        return None;
    }
    let n_letters = name.chars().count();
    let allowed = (n_letters / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| *candidate != name && candidate.len().abs_diff(name.len()) <= allowed)
        .filter_map(|candidate| {
            let same_but_for_case = candidate.eq_ignore_ascii_case(name);
            // Every name of one letter is one change away from every other.
            if n_letters == 1 && !same_but_for_case {
                return None;
            }
            let distance = if same_but_for_case { 0 } else { strsim::damerau_levenshtein(name, candidate) };
            (distance <= allowed).then_some((distance, candidate))
        })
        .min()
        .map(|(_, candidate)| candidate)
}

/// The path among `candidates` that `name` most likely means: the most similar one, or one of the same last member.
pub fn nearest_path<'c>(name: &str, candidates: &[&'c str]) -> Option<&'c str> {
    did_you_mean(name, candidates.iter().copied()).or_else(|| of_that_member(name, candidates))
}

/// The name that has the same last member, or that of a member where the whole was named: hosts name members after the block rather than
/// its instance, after nothing where the block has no instance, and elements one by one.
fn of_that_member<'c>(name: &str, candidates: &[&'c str]) -> Option<&'c str> {
    let last = |path: &str| {
        let member = path.rsplit('.').next().unwrap_or(path);
        member.split('[').next().unwrap_or(member).to_owned()
    };
    let root = |path: &str| path.split(['.', '[']).next().unwrap_or(path).to_owned();
    let member = last(name);
    let alike: Vec<&str> = candidates.iter().copied().filter(|candidate| last(candidate) == member).collect();
    let of_root = alike.iter().copied().find(|candidate| root(candidate) == root(name));
    let part = |candidate: &&str| {
        candidate.strip_prefix(name).is_some_and(|rest| rest.starts_with('.') || rest.starts_with('['))
    };
    of_root.or(alike.first().copied()).or_else(|| candidates.iter().copied().find(part))
}
