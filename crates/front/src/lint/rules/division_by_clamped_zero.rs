//! `division-by-clamped-zero`: a divisor that was clamped so that zero is its least value.

use super::super::domain::{Fault, examine};
use super::super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::hir::{BinaryOp, ExprId, ExprKind};

const FAULT: Fault = Fault {
    is_in: |range| range.low == 0.0 && range.reaches_low && range.high > 0.0,
    message: "this divides by a number that is clamped to zero",
    guard: ["max(", ", 1e-6)"],
};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let (ExprKind::Binary(BinaryOp::Div, _, divisor) | ExprKind::Assign(Some(BinaryOp::Div), _, divisor)) =
            place.kind(expr)
        else {
            continue;
        };
        if place.is_float(*divisor) && is_clamped(place, *divisor) {
            examine(subject, place, *divisor, &FAULT, findings);
        }
    }
}

/// Whether a value ends at zero because somebody wrote so.
fn is_clamped(place: &Place<'_>, id: ExprId) -> bool {
    let is_clamp = |id: ExprId| {
        matches!(place.kind(place.meaning(id)), ExprKind::BuiltinCall(B::Max | B::Clamp, arguments)
            if arguments.iter().skip(1).take(1).chain(arguments.iter().take(1)).any(|bound| place.is_number(*bound, 0.0)))
    };
    match place.kind(place.meaning(id)) {
        ExprKind::Binary(BinaryOp::Mul, a, b) => is_clamp(*a) || is_clamp(*b),
        _ => is_clamp(id),
    }
}
