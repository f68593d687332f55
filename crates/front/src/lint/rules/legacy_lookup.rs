//! `legacy-lookup`: `texture2D` and its like, which 1.30 replaced by `texture`.

use super::super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction;
use crate::diagnostic::Applicability;
use crate::hir::{ExprId, ExprKind};
use crate::source::Span;
use crate::syntax::token::TokenKind;

/// The functions that have a new name and the same parameters and result.
static OLD: &[&str] = &[
    "texture1D",
    "texture2D",
    "texture3D",
    "textureCube",
    "texture2DRect",
    "texture1DProj",
    "texture2DProj",
    "texture3DProj",
    "texture2DRectProj",
    "texture1DLod",
    "texture2DLod",
    "texture3DLod",
    "textureCubeLod",
    "texture1DProjLod",
    "texture2DProjLod",
    "texture3DProjLod",
    "texture2DArray",
    "texture1DArray",
];

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(function, _) = place.kind(expr) else { continue };
        let Some((name, span)) = name(subject, place, expr).filter(|_| subject.texts.chooses_modern(place.shader))
        else {
            continue;
        };
        // A macro of this name is what a header makes of the old word: it is not the function.
        let is_macro =
            || subject.texts.files(place.shader).iter().any(|file| subject.texts.lexemes(*file).defines(name));
        if OLD.contains(&name) && subject.texts.is_own(place.shader, span) && !is_macro() {
            let new = function.name();
            let finding = findings.at(span, format!("`{name}` is the name of before GLSL 1.30"));
            findings.push(if is_free(subject, place, *function) {
                let fix = subject.texts.replace(Applicability::Safe, span, new);
                finding.help(format!("write `{new}`")).maybe_fix(fix)
            } else {
                finding.help(format!("give what is named `{new}` here another name, then write `{new}`"))
            });
        }
    }
}

/// The name by which a function is called.
fn name<'t>(subject: &'t Subject<'_>, place: &Place<'_>, call: ExprId) -> Option<(&'t str, Span)> {
    let whole = place.expr(call).span;
    let text = subject.texts.text(whole)?;
    let length = text.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_')?;
    let span = Span::new(whole.start, whole.start + length as u32);
    Some((text.get(..length)?, span))
}

/// Whether the new name is that of the built-in function everywhere: it is only ever called.
fn is_free(subject: &Subject<'_>, place: &Place<'_>, function: BuiltinFunction) -> bool {
    let name = function.name();
    let is_own = place.shader.functions.iter().any(|own| own.name == name);
    !is_own
        && subject.texts.files(place.shader).iter().all(|file| {
            let lexemes = subject.texts.lexemes(*file);
            lexemes.places(name).all(|span| {
                lexemes.tokens().get(lexemes.from(span.end)).is_some_and(|next| next.kind == TokenKind::LeftParen)
            })
        })
}
