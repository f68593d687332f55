//! `self-assignment`: `a = a`, which does nothing.

use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{ExprKind, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::Expr(expr) = statement.kind else { continue };
        let ExprKind::Assign(None, target, value) = place.kind(expr) else { continue };
        let span = place.expr(expr).span;
        if place.same(*target, *value) && subject.texts.is_plain(place.shader, expr) {
            let whole = subject.texts.simple_statement(span);
            let fix = whole.and_then(|whole| subject.texts.remove(Applicability::Safe, whole, "remove it"));
            findings.push(findings.at(span, "a value is assigned to itself").help("remove it").maybe_fix(fix));
        }
    }
}
