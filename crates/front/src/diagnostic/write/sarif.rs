//! Writes diagnostics as SARIF 2.1.0, the format of code-scanning services.
//!
//! *Holds:* there is one run; `rules` lists the codes that occur, in order of identifier, with their pages. Columns
//! count Unicode code points (`columnKind`); the end is exclusive. Files that were not checked are notifications of the
//! invocation (§3.20.21), not results.

use super::hostile::escaped;
use super::{Finding, FindingFix, NotChecked, Region, Scope, fingerprints};
use crate::diagnostic::codes::general::NOT_CHECKED;
use crate::diagnostic::{Code, Severity};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Where the documentation of the program is.
const HOME: &str = "https://docs.rs/glisten";
/// Where the documentation of a code is: a search for its identifier.
const CODES: &str = concat!("https://docs.rs/glisten-front/", env!("CARGO_PKG_VERSION"), "/glisten_front/?search=");
/// The name and version of [`Finding::fingerprint`].
const FINGERPRINT: &str = "glistenFinding/v1";

/// Writes the findings as a SARIF log, ending in a newline.
pub fn sarif(findings: &[Finding], scope: Option<&Scope>) -> String {
    sarif_with_names(findings, scope, &|name| name.as_bytes().to_vec())
}

/// Writes the findings like [`sarif()`], for a caller who knows the bytes of names that are not UTF-8: the URI of a file has those.
pub fn sarif_with_names(findings: &[Finding], scope: Option<&Scope>, bytes_of: &dyn Fn(&str) -> Vec<u8>) -> String {
    let codes: BTreeMap<&str, &Code> = findings.iter().map(|finding| (finding.code.id, finding.code)).collect();
    let indices: BTreeMap<&str, usize> = codes.keys().enumerate().map(|(index, id)| (*id, index)).collect();
    let rules: Vec<Value> = codes.values().map(|code| rule(code)).collect();
    let index = |finding: &Finding| indices.get(finding.code.id).copied();
    let results = findings.iter().zip(fingerprints(findings));
    let results: Vec<Value> = results.map(|(finding, print)| result(finding, index(finding), &print)).collect();
    let mut log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "glisten",
                "informationUri": HOME,
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    if let (Some(scope), Some(run)) = (scope, log.pointer_mut("/runs/0").and_then(Value::as_object_mut)) {
        let notifications: Vec<Value> = scope.not_checked.iter().map(notification).collect();
        let invocation = json!({ "executionSuccessful": true, "toolExecutionNotifications": notifications });
        run.insert("invocations".to_owned(), json!([invocation]));
    }
    set_uris(&mut log, bytes_of);
    let text = serde_json::to_string_pretty(&log).expect("strings and numbers are always JSON");
    escaped(&text) + "\n"
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
        "helpUri": format!("{CODES}{}", code.id),
        "defaultConfiguration": { "level": level(code.severity) },
    })
}

/// A file that was not checked.
fn notification(one: &NotChecked) -> Value {
    json!({
        "descriptor": { "id": NOT_CHECKED.id },
        "level": if one.is_denied { "error" } else { "note" },
        "message": { "text": format!("not checked: {}", one.because) },
        "locations": [location(&one.region)],
    })
}

/// A fix (§3.55): the changes of each file.
fn fix(fix: &FindingFix) -> Value {
    let mut files: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
    for edit in &fix.edits {
        files.entry(&edit.region.file).or_default().push(json!({
            "deletedRegion": region(&edit.region),
            "insertedContent": { "text": edit.text },
        }));
    }
    let changes = files
        .into_iter()
        .map(|(file, replacements)| json!({ "artifactLocation": { "uri": file }, "replacements": replacements }));
    let changes: Vec<Value> = changes.collect();
    json!({
        "description": { "text": fix.title },
        "artifactChanges": changes,
        "properties": { "applicability": fix.applicability.name() },
    })
}

fn result(finding: &Finding, rule_index: Option<usize>, fingerprint: &str) -> Value {
    let mut text = finding.message.clone();
    if let Some(help) = &finding.help {
        text.push_str(". Help: ");
        text.push_str(help);
    }
    let related: Vec<Value> = finding
        .labels
        .iter()
        // The primary location is told already.
        .filter(|label| label.region != finding.region)
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
        "partialFingerprints": { FINGERPRINT: fingerprint },
    });
    if let (Some(index), Some(map)) = (rule_index, result.as_object_mut()) {
        map.insert("ruleIndex".to_owned(), json!(index));
    }
    let fixes: Vec<Value> = finding.fixes.iter().map(fix).collect();
    if let (false, Some(map)) = (fixes.is_empty(), result.as_object_mut()) {
        map.insert("fixes".to_owned(), json!(fixes));
    }
    result
}

fn location(at: &Region) -> Value {
    json!({ "physicalLocation": {
        "artifactLocation": { "uri": at.file },
        "region": region(at),
    }})
}

fn region(region: &Region) -> Value {
    json!({
        "startLine": region.line,
        "startColumn": region.column,
        "endLine": region.end_line,
        "endColumn": region.end_column,
    })
}

/// Makes URIs of the names of files.
fn set_uris(value: &mut Value, bytes_of: &dyn Fn(&str) -> Vec<u8>) {
    match value {
        Value::Array(all) => all.iter_mut().for_each(|one| set_uris(one, bytes_of)),
        Value::Object(map) => {
            for (key, one) in map {
                match one.get_mut("uri").filter(|_| key == "artifactLocation") {
                    Some(name) => *name = json!(uri(&bytes_of(name.as_str().unwrap_or_default()))),
                    None => set_uris(one, bytes_of),
                }
            }
        }
        _ => {}
    }
}

/// The path as a URI reference: bytes that RFC 3986 does not allow in a path are percent-encoded.
fn uri(path: &[u8]) -> String {
    let mut uri = String::new();
    for &byte in path {
        match byte {
            b'\\' => uri.push('/'),
            byte if byte.is_ascii_alphanumeric() || b"-._~/!$&'()*+,;=@".contains(&byte) => uri.push(char::from(byte)),
            byte => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}
