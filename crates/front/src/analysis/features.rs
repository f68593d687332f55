//! Rules that depend on the version: whether the language has a [`Feature`] at a place, and the message where it does
//! not.
//!
//! *Holds:* each missing feature is reported once in a shader, and the analysis goes on as if the language had it.

use super::context::Analyzer;
use crate::builtin::Availability;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::qualifiers;
use crate::language::{Extensions, Feature, NEVER, Since, Version};
use crate::source::Span;
use crate::syntax::{of_version, warning_of_use};

impl Analyzer<'_> {
    /// Whether the language has the feature used at `span`, by its version or by an enabled extension. Warns about the
    /// use if the source asks for that (§3.3).
    pub(super) fn allows(&mut self, feature: Feature, span: Span) -> bool {
        if self.ast.version.has(feature) {
            return true;
        }
        let extensions = feature.row().extensions;
        if let Some(warning) = warning_of_use(self.extensions, extensions, span) {
            self.report(warning);
        }
        self.extensions.intersects(extensions)
    }

    /// Reports a feature at `span` that the language lacks, at its first use.
    pub(super) fn require(&mut self, feature: Feature, span: Span) {
        let bit = 1u64 << (feature as u32 % 64);
        if self.allows(feature, span) || self.lacking & bit != 0 {
            return;
        }
        self.lacking |= bit;
        self.report_lacking(feature, span);
    }

    /// Reports a feature at `span` that the language lacks, at each use.
    pub(super) fn require_here(&mut self, feature: Feature, span: Span) {
        if !self.allows(feature, span) {
            self.report_lacking(feature, span);
        }
    }

    fn report_lacking(&mut self, feature: Feature, span: Span) {
        let row = feature.row();
        let version = self.ast.version;
        let finding =
            Diagnostic::new(&qualifiers::NEEDS_EXTENSION, span, format!("{} is not in {}", row.name, version.name()))
                .here("not in this version of the language")
                .maybe_help(remedy(version, row.since, row.gone, row.extensions));
        self.report(of_version(finding, version));
    }

    /// Warns about the use of a built-in name that only an extension provides, if the source asks for that (§3.3).
    pub(super) fn note_builtin(&mut self, availability: Availability, span: Span) {
        if availability.in_version(self.ast.version) {
            return;
        }
        if let Some(warning) = warning_of_use(self.extensions, availability.extensions, span) {
            self.report(warning);
        }
    }
}

/// How a language becomes one that has something.
pub(super) fn remedy(version: Version, since: Since, gone: Since, extensions: Extensions) -> Option<String> {
    if version.reaches(since) && !version.still_has(gone) {
        let last = if version.is_es() { gone.es } else { gone.desktop };
        return Some(format!("versions before {} have it", Version { number: last, ..version }.name()));
    }
    let first = version.first(since).map(|line| format!("`{line}` has it"));
    let extension = extensions.name().filter(|_| !version.is_es());
    let extension = extension.map(|name| format!("put `#extension {name} : enable` at the top"));
    match (first, extension) {
        (Some(first), Some(extension)) => Some(format!("{first}, or {extension}")),
        (first, extension) => first.or(extension),
    }
    .or_else(|| {
        let other = if version.is_es() { since.desktop } else { since.es };
        (other != NEVER)
            .then(|| if version.is_es() { "only OpenGL has it" } else { "only OpenGL ES has it" }.to_owned())
    })
}
