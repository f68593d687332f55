//! Writes diagnostics as workflow commands of GitHub Actions, which shows them next to the changed lines.

use super::{Finding, NotChecked, Scope, clean};
use crate::diagnostic::Severity;
use crate::diagnostic::codes::general::NOT_CHECKED;

/// Writes one `::error file=...::` line per finding, and one per file that was not checked.
pub fn github(findings: &[Finding], scope: Option<&Scope>) -> String {
    let not_checked = scope.map_or(&[][..], |scope| &scope.not_checked);
    findings.iter().map(line).chain(not_checked.iter().map(passed_over)).collect()
}

fn passed_over(one: &NotChecked) -> String {
    format!(
        "::{} file={},line={},title={}::not checked: {}\n",
        if one.is_denied { "error" } else { "notice" },
        property(&one.region.file),
        one.region.line,
        property(&format!("{} {}", NOT_CHECKED.id, NOT_CHECKED.name)),
        data(&one.because),
    )
}

fn line(finding: &Finding) -> String {
    let command = match finding.severity {
        Severity::Note => "notice",
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    let region = &finding.region;
    let mut message = finding.message.clone();
    if let Some(help) = &finding.help {
        message.push_str("\nhelp: ");
        message.push_str(help);
    }
    // GitHub accepts columns only for annotations within one line.
    let columns = if region.line == region.end_line {
        format!(",col={},endColumn={}", region.column, region.end_column)
    } else {
        String::new()
    };
    format!(
        "::{command} file={},line={},endLine={}{columns},title={}::{}\n",
        property(&region.file),
        region.line,
        region.end_line,
        property(&format!("{} {}", finding.code.id, finding.code.name)),
        data(&message),
    )
}

/// Escapes the text after `::`. The log of a workflow is shown by terminals, too.
fn data(text: &str) -> String {
    clean(&text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A"))
}

/// Escapes the value of a property.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
