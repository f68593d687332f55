//! `loop-counts-away`: a loop whose counter moves away from its bound: `for (int i = 0; i < 4; i--)`.

use super::super::{Findings, Place, Subject};
use crate::hir::written_by;
use crate::hir::{BinaryOp, ExprId, ExprKind, IncDec, LocalId, StmtKind, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::Loop { condition: Some(condition), step: Some(step), body, .. } = &statement.kind else {
            continue;
        };
        let (Some((counter, up)), Some(direction)) = (bound(place, condition.expr), steps(place, *step)) else {
            continue;
        };
        let mut written = false;
        place.shader.visit_body(body, &mut |expr| {
            written_by(place.shader, expr, &mut |target| {
                written |= place.shader.root_variable(target) == Some(VarRef::Local(counter));
            });
        });
        if direction == (counter, !up) && !written {
            let name = &place.function.local(counter).name;
            let message = format!("`{name}` counts away from the bound of its loop");
            let finding = findings.at(place.expr(*step).span, message);
            findings.push(finding.label(place.expr(condition.expr).span, "the loop ends when this does not hold"));
        }
    }
}

/// The counter of a condition, and whether the loop ends when it becomes large.
fn bound(place: &Place<'_>, condition: ExprId) -> Option<(LocalId, bool)> {
    let ExprKind::Binary(operator, a, b) = place.kind(condition) else { return None };
    let below = match operator {
        BinaryOp::Less | BinaryOp::LessEqual => true,
        BinaryOp::Greater | BinaryOp::GreaterEqual => false,
        _ => return None,
    };
    match (place.kind(*a), place.kind(*b)) {
        (ExprKind::Var(VarRef::Local(counter)), _) if place.value(*b).is_some() => Some((*counter, below)),
        (_, ExprKind::Var(VarRef::Local(counter))) if place.value(*a).is_some() => Some((*counter, !below)),
        _ => None,
    }
}

/// The counter of a step, and whether it becomes larger.
fn steps(place: &Place<'_>, step: ExprId) -> Option<(LocalId, bool)> {
    let counter = |target: ExprId| match place.kind(target) {
        ExprKind::Var(VarRef::Local(counter)) => Some(*counter),
        _ => None,
    };
    match place.kind(step) {
        ExprKind::IncDec(which, target) => {
            Some((counter(*target)?, matches!(which, IncDec::PreIncrement | IncDec::PostIncrement)))
        }
        ExprKind::Assign(Some(operator @ (BinaryOp::Add | BinaryOp::Sub)), target, value) => {
            use crate::hir::ScalarValue::{Float, Int, Uint};
            let positive = match place.value(*value)?.scalars.first()? {
                Int(value) if *value != 0 => *value > 0,
                Uint(value) if *value != 0 => true,
                Float(value) if *value != 0.0 => *value > 0.0,
                _ => return None,
            };
            Some((counter(*target)?, positive == (*operator == BinaryOp::Add)))
        }
        _ => None,
    }
}
