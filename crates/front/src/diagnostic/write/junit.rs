//! Writes diagnostics as a report of JUnit's form, which most systems for continuous integration read.
//!
//! *Holds:* a test suite for each file, a test case for each finding. Errors and warnings are failures, notes pass, and
//! a file that was not checked is a skipped case (a failure if that is denied). A run without findings has one case that
//! passes, since some systems refuse a report without cases.

use super::hostile::is_hostile;
use super::{Finding, NotChecked, Scope};
use crate::diagnostic::Severity;
use std::collections::BTreeMap;

/// The cases of a file.
#[derive(Default)]
struct Suite {
    tests: usize,
    failures: usize,
    skipped: usize,
    cases: String,
}

impl Suite {
    fn counts(&self) -> String {
        let Self { tests, failures, skipped, .. } = self;
        format!("tests=\"{tests}\" failures=\"{failures}\" errors=\"0\" skipped=\"{skipped}\"")
    }

    /// Adds a case, `inner` being its elements.
    fn case(&mut self, file: &str, name: &str, inner: &str) {
        self.tests += 1;
        let (file, name) = (escaped_xml(file), escaped_xml(name));
        self.cases.push_str(&format!("    <testcase classname=\"{file}\" name=\"{name}\">{inner}</testcase>\n"));
    }

    fn finding(&mut self, finding: &Finding) {
        let region = &finding.region;
        let name = format!("{} {} at {}:{}", finding.code.id, finding.code.name, region.line, region.column);
        let help = finding.help.iter().map(|help| format!("\nhelp: {help}"));
        let place = format!("{}:{}:{}: {}", region.file, region.line, region.column, finding.message);
        let text = escaped_xml(&help.fold(place, |text, help| text + &help));
        let inner = match finding.severity {
            Severity::Note => format!("<system-out>{text}</system-out>"),
            severity => {
                self.failures += 1;
                let (kind, message) = (if severity == Severity::Error { "error" } else { "warning" }, &finding.message);
                format!("<failure type=\"{kind}\" message=\"{}\">{text}</failure>", escaped_xml(message))
            }
        };
        self.case(&region.file, &name, &inner);
    }

    fn not_checked(&mut self, one: &NotChecked) {
        let message = escaped_xml(&format!("not checked: {}", one.because));
        let inner = if one.is_denied {
            self.failures += 1;
            format!("<failure type=\"error\" message=\"{message}\"/>")
        } else {
            self.skipped += 1;
            format!("<skipped message=\"{message}\"/>")
        };
        self.case(&one.region.file, "not checked", &inner);
    }
}

/// Writes one XML document.
pub fn junit(findings: &[Finding], scope: Option<&Scope>) -> String {
    let mut suites: BTreeMap<&str, Suite> = BTreeMap::new();
    for finding in findings {
        suites.entry(&finding.region.file).or_default().finding(finding);
    }
    for one in scope.into_iter().flat_map(|scope| &scope.not_checked) {
        suites.entry(&one.region.file).or_default().not_checked(one);
    }
    if suites.is_empty() {
        let files = scope.map_or_else(|| "all files".to_owned(), |scope| format!("files: {}", scope.files));
        suites.entry("glisten").or_default().case("glisten", &format!("{files}, nothing found"), "");
    }
    let all = Suite {
        tests: suites.values().map(|suite| suite.tests).sum(),
        failures: suites.values().map(|suite| suite.failures).sum(),
        skipped: suites.values().map(|suite| suite.skipped).sum(),
        cases: String::new(),
    };
    let mut text =
        format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"glisten\" {}>\n", all.counts());
    for (file, suite) in &suites {
        let head = format!("  <testsuite name=\"{}\" {}>\n", escaped_xml(file), suite.counts());
        text.push_str(&(head + &suite.cases + "  </testsuite>\n"));
    }
    text + "</testsuites>\n"
}

/// Text for XML 1.0, in an element or in quotes; characters that XML cannot hold are left out.
pub fn escaped_xml(text: &str) -> String {
    let is_allowed = |c: &char| match c {
        '\n' | '\t' => true,
        '\u{fffe}' | '\u{ffff}' => false,
        c => !c.is_control(),
    };
    let mut out = String::new();
    for c in text.chars().filter(is_allowed) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if is_hostile(c) && c != '\n' && c != '\t' => out.push_str(&format!("&#x{:X};", u32::from(c))),
            c => out.push(c),
        }
    }
    out
}
