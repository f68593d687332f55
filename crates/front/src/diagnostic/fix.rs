//! [`Fix`]: a change of the text that removes a diagnostic.
//!
//! *In:* the rule that found something, and the text that it would like to see. *Out:* [`Edit`]s of the text as it is on disk.
//! *Holds:* the edits of one fix do not overlap. A span in a macro's body or in a text that is on no disk has no edit
//! ([`super::write::Finding`] leaves such a fix out).

use crate::source::Span;

/// Whether a program may apply a fix that nobody looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Applicability {
    /// It changes nothing that the shader computes, or is the only reading of a text that does not compile.
    Safe,
    /// It may change what the shader computes, or guesses what was meant.
    Unsafe,
}

impl Applicability {
    /// The word for it: `safe`, `unsafe`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
        }
    }
}

/// The replacement of a span; an insertion if the span is empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The text to replace.
    pub span: Span,
    /// The new text.
    pub text: String,
}

/// Edits that belong to each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The action, as an editor shows it.
    pub title: String,
    /// Whether it may be applied without a look at it.
    pub applicability: Applicability,
    /// The edits, in any order.
    pub edits: Vec<Edit>,
}

impl Fix {
    /// A fix of one edit.
    pub fn new(applicability: Applicability, title: impl Into<String>, span: Span, text: impl Into<String>) -> Self {
        Self { title: title.into(), applicability, edits: vec![Edit { span, text: text.into() }] }
    }
}
