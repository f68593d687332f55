//! The writers of diagnostics, one file for each format. They know nothing about rules.
//!
//! *In:* a [`SourceMap`] and [`Diagnostic`]s. *Out:* text for people ([`human()`]), or [`Finding`]s, which
//! [`json()`], [`sarif()`], [`github()`], [`gitlab()`] and [`junit()`] convert. A [`Finding`] no longer needs its source map, so the findings of
//! many programs can be joined, sorted and deduplicated.
//!
//! *Holds:* no text has characters of a source that a terminal would obey, in any format. Regions are those of the text on disk, whatever `#line` says. The region of text from a macro is the use of
//! the macro; the text in the macro's body becomes a label.

mod github;
mod gitlab;
mod hostile;
mod human;
mod json;
mod junit;
mod sarif;
mod scope;

pub use github::github;
pub use gitlab::gitlab;
pub use hostile::clean;
pub use human::human;
pub use json::json;
pub use junit::{escaped_xml, junit};
pub use sarif::{sarif, sarif_with_names};
pub use scope::{NotChecked, Scope};

use super::{Applicability, Diagnostic, Fix, Label, Severity};
use crate::language::{Edition, cite};
use crate::source::{Language, SourceMap, Span};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A range of text for people. Lines and columns count from 1, columns in Unicode scalar values (a tab is one); the
/// end is exclusive.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Region {
    /// The name of the file as the user wrote it.
    pub file: String,
    /// First line.
    pub line: u32,
    /// First column.
    pub column: u32,
    /// Last line.
    pub end_line: u32,
    /// One past the last column.
    pub end_column: u32,
}

/// A region with a message about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FindingLabel {
    /// The region.
    pub region: Region,
    /// The message.
    pub message: String,
}

/// A replacement of the text of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FindingEdit {
    /// The region; empty for an insertion.
    pub region: Region,
    /// The new text.
    pub text: String,
}

/// A change of texts on disk that removes a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FindingFix {
    /// The action, as an editor shows it.
    pub title: String,
    /// Whether it may be applied without a look at it.
    pub applicability: Applicability,
    /// The edits, by position.
    pub edits: Vec<FindingEdit>,
}

/// A diagnostic with resolved regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The primary region; for a diagnostic without a span, the start of the first text.
    pub region: Region,
    /// The severity.
    pub severity: Severity,
    /// The code.
    pub code: &'static super::Code,
    /// The message.
    pub message: String,
    /// The help text.
    pub help: Option<String>,
    /// Changes of the text that remove it.
    pub fixes: Vec<FindingFix>,
    /// The primary label's message, if it adds to the message, and the secondary labels.
    pub labels: Vec<FindingLabel>,
    /// Facts that need no region.
    pub notes: Vec<String>,
    /// The line number that a `#line` directive gave to the region.
    pub presented_line: Option<u32>,
    /// The section of the specification, in the version of the source; empty if there is none.
    pub section: Cow<'static, str>,
    /// A number that stays the same when lines above it come and go: of its code, its message and its line of text.
    pub fingerprint: u64,
}

impl Finding {
    /// Resolves the spans of a diagnostic.
    pub fn new(sources: &SourceMap, diagnostic: &Diagnostic) -> Self {
        let outer = sources.call_site(diagnostic.primary.span);
        let labels = labels(sources, diagnostic)
            .into_iter()
            .map(|label| FindingLabel { region: region(sources, label.span), message: label.message })
            .collect();
        Self {
            region: region(sources, outer),
            severity: diagnostic.severity,
            code: diagnostic.code,
            message: diagnostic.message.clone(),
            help: diagnostic.help.clone(),
            fixes: diagnostic.fixes.iter().filter_map(|fix| resolved(sources, fix)).collect(),
            labels,
            notes: diagnostic.notes.clone(),
            presented_line: diagnostic.presented_line.or_else(|| sources.presented_line(outer)),
            section: section(sources, diagnostic),
            fingerprint: fingerprint(sources, diagnostic, outer),
        }
    }
}

/// The findings of a compilation.
pub fn findings<'a>(sources: &SourceMap, diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> Vec<Finding> {
    diagnostics.into_iter().map(|diagnostic| Finding::new(sources, diagnostic)).collect()
}

/// The fix with regions, if all of its edits are of texts on disk.
fn resolved(sources: &SourceMap, fix: &Fix) -> Option<FindingFix> {
    let mut edits = Vec::new();
    for edit in &fix.edits {
        // What a macro brings is written elsewhere, and for other uses of the macro, too.
        let at = sources.location(edit.span).filter(|_| !edit.span.expansion.is_some())?;
        (!sources.file(at.file).name().starts_with('<')).then_some(())?;
        let span = if edit.text.is_empty() { removed(sources, edit.span) } else { edit.span };
        edits.push(FindingEdit { region: region(sources, span), text: edit.text.clone() });
    }
    edits.sort_by(|a, b| a.region.cmp(&b.region));
    Some(FindingFix { title: fix.title.clone(), applicability: fix.applicability, edits })
}

