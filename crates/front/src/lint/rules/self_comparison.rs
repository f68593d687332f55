//! `self-comparison`: `x == x`, `x < x`: always the same, but for NaN.

use super::super::uses::compares;
use super::super::{Findings, Subject};
use crate::hir::{BinaryOp, ExprKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::Binary(operator, a, b) = place.kind(expr) else { continue };
        let span = place.expr(expr).span;
        if !compares(*operator)
            || !subject.texts.is_plain(place.shader, expr)
            || !place.same(*a, *b)
            || place.value(*a).is_some()
        {
            continue;
        }
        let finding = findings.at(span, "both sides of this comparison are the same");
        let tests_nan = place.is_float(*a) && matches!(operator, BinaryOp::Equal | BinaryOp::NotEqual);
        findings.push(if tests_nan {
            finding.help("a driver may fold it: a test for NaN is `isnan`")
        } else {
            finding
        });
    }
}
