//! `divergent-derivative`: an implicit derivative where neighboring fragments may have taken another path (§8.7,
//! §8.8).
//!
//! Lookups that compare depths are left out: such maps have one level. Those of one texture are one finding.

use super::super::divergence::{self, Cause, DivergentCall};
use super::super::{Findings, Subject};
use crate::hir::{ExprId, ExprKind, GlobalId, Shader, Stage, Type, Types, VarRef};
use rustc_hash::FxHashMap;

/// How many further calls of a group get a label.
const MAX_LABELS: usize = 4;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let Some(fragment) = program.stage(Stage::Fragment) else { return };
    let mut groups: Vec<(Cause, Vec<ExprId>)> = Vec::new();
    let mut indices: FxHashMap<Group, usize> = FxHashMap::default();
    for DivergentCall { expr, cause } in divergence::divergent_calls(fragment) {
        let ExprKind::BuiltinCall(function, arguments) = &fragment.expr(expr).kind else { continue };
        if !function.implicit_derivatives() || has_one_level(&program.types, fragment, arguments) {
            continue;
        }
        let texture = arguments.first().and_then(|&first| fragment.root_variable(first));
        let group = match texture {
            Some(VarRef::Global(global)) => Group::Texture(global),
            _ => Group::Condition(cause.condition),
        };
        let index = *indices.entry(group).or_insert(groups.len());
        match groups.get_mut(index) {
            Some((_, calls)) => calls.push(expr),
            None => groups.push((cause, vec![expr])),
        }
    }
    for (cause, mut calls) in groups {
        calls.sort_by_key(|&call| fragment.expr(call).span.start);
        report(fragment, cause, &calls, findings);
    }
}

/// Calls that are one finding.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Group {
    /// Lookups of one texture, which has several levels, or has not.
    Texture(GlobalId),
    /// Others under one condition.
    Condition(ExprId),
}

/// One finding for a group: at the first call, with labels at the condition and at further calls.
fn report(fragment: &Shader, cause: Cause, calls: &[ExprId], findings: &mut Findings<'_>) {
    let span = |id: ExprId| fragment.expr(id).span;
    let Some((&first, more)) = calls.split_first() else { return };
    let ExprKind::BuiltinCall(function, _) = &fragment.expr(first).kind else { return };
    let message = format!("`{}` takes implicit derivatives in non-uniform control flow", function.name());
    let mut finding = findings.at(span(first), message).here("the level of detail is undefined here");
    finding = finding.label(span(cause.condition), "this may differ between fragments");
    if let Some(call) = cause.call {
        finding = finding.label(span(call), "this call depends on it");
    }
    for &call in more.iter().take(MAX_LABELS) {
        finding = finding.label(span(call), "and here");
    }
    if more.len() > MAX_LABELS {
        finding = finding.note(format!("and in {} more places", more.len() - MAX_LABELS));
    }
    findings.push(finding.help("compute it before the branch, or use the form with `Lod` or `Grad`"));
}

/// Whether the texture has only one level, so that no level is selected, as maps of depths have.
fn has_one_level(types: &Types, shader: &Shader, arguments: &[ExprId]) -> bool {
    let sampler = arguments.first().map(|&first| types.get(shader.expr(first).ty));
    matches!(sampler, Some(Type::Sampler(kind)) if !kind.has_levels() || kind.shadow)
}
