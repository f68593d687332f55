//! The cases that the text of the specification forbids and every driver silently accepts. glisten warns and cites
//! the section; with `strict` it reports an error. All cases are rows of one table, each with its reason.

use super::session::ParseSession;
use crate::diagnostic::codes::{preprocess, syntax};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::source::Span;

/// A case that is forgiven.
#[derive(Debug)]
pub(super) struct Kindness {
    /// The code; its section is the one that forbids the case.
    code: &'static Code,
    /// Why drivers forgive it.
    reason: &'static str,
}

/// `\` at the end of a line.
pub(super) static LINE_CONTINUATION: Kindness = Kindness {
    code: &preprocess::LINE_CONTINUATION,
    reason: "every driver joins the lines, as GLSL 4.20 and GL_ARB_shading_language_420pack have it",
};
/// `#if NAME` where no macro `NAME` is defined.
pub(super) static UNDEFINED_IN_CONDITION: Kindness =
    Kindness { code: &preprocess::UNDEFINED_IN_CONDITION, reason: "every driver counts it as 0, as C does" };
/// Directives before `#version`.
pub(super) static BEFORE_VERSION: Kindness = Kindness {
    code: &preprocess::BEFORE_VERSION,
    reason: "drivers accept directives there, because tools that put texts together write them there",
};
/// `#extension` after the first token.
pub(super) static LATE_EXTENSION: Kindness = Kindness {
    code: &preprocess::LATE_EXTENSION,
    reason: "drivers turn the extension on from there, because included texts bring their own lines",
};
/// `#endif NAME`
pub(super) static EXTRA_TEXT: Kindness = Kindness {
    code: &preprocess::EXTRA_TEXT,
    reason: "every driver ignores it, and many sources repeat the name after `#endif`",
};
/// `#include` without its extension.
pub(super) static INCLUDE_WITHOUT_EXTENSION: Kindness = Kindness {
    code: &preprocess::INCLUDE_WITHOUT_EXTENSION,
    reason: "engines resolve it before the driver sees the text",
};
/// `#pragma optimize(off)` inside a function.
pub(super) static PRAGMA_IN_FUNCTION: Kindness =
    Kindness { code: &preprocess::PRAGMA_IN_FUNCTION, reason: "no driver checks where such a pragma is" };
/// U+FEFF before the text.
pub(super) static BYTE_ORDER_MARK: Kindness = Kindness {
    code: &preprocess::BYTE_ORDER_MARK,
    reason: "editors write it, and programs often take it away before the driver sees the text",
};
/// `#ifdef` inside the arguments of a macro use.
pub(super) static DIRECTIVE_IN_ARGUMENTS: Kindness =
    Kindness { code: &preprocess::DIRECTIVE_IN_ARGUMENTS, reason: "preprocessors run it, as those of C++ do" };
/// A macro whose name contains `__`.
pub(super) static RESERVED_NAME: Kindness = Kindness {
    code: &preprocess::RESERVED_NAME,
    reason: "no driver uses such names, and include guards often have them",
};
/// `##` in GLSL 1.10 and 1.20.
pub(super) static EARLY_PASTE: Kindness =
    Kindness { code: &preprocess::EARLY_PASTE, reason: "the drivers of OpenGL join tokens in every version" };
/// `;` at global scope.
pub(super) static STRAY_SEMICOLON: Kindness =
    Kindness { code: &syntax::STRAY_SEMICOLON, reason: "every driver skips it, and macros leave it behind" };

impl Kindness {
    /// The diagnostic for one occurrence; the caller adds labels and help.
    pub(super) fn diagnostic(&self, strict: bool, span: Span, message: impl Into<String>) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(self.code, span, message);
        if strict {
            diagnostic.severity = Severity::Error;
            return diagnostic.note("an error because of strict checking");
        }
        diagnostic.note(format!("accepted because {}", self.reason))
    }

    /// Reports one occurrence.
    pub(super) fn report(&self, session: &mut ParseSession<'_>, strict: bool, span: Span, message: impl Into<String>) {
        let diagnostic = self.diagnostic(strict, span, message);
        session.report(diagnostic);
    }
}
