//! [`Told`]: the diagnostics that were reported, each once; [`Document`]: those that standard error gets as one text for programs.
//!
//! *In:* batches of diagnostics. *Out:* the findings, and their text in a format. *Holds:* a command that reads several scenes or
//! programs has one document, written at its end, so that its reader has one text to parse.

use crate::arguments::args::DiagnosticFormat;
use crate::batch::Batch;
use crate::files;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::write::{self, Finding, Region, Scope};
use std::collections::{BTreeMap, BTreeSet};

/// The diagnostics that have been reported.
#[derive(Debug, Default)]
pub(crate) struct Told {
    /// Each of them once, in order.
    pub(crate) findings: Vec<Finding>,
    seen: BTreeSet<(Region, &'static str, String)>,
    /// The files by the names that findings have.
    files: BTreeMap<String, String>,
}

impl Told {
    /// Adds a batch and returns its diagnostics that are new.
    pub(crate) fn add<'b>(&mut self, batch: &'b Batch) -> Vec<&'b Diagnostic> {
        let mut fresh = Vec::new();
        for diagnostic in &batch.diagnostics {
            let finding = Finding::new(&batch.sources, diagnostic);
            let region = self.region(&finding);
            if self.seen.insert((region, finding.code.id, finding.message.clone())) {
                self.findings.push(finding);
                fresh.push(diagnostic);
            }
        }
        fresh
    }

    /// The region of a finding, with one name for its file, however the path there is written.
    fn region(&mut self, finding: &Finding) -> Region {
        let name = &finding.region.file;
        let file = match self.files.get(name) {
            Some(file) => file.clone(),
            None => self.files.entry(name.clone()).or_insert(files::one_name(name)).clone(),
        };
        Region { file, ..finding.region.clone() }
    }

    /// The findings as a text for programs; none for the format of people, which is written with the sources.
    pub(crate) fn text(&self, format: DiagnosticFormat, scope: Option<&Scope>) -> Option<String> {
        let findings = &self.findings;
        Some(match format {
            DiagnosticFormat::Human => return None,
            DiagnosticFormat::Json => write::json(findings, scope),
            DiagnosticFormat::Sarif => write::sarif_with_names(findings, scope, &files::bytes_of_name),
            DiagnosticFormat::Github => write::github(findings, scope),
            DiagnosticFormat::Gitlab => write::gitlab(findings, scope),
            DiagnosticFormat::Junit => write::junit(findings, scope),
        })
    }
}

/// The document of a run.
#[derive(Debug)]
pub(crate) struct Document {
    format: DiagnosticFormat,
    told: Told,
    scope: Option<Scope>,
    is_due: bool,
}

impl Document {
    /// A document that nothing was reported to.
    pub(crate) fn new(format: DiagnosticFormat) -> Self {
        Self { format, told: Told::default(), scope: None, is_due: false }
    }

    /// Adds batches. From now on there is something to write, be it that nothing was found.
    pub(crate) fn add(&mut self, batches: &[&Batch], scope: Option<&Scope>) {
        for batch in batches {
            self.told.add(batch);
        }
        self.scope = scope.cloned().or(self.scope.take());
        self.is_due = true;
    }

    /// The text, if there is something to write. It is written once.
    pub(crate) fn take(&mut self) -> Option<String> {
        let text = self.told.text(self.format, self.scope.as_ref()).filter(|_| self.is_due);
        self.is_due = false;
        text
    }
}
