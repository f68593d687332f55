//! Writes diagnostics as one JSON array, for editors and scripts.
//!
//! *Holds:* keys are only ever added. Lines and columns count from 1; `end_column` is exclusive.

use super::{Finding, Region};
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

#[derive(Serialize)]
struct JsonFinding<'a> {
    #[serde(flatten)]
    region: JsonRegion<'a>,
    severity: String,
    code: &'a str,
    name: &'a str,
    message: &'a str,
    help: Option<&'a str>,
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

/// Writes the findings as a JSON array, ending in a newline.
pub fn json(findings: &[Finding]) -> String {
    let rows: Vec<JsonFinding<'_>> = findings.iter().map(row).collect();
    let mut text = serde_json::to_string_pretty(&rows).expect("strings and numbers are always JSON");
    text.push('\n');
    text
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
        labels: labels
            .map(|label| JsonLabel { region: JsonRegion::from(&label.region), message: &label.message })
            .collect(),
        notes: &finding.notes,
        section: Some(&*finding.section).filter(|section| !section.is_empty()),
        presented_line: finding.presented_line,
    }
}
