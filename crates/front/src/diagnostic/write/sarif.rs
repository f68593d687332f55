//! Writes diagnostics as SARIF 2.1.0, the format of code-scanning services.
//!
//! *Holds:* there is one run; `rules` lists the codes that occur, in order of identifier, with their pages. Columns
//! count Unicode code points (`columnKind`); the end is exclusive.

use super::{Finding, Region};
use crate::diagnostic::{Code, Severity};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Writes the findings as a SARIF log, ending in a newline.
pub fn sarif(findings: &[Finding]) -> String {
    let codes: BTreeMap<&str, &Code> = findings.iter().map(|finding| (finding.code.id, finding.code)).collect();
    let indices: BTreeMap<&str, usize> = codes.keys().enumerate().map(|(index, id)| (*id, index)).collect();
    let rules: Vec<Value> = codes.values().map(|code| rule(code)).collect();
    let results: Vec<Value> =
        findings.iter().map(|finding| result(finding, indices.get(finding.code.id).copied())).collect();
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "glisten",
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    let mut text = serde_json::to_string_pretty(&log).expect("strings and numbers are always JSON");
    text.push('\n');
    text
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    }
}

fn rule(code: &Code) -> Value {
    let mut help = code.page.to_owned();
    if !code.section.is_empty() {
        help.push_str(&format!(" ({})", code.section));
    }
    json!({
        "id": code.id,
        "name": code.name,
        "shortDescription": { "text": code.name.replace('-', " ") },
        "fullDescription": { "text": code.page },
        "help": { "text": help },
        "defaultConfiguration": { "level": level(code.severity) },
    })
}

fn result(finding: &Finding, rule_index: Option<usize>) -> Value {
    let mut text = finding.message.clone();
    if let Some(help) = &finding.help {
        text.push_str(". ");
        text.push_str(help);
    }
    let related: Vec<Value> = finding
        .labels
        .iter()
        .map(|label| {
            let mut location = location(&label.region);
            if let Some(map) = location.as_object_mut() {
                map.insert("message".to_owned(), json!({ "text": label.message }));
            }
            location
        })
        .collect();
    let mut result = json!({
        "ruleId": finding.code.id,
        "level": level(finding.severity),
        "message": { "text": text },
        "locations": [location(&finding.region)],
        "relatedLocations": related,
    });
    if let (Some(index), Some(map)) = (rule_index, result.as_object_mut()) {
        map.insert("ruleIndex".to_owned(), json!(index));
    }
    result
}

fn location(region: &Region) -> Value {
    json!({ "physicalLocation": {
        "artifactLocation": { "uri": uri(&region.file) },
        "region": {
            "startLine": region.line,
            "startColumn": region.column,
            "endLine": region.end_line,
            "endColumn": region.end_column,
        },
    }})
}

/// The path as a URI reference: bytes that RFC 3986 does not allow in a path are percent-encoded.
fn uri(path: &str) -> String {
    let mut uri = String::new();
    for byte in path.replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/!$&'()*+,;=@".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}
