//! `float-equality`: `==` and `!=` of floats that were computed. Comparisons with constants are left out, which are often exact.

use super::super::interval::Range;
use super::super::range::range;
use super::super::{Findings, Place, Subject};
use crate::hir::{BinaryOp, ExprId, ExprKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::Binary(operator @ (BinaryOp::Equal | BinaryOp::NotEqual), a, b) = place.kind(expr) else {
            continue;
        };
        if !place.is_float(*a) || place.same(*a, *b) || is_exact(place, *a) || is_exact(place, *b) {
            continue;
        }
        if [a, b].into_iter().any(|side| place.numbers(*side).is_some())
            || !(computed(place, *a) || computed(place, *b))
        {
            continue;
        }
        let sign = if *operator == BinaryOp::Equal { "==" } else { "!=" };
        let finding = findings.at(place.expr(expr).span, format!("`{sign}` of floats that are rounded"));
        findings.push(finding.help("compare their difference with a tolerance"));
    }
}

/// Whether rounding is part of the value.
fn computed(place: &Place<'_>, id: ExprId) -> bool {
    matches!(place.kind(place.meaning(id)), ExprKind::Binary(..) | ExprKind::BuiltinCall(..))
}

/// Whether the value is a whole number, or one of its own operands.
fn is_exact(place: &Place<'_>, id: ExprId) -> bool {
    use crate::builtin::BuiltinFunction as B;
    match place.kind(place.meaning(id)) {
        ExprKind::Convert(_) => true,
        ExprKind::BuiltinCall(function, _) => matches!(
            function,
            B::Floor | B::Ceil | B::Round | B::RoundEven | B::Trunc | B::Sign | B::Step | B::Min | B::Max | B::Clamp
        ),
        _ => {
            let Range { low, high, .. } = range(place, id);
            low == high
        }
    }
}
