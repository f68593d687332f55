//! Rules that depend on the version: whether the language has a [`Feature`] at a place, and the message where it does
//! not.
//!
//! *Holds:* each use of a missing feature is reported, and the analysis goes on as if the language had it.

use super::context::Analyzer;
use crate::builtin::Availability;
use crate::diagnostic::codes::qualifiers;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::hir::{ExprId, ExprKind, Type};
use crate::language::Feature;
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

    /// Reports a feature at `span` that the language lacks.
    pub(super) fn require(&mut self, feature: Feature, span: Span) {
        if !self.allows(feature, span) {
            let finding = self.finding_of(feature, span);
            self.report(finding);
        }
    }

    /// Reports an operator on integers that the language lacks, by its sign.
    pub(super) fn require_operator(&mut self, sign: &str, span: Span) {
        let feature = Feature::IntegerOperators;
        if self.allows(feature, span) {
            return;
        }
        self.report(self.finding_named(feature, span, &format!("`{sign}` on integers")));
    }

    /// Reports a whole array as a value that the language lacks. A constructor of an array is reported by itself.
    pub(super) fn require_array_value(&mut self, value: ExprId, span: Span) {
        let is_array = matches!(self.types.get(self.ty(value)), Type::Array(..));
        let is_list = self.sources.snippet(self.span(value)).starts_with('{');
        let is_reported = matches!(self.expr_at(value).kind, ExprKind::Construct(..)) && !is_list;
        if is_array && !is_reported {
            self.require(Feature::ArrayObjects, span);
        }
    }

    /// Reports a feature at `span` that the language lacks, with what to write instead.
    pub(super) fn require_with(&mut self, feature: Feature, span: Span, help: Option<Advice>) {
        if self.allows(feature, span) {
            return;
        }
        let finding = self.finding_of(feature, span);
        self.report(finding.maybe_help(help.filter(|_| self.ast.version.span.is_known())));
    }

    /// Reports an integer that only other versions convert to a `float`. The help is how to write the value.
    pub(super) fn require_float(&mut self, id: ExprId) {
        let (feature, span) = (Feature::ImplicitToFloat, self.span(id));
        if self.allows(feature, span) {
            return;
        }
        let finding = self.finding_of(feature, span);
        if !self.ast.version.span.is_known() {
            return self.report(finding);
        }
        let text = self.sources.snippet(span);
        let is_literal = !span.expansion.is_some() && is_decimal(text);
        let is_scalar = matches!(self.types.get(self.ty(id)), Type::Scalar(_));
        let help = match (is_literal, is_scalar) {
            (true, _) => Advice::write(Applicability::Safe, format!("{text}.0")),
            (false, true) => {
                Advice::new(Applicability::Safe, "write `float(..)` around it", Place::Around, "float(...)")
            }
            (false, false) => Advice::from("convert it, as by `vec2(..)`"),
        };
        self.report(Diagnostic { help: None, ..finding }.help(help));
    }

    fn finding_of(&self, feature: Feature, span: Span) -> Diagnostic {
        self.finding_named(feature, span, feature.row().name)
    }

    fn finding_named(&self, feature: Feature, span: Span, name: &str) -> Diagnostic {
        let row = feature.row();
        let version = self.ast.version;
        let finding =
            Diagnostic::new(&qualifiers::NEEDS_EXTENSION, span, format!("{name} is not in {}", version.name()))
                .here("not in this version of the language")
                .maybe_help(version.remedy(row.since, row.gone, row.extensions));
        of_version(Diagnostic { lacking: Some(feature), ..finding }, version)
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

/// Whether a text is a decimal number that an `int` holds: another one, such as the octal `010`, has another value with `.0` behind it.
fn is_decimal(text: &str) -> bool {
    (text == "0" || text.starts_with(|first: char| matches!(first, '1'..='9'))) && text.parse::<i32>().is_ok()
}
