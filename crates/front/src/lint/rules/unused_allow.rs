//! `unused-allow`: a comment `glisten: allow(..)` for a lint rule that finds nothing there.
//!
//! It runs last, over what the other rules found. Comments for codes that are no lint rules are left out, since a rule does not see
//! the findings of other phases.

use super::super::{Findings, Subject};
use crate::diagnostic::{Applicability, Code, Key, allowed_lines};
use crate::source::{FileId, SourceMap, Span};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let mut found = Found::new(subject.texts.sources(), findings);
    for shader in &subject.program.stages {
        for (span, keys) in &shader.origin.allows {
            if !subject.texts.is_own(shader, *span) {
                continue;
            }
            let allowed = found.allowed_by(*span);
            let is_idle = |key: &&String| {
                let key = Key::find(key);
                let is_rule = match key {
                    Some(Key::Code(code)) => code.lint.is_some() && code.id != findings.code.id,
                    Some(Key::Group(_)) => true,
                    None => false,
                };
                is_rule && !allowed.iter().any(|code| key.is_some_and(|key| key.names(code)))
            };
            let idle: Vec<&str> = keys.iter().filter(is_idle).map(String::as_str).collect();
            if idle.is_empty() {
                continue;
            }
            let names = idle.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
            let all = idle.len() == keys.len();
            let fix = subject.texts.remove(Applicability::Safe, *span, "remove the comment").filter(|_| all);
            let finding = findings.at(*span, format!("this comment silences nothing: {names}"));
            findings.push(
                finding.help(if all { "remove the comment" } else { "remove what is not needed" }).maybe_fix(fix),
            );
        }
    }
}

/// The codes of what the other rules found, line by line.
struct Found<'a> {
    sources: &'a SourceMap,
    by_line: BTreeMap<(FileId, u32), Vec<&'static Code>>,
    /// The lines that the last comment was about, if lines of comments alone followed it.
    run: Option<(FileId, RangeInclusive<u32>)>,
}

impl<'a> Found<'a> {
    fn new(sources: &'a SourceMap, findings: &Findings<'_>) -> Self {
        let mut by_line: BTreeMap<(FileId, u32), Vec<&'static Code>> = BTreeMap::new();
        for finding in findings.list.iter() {
            if let Some(at) = sources.location(sources.call_site(finding.primary.span)) {
                by_line.entry((at.file, at.line)).or_default().push(finding.code);
            }
        }
        Self { sources, by_line, run: None }
    }

    /// The codes of the findings that a comment may silence.
    fn allowed_by(&mut self, comment: Span) -> Vec<&'static Code> {
        let Some(at) = self.sources.location(self.sources.call_site(comment)) else { return Vec::new() };
        let known = self.run.take().filter(|(file, lines)| *file == at.file && lines.contains(&at.line));
        let lines = known.map_or_else(|| allowed_lines(self.sources.file(at.file), at.line), |(_, lines)| lines);
        self.run = Some((at.file, lines.clone()));
        let range = (at.file, *lines.start())..=(at.file, *lines.end());
        self.by_line.range(range).flat_map(|(_, codes)| codes).copied().collect()
    }
}
