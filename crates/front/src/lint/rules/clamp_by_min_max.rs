//! `clamp-by-min-max`: `min(max(x, a), b)`, which is `clamp(x, a, b)`.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::ExprKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(outer @ (B::Min | B::Max), arguments) = place.kind(expr) else { continue };
        let [whole, bound] = arguments.as_slice() else { continue };
        let ExprKind::BuiltinCall(inner @ (B::Min | B::Max), parts) = place.kind(*whole) else { continue };
        let [value, other] = parts.as_slice() else { continue };
        let is_float = place.is_float(expr) && place.numbers(*bound).is_some() && place.numbers(*other).is_some();
        if outer == inner || !is_float || place.expr(*bound).ty != place.expr(*other).ty {
            continue;
        }
        let (low, high) = if *inner == B::Max { (*other, *bound) } else { (*bound, *other) };
        let least = |id| place.numbers(id).and_then(|all| all.first().copied()).unwrap_or(0.0);
        if least(low) > least(high) {
            continue;
        }
        let span = place.expr(expr).span;
        let texts = [*value, low, high].map(|id| subject.texts.text(place.expr(id).span));
        let finding = findings.at(span, "`min` and `max` together are `clamp`");
        let text = match texts {
            [Some(value), Some(low), Some(high)] => Some(format!("clamp({value}, {low}, {high})")),
            _ => None,
        };
        findings.push(subject.texts.advised(finding, Applicability::Unsafe, text));
    }
}
