//! `empty-body`: `if (..);`, or a loop that ends in `;` before a block.

use super::super::{Findings, Subject};
use crate::hir::StmtKind;
use crate::source::Span;
use crate::syntax::token::TokenKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        match &statement.kind {
            StmtKind::If { arms, .. } => {
                for (condition, _) in arms.iter().filter(|(_, body)| body.is_empty()) {
                    if let Some((semicolon, _)) = semicolon(subject, place.expr(*condition).span) {
                        let finding = findings.at(semicolon, "this `;` is all that the condition guards");
                        findings.push(finding.label(place.expr(*condition).span, "the condition"));
                    }
                }
            }
            StmtKind::Loop { kind, condition: Some(condition), step, body } if body.is_empty() => {
                let last = step.unwrap_or(condition.expr);
                let is_do = *kind == crate::hir::LoopKind::DoWhile;
                if let Some((semicolon, true)) = semicolon(subject, place.expr(last).span).filter(|_| !is_do) {
                    let finding = findings.at(semicolon, "this `;` is all that the loop repeats");
                    findings.push(finding.help("remove it, if the block behind it is the body"));
                }
            }
            _ => {}
        }
    }
}

/// The `;` directly behind the parentheses around a span, and whether a block follows.
fn semicolon(subject: &Subject<'_>, span: Span) -> Option<(Span, bool)> {
    let (lexemes, _) = subject.texts.token_at(span)?;
    let mut rest = lexemes.tokens().get(lexemes.from(span.end)..)?.iter();
    let mut closed = false;
    let first = rest.find(|token| {
        closed |= token.kind == TokenKind::RightParen;
        token.kind != TokenKind::RightParen
    })?;
    let block = rest.next().is_some_and(|token| token.kind == TokenKind::LeftBrace);
    (closed && first.kind == TokenKind::Semicolon).then_some((first.span, block))
}
