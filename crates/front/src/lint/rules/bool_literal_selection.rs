//! `bool-literal-selection`: `c ? true : false`, which is `c`; and comparisons with `true` or `false`.

use super::super::{Findings, Place, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{BinaryOp, ExprId, ExprKind, ScalarValue};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let (condition, holds) = match place.kind(expr) {
            ExprKind::Ternary(condition, yes, no) => match (literal(place, *yes), literal(place, *no)) {
                (Some(yes), Some(no)) if yes != no => (*condition, yes),
                _ => continue,
            },
            ExprKind::Binary(operator @ (BinaryOp::Equal | BinaryOp::NotEqual), a, b) => {
                let (side, value) = match (literal(place, *a), literal(place, *b)) {
                    (None, Some(value)) => (*a, value),
                    (Some(value), None) => (*b, value),
                    _ => continue,
                };
                (side, value == (*operator == BinaryOp::Equal))
            }
            _ => continue,
        };
        let span = place.expr(expr).span;
        let is_written = subject.texts.text(span).is_some();
        let Some(text) = subject.texts.operand(place.expr(condition).span).filter(|_| is_written) else { continue };
        let text = if holds { text } else { format!("!{text}") };
        let fix = subject.texts.replace(Applicability::Safe, span, text.clone());
        findings.push(findings.at(span, "this is the condition itself").help(format!("write `{text}`")).maybe_fix(fix));
    }
}

fn literal(place: &Place<'_>, id: ExprId) -> Option<bool> {
    match place.kind(id) {
        ExprKind::Literal(ScalarValue::Bool(value)) if !place.expr(id).span.expansion.is_some() => Some(*value),
        _ => None,
    }
}
