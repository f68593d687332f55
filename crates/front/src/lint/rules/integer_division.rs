//! `integer-division`: `1 / 2 * x`, where two whole numbers are divided, the rest is dropped, and the result becomes a float.

use super::super::{Findings, Subject};
use crate::diagnostic::{Applicability, Edit, Fix};
use crate::hir::{BinaryOp, ExprId, ExprKind, ScalarValue};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::Convert(inner) = place.kind(expr) else { continue };
        if !place.is_float(expr) {
            continue;
        }
        // The quotient may be a part of a product or a sum of whole numbers.
        let mut pending = vec![*inner];
        while let Some(id) = pending.pop() {
            let ExprKind::Binary(operator, a, b) = place.kind(id) else { continue };
            match operator {
                BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul => pending.extend([*a, *b]),
                BinaryOp::Div => {
                    let literal = |id: ExprId| match place.kind(id) {
                        ExprKind::Literal(ScalarValue::Int(value)) => Some(i64::from(*value)),
                        ExprKind::Literal(ScalarValue::Uint(value)) => Some(i64::from(*value)),
                        _ => None,
                    };
                    let (Some(over), Some(under)) = (literal(*a), literal(*b)) else { continue };
                    if under == 0 || over % under == 0 || subject.texts.text(place.expr(id).span).is_none() {
                        continue;
                    }
                    let span = place.expr(id).span;
                    let message = format!("{over} / {under} is a quotient of whole numbers: {}", over / under);
                    let finding = findings.at(span, message).here("becomes a float only then");
                    findings.push(
                        finding
                            .help("write the operands with a decimal point")
                            .maybe_fix(floats(subject, [place.expr(*a).span, place.expr(*b).span])),
                    );
                }
                _ => {}
            }
        }
    }
}

/// The fix that writes decimal points.
fn floats(subject: &Subject<'_>, spans: [crate::source::Span; 2]) -> Option<Fix> {
    let mut edits = Vec::new();
    for span in spans {
        let text = subject.texts.text(span)?;
        if !text.bytes().all(|byte| byte.is_ascii_digit()) || text.len() > 1 && text.starts_with('0') {
            return None;
        }
        edits.push(Edit { span, text: format!("{text}.0") });
    }
    Some(Fix { title: "write decimal points".to_owned(), applicability: Applicability::Unsafe, edits })
}
