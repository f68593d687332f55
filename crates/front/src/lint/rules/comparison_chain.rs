//! `comparison-chain`: `a == b == c`, which compares the truth of `a == b` with `c`.

use super::super::uses::compares;
use super::super::{Findings, Subject};
use crate::hir::ExprKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::Binary(operator, left, _) = place.kind(expr) else { continue };
        let ExprKind::Binary(inner, ..) = place.kind(*left) else { continue };
        let (whole, part) = (place.expr(expr).span, place.expr(*left).span);
        // In parentheses, it is meant.
        let bare = subject.texts.text(whole).zip(subject.texts.text(part));
        let bare = bare.is_some_and(|(whole, part)| whole.starts_with(part) && !part.starts_with('('));
        if compares(*operator) && compares(*inner) && bare {
            let finding = findings.at(whole, "this compares the result of a comparison");
            findings.push(
                finding.label(part, "true or false").help("join comparisons by a logical and, or write parentheses"),
            );
        }
    }
}
