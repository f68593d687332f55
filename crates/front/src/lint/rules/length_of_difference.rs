//! `length-of-difference`: `length(a - b)`, which is `distance(a, b)`.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::{BinaryOp, ExprKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(B::Length, arguments) = place.kind(expr) else { continue };
        let Some(ExprKind::Binary(BinaryOp::Sub, a, b)) = arguments.first().map(|&argument| place.kind(argument))
        else {
            continue;
        };
        if place.expr(*a).ty != place.expr(*b).ty || !place.is_vector(*a) {
            continue;
        }
        let span = place.expr(expr).span;
        let text = |id| subject.texts.text(place.expr(id).span);
        let finding = findings.at(span, "the length of a difference is a distance");
        let text = text(*a).zip(text(*b)).map(|(a, b)| format!("distance({a}, {b})"));
        findings.push(subject.texts.advised(finding, Applicability::Unsafe, text));
    }
}
