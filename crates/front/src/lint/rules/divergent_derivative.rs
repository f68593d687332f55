//! `divergent-derivative`: an implicit derivative where neighboring fragments may have taken another path (§8.7,
//! §8.8). Textures that nearly always have one level are left out: lines, volumes, depths.

use super::super::divergence::{self, Cause, DivergentCall};
use super::super::{Findings, Subject};
use crate::hir::{ExprId, ExprKind, SamplerDim, Shader, Stage, Type, Types, VarRef};
use rustc_hash::FxHashMap;

/// How many further calls under one condition get a label.
const MAX_LABELS: usize = 4;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let Some(fragment) = program.stage(Stage::Fragment) else { return };
    let mut groups: Vec<(Cause, Vec<ExprId>)> = Vec::new();
    let mut indices: FxHashMap<ExprId, usize> = FxHashMap::default();
    for DivergentCall { expr, cause } in divergence::divergent_calls(fragment) {
        let ExprKind::BuiltinCall(function, arguments) = &fragment.expr(expr).kind else { continue };
        if !function.implicit_derivatives() || has_one_level(&program.types, fragment, arguments) {
            continue;
        }
        let index = *indices.entry(cause.condition).or_insert(groups.len());
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

/// One finding for a condition: at the first call, with labels at the condition and at further calls.
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
        finding = finding.note(format!("and in {} more places under the same condition", more.len() - MAX_LABELS));
    }
    findings.push(finding.help("compute it before the branch, or use the form with `Lod` or `Grad`"));
}

/// Parts of the names of textures that have one level in nearly all programs: maps of depths, places and random numbers, tables.
static OF_ONE_LEVEL: &[&str] = &["shadow", "depth", "noise", "rand", "lut", "position"];

/// Whether the texture has only one level, so that no level is selected; or nearly always has, as lines, volumes, and maps of depths.
fn has_one_level(types: &Types, shader: &Shader, arguments: &[ExprId]) -> bool {
    let Some(&sampler) = arguments.first() else { return false };
    let Type::Sampler(kind) = types.get(shader.expr(sampler).ty) else { return false };
    let is_named = || match shader.root_variable(sampler) {
        Some(VarRef::Global(global)) => {
            let name = shader.global(global).name.to_ascii_lowercase();
            OF_ONE_LEVEL.iter().any(|part| name.contains(part))
        }
        _ => false,
    };
    !kind.has_levels() || kind.shadow || matches!(kind.dim, SamplerDim::D1 | SamplerDim::D3) || is_named()
}
