//! Calls in a loop that give the same in each iteration.
//!
//! Calls behind a condition in the loop are left out.

use super::rate::{Changing, Rate, rate};
use super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction;
use crate::hir::{ExprId, ExprKind, Stmt, StmtKind};

/// Reports the wanted calls that a loop does not change.
pub(super) fn find(subject: &Subject<'_>, wanted: fn(BuiltinFunction) -> bool, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::Loop { condition, step, body, .. } = &statement.kind else { continue };
        let changing = Changing::of(place, condition.as_ref(), *step, body);
        let mut told: Vec<ExprId> = Vec::new();
        for expr in always(place, body) {
            let ExprKind::BuiltinCall(function, _) = place.kind(expr) else { continue };
            // The author of a macro is not that of the loop, and may be an engine.
            let is_written = !place.expr(expr).span.expansion.is_some();
            if !is_written || !wanted(*function) || rate(place, expr) == Rate::Constant || !changing.leaves(place, expr)
            {
                continue;
            }
            // What is inside of a finding comes with it, and the same call again, too.
            let inside = |outer: &ExprId| {
                let mut found = place.same(*outer, expr);
                place.shader.visit_expr(*outer, &mut |inner| found |= inner == expr);
                found
            };
            if told.iter().any(inside) {
                continue;
            }
            told.push(expr);
            let message = format!("`{}` gives the same in each iteration of the loop", function.name());
            findings.push(findings.at(place.expr(expr).span, message).help("compute it once, before the loop"));
        }
    }
}

/// The expressions that each iteration evaluates: outside of conditions, before the first way out, and not in an inner loop, which is
/// a loop of its own.
fn always(place: &Place<'_>, body: &[Stmt]) -> Vec<ExprId> {
    let mut found = Vec::new();
    let mut pending: Vec<&Stmt> = body.iter().rev().collect();
    while let Some(statement) = pending.pop() {
        let roots = match &statement.kind {
            StmtKind::Block(inner) => {
                pending.extend(inner.iter().rev());
                continue;
            }
            StmtKind::If { arms, .. } => {
                if leaves(place, statement) {
                    return found;
                }
                arms.first().map(|(condition, _)| *condition).into_iter().collect()
            }
            StmtKind::Switch { selector, .. } => vec![*selector],
            StmtKind::Loop { .. } => continue,
            StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard => return found,
            kind => kind.exprs().to_vec(),
        };
        for root in roots {
            let mut inner = vec![root];
            while let Some(expr) = inner.pop() {
                found.push(expr);
                match place.kind(expr) {
                    ExprKind::Ternary(first, ..) | ExprKind::Logical(_, first, _) => inner.push(*first),
                    kind => inner.extend(kind.children().into_iter().rev()),
                }
            }
        }
    }
    found
}

/// Whether a statement may leave the loop or the function.
fn leaves(place: &Place<'_>, statement: &Stmt) -> bool {
    let mut found = false;
    for body in statement.kind.bodies() {
        place.shader.visit_statements(body, &mut |inner| {
            found |=
                matches!(inner.kind, StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard);
        });
    }
    found
}
