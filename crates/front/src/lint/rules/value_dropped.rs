//! `value-dropped`: `a == b;`, `a + b;`, `max(a, b);`, and what the comma operator drops, as in `a * 0,5`.
//!
//! Left out are macros; calls of functions of the shader; and a variable alone that nothing else names, which silences those who report
//! unused variables, or that is in parentheses: `(a);`, `for (i; i < 4; i++)`.

use super::super::uses::compares;
use super::super::{Findings, Place, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{BinaryOp, ExprId, ExprKind, LocalKind, ParamMode, StmtKind, Storage, VarRef, is_pure};
use crate::source::Span;
use crate::syntax::token::TokenKind;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        match statement.kind {
            StmtKind::Expr(root) | StmtKind::Loop { step: Some(root), .. } => {
                report(subject, place, root, findings);
            }
            _ => {}
        }
    }
    for (place, expr) in subject.exprs() {
        if let ExprKind::Comma(first, _) = place.kind(expr) {
            report(subject, place, *first, findings);
        }
    }
}

/// Reports the value of an expression that nothing takes.
fn report(subject: &Subject<'_>, place: &Place<'_>, whole: ExprId, findings: &mut Findings<'_>) {
    let mut root = whole;
    let mut comma = None;
    while let ExprKind::Comma(first, last) = place.kind(root) {
        comma = between(subject, place, (*first, *last), |kind| kind == TokenKind::Comma);
        root = *last;
    }
    let span = place.expr(root).span;
    if subject.texts.text(span).is_none() || is_meant(subject, place, root) {
        return;
    }
    if let Some(comma) = comma.filter(|comma| is_decimal(subject, *comma)) {
        let finding = findings.at(comma, "this comma drops the number behind it").label(span, "nothing takes it");
        let finding = finding.note("a number has a point where some languages have a comma");
        return findings.push(subject.texts.advised(finding, Applicability::Unsafe, Some(".".to_owned())));
    }
    match assigning(subject, place, root) {
        Some((operator, text)) => {
            let finding = findings.at(operator, "nothing takes the result of this operator");
            let finding = finding.label(span, "it is dropped");
            findings.push(subject.texts.advised(finding, Applicability::Unsafe, Some(text)));
        }
        None => findings.push(findings.at(span, "nothing takes this value").here("it is dropped")),
    }
}

/// Whether an expression does something, or is a name that somebody wrote on purpose.
fn is_meant(subject: &Subject<'_>, place: &Place<'_>, root: ExprId) -> bool {
    match place.kind(root) {
        // Whatever its operands do, the result of an operator is for something.
        ExprKind::Binary(..) => false,
        ExprKind::Var(variable) => silences(subject, place, root, *variable),
        _ => !is_pure(place.shader, root),
    }
}

/// Whether a name alone is in parentheses, or all that names its variable.
fn silences(subject: &Subject<'_>, place: &Place<'_>, root: ExprId, variable: VarRef) -> bool {
    let span = place.expr(root).span;
    let Some((lexemes, index)) = subject.texts.token_at(span) else { return true };
    let near = lexemes.tokens().get(index.saturating_sub(1)..=index).unwrap_or_default();
    if near.iter().any(|token| token.kind == TokenKind::LeftParen) {
        return true;
    }
    match variable {
        VarRef::Local(local) => place.locals.get(local.index()).is_none_or(|uses| uses.mentions < 2),
        VarRef::Global(global) => subject.texts.mentions(place.shader, &place.shader.global(global).name) < 3,
    }
}

/// The place of the operator that would assign, and its text: `=` for `==`, `+=` for `+`.
fn assigning(subject: &Subject<'_>, place: &Place<'_>, root: ExprId) -> Option<(Span, String)> {
    let ExprKind::Binary(operator, a, b) = place.kind(root) else { return None };
    let is_equal = *operator == BinaryOp::Equal;
    let fits = is_equal || place.expr(root).ty == place.expr(*a).ty;
    if !fits || compares(*operator) && !is_equal || !can_be_assigned(place, *a) {
        return None;
    }
    let is_operator = |kind| !matches!(kind, TokenKind::LeftParen | TokenKind::RightParen);
    let span = between(subject, place, (*a, *b), is_operator)?;
    let text = if is_equal { "=".to_owned() } else { format!("{}=", subject.texts.text(span)?) };
    Some((span, text))
}

/// Whether an expression names a variable that can be written.
fn can_be_assigned(place: &Place<'_>, id: ExprId) -> bool {
    let mut at = id;
    loop {
        match place.kind(at) {
            ExprKind::Swizzle(_, swizzle) if swizzle.has_repeats() => return false,
            ExprKind::Swizzle(inner, _) | ExprKind::Member(inner, _) | ExprKind::Index(inner, _) => at = *inner,
            ExprKind::Var(VarRef::Global(global)) => {
                return matches!(place.shader.global(*global).storage, Storage::Private | Storage::Out);
            }
            ExprKind::Var(VarRef::Local(local)) => {
                let kind = place.function.local(*local).kind;
                return !matches!(kind, LocalKind::Const | LocalKind::Param(ParamMode::ConstIn));
            }
            _ => return false,
        }
    }
}

/// The first token of a kind between two operands.
fn between(
    subject: &Subject<'_>,
    place: &Place<'_>,
    (a, b): (ExprId, ExprId),
    is_wanted: impl Fn(TokenKind) -> bool,
) -> Option<Span> {
    let (a, b) = (place.expr(a).span, place.expr(b).span);
    let (lexemes, _) = subject.texts.token_at(a)?;
    let inside = Span::new(a.end, b.start.max(a.end));
    lexemes.within(inside).iter().find(|token| is_wanted(token.kind)).map(|token| token.span)
}

/// Whether a comma is between the digits of two whole numbers, without a blank.
fn is_decimal(subject: &Subject<'_>, comma: Span) -> bool {
    let Some((lexemes, index)) = subject.texts.token_at(comma) else { return false };
    let near = index.checked_sub(1).and_then(|before| lexemes.tokens().get(before..index + 2));
    let Some([before, _, after]) = near else { return false };
    let is_whole = |span| subject.texts.text(span).is_some_and(|text| text.bytes().all(|byte| byte.is_ascii_digit()));
    before.span.end == comma.start && after.span.start == comma.end && is_whole(before.span) && is_whole(after.span)
}
