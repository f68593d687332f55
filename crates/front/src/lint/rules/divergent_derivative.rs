//! `divergent-derivative`: an implicit derivative where neighboring fragments may have taken another path (§8.7,
//! §8.8). Textures that nearly always have one level are left out: lines, volumes, depths.

use super::super::divergence::{self, Cause, DivergentCall};
use super::super::{Findings, Subject, running};
use crate::fold;
use crate::hir::{ExprId, ExprKind, SamplerDim, ScalarValue, Shader, Stage, Type, Types, VarRef};
use rustc_hash::FxHashMap;

/// How many further calls under one condition get a label.
const MAX_LABELS: usize = 4;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let Some(fragment) = program.stage(Stage::Fragment) else { return };
    let mut groups: Vec<(Cause, Vec<ExprId>)> = Vec::new();
    let mut indices: FxHashMap<ExprId, usize> = FxHashMap::default();
    let names = names_of_samplers(fragment);
    for DivergentCall { expr, cause } in divergence::divergent_calls(fragment) {
        let ExprKind::BuiltinCall(function, arguments) = &fragment.expr(expr).kind else { continue };
        if !function.implicit_derivatives() || has_one_level(&program.types, fragment, arguments, &names) {
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
        report(&program.types, fragment, cause, &calls, findings);
    }
}

/// One finding for a condition: at the first call, with labels at the condition and at further calls.
fn report(types: &Types, fragment: &Shader, cause: Cause, calls: &[ExprId], findings: &mut Findings<'_>) {
    let span = |id: ExprId| fragment.expr(id).span;
    let Some((&first, more)) = calls.split_first() else { return };
    let ExprKind::BuiltinCall(function, arguments) = &fragment.expr(first).kind else { return };
    let message = format!("`{}` takes implicit derivatives in non-uniform control flow", function.name());
    let is_lookup = |&id: &ExprId| matches!(types.get(fragment.expr(id).ty), Type::Sampler(_));
    let (what, help) = match arguments.first().is_some_and(is_lookup) {
        true => ("the level of detail", "compute it before the branch, or use the form with `Lod` or `Grad`"),
        false => ("the derivative", "compute it before the branch"),
    };
    let mut finding = findings.at(span(first), message).here(format!("{what} is undefined here"));
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
    if arguments.first().is_some_and(is_lookup) {
        finding = finding.note("a texture of one level, without mipmaps, is not affected");
    }
    findings.push(finding.help(help));
}

/// Parts of the names of textures that have one level in nearly all programs: maps of depths, places and random numbers, tables.
static OF_ONE_LEVEL: &[&str] = &["shadow", "depth", "noise", "rand", "lut", "position"];

/// The names of the variables that each expression for a sampler stands for.
fn names_of_samplers(shader: &Shader) -> FxHashMap<ExprId, String> {
    let mut names = FxHashMap::default();
    for (function, body) in running(shader) {
        shader.visit_body(body, &mut |expr| {
            let name = match shader.root_variable(expr) {
                Some(VarRef::Global(global)) => &shader.global(global).name,
                Some(VarRef::Local(local)) => &function.local(local).name,
                None => return,
            };
            names.insert(expr, name.to_ascii_lowercase());
        });
    }
    names
}

/// Whether the texture has only one level, so that no level is selected; or nearly always has, as lines, volumes, and maps of depths.
/// A large bias selects the first or the last level in any case.
fn has_one_level(types: &Types, shader: &Shader, arguments: &[ExprId], names: &FxHashMap<ExprId, String>) -> bool {
    const LARGE_BIAS: f32 = 32.0;
    let Some(&sampler) = arguments.first() else { return false };
    let Type::Sampler(kind) = types.get(shader.expr(sampler).ty) else { return false };
    let is_named = || names.get(&sampler).is_some_and(|name| OF_ONE_LEVEL.iter().any(|part| name.contains(part)));
    let bias = arguments.get(2).and_then(|&bias| fold::evaluate(shader, types, bias, &|_| None));
    let is_settled = bias
        .is_some_and(|bias| matches!(bias.scalars.first(), Some(ScalarValue::Float(bias)) if bias.abs() >= LARGE_BIAS));
    let rarely = kind.shadow || matches!(kind.dim, SamplerDim::D1 | SamplerDim::D3);
    !kind.has_levels() || rarely || is_settled || is_named()
}