/// The span of a text that is removed, and of what goes with it: the whole line if nothing else is on it, otherwise the blanks behind it.
fn removed(sources: &SourceMap, span: Span) -> Span {
    let Some(line) = sources.line_of(span) else { return span };
    let before = sources.snippet(Span { end: span.start, ..line });
    let after = sources.snippet(Span { start: span.end, ..line });
    let is_blank = |text: &str| text.chars().all(char::is_whitespace);
    if span.end <= line.end && is_blank(before) && is_blank(after) {
        return Span { start: line.start, end: line.end, ..span };
    }
    let blanks = after.len() - after.trim_start_matches([' ', '\t']).len();
    let stands_apart = before.is_empty() || before.ends_with([' ', '\t', '(']);
    if stands_apart && span.end <= line.end { Span { end: span.end + blanks as u32, ..span } } else { span }
}

/// FNV-1a over the code, the message and the line of text without its indentation, or the begin of a very long one.
fn fingerprint(sources: &SourceMap, diagnostic: &Diagnostic, span: Span) -> u64 {
    const START: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
    const LONGEST: usize = 4096;
    let line = sources.location(span).and_then(|at| sources.file(at.file).line(at.line)).unwrap_or_default();
    let line = line.trim().as_bytes();
    let line = line.get(..LONGEST).unwrap_or(line);
    let parts = [diagnostic.code.id.as_bytes(), diagnostic.message.as_bytes(), line];
    let bytes = parts.into_iter().flat_map(|part| part.iter().copied().chain([0]));
    bytes.fold(START, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}

/// The fingerprints of findings as text. Equal ones of a file, as of equal lines, are told apart by their order.
pub fn fingerprints(findings: &[Finding]) -> Vec<String> {
    let mut repeated: BTreeMap<(&str, u64), usize> = BTreeMap::new();
    let numbered = findings.iter().map(|finding| {
        let count = repeated.entry((finding.region.file.as_str(), finding.fingerprint)).or_default();
        *count += 1;
        format!("{:016x}:{count}", finding.fingerprint)
    });
    numbered.collect()
}

/// The section that a diagnostic cites, in the version of the source.
fn section(sources: &SourceMap, diagnostic: &Diagnostic) -> Cow<'static, str> {
    let cited = diagnostic.code.section;
    match sources.language_of(sources.call_site(diagnostic.primary.span)) {
        Some(Language { number, es }) => cite(cited, Edition { es, number }),
        None => cited.into(),
    }
}

/// How many macros are shown between a span and the macro use that produced it.
const MAX_MACRO_LABELS: usize = 3;

/// The labels to show besides the primary span: its own message (if there is one), the bodies of the macros that the
/// text came through, and the diagnostic's secondary labels. All of them are outside macros or in the definition of
/// one.
fn labels(sources: &SourceMap, diagnostic: &Diagnostic) -> Vec<Label> {
    let primary = &diagnostic.primary;
    let mut labels = Vec::new();
    if !primary.message.is_empty() {
        labels.push(Label { span: sources.call_site(primary.span), message: primary.message.clone() });
    }
    let mut span = primary.span;
    while let Some(expansion) = sources.expansion(span.expansion) {
        if labels.len() > MAX_MACRO_LABELS {
            break;
        }
        let written = Span::new(span.start, span.end);
        // An argument is written at the use itself, so there is nothing more to show.
        let in_call = expansion.call.start <= span.start && span.end <= expansion.call.end;
        if !in_call {
            labels.push(Label { span: written, message: format!("in the macro `{}`", expansion.name) });
        }
        span = expansion.call;
    }
    labels.extend(
        diagnostic
            .secondary
            .iter()
            .map(|label| Label { span: sources.call_site(label.span), message: label.message.clone() }),
    );
    labels
}

fn region(sources: &SourceMap, span: Span) -> Region {
    match sources.location(span) {
        Some(at) => Region {
            file: sources.file(at.file).name().to_owned(),
            line: at.line,
            column: at.column,
            end_line: at.end_line,
            end_column: at.end_column,
        },
        None => Region {
            file: sources.files().next().map(|(_, file)| file.name().to_owned()).unwrap_or_default(),
            line: 1,
            column: 1,
            end_line: 1,
            end_column: 1,
        },
    }
}

#[cfg(test)]
mod tests;
