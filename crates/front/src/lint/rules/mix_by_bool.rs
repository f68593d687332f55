//! `mix-by-bool`: `mix(a, b, float(c))` with a `bool`, which is the selection `c ? b : a`.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::{ExprKind, TypeId};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(B::Mix, arguments) = place.kind(expr) else { continue };
        let [first, second, weight] = arguments.as_slice() else { continue };
        let ExprKind::Convert(condition) = place.kind(*weight) else { continue };
        if place.expr(*condition).ty != TypeId::BOOL {
            continue;
        }
        let span = place.expr(expr).span;
        let operand = |id| subject.texts.operand(place.expr(id).span);
        let text = match (operand(*condition), operand(*second), operand(*first)) {
            (Some(condition), Some(yes), Some(no)) => Some(format!("({condition} ? {yes} : {no})")),
            _ => None,
        };
        let finding = findings.at(span, "a `mix` by a `bool` is a selection, which needs no arithmetic");
        findings.push(subject.texts.advised(finding, Applicability::Unsafe, text));
    }
}
