//! `repeated-macro`: a macro that is defined a second time with the same text.

use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::source::{SourceFile, Span};
use rustc_hash::FxHashMap;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let sources = subject.texts.sources();
    for shader in &subject.program.stages {
        let Some(own) = shader.origin.file else { continue };
        let (lexemes, file) = (subject.texts.lexemes(own), sources.file(own));
        let mut known: FxHashMap<String, (String, Span)> = FxHashMap::default();
        let mut depth = 0_usize;
        for (word, index) in lexemes.directives() {
            let Some(hash) = lexemes.tokens().get(index) else { continue };
            match word {
                "if" | "ifdef" | "ifndef" => depth += 1,
                "endif" => depth = depth.saturating_sub(1),
                // Behind any of these, the macro may be another one.
                "undef" | "include" => known.clear(),
                "define" if depth == 0 => {
                    let Some(name) = lexemes.tokens().get(index + 2) else { continue };
                    let Some((text, line)) = line(file, sources.line(hash.span)) else { continue };
                    let spelling = lexemes.spelling(name).to_owned();
                    if text.ends_with('\\') || text.contains("/*") || !subject.texts.is_own(shader, name.span) {
                        continue;
                    }
                    match known.get(&spelling) {
                        Some((first, place)) if *first == text => {
                            let fix = subject.texts.remove(Applicability::Safe, line, "remove the line");
                            let message = format!("`{spelling}` is defined a second time with the same text");
                            let finding = findings.at(name.span, message).label(*place, "the first time");
                            findings.push(finding.help("remove the line").maybe_fix(fix));
                        }
                        _ => {
                            known.insert(spelling, (text, name.span));
                        }
                    }
                }
                _ => {}
            }
        }
    }
}

/// The text of a line with single blanks, and its span without the end of the line.
fn line(file: &SourceFile, number: Option<u32>) -> Option<(String, Span)> {
    let number = number?;
    let (text, range) = (file.line(number)?, file.line_range(number)?);
    let words: Vec<&str> = text.split("//").next()?.split_whitespace().collect();
    let start = file.base() + range.start as u32;
    Some((words.join(" "), Span::new(start, start + text.len() as u32)))
}
