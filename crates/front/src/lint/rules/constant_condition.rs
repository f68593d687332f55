//! `constant-condition`: a condition of an `if` or a selection that is a literal, or made of literals.
//!
//! Conditions that name a constant or a macro are switches, and loops without an end have a rule of their own.

use super::super::{Findings, Place, Subject};
use crate::hir::{ExprId, ExprKind, ScalarValue, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let mut conditions: Vec<(&Place<'_>, ExprId)> = Vec::new();
    for (place, statement) in subject.statements() {
        if let StmtKind::If { arms, .. } = &statement.kind {
            conditions.extend(arms.iter().map(|(condition, _)| (place, *condition)));
        }
    }
    for (place, expr) in subject.exprs() {
        if let ExprKind::Ternary(condition, ..) = place.kind(expr) {
            conditions.push((place, *condition));
        }
    }
    for (place, condition) in conditions {
        let mut written = true;
        place.shader.visit_expr(condition, &mut |expr| {
            let in_place = subject.texts.text(place.expr(expr).span).is_some();
            written &= in_place && !matches!(place.kind(expr), ExprKind::Var(_) | ExprKind::Call(..));
        });
        let value = if written { place.value(condition) } else { None };
        if let Some(&ScalarValue::Bool(value)) = value.as_ref().and_then(|value| value.scalars.first()) {
            findings.push(findings.at(place.expr(condition).span, format!("this condition is always {value}")));
        }
    }
}
