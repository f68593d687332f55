//! `assignment-in-condition`: `if (a = b)` with two bools, where `==` may be meant.
//!
//! A second pair of parentheses says that the assignment is meant.

use super::super::{Findings, Place, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{ExprId, ExprKind, StmtKind};
use crate::source::Span;
use crate::syntax::token::TokenKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let mut conditions: Vec<ExprId> = match &statement.kind {
            StmtKind::If { arms, .. } => arms.iter().map(|(condition, _)| *condition).collect(),
            StmtKind::Loop { condition: Some(condition), .. } if condition.local.is_none() => vec![condition.expr],
            _ => continue,
        };
        while let Some(condition) = conditions.pop() {
            match place.kind(condition) {
                ExprKind::Logical(_, a, b) => conditions.extend([*a, *b]),
                ExprKind::Assign(None, target, value) => {
                    if let Some(operator) = operator(subject, place, (*target, *value)) {
                        report(subject, place, condition, operator, findings);
                    }
                }
                _ => {}
            }
        }
    }
}

/// The `=` between two operands; none if the whole is in parentheses of its own.
fn operator(subject: &Subject<'_>, place: &Place<'_>, (target, value): (ExprId, ExprId)) -> Option<Span> {
    let (target, value) = (place.expr(target).span, place.expr(value).span);
    let (lexemes, _) = subject.texts.token_at(target)?;
    let between = Span::new(target.end, value.start);
    let equal = lexemes.within(between).iter().find(|token| token.kind == TokenKind::Equal)?;
    let before = lexemes.from(target.start).checked_sub(2).and_then(|index| lexemes.tokens().get(index));
    let doubled = before.is_some_and(|token| token.kind == TokenKind::LeftParen);
    (!doubled).then_some(equal.span)
}

fn report(subject: &Subject<'_>, place: &Place<'_>, whole: ExprId, operator: Span, findings: &mut Findings<'_>) {
    let finding = findings.at(operator, "this condition assigns").label(place.expr(whole).span, "the condition");
    let finding = finding.note("a second pair of parentheses says that it is meant");
    findings.push(subject.texts.advised(finding, Applicability::Unsafe, Some("==".to_owned())));
}
