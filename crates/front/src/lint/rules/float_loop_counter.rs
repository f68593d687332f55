//! `float-loop-counter`: a loop that counts in steps that floats do not have exactly, so that rounding decides how often it runs.

use super::super::{Findings, Subject};
use crate::hir::{BinaryOp, ExprId, ExprKind, StmtKind, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::Loop { condition: Some(condition), step: Some(step), .. } = &statement.kind else { continue };
        let ExprKind::Assign(Some(BinaryOp::Add | BinaryOp::Sub), target, value) = place.kind(*step) else { continue };
        let ExprKind::Var(VarRef::Local(counter)) = place.kind(*target) else { continue };
        let is_inexact =
            |id: ExprId| place.numbers(id).is_some_and(|all| all.iter().any(|step| (step * 256.0).fract() != 0.0));
        let mut compared = false;
        place.shader.visit_expr(condition.expr, &mut |expr| {
            compared |= matches!(place.kind(expr), ExprKind::Var(VarRef::Local(named)) if named == counter);
        });
        if place.is_float(*target) && compared && is_inexact(*value) {
            let name = &place.function.local(*counter).name;
            let message = format!("rounding decides how often this loop runs: `{name}` is a float");
            let finding = findings.at(place.expr(*step).span, message).here("not exact in binary");
            findings.push(finding.help("count in whole numbers, and compute the float from them"));
        }
    }
}
