//! Analyzes calls of built-in functions (§8): resolves overloads over the rows of the table.

use super::super::context::Analyzer;
use super::overload::{Resolution, leading, resolve};
use crate::builtin::constants::{MAX_PROGRAM_TEXEL_OFFSET, MIN_PROGRAM_TEXEL_OFFSET};
use crate::builtin::functions::{self, Row, Signature};
use crate::builtin::operations::{Class, Lookup};
use crate::builtin::{Availability, BuiltinFunction};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{names, types};
use crate::hir::{ExprId, ExprKind, Function, ScalarValue, Stage, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::Ident;
use crate::syntax::of_version;
use std::cmp::Reverse;

impl Analyzer<'_> {
    /// A call of a name that is a built-in function in some version.
    pub(super) fn builtin_call(&mut self, name: Ident, arguments: Vec<ExprId>, span: Span) -> ExprId {
        let (stage, version, extensions) = (self.stage, self.ast.version, self.extensions);
        let rows = functions::named(self.name(name));
        let given: Vec<TypeId> = arguments.iter().map(|&argument| self.ty(argument)).collect();
        let available = || rows.iter().copied().filter(|row| row.availability.holds(version, extensions, stage));
        let signatures = || available().flat_map(|row| row.signatures(stage).map(move |signature| (row, signature)));
        if available().next().is_none() {
            self.report_unavailable(name, rows, &given);
            return self.poison(span);
        }
        // Most calls match exactly, and then no candidates need to be collected.
        let exact = signatures().find(|(_, signature)| {
            let params = signature.params();
            params.len() == given.len() && params.iter().zip(&given).all(|((param, _), given)| param == given)
        });
        let found = exact.or_else(|| {
            // Two rows may have one signature: `max(genType, genType)` and `max(genType, float)` for one float.
            let mut candidates: Vec<(&'static Row, Signature)> = Vec::new();
            for (row, signature) in signatures() {
                if !candidates.iter().any(|(_, other)| other.params() == signature.params()) {
                    candidates.push((row, signature));
                }
            }
            self.builtin_by_conversion(name, &candidates, rows, &given)
        });
        let Some((row, signature)) = found else { return self.poison(span) };
        self.note_builtin(row.availability, name.span);
        let Some(arguments) = self.pass(arguments, signature.params()) else { return self.poison(span) };
        if !self.check_offset(row, &arguments) || !self.check_component_number(row, &arguments) {
            return self.poison(span);
        }
        if row.function.class() == Class::Composed {
            return self.composed(row.function, &arguments, span);
        }
        self.push(ExprKind::BuiltinCall(row.function, arguments), signature.ret, span)
    }

    /// Reports a built-in function that is not available here. Nothing is known of the arguments.
    pub(super) fn require_builtin(&mut self, name: Ident) {
        let (stage, version, extensions) = (self.stage, self.ast.version, self.extensions);
        let rows = functions::named(self.name(name));
        if !rows.iter().any(|row| row.availability.holds(version, extensions, stage)) {
            self.report_unavailable(name, rows, &[]);
        }
    }

    /// Whether a built-in function has the name and the parameters of a function of the shader.
    pub(in crate::analysis) fn is_builtin(&self, function: &Function) -> bool {
        let (stage, version, extensions) = (self.stage, self.ast.version, self.extensions);
        let rows = functions::named(&function.name).iter();
        let available = rows.filter(|row| row.availability.holds(version, extensions, stage));
        available.copied().flat_map(|row| row.signatures(stage)).any(|signature| {
            let params = signature.params();
            params.len() == function.param_count
                && params.iter().zip(function.params()).all(|((ty, _), param)| *ty == param.ty)
        })
    }

    /// The overload that takes the arguments after implicit conversions, if there is exactly one.
    fn builtin_by_conversion(
        &mut self,
        name: Ident,
        candidates: &[(&'static Row, Signature)],
        rows: &[&'static Row],
        given: &[TypeId],
    ) -> Option<(&'static Row, Signature)> {
        match self.resolve_builtin(candidates, given) {
            Resolution::Found(index) => candidates.get(index).copied(),
            Resolution::Ambiguous(first, second) => {
                let spelling = self.name(name);
                let mut finding = self.ambiguous(name, given);
                for index in [first, second] {
                    if let Some((_, signature)) = candidates.get(index) {
                        finding = finding.note(format!("it fits `{}`", signature.describe(spelling, self.types)));
                    }
                }
                self.report(finding);
                None
            }
            Resolution::Missing => {
                self.report_no_overload(name, rows, given);
                None
            }
        }
    }

    /// Resolves the overload.
    fn resolve_builtin(&self, candidates: &[(&'static Row, Signature)], given: &[TypeId]) -> Resolution {
        let params = candidates.iter().map(|(_, signature)| signature.params().iter().copied());
        resolve(self.types, self.rules(), given, params)
    }

    /// Checks that the offsets of texture functions are constant expressions (§8.7).
    fn check_offset(&mut self, row: &Row, arguments: &[ExprId]) -> bool {
        let Class::Texture(form) = row.function.class() else { return true };
        let position = row.params.iter().position(|param| matches!(param.name, "offset" | "offsets"));

        let Some(&offset) = position.and_then(|index| arguments.get(index)) else { return true };
        if self.is_constant(offset) {
            return form.lookup == Lookup::Gather || self.check_offset_range(offset);
        }
        let gathers = form.lookup == Lookup::Gather && !form.offsets;
        if gathers && self.allows(Feature::DynamicOffsets, self.span(offset)) {
            return true;
        }
        self.report(self.not_constant(offset, "the offset of a texture lookup"));
        false
    }

    /// "A limited range of offset values are supported" (§8.7): from gl_MinProgramTexelOffset to gl_MaxProgramTexelOffset. Gathers have
    /// another range, which implementations widen.
    fn check_offset_range(&mut self, offset: ExprId) -> bool {
        const RANGE: std::ops::RangeInclusive<i32> = MIN_PROGRAM_TEXEL_OFFSET..=MAX_PROGRAM_TEXEL_OFFSET;
        let Some(value) = self.evaluate(offset) else { return true };
        let outside = value.scalars.iter().find_map(|scalar| match scalar {
            ScalarValue::Int(number) if !RANGE.contains(number) => Some(*number),
            _ => None,
        });
        let Some(number) = outside else { return true };
        let message = format!("a texture lookup has no offset of {number} texels");
        self.report(
            Diagnostic::new(&types::OFFSET_RANGE, self.span(offset), message)
                .here(format!("{MIN_PROGRAM_TEXEL_OFFSET} to {MAX_PROGRAM_TEXEL_OFFSET} are supported"))
                .help("add the offset, divided by the size of the texture, to the coordinate"),
        );
        false
    }

    /// Checks the component that a gather reads: "the value of comp must be a constant integer expression with a value of 0, 1, 2,
    /// or 3" (GLSL 4.00 §8.9.3).
    fn check_component_number(&mut self, row: &Row, arguments: &[ExprId]) -> bool {
        let position = row.params.iter().position(|param| param.name == "comp");
        let Some(&component) = position.and_then(|index| arguments.get(index)) else { return true };
        if !self.is_constant(component) {
            self.report(self.not_constant(component, "the component of a gather"));
            return false;
        }
        let Some(number) = self.evaluate_integer(component).filter(|number| !(0..=3).contains(number)) else {
            return true;
        };
        self.report(
            Diagnostic::new(&types::INDEX_RANGE, self.span(component), format!("a gather has no component {number}"))
                .here("0, 1, 2 or 3 is needed")
                .help("0 is red, 1 green, 2 blue and 3 alpha"),
        );
        false
    }

    /// Reports a built-in function that this stage, version or profile has not. `given` are the types of the arguments, as far as
    /// they are known.
    fn report_unavailable(&mut self, name: Ident, rows: &[&'static Row], given: &[TypeId]) {
        let spelling = self.name(name);
        let (version, extensions) = (self.ast.version, self.extensions);
        // No version brings a function into a stage for which none has it.
        let is_of_stage = rows.iter().any(|row| row.availability.stages.has(self.stage));
        let has = |stage: Stage| {
            let mut rows = rows.iter().map(|row| row.availability);
            if is_of_stage {
                rows.any(|one| one.holds(version, extensions, stage))
            } else {
                rows.any(|one| one.stages.has(stage))
            }
        };
        let elsewhere: Vec<&str> = Stage::ALL.into_iter().filter(|&stage| has(stage)).map(Stage::name).collect();
        let finding = if elsewhere.is_empty() {
            let message = format!("the function `{spelling}` is not in {}", version.name());
            // The overload that takes these arguments may need another extension than the others.
            let mut rows: Vec<&'static Row> = rows.to_vec();
            rows.sort_by_key(|row| !self.takes(row, given));
            let finding = Diagnostic::new(&names::BUILTIN_UNAVAILABLE, name.span, message).here("not available here");
            of_version(finding.maybe_help(self.remedy(spelling, &rows)), version)
        } else {
            self.in_other_stages(name, &elsewhere)
        };
        self.report(finding);
    }

    /// The finding about a function that other stages alone have.
    fn in_other_stages(&self, name: Ident, stages: &[&str]) -> Diagnostic {
        let (spelling, stage) = (self.name(name), self.stage.name());
        let message = format!("the function `{spelling}` does not exist in a {stage} shader");
        let finding = Diagnostic::new(&names::BUILTIN_UNAVAILABLE, name.span, message);
        finding.here(format!("only in {} shaders", stages.join(" and ")))
    }

    /// How the source gets one of some rows, which it has not: the first of them by preference.
    fn remedy(&self, spelling: &str, rows: &[&'static Row]) -> Option<String> {
        let version = self.ast.version;
        let remedies = || {
            rows.iter().filter_map(|row| {
                let Availability { since, gone, extensions, compatibility_only, .. } = row.availability;
                if compatibility_only && version.reaches(since) {
                    return Some("only the compatibility profile has it".to_owned());
                }
                let remedy = version.remedy(since, gone, extensions)?;
                let is_renamed = version.reaches(since) && row.function.name() != spelling;
                Some(if is_renamed { format!("write `{}`; {remedy}", row.function.name()) } else { remedy })
            })
        };
        // One of the overloads may be for the other language alone.
        remedies().find(|remedy| !remedy.starts_with("only")).or_else(|| remedies().next())
    }

    /// Whether an overload of a row takes these arguments, in the versions that have it.
    fn takes(&self, row: &'static Row, given: &[TypeId]) -> bool {
        row.params.len() == given.len() && self.leading_arguments(row, given) == given.len()
    }

    /// How many of the first arguments an overload of a row takes.
    fn leading_arguments(&self, row: &'static Row, given: &[TypeId]) -> usize {
        let conversions = self.rules().conversions;
        let leading =
            |signature: Signature| leading(self.types, conversions, given, signature.params().iter().copied());
        row.signatures(self.stage).map(leading).max().unwrap_or(0)
    }

    fn report_no_overload(&mut self, name: Ident, rows: &[&'static Row], given: &[TypeId]) {
        let mut finding = self.no_overload(name, given);
        let (version, extensions, stage) = (self.ast.version, self.extensions, self.stage);
        let prototypes = rows.iter().copied().filter(|row| row.availability.holds(version, extensions, stage));
        // The overloads that take most of the first arguments are the closest, then those with the right number of parameters.
        let mut closest: Vec<_> = prototypes.map(|row| (self.leading_arguments(row, given), row)).collect();
        closest.sort_by_key(|(leading, row)| (Reverse(*leading), row.params.len().abs_diff(given.len())));
        let any = closest.first().is_some_and(|(leading, _)| *leading > 0);
        for (_, row) in closest.iter().filter(|(leading, _)| *leading > 0 || !any).take(4) {
            finding = finding.note(format!("there is `{}`", row.prototype()));
        }
        let elsewhere: Vec<&'static Row> = rows
            .iter()
            .copied()
            .filter(|row| row.availability.stages.has(stage) && !row.availability.in_language(version, extensions))
            .filter(|row| self.takes(row, given))
            .collect();
        let help = derivative_help(rows, given, self).or_else(|| self.remedy(self.name(name), &elsewhere));
        self.report(finding.maybe_help(help));
    }
}

/// A help text for the most frequent mistakes.
fn derivative_help(rows: &[&'static Row], given: &[TypeId], analyzer: &Analyzer<'_>) -> Option<String> {
    let function = rows.first()?.function;
    let sampler = given.first().is_some_and(|&ty| analyzer.types.contains_sampler(ty));
    match function {
        BuiltinFunction::Texture if !sampler => Some("the first argument is a sampler".into()),
        _ => None,
    }
}
