//! [`Directives`]: what the preprocessor met besides the tokens, for programs that show a text to its author.
//!
//! *In:* the preprocessor's work. *Out:* where macros are defined and named, which lines are left out, what is included.
//! *Holds:* uses of macros in the text are expansions of the [`SourceMap`](crate::source::SourceMap), and not here.

use crate::source::{FileId, Span};
use std::sync::Arc;

/// A `#define`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MacroDefinition {
    /// The name.
    pub name: Arc<str>,
    /// The name in the directive.
    pub span: Span,
    /// The names of the parameters of a function-like macro.
    pub params: Option<Vec<Arc<str>>>,
    /// The replacement text; unknown if it is empty.
    pub body: Span,
}

/// A macro named in `#ifdef`, `#ifndef`, `#undef` or `defined`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MacroMention {
    /// The name there.
    pub span: Span,
    /// The name in the definition that counts there; unknown for a predefined macro, `None` if there is none.
    pub definition: Option<Span>,
}

/// An `#include`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IncludeName {
    /// The name with its quotes or angle brackets.
    pub span: Span,
    /// The file, whether or not it was read again here; `None` if it was not found.
    pub file: Option<FileId>,
}

/// The directives and comments that the preprocessor met, in the order of reading.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directives {
    /// The definitions of macros, those from outside included.
    pub definitions: Vec<MacroDefinition>,
    /// The macros that are defined at the end.
    pub defined: Vec<Span>,
    /// Where directives name macros.
    pub mentions: Vec<MacroMention>,
    /// The lines that conditions leave out.
    pub inactive: Vec<Span>,
    /// The included files.
    pub includes: Vec<IncludeName>,
}
