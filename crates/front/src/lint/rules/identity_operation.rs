//! `identity-operation`: `x * 1.0`, `x / 1.0`, which do nothing.

use super::super::{Findings, Place, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{BinaryOp, ExprId, ExprKind, ScalarValue};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::Binary(operator @ (BinaryOp::Mul | BinaryOp::Div), a, b) = place.kind(expr) else { continue };
        let kept = match operator {
            _ if is_one(place, *b) => *a,
            BinaryOp::Mul if is_one(place, *a) => *b,
            _ => continue,
        };
        let span = place.expr(expr).span;
        // A conversion to a float is what the product may be for.
        let keeps_type =
            place.expr(kept).ty == place.expr(expr).ty && !matches!(place.kind(kept), ExprKind::Convert(_));
        let is_written = [expr, *a, *b].iter().all(|&id| subject.texts.text(place.expr(id).span).is_some());
        if !keeps_type || !is_written || place.value(kept).is_some() {
            continue;
        }
        let text = subject.texts.operand(place.expr(kept).span);
        let fix = text.and_then(|text| subject.texts.replace(Applicability::Safe, span, text));
        let what = if *operator == BinaryOp::Mul { "a product with 1" } else { "a quotient by 1" };
        findings.push(findings.at(span, format!("{what} changes nothing")).help("remove it").maybe_fix(fix));
    }
}

fn is_one(place: &Place<'_>, id: ExprId) -> bool {
    match place.kind(id) {
        ExprKind::Literal(ScalarValue::Float(number)) => (number - 1.0).abs() == 0.0,
        ExprKind::Literal(ScalarValue::Int(1) | ScalarValue::Uint(1)) => true,
        _ => false,
    }
}
