//! Declarations of a shader's own file that nothing names.
//!
//! *Holds:* what a header declares is for many shaders, and text that is skipped may name what the rest does not: both are no
//! findings. So is everything, if an include was not read.

use super::subject::{Place, Subject};
use crate::hir::{Function, Global, LocalId, Shader};
use crate::source::Span;
use crate::syntax::Lexemes;
use crate::syntax::token::{Token, TokenKind};

/// Whether a global of the shader's own file is named nowhere but in its declaration.
pub(super) fn is_unused(subject: &Subject<'_>, shader: &Shader, global: &Global) -> bool {
    // The host of a lone file may have one set of inputs and uniforms for all files.
    subject.program.stages.len() > 1
        && !global.used
        && global.builtin.is_none()
        && global.block.is_none()
        && subject.texts.is_own(shader, global.span)
        && subject.texts.mentions(shader, &global.name) == 1
        && subject.texts.are_whole(shader)
}

/// Whether the text of a function names a local as often as the program does, so that no text that is skipped names it.
pub(super) fn is_all_of(subject: &Subject<'_>, place: &Place<'_>, id: LocalId) -> bool {
    let local = place.function.local(id);
    if local.name.is_empty() || !subject.texts.is_own(place.shader, local.span) {
        return false;
    }
    let Some((lexemes, body)) = place.text.get_or_init(|| body(subject, place.function)) else { return false };
    let named = lexemes.count_within(&local.name, *body);
    let uses = place.locals.get(id.index()).copied().unwrap_or_default();
    named == uses.mentions + 1
}

/// The tokens of a function's file, and the text from its name to its last brace.
pub(super) fn body(subject: &Subject<'_>, function: &Function) -> Option<(std::rc::Rc<Lexemes>, Span)> {
    let (lexemes, first) = subject.texts.token_at(function.span)?;
    let mut depth = 0_usize;
    for token in lexemes.tokens().get(first..)? {
        match token.kind {
            TokenKind::LeftBrace => depth += 1,
            TokenKind::RightBrace if depth == 1 => {
                let span = Span::new(function.span.start, token.span.end);
                return Some((lexemes, span));
            }
            TokenKind::RightBrace => depth = depth.checked_sub(1)?,
            TokenKind::Semicolon if depth == 0 => return None,
            _ => {}
        }
    }
    None
}

/// Whether the token declares a function: a type before it, a parenthesis behind it.
pub(super) fn declares_function(lexemes: &Lexemes, index: usize) -> bool {
    let at = |index: Option<usize>| index.and_then(|index| lexemes.tokens().get(index));
    let is_type = |token: &Token| {
        token.kind == TokenKind::RightBracket
            || token.kind == TokenKind::Word && !matches!(lexemes.spelling(token), "return" | "else" | "do" | "case")
    };
    at(index.checked_sub(1)).is_some_and(is_type)
        && at(Some(index + 1)).is_some_and(|token| token.kind == TokenKind::LeftParen)
}
