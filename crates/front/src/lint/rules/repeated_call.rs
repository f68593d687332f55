//! `repeated-call`: `abs(abs(x))`, `normalize(normalize(x))`: the second call changes nothing.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::ExprKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(outer, arguments) = place.kind(expr) else { continue };
        let Some(ExprKind::BuiltinCall(inner, _)) = arguments.first().map(|&inner| place.kind(inner)) else { continue };
        let applicability = match outer {
            B::Abs | B::Floor | B::Ceil | B::Trunc | B::Round | B::RoundEven | B::Sign => Applicability::Safe,
            B::Normalize => Applicability::Unsafe,
            _ => continue,
        };
        if outer != inner || arguments.len() != 1 || !subject.texts.is_plain(place.shader, expr) {
            continue;
        }
        let span = place.expr(expr).span;
        let text = arguments.first().and_then(|&inner| subject.texts.text(place.expr(inner).span));
        let fix = text.and_then(|text| subject.texts.replace(applicability, span, text));
        let message = format!("the second `{}` changes nothing", outer.name());
        findings.push(findings.at(span, message).help("remove it").maybe_fix(fix));
    }
}
