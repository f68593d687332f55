//! Which findings in the strings of a host depend on what is not in them.
//!
//! *In:* the shaders of a program, its findings, and those that it has with other texts in its interpolations, as far as the grammar allows
//! them. *Out:* the findings that are there whatever the interpolations bring. *Holds:* nothing is said about a name that an interpolation, or the text before
//! a piece, may declare, nor about a macro that the host seems to define; nor about what is not used, if an interpolation may use it.

use super::{Program, Shader};
use crate::engines::code::words;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::codes::names::{UNDECLARED, UNKNOWN_FUNCTION, UNKNOWN_TYPE};
use glisten_front::diagnostic::codes::preprocess::INCLUDE_NOT_FOUND;
use glisten_front::diagnostic::codes::qualifiers::MISSING_PRECISION;
use glisten_front::diagnostic::{Area, Code, Diagnostic};
use glisten_front::source::{SourceMap, Span};
use std::collections::BTreeSet;
use std::ops::Range;

/// A finding, whatever the filling: its code, and its place in the file.
pub(crate) type Known = (&'static str, String, usize);

/// The findings of one filling.
pub fn known(sources: &SourceMap, findings: &[Diagnostic]) -> BTreeSet<Known> {
    findings
        .iter()
        .filter_map(|finding| {
            let (name, range) = place(sources, finding.primary.span)?;
            Some((finding.code.id, name, range.start))
        })
        .collect()
}

/// Whether a filling has more errors of the grammar than the first one.
pub fn breaks(findings: &[Diagnostic], first: &[Diagnostic]) -> bool {
    let is_of_grammar = |one: &&Diagnostic| one.is_error() && one.code.area() == Area::Syntax;
    let count = |findings: &[Diagnostic]| findings.iter().filter(is_of_grammar).count();
    count(findings) > count(first)
}

fn place(sources: &SourceMap, span: Span) -> Option<(String, Range<usize>)> {
    let span = sources.call_site(span);
    let file = sources.file(sources.file_of(span)?);
    let at = |offset: u32| offset.saturating_sub(file.base()) as usize;
    Some((file.name().to_owned(), at(span.start)..at(span.end)))
}

/// Keeps the findings that do not depend on what is not in the strings; `others` are those of the other fillings.
pub fn keep(
    program: &Program,
    host: &str,
    sources: &SourceMap,
    others: &[BTreeSet<Known>],
    findings: &mut Vec<Diagnostic>,
) {
    // An engine that the file shows has its chunks somewhere.
    let lacks = |finding: &Diagnostic| program.engine.is_some() && finding.code.id == INCLUDE_NOT_FOUND.id;
    let has_lost = findings.iter().any(lacks);
    let is_open = has_lost || program.shaders.iter().any(|shader| shader.holes.iter().any(|hole| hole.is_alone));
    let has_holes = has_lost || program.has_holes();
    let is_one = |code: &Code, all: &[&Code]| all.iter().any(|one| one.id == code.id);
    findings.retain(|finding| {
        let Some((name, range)) = place(sources, finding.primary.span) else { return true };
        let shader = program
            .shaders
            .iter()
            .find(|shader| shader.inside.start <= range.start && range.start <= shader.inside.end);
        let is_piece = shader.is_none_or(|shader| !shader.is_whole);
        if is_one(finding.code, &[&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION]) && (is_piece || has_holes) {
            return false;
        }
        if is_one(finding.code, &[&UNDECLARED, &UNKNOWN_TYPE, &UNKNOWN_FUNCTION, &MISSING_PRECISION])
            && (is_piece || is_open)
        {
            return false;
        }
        if lacks(finding) || is_one(finding.code, &[&UNDECLARED]) && is_macro_of_host(program, host, &range) {
            return false;
        }
        let is_of_use = finding.code.name.starts_with("unused") || finding.code.name.starts_with("unread");
        if is_of_use && (is_piece || has_holes) || shader.is_some_and(|shader| is_in_hole(shader, &range)) {
            return false;
        }
        others.iter().all(|other| other.contains(&(finding.code.id, name.clone(), range.start)))
    });
    for finding in findings {
        finding.fixes.retain(|fix| {
            fix.edits.iter().all(|edit| {
                let Some((_, range)) = place(sources, edit.span) else { return false };
                // Quotes and backslashes would mean something else in the host.
                let is_plain = !edit.text.contains(['`', '\\', '"', '\'', '$']);
                is_plain
                    && !program.shaders.iter().any(|shader| shader.is_changed(&range))
                    && program
                        .shaders
                        .iter()
                        .any(|shader| shader.inside.start <= range.start && range.end <= shader.inside.end)
            })
        });
    }
}

/// Whether a name in capitals is in the host outside of its shaders, too, as the macros do that it defines for them.
fn is_macro_of_host(program: &Program, host: &str, range: &Range<usize>) -> bool {
    let Some(name) = host.get(range.clone()).filter(|name| name.len() > 1) else { return false };
    let is_capital = |letter: char| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_';
    let is_outside = |(at, _): &(usize, &str)| {
        program.shaders.iter().all(|shader| *at < shader.inside.start || shader.inside.end <= *at)
    };
    name.chars().all(is_capital) && words(host).filter(is_outside).any(|(_, word)| word == name)
}

fn is_in_hole(shader: &Shader, range: &Range<usize>) -> bool {
    shader.holes.iter().any(|hole| hole.range.start <= range.start && range.start < hole.range.end)
}
