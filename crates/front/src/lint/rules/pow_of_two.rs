//! `pow-of-two`: `pow(x, 2.0)`, which is `x * x`.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::ExprKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(B::Pow, arguments) = place.kind(expr) else { continue };
        let [base, exponent] = arguments.as_slice() else { continue };
        if !place.is_number(*exponent, 2.0) || place.value(*base).is_some() {
            continue;
        }
        let span = place.expr(expr).span;
        let is_simple = place.shader.root_variable(*base).is_some();
        let text = subject.texts.operand(place.expr(*base).span).filter(|_| is_simple);
        let fix =
            text.and_then(|text| subject.texts.replace(Applicability::Unsafe, span, format!("({text} * {text})")));
        let finding = findings.at(span, "a square takes one multiplication, `pow` a logarithm and an exponential");
        findings.push(finding.help("multiply the base by itself").maybe_fix(fix));
    }
}
