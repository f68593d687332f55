//! `divergent-derivative`: an implicit derivative where neighboring fragments may have taken another path (§8.7,
//! §8.8).

use super::super::Findings;
use super::super::divergence::{self, DivergentCall};
use crate::hir::{ExprKind, Shader, Stage, Type, Types};
use crate::link::Program;

pub(super) fn check(program: &Program, findings: &mut Findings<'_>) {
    let Some(fragment) = program.stage(Stage::Fragment) else { return };
    for DivergentCall { expr, condition } in divergence::divergent_calls(fragment) {
        let ExprKind::BuiltinCall(function, arguments) = &fragment.expr(expr).kind else { continue };
        if !function.implicit_derivatives() || has_one_level(&program.types, fragment, arguments) {
            continue;
        }
        let message =
            format!("`{}` takes derivatives where neighboring fragments may have gone another way", function.name());
        let mut finding = findings.at(fragment.expr(expr).span, message).here("the level of detail is undefined here");
        if let Some(condition) = condition {
            finding = finding.label(fragment.expr(condition).span, "this may differ between fragments");
        }
        findings.push(finding.help("compute it before the branch, or use the form with `Lod` or `Grad`"));
    }
}

/// Whether the texture has only one level, so that no level is selected.
fn has_one_level(types: &Types, shader: &Shader, arguments: &[crate::hir::ExprId]) -> bool {
    let sampler = arguments.first().map(|&first| types.get(shader.expr(first).ty));
    matches!(sampler, Some(Type::Sampler(kind)) if !kind.has_levels())
}
