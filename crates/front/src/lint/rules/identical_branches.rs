//! `identical-branches`: a condition whose branches do the same.

use super::super::uses::same_statements;
use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{ExprKind, StmtKind, same_value};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::If { arms, otherwise } = &statement.kind else { continue };
        let [(condition, body)] = arms.as_slice() else { continue };
        let span = place.expr(*condition).span;
        if !body.is_empty() && subject.texts.text(span).is_some() && same_statements(place.shader, body, otherwise) {
            findings.push(findings.at(span, "both branches of this condition do the same"));
        }
    }
    for (place, expr) in subject.exprs() {
        let ExprKind::Ternary(_, yes, no) = place.kind(expr) else { continue };
        let span = place.expr(expr).span;
        if subject.texts.is_plain(place.shader, expr) && same_value(place.shader, *yes, *no) {
            let text = subject.texts.operand(place.expr(*yes).span);
            let fix = text.and_then(|text| subject.texts.replace(Applicability::Unsafe, span, text));
            findings.push(findings.at(span, "both values of this selection are the same").maybe_fix(fix));
        }
    }
}
