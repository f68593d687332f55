//! Writes diagnostics as one JSON array, for editors and scripts.
//!
//! *Holds:* keys are only ever added. Lines and columns count from 1; `end_column` is exclusive.

use super::hostile::escaped;
use super::scope::counts;
use super::{Finding, FindingFix, NotChecked, Region, Scope};
use serde::Serialize;

/// The keys of a region.
#[derive(Serialize)]
struct JsonRegion<'a> {
    file: &'a str,
    line: u32,
    column: u32,
    end_line: u32,
    end_column: u32,
}

#[derive(Serialize)]
struct JsonLabel<'a> {
    #[serde(flatten)]
    region: JsonRegion<'a>,
    message: &'a str,
}

/// A position; the end of an edit is exclusive.
#[derive(Serialize)]
struct JsonPosition {
    line: u32,
    column: u32,
}

#[derive(Serialize)]
struct JsonEdit<'a> {
    file: &'a str,
    start: JsonPosition,
    end: JsonPosition,
    text: &'a str,
}

#[derive(Serialize)]
struct JsonFix<'a> {
    title: &'a str,
    applicability: &'a str,
    edits: Vec<JsonEdit<'a>>,
}

#[derive(Serialize)]
struct JsonFinding<'a> {
    #[serde(flatten)]
    region: JsonRegion<'a>,
    severity: String,
    code: &'a str,
    name: &'a str,
    message: &'a str,
    help: Option<&'a str>,
    fixes: Vec<JsonFix<'a>>,
    labels: Vec<JsonLabel<'a>>,
    notes: &'a [String],
    section: Option<&'a str>,
    presented_line: Option<u32>,
}

impl<'a> From<&'a Region> for JsonRegion<'a> {
    fn from(region: &'a Region) -> Self {
        Self {
            file: &region.file,
            line: region.line,
            column: region.column,
            end_line: region.end_line,
            end_column: region.end_column,
        }
    }
}

/// The last object of a run that says what it looked at.
#[derive(Serialize)]
struct JsonScope<'a> {
    summary: JsonSummary,
    not_checked: Vec<JsonNotChecked<'a>>,
}

#[derive(Serialize)]
struct JsonSummary {
    files: usize,
    programs: usize,
    errors: usize,
    warnings: usize,
    notes: usize,
    not_checked: usize,
}

#[derive(Serialize)]
struct JsonNotChecked<'a> {
    file: &'a str,
    because: &'a str,
}

/// An element of the array.
#[derive(Serialize)]
#[serde(untagged)]
enum JsonRow<'a> {
    Finding(Box<JsonFinding<'a>>),
    Scope(JsonScope<'a>),
}

/// Writes the findings as a JSON array, ending in a newline. With a scope, the last object tells it.
pub fn json(findings: &[Finding], scope: Option<&Scope>) -> String {
    let found = findings.iter().map(|finding| JsonRow::Finding(Box::new(row(finding))));
    let scope = scope.map(|scope| JsonRow::Scope(summary(findings, scope)));
    let rows: Vec<JsonRow<'_>> = found.chain(scope).collect();
    let text = serde_json::to_string_pretty(&rows).expect("strings and numbers are always JSON");
    escaped(&text) + "\n"
}

fn summary<'a>(findings: &[Finding], scope: &'a Scope) -> JsonScope<'a> {
    let [errors, warnings, notes] = counts(findings);
    let row = |one: &'a NotChecked| JsonNotChecked { file: &one.region.file, because: &one.because };
    JsonScope {
        summary: JsonSummary {
            files: scope.files,
            programs: scope.programs,
            errors,
            warnings,
            notes,
            not_checked: scope.not_checked.len(),
        },
        not_checked: scope.not_checked.iter().map(row).collect(),
    }
}

fn fix(fix: &FindingFix) -> JsonFix<'_> {
    let edits = fix.edits.iter().map(|edit| JsonEdit {
        file: &edit.region.file,
        start: JsonPosition { line: edit.region.line, column: edit.region.column },
        end: JsonPosition { line: edit.region.end_line, column: edit.region.end_column },
        text: &edit.text,
    });
    JsonFix { title: &fix.title, applicability: fix.applicability.name(), edits: edits.collect() }
}

fn row(finding: &Finding) -> JsonFinding<'_> {
    let labels = finding.labels.iter();
    JsonFinding {
        region: JsonRegion::from(&finding.region),
        severity: finding.severity.to_string(),
        code: finding.code.id,
        name: finding.code.name,
        message: &finding.message,
        help: finding.help.as_deref(),
        fixes: finding.fixes.iter().map(fix).collect(),
        labels: labels
            .map(|label| JsonLabel { region: JsonRegion::from(&label.region), message: &label.message })
            .collect(),
        notes: &finding.notes,
        section: Some(&*finding.section).filter(|section| !section.is_empty()),
        presented_line: finding.presented_line,
    }
}
