//! The cases that the text of the specification forbids and every driver silently accepts. glisten warns and cites
//! the section; with `strict` it reports an error. All cases are rows of one table, each with its reason, and with the
//! language whose compilers refuse it.

use super::session::ParseSession;
use crate::diagnostic::codes::{preprocess, syntax};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::language::{Feature, Version};
use crate::source::Span;

/// A case that is forgiven.
#[derive(Debug)]
pub(super) struct Kindness {
    /// The code; its section is the one that forbids the case.
    code: &'static Code,
    /// Why drivers forgive it.
    reason: &'static str,
    /// The rule of a language whose compilers do not, and the code of that error.
    refused: Option<(Feature, &'static Code)>,
}

/// `\` at the end of a line.
pub(super) static LINE_CONTINUATION: Kindness = Kindness::new(
    &preprocess::LINE_CONTINUATION,
    "every driver joins the lines, as GLSL 4.20 and GL_ARB_shading_language_420pack have it",
);
/// `/* .. */` over several lines inside a directive.
pub(super) static COMMENT_ACROSS_LINES: Kindness =
    Kindness::new(&preprocess::COMMENT_ACROSS_LINES, "every driver reads a comment as one space, as GLSL 4.40 has it");
/// `#if NAME` where no macro `NAME` is defined.
pub(super) static UNDEFINED_IN_CONDITION: Kindness =
    Kindness::new(&preprocess::UNDEFINED_IN_CONDITION, "every driver counts it as 0, as C does")
        .refused(Feature::NamesInConditions, &preprocess::MALFORMED_CONDITION);
/// Directives before `#version`.
pub(super) static BEFORE_VERSION: Kindness = Kindness::new(
    &preprocess::BEFORE_VERSION,
    "drivers accept directives there, because tools that put texts together write them there",
);
/// `#extension` after the first token.
pub(super) static LATE_EXTENSION: Kindness = Kindness::new(
    &preprocess::LATE_EXTENSION,
    "drivers turn the extension on from there, because included texts bring their own lines",
)
.refused(Feature::ExtensionsFirst, &preprocess::MISPLACED_EXTENSION);
/// `#endif NAME`
pub(super) static EXTRA_TEXT: Kindness =
    Kindness::new(&preprocess::EXTRA_TEXT, "every driver ignores it, and many sources repeat the name after `#endif`")
        .refused(Feature::DirectiveEnds, &preprocess::MALFORMED_DIRECTIVE);
/// `#include` without its extension.
pub(super) static INCLUDE_WITHOUT_EXTENSION: Kindness =
    Kindness::new(&preprocess::INCLUDE_WITHOUT_EXTENSION, "engines resolve it before the driver sees the text");
/// `#pragma optimize(off)` inside a function.
pub(super) static PRAGMA_IN_FUNCTION: Kindness =
    Kindness::new(&preprocess::PRAGMA_IN_FUNCTION, "no driver checks where such a pragma is");
/// U+FEFF before the text.
pub(super) static BYTE_ORDER_MARK: Kindness = Kindness::new(
    &preprocess::BYTE_ORDER_MARK,
    "editors write it, and programs often take it away before the driver sees the text",
);
/// `#ifdef` inside the arguments of a macro use.
pub(super) static DIRECTIVE_IN_ARGUMENTS: Kindness =
    Kindness::new(&preprocess::DIRECTIVE_IN_ARGUMENTS, "preprocessors run it, as those of C++ do");
/// A macro whose name contains `__`.
pub(super) static RESERVED_NAME: Kindness =
    Kindness::new(&preprocess::RESERVED_NAME, "no driver uses such names, and include guards often have them");
/// `##` in GLSL 1.10 and 1.20.
pub(super) static EARLY_PASTE: Kindness =
    Kindness::new(&preprocess::EARLY_PASTE, "the drivers of OpenGL join tokens in every version");
/// `;` at global scope.
pub(super) static STRAY_SEMICOLON: Kindness =
    Kindness::new(&syntax::STRAY_SEMICOLON, "every driver skips it, and macros leave it behind");

impl Kindness {
    const fn new(code: &'static Code, reason: &'static str) -> Self {
        Self { code, reason, refused: None }
    }

    /// The same case, which is an error in languages with a rule.
    const fn refused(self, rule: Feature, code: &'static Code) -> Self {
        Self { refused: Some((rule, code)), ..self }
    }

    /// The code of the error in a language whose compilers refuse the case.
    fn refusal(&self, version: Version) -> Option<&'static Code> {
        self.refused.filter(|(rule, _)| version.has(*rule)).map(|(_, code)| code)
    }

    /// Whether the case is an error in a language.
    pub(super) fn is_refused(&self, version: Version) -> bool {
        self.refusal(version).is_some()
    }

    /// The diagnostic for one occurrence in a language; the caller adds labels and help.
    pub(super) fn judged(&self, version: Version, strict: bool, span: Span, message: impl Into<String>) -> Diagnostic {
        match self.refusal(version) {
            Some(code) => Diagnostic::new(code, span, message),
            None => self.diagnostic(strict, span, message),
        }
    }

    /// The diagnostic for one occurrence in a language that forgives it; the caller adds labels and help.
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
        let diagnostic = self.judged(session.version, strict, span, message);
        session.report(diagnostic);
    }
}
