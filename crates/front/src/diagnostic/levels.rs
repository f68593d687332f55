//! [`Levels`]: which diagnostics the user wants, and at which severity.
//!
//! *In:* levels by code, and comments `// glisten: allow(CODE)` in the sources. *Out:* each diagnostic is dropped, or
//! gets its severity.
//!
//! *Holds:* levels affect only warnings and notes, never errors of the language. A level for a code takes precedence
//! over `deny warnings`; a comment takes precedence over both.

use super::{Code, Diagnostic, Severity, codes};
use crate::source::SourceMap;
use std::collections::BTreeMap;

/// The treatment of a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// It is dropped.
    Allow,
    /// It stays a warning.
    Warn,
    /// It becomes an error.
    Deny,
}

/// Levels by code.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Levels {
    by_code: BTreeMap<&'static str, Level>,
    deny_warnings: bool,
}

impl Levels {
    /// Sets the level of a code.
    pub fn set(&mut self, code: &'static Code, level: Level) {
        self.by_code.insert(code.id, level);
    }

    /// Turns all warnings without a level of their own into errors.
    pub fn deny_warnings(&mut self) {
        self.deny_warnings = true;
    }

    /// The level that a code has been given.
    pub fn get(&self, code: &Code) -> Option<Level> {
        self.by_code.get(code.id).copied()
    }

    /// These levels, completed by those of `base`.
    #[must_use]
    pub fn over(&self, base: &Self) -> Self {
        let mut by_code = base.by_code.clone();
        by_code.extend(self.by_code.iter().map(|(id, level)| (*id, *level)));
        Self { by_code, deny_warnings: self.deny_warnings || base.deny_warnings }
    }

    /// Gives a diagnostic its severity under these levels; `false` if it is to be dropped. The only place where levels and
    /// comments in the text are applied.
    pub fn apply(&self, sources: &SourceMap, diagnostic: &mut Diagnostic) -> bool {
        let severity = self.severity(sources, diagnostic);
        diagnostic.severity = severity.unwrap_or(diagnostic.severity);
        severity.is_some()
    }

    /// The severity of a diagnostic under these levels, or `None` if it is dropped.
    fn severity(&self, sources: &SourceMap, diagnostic: &Diagnostic) -> Option<Severity> {
        if diagnostic.severity == Severity::Error {
            return Some(Severity::Error);
        }
        if is_allowed_by_comment(sources, diagnostic) {
            return None;
        }
        match self.get(diagnostic.code) {
            Some(Level::Allow) => None,
            Some(Level::Warn) => Some(Severity::Warning),
            Some(Level::Deny) => Some(Severity::Error),
            None if self.deny_warnings && diagnostic.severity == Severity::Warning => Some(Severity::Error),
            None => Some(diagnostic.severity),
        }
    }
}

/// Whether a comment on the diagnostic's line, or on comment-only lines directly above it, allows the code.
fn is_allowed_by_comment(sources: &SourceMap, diagnostic: &Diagnostic) -> bool {
    let Some(at) = sources.location(sources.call_site(diagnostic.primary.span)) else { return false };
    let file = sources.file(at.file);
    let allows = |line: &str| allowed(line).any(|key| codes::find(key) == Some(diagnostic.code));
    if file.line(at.line).is_some_and(allows) {
        return true;
    }
    (1..at.line).rev().map_while(|number| file.line(number).filter(|line| is_comment(line))).any(allows)
}

/// The codes in a line's `// glisten: allow(CODE, CODE)`, in any case and with any white space, in either kind of comment.
fn allowed(line: &str) -> impl Iterator<Item = &str> {
    let comment = line.find("//").into_iter().chain(line.find("/*")).min();
    comment
        .and_then(|comment| line.get(comment..))
        .and_then(|comment| after_word(comment, "glisten:"))
        .and_then(|rest| rest.trim_start().strip_prefix("allow"))
        .and_then(|rest| rest.trim_start().strip_prefix('('))
        .and_then(|rest| rest.split_once(')'))
        .map(|(list, _)| list)
        .into_iter()
        .flat_map(|list| list.split(','))
        .map(str::trim)
}

/// The text after the first occurrence of a word of ASCII letters, in any case.
fn after_word<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    let start = text.as_bytes().windows(word.len()).position(|part| part.eq_ignore_ascii_case(word.as_bytes()))?;
    text.get(start + word.len()..)
}

/// Whether a line is nothing but a comment.
fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.starts_with("//") || line.starts_with("/*") && line.ends_with("*/")
}

#[cfg(test)]
mod tests {
    use super::{Level, Levels};
    use crate::diagnostic::codes::general::{LONE_STAGE, TOO_DEEP};
    use crate::diagnostic::{Diagnostic, Severity};
    use crate::source::{SourceMap, Span};

    fn warning_on_line(text: &str, line: usize) -> (SourceMap, Diagnostic) {
        let mut sources = SourceMap::default();
        let id = sources.add("a.vert", text).expect("there is room");
        let start = text.lines().take(line - 1).map(|line| line.len() + 1).sum::<usize>() as u32;
        let base = sources.file(id).base() + start;
        (sources, Diagnostic::new(&LONE_STAGE, Span::new(base, base + 1), "lone"))
    }

    #[test]
    fn a_code_beats_deny_warnings_and_errors_stay() {
        let (sources, warning) = warning_on_line("int x;\n", 1);
        let mut levels = Levels::default();
        assert_eq!(levels.severity(&sources, &warning), Some(Severity::Warning));
        levels.deny_warnings();
        assert_eq!(levels.severity(&sources, &warning), Some(Severity::Error));
        levels.set(&LONE_STAGE, Level::Warn);
        assert_eq!(levels.severity(&sources, &warning), Some(Severity::Warning));
        levels.set(&TOO_DEEP, Level::Allow);
        let error = Diagnostic::new(&TOO_DEEP, warning.primary.span, "deep");
        assert_eq!(levels.severity(&sources, &error), Some(Severity::Error));
    }

    #[test]
    fn comments_allow_on_the_line_and_above_it() {
        for (text, line, dropped) in [
            ("int x; // glisten: allow(W0001)\n", 1, true),
            ("// glisten: allow(E0003, lone-stage)\n// why\nint x;\n", 3, true),
            ("// glisten: allow(W0001)\nint y;\nint x;\n", 3, false),
            ("int x; //glisten:allow(W0001)\n", 1, true),
            ("/* Glisten: allow (W0001) */\nint x;\n", 2, true),
            ("int x; // glisten: allow(W0101)\n", 1, false),
            ("int x; // glisten: allow(W0001\n", 1, false),
        ] {
            let (sources, warning) = warning_on_line(text, line);
            assert_eq!(Levels::default().severity(&sources, &warning).is_none(), dropped, "{text}");
        }
    }
}
