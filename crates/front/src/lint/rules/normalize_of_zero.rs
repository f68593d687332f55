//! `normalize-of-zero`: `normalize` of a vector that is zero, always or for some input.

use super::super::range::range;
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::hir::{BinaryOp, ExprKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(B::Normalize, arguments) = place.kind(expr) else { continue };
        let Some(&argument) = arguments.first() else { continue };
        let meaning = place.meaning(argument);
        let message = match place.kind(meaning) {
            _ if place.is_number(argument, 0.0) => "this vector is zero, which has no direction",
            ExprKind::Binary(BinaryOp::Sub, a, b) if place.same(*a, *b) => {
                "this vector is zero, which has no direction"
            }
            // All components are clamped at zero, so all can be zero.
            ExprKind::BuiltinCall(B::Max, parts)
                if parts.get(1).is_some_and(|bound| place.is_number(*bound, 0.0)) && !place.is_guarded(argument) =>
            {
                let inner = parts.first().map(|&part| range(place, part));
                if inner.is_some_and(|inner| inner.low > 0.0) {
                    continue;
                }
                "this vector can be clamped to zero, which has no direction"
            }
            ExprKind::BuiltinCall(B::Cross, sides) if matches!(sides.as_slice(), [a, b] if place.same(place.meaning(*a), place.meaning(*b))) => {
                "this cross product is zero, which has no direction"
            }
            _ => continue,
        };
        findings.push(findings.at(place.expr(argument).span, message));
    }
}
