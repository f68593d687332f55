//! [`Levels`]: which diagnostics the user wants, and at which severity.
//!
//! *In:* levels by code and by group, and comments `// glisten: allow(CODE)` in the sources. *Out:* each diagnostic is dropped, or
//! gets its severity.
//!
//! *Holds:* levels affect only warnings and notes, never errors of the language. The level of a code takes precedence over that of
//! its group, that over `deny warnings`, and a comment over all. A rule that is off reports where a level asks for it.

use super::{Code, Diagnostic, Group, Key, Severity};
use crate::source::{SourceFile, SourceMap, is_comment};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

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

/// Levels by code and by group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Levels {
    by_code: BTreeMap<&'static str, Level>,
    by_group: BTreeMap<Group, Level>,
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

    /// Sets the level of a group of lint rules.
    pub fn set_group(&mut self, group: Group, level: Level) {
        self.by_group.insert(group, level);
    }

    /// Sets the level of what a word names.
    pub fn set_key(&mut self, key: Key, level: Level) {
        match key {
            Key::Code(code) => self.set(code, level),
            Key::Group(group) => self.set_group(group, level),
        }
    }

    /// The level that exactly this has been given: the code itself, or the group as a whole.
    pub fn given(&self, key: Key) -> Option<Level> {
        match key {
            Key::Code(code) => self.by_code.get(code.id).copied(),
            Key::Group(group) => self.by_group.get(&group).copied(),
        }
    }

    /// The level that a code has been given, itself or with its group.
    pub fn get(&self, code: &Code) -> Option<Level> {
        let of_group = || self.by_group.get(&code.group()?).copied();
        self.by_code.get(code.id).copied().or_else(of_group)
    }

    /// Whether a lint rule can report anything under these levels, comments aside.
    pub fn may_report(&self, code: &Code) -> bool {
        self.get(code).map_or(!code.is_off(), |level| level != Level::Allow)
    }

    /// These levels, completed by those of `base`.
    #[must_use]
    pub fn over(&self, base: &Self) -> Self {
        let mut by_code = base.by_code.clone();
        by_code.extend(self.by_code.iter().map(|(id, level)| (*id, *level)));
        let mut by_group = base.by_group.clone();
        by_group.extend(&self.by_group);
        Self { by_code, by_group, deny_warnings: self.deny_warnings || base.deny_warnings }
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
            None if diagnostic.code.is_off() => None,
            None if self.deny_warnings && diagnostic.severity == Severity::Warning => Some(Severity::Error),
            None => Some(diagnostic.severity),
        }
    }
}

/// Whether a comment on the diagnostic's line, or on comment-only lines directly above it, allows the code. Lines that `\` joins are one.
fn is_allowed_by_comment(sources: &SourceMap, diagnostic: &Diagnostic) -> bool {
    let Some(at) = sources.location(sources.call_site(diagnostic.primary.span)) else { return false };
    let file = sources.file(at.file);
    let remarks = file.remarks();
    // Most texts have no such comment.
    if remarks.is_empty() {
        return false;
    }
    let joined = joined_lines(file, at.line);
    let first = remarks.first_comment_above(*joined.start());
    let mut words = remarks.words(first..=*joined.end());
    words.any(|word| Key::find(word).is_some_and(|key| key.names(diagnostic.code)))
}

/// The lines of a file whose findings a comment on this line allows: those that are one with it, or, below lines of comments, with the first
/// one that has more.
pub(crate) fn allowed_lines(file: &SourceFile, comment: u32) -> RangeInclusive<u32> {
    let comments = (comment..).take_while(|number| file.line(*number).is_some_and(is_comment)).count();
    let last = comment.saturating_add(u32::try_from(comments).unwrap_or(u32::MAX));
    *joined_lines(file, comment).start()..=*joined_lines(file, last).end()
}

/// The largest number of lines above or below a line that are taken for one with it.
const MAX_JOINED: u32 = 256;

/// The lines that `\` joins with this one.
fn joined_lines(file: &SourceFile, line: u32) -> RangeInclusive<u32> {
    let goes_on = |number: &u32| file.line(*number).is_some_and(|line| line.ends_with('\\'));
    let above = (line.saturating_sub(MAX_JOINED)..line).rev().take_while(goes_on).last();
    let below = (line..line.saturating_add(MAX_JOINED)).take_while(goes_on).last();
    above.unwrap_or(line)..=below.map_or(line, |last| last + 1)
}

#[cfg(test)]
mod tests {
    use super::{Level, Levels};
    use crate::diagnostic::codes::{
        self,
        general::{LONE_STAGE, TOO_DEEP},
    };
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
    fn a_code_beats_its_group_and_rules_that_are_off_stay_off() {
        let off = codes::all().find(|code| code.is_off()).expect("some rule is off");
        let group = off.group().expect("it is a lint rule");
        let (sources, _) = warning_on_line("int x;\n", 1);
        let note = Diagnostic::new(off, Span::new(1, 2), "off");
        let mut levels = Levels::default();
        assert_eq!((levels.severity(&sources, &note), levels.may_report(off)), (None, false));
        levels.deny_warnings();
        assert_eq!(levels.severity(&sources, &note), None);
        levels.set_group(group, Level::Deny);
        assert_eq!(levels.severity(&sources, &note), Some(Severity::Error));
        levels.set(off, Level::Warn);
        assert_eq!(levels.severity(&sources, &note), Some(Severity::Warning));
        let mut above = Levels::default();
        above.set_group(group, Level::Allow);
        assert_eq!(above.over(&levels).severity(&sources, &note), Some(Severity::Warning));
        for word in [group.name().to_uppercase(), off.name.to_owned()] {
            let (sources, _) = warning_on_line(&format!("x // glisten: allow({word})\n"), 1);
            assert_eq!(levels.severity(&sources, &note), None, "{word}");
        }
    }

    #[test]
    fn comments_allow_on_the_line_and_above_it() {
        for (text, line, dropped) in [
            ("int x; // glisten: allow(W0001)\n", 1, true),
            ("// glisten: allow(E0003, lone-stage)\n// why\nint x;\n", 3, true),
            ("// glisten: allow(W0001)\nint y;\nint x;\n", 3, false),
            ("int x; //glisten:allow(W0001)\n", 1, true),
            ("/* Glisten: allow (W0001) */\nint x;\n", 2, true),
            ("// glisten: allow(W0001)\n#if A && \\\r\n  B\n", 3, true),
            ("#if A && \\\n  B // glisten: allow(W0001)\n", 1, true),
            ("// glisten: allow(W0001)\n#if A\n  B\n", 3, false),
            ("int x; // glisten: allow(W0101)\n", 1, false),
            ("int x; // glisten: allow(W0001\n", 1, false),
        ] {
            let (sources, warning) = warning_on_line(text, line);
            assert_eq!(Levels::default().severity(&sources, &warning).is_none(), dropped, "{text}");
        }
    }
}
