//! Writes diagnostics as a code quality report of GitLab, which shows them in merge requests.
//!
//! *Holds:* each entry has the keys that GitLab requires: `description`, `check_name`, `fingerprint`, `severity` and
//! `location`; no two entries have the same fingerprint.

use super::hostile::escaped;
use super::{Finding, NotChecked, Scope, fingerprints};
use crate::diagnostic::Severity;
use crate::diagnostic::codes::general::NOT_CHECKED;
use serde_json::{Value, json};

/// Writes one JSON array, ending in a newline.
pub fn gitlab(findings: &[Finding], scope: Option<&Scope>) -> String {
    let not_checked = scope.map_or(&[][..], |scope| &scope.not_checked);
    let found = findings.iter().zip(fingerprints(findings)).map(|(finding, fingerprint)| entry(finding, &fingerprint));
    let all: Vec<Value> = found.chain(not_checked.iter().map(passed_over)).collect();
    let text = serde_json::to_string_pretty(&all).expect("strings and numbers are always JSON");
    escaped(&text) + "\n"
}

fn entry(finding: &Finding, fingerprint: &str) -> Value {
    let severity = match finding.severity {
        Severity::Note => "info",
        Severity::Warning => "minor",
        Severity::Error => "major",
    };
    let description = match &finding.help {
        Some(help) => format!("{}. Help: {help}", finding.message),
        None => finding.message.clone(),
    };
    json!({
        "description": description,
        "check_name": finding.code.id,
        "fingerprint": format!("{}:{fingerprint}", finding.region.file),
        "severity": severity,
        "location": {
            "path": finding.region.file,
            "positions": {
                "begin": { "line": finding.region.line, "column": finding.region.column },
                "end": { "line": finding.region.end_line, "column": finding.region.end_column },
            },
        },
    })
}

fn passed_over(one: &NotChecked) -> Value {
    json!({
        "description": format!("not checked: {}", one.because),
        "check_name": NOT_CHECKED.id,
        "fingerprint": format!("{}:not-checked", one.region.file),
        "severity": if one.is_denied { "major" } else { "info" },
        "location": { "path": one.region.file, "lines": { "begin": one.region.line } },
    })
}
