//! Diagnostics, pushed and pulled (LSP 3.17, `textDocument/publishDiagnostics` and `textDocument/diagnostic`).
//!
//! *Holds:* they are the findings of `glisten lint` over the programs of the open documents, each at the file that it is in. Text
//! that conditions leave out is marked as unnecessary, for editors that gray it.

use crate::analysis::Analysis;
use crate::state::State;
use crate::uri;
use glisten_front::diagnostic::{Code, Diagnostic as Finding, Severity};
use glisten_front::source::{SourceMap, Span};
use lsp_types::{
    CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag,
    DocumentDiagnosticParams, DocumentDiagnosticReport, DocumentDiagnosticReportKind, DocumentDiagnosticReportResult,
    FullDocumentDiagnosticReport, Location, NumberOrString, RelatedFullDocumentDiagnosticReport,
    RelatedUnchangedDocumentDiagnosticReport, UnchangedDocumentDiagnosticReport,
};
use std::collections::{BTreeMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The name of the program in an editor's list.
pub(crate) const SOURCE: &str = "glisten";
/// A file has at most this many diagnostics.
const MAX_IN_FILE: usize = 500;

/// The diagnostics of all files of the programs of open documents.
pub(crate) fn all(state: &mut State<'_>) -> BTreeMap<PathBuf, Vec<Diagnostic>> {
    let open: Vec<PathBuf> = state.documents.keys().cloned().collect();
    let mut found: BTreeMap<PathBuf, Vec<Diagnostic>> = open.iter().map(|path| (path.clone(), Vec::new())).collect();
    let mut analyses: Vec<Rc<Analysis>> = Vec::new();
    for path in &open {
        for analysis in state.analyses_of(path) {
            if !analyses.iter().any(|known| known.key == analysis.key) {
                analyses.push(analysis);
            }
        }
    }
    for analysis in &analyses {
        add_analysis(state, analysis, &mut found);
    }
    add_configurations(state, &mut found);
    if state.client.grays {
        for path in &open {
            let gray = inactive(state, path);
            found.entry(path.clone()).or_default().extend(gray);
        }
    }
    for diagnostics in found.values_mut() {
        diagnostics.truncate(MAX_IN_FILE);
    }
    found
}

fn add_analysis(state: &mut State<'_>, analysis: &Analysis, found: &mut BTreeMap<PathBuf, Vec<Diagnostic>>) {
    let is_lone = analysis.key.name.ends_with(" alone");
    for finding in &analysis.compiled.findings {
        let sources = analysis.sources();
        let span = sources.call_site(finding.primary.span);
        let Some(file) = sources.file_of(span).or(sources.files().next().map(|(id, _)| id)) else { continue };
        let name = sources.file(file).name();
        if name.starts_with('<') {
            continue;
        }
        let path = PathBuf::from(name);
        // A header that nobody includes lacks what its includers would have.
        if is_lone && (state.project.is_about_a_part(finding) || state.is_header(&path)) {
            continue;
        }
        let diagnostic = diagnostic(state, analysis, finding);
        add(found.entry(path).or_default(), diagnostic);
    }
}

/// Adds a diagnostic, unless another program had it, too.
fn add(list: &mut Vec<Diagnostic>, diagnostic: Diagnostic) {
    let is_same = |other: &Diagnostic| {
        other.range == diagnostic.range && other.code == diagnostic.code && other.message == diagnostic.message
    };
    if !list.iter().any(is_same) {
        list.push(diagnostic);
    }
}

/// A finding as the protocol has it.
pub(super) fn diagnostic(state: &State<'_>, analysis: &Analysis, finding: &Finding) -> Diagnostic {
    let sources = analysis.sources();
    let locate = |span: Span| state.location(analysis, sources.call_site(span));
    let range = locate(finding.primary.span).map(|location| location.range).unwrap_or_default();
    let mut related = Vec::new();
    if finding.primary.span.expansion.is_some()
        && let Some(location) = state.location(analysis, finding.primary.span)
    {
        related.push(DiagnosticRelatedInformation { location, message: "in the macro".to_owned() });
    }
    for label in &finding.secondary {
        if let Some(location) = locate(label.span) {
            related.push(DiagnosticRelatedInformation { location, message: label.message.clone() });
        }
    }
    let is_unnecessary = finding.code.name.starts_with("unused") || finding.code.name.starts_with("unreachable");
    Diagnostic {
        range,
        severity: Some(severity(finding.severity)),
        code: Some(NumberOrString::String(finding.code.id.to_owned())),
        code_description: page(state, finding.code),
        source: Some(SOURCE.to_owned()),
        message: message(finding, state.client.relates),
        related_information: (state.client.relates && !related.is_empty()).then_some(related),
        tags: (is_unnecessary && state.client.grays).then(|| vec![DiagnosticTag::UNNECESSARY]),
        data: None,
    }
}

fn page(state: &State<'_>, code: &'static Code) -> Option<CodeDescription> {
    uri::of(&state.project.explained(code)?).map(|href| CodeDescription { href })
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::ERROR,
        Severity::Warning => DiagnosticSeverity::WARNING,
        Severity::Note => DiagnosticSeverity::INFORMATION,
    }
}

