//! `float-loop-counter`: a loop that counts in steps that floats do not have exactly, so that rounding decides how often it runs.

use super::super::{Findings, Place, Subject};
use crate::hir::{BinaryOp, ExprId, ExprKind, LocalId, StmtKind, VarRef};

/// The relative error of one rounding, doubled.
const ROUNDING: f64 = f32::EPSILON as f64;

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
        if place.is_float(*target)
            && compared
            && is_inexact(*value)
            && !is_certain(place, condition.expr, *counter, *value)
        {
            let name = &place.function.local(*counter).name;
            let message = format!("rounding decides how often this loop runs: `{name}` is a float");
            let finding = findings.at(place.expr(*step).span, message).here("not exact in binary");
            findings.push(finding.help("count in whole numbers, and compute the float from them"));
        }
    }
}

/// Whether the rounds are the same however the counter is rounded: its end is no whole number of steps away from its start.
fn is_certain(place: &Place<'_>, condition: ExprId, counter: LocalId, step: ExprId) -> bool {
    let start = place.locals.get(counter.index()).filter(|uses| uses.writes == 1).and_then(|uses| uses.initializer);
    let number = |id: ExprId| match place.numbers(id).as_deref() {
        Some([one]) => Some(f64::from(*one)),
        _ => None,
    };
    let (Some(start), Some(end), Some(step)) = (start.and_then(number), bound(place, condition, counter), number(step))
    else {
        return false;
    };
    let Some(end) = number(end) else { return false };
    let steps = ((end - start) / step).abs();
    // Each step rounds the counter, which is as large as its ends.
    let slack = (steps + 2.0) * ROUNDING * (start.abs().max(end.abs()) / step.abs() + 1.0);
    (steps - steps.round()).abs() > slack
}

/// The number that a condition compares a counter with.
fn bound(place: &Place<'_>, condition: ExprId, counter: LocalId) -> Option<ExprId> {
    use BinaryOp::{Greater, GreaterEqual, Less, LessEqual};
    let ExprKind::Binary(Less | LessEqual | Greater | GreaterEqual, a, b) = *place.kind(condition) else { return None };
    let is_counter = |id: ExprId| matches!(place.kind(id), ExprKind::Var(VarRef::Local(local)) if *local == counter);
    match (is_counter(a), is_counter(b)) {
        (true, false) => Some(b),
        (false, true) => Some(a),
        _ => None,
    }
}