/// The message, and below it what else is known. The labels are apart, if the editor shows them.
fn message(finding: &Finding, relates: bool) -> String {
    let mut text = finding.message.clone();
    if !finding.primary.message.is_empty() {
        text.push_str(&format!("\n{}", finding.primary.message));
    }
    if !relates {
        for label in finding.secondary.iter().filter(|label| !label.message.is_empty()) {
            text.push_str(&format!("\n{}", label.message));
        }
    }
    for note in &finding.notes {
        text.push_str(&format!("\nnote: {note}"));
    }
    if let Some(help) = &finding.help {
        text.push_str(&format!("\nhelp: {help}"));
    }
    text
}

fn add_configurations(state: &mut State<'_>, found: &mut BTreeMap<PathBuf, Vec<Diagnostic>>) {
    for (sources, findings) in state.project.configuration_findings() {
        for finding in &findings {
            if let Some((path, diagnostic)) = of_configuration(state, &sources, finding) {
                add(found.entry(path).or_default(), diagnostic);
            }
        }
    }
}

fn of_configuration(state: &State<'_>, sources: &SourceMap, finding: &Finding) -> Option<(PathBuf, Diagnostic)> {
    let file = sources.file(sources.file_of(finding.primary.span)?);
    let text = crate::text::Text::new(file.text().clone());
    let base = file.base();
    let range = (finding.primary.span.start - base) as usize..(finding.primary.span.end - base) as usize;
    let diagnostic = Diagnostic {
        range: text.range(range, state.encoding),
        severity: Some(severity(finding.severity)),
        code: Some(NumberOrString::String(finding.code.id.to_owned())),
        source: Some(SOURCE.to_owned()),
        message: message(finding, false),
        ..Diagnostic::default()
    };
    Some((PathBuf::from(file.name()), diagnostic))
}

/// The text of a document that conditions leave out in each of its programs and stages.
fn inactive(state: &mut State<'_>, path: &Path) -> Vec<Diagnostic> {
    let ranges = inactive_ranges(state, path);
    let Some(document) = state.documents.get(path) else { return Vec::new() };
    let gray = |range: std::ops::Range<usize>| Diagnostic {
        range: document.text.range(range, state.encoding),
        severity: Some(DiagnosticSeverity::HINT),
        source: Some(SOURCE.to_owned()),
        message: "left out by a condition of the preprocessor".to_owned(),
        tags: Some(vec![DiagnosticTag::UNNECESSARY]),
        ..Diagnostic::default()
    };
    ranges.into_iter().map(gray).collect()
}

/// The ranges of a file that conditions leave out, in the first program of the file: in all stages that read it.
pub(super) fn inactive_ranges(state: &mut State<'_>, path: &Path) -> Vec<std::ops::Range<usize>> {
    let analyses = state.analyses_of(path);
    let n_shown = if state.pieces(path).is_some() { analyses.len() } else { 1 };
    let mut ranges: Vec<_> = analyses.iter().take(n_shown).flat_map(|one| inactive_in(one, path)).collect();
    ranges.sort_by_key(|range| (range.start, range.end));
    ranges.dedup();
    ranges
}

/// The ranges of a file that conditions leave out in all stages of a program that read it.
fn inactive_in(first: &Analysis, path: &Path) -> Vec<std::ops::Range<usize>> {
    let files: Vec<_> = first.files(path).collect();
    let mut lists = first.views_of(path).into_iter().map(|view| {
        let spans = view.ast.directives.inactive.iter();
        let places = spans.filter_map(|span| first.place(*span)).filter(|(file, _)| files.contains(file));
        places.map(|(_, range)| range).collect::<Vec<_>>()
    });
    let Some(mut ranges) = lists.next() else { return Vec::new() };
    for other in lists {
        let other: HashSet<std::ops::Range<usize>> = other.into_iter().collect();
        ranges.retain(|range| other.contains(range));
    }
    ranges
}

/// Answers an editor that asks for the diagnostics of a document.
pub(super) fn pull(state: &mut State<'_>, params: &DocumentDiagnosticParams) -> DocumentDiagnosticReportResult {
    let path = uri::path(&params.text_document.uri);
    let mut found = all(state);
    let own = found.remove(&path).unwrap_or_default();
    let id = identity(&own);
    found.retain(|other, _| !state.documents.contains_key(other));
    let report = |(path, items): (PathBuf, Vec<Diagnostic>)| {
        let report = FullDocumentDiagnosticReport { result_id: Some(identity(&items)), items };
        Some((state.uri(&path)?, DocumentDiagnosticReportKind::Full(report)))
    };
    let is_any = !found.is_empty();
    let related_documents = is_any.then(|| found.into_iter().filter_map(report).collect());
    let report = if params.previous_result_id.as_ref() == Some(&id) {
        DocumentDiagnosticReport::Unchanged(RelatedUnchangedDocumentDiagnosticReport {
            related_documents,
            unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport { result_id: id },
        })
    } else {
        DocumentDiagnosticReport::Full(RelatedFullDocumentDiagnosticReport {
            related_documents,
            full_document_diagnostic_report: FullDocumentDiagnosticReport { result_id: Some(id), items: own },
        })
    };
    DocumentDiagnosticReportResult::Report(report)
}

/// A word that is the same for the same diagnostics.
fn identity(diagnostics: &[Diagnostic]) -> String {
    let mut hasher = DefaultHasher::new();
    serde_json::to_string(diagnostics).unwrap_or_default().hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

/// The location of a finding's place, for those who only need that.
pub(super) fn location(state: &State<'_>, analysis: &Analysis, span: Span) -> Option<Location> {
    state.location(analysis, analysis.sources().call_site(span))
}
