//! Keywords in the place of names: `uniform int switch;`, `float a, float b;`.
//!
//! *In:* a declaration that names something by a keyword, or repeats a type after a comma. *Out:* one error, and what was meant.
//! *Holds:* the keyword keeps its meaning wherever it can have it. It is a name only where nothing but a name makes sense, so that
//! what follows the declaration gives no further errors.

use super::types::is_qualifier;
use super::{Parser, Token, TokenKind, TokenSource, codes, is_word};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::syntax::ast::{TypeBase, TypeSpec};

/// How many qualifiers may precede a type that is repeated after a comma.
const MOST_QUALIFIERS: usize = 8;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Reports a keyword in the place of a name, and takes it as one.
    pub(super) fn keyword_as_name(&mut self, token: Token, what: &str) {
        let name = self.session.spelling(token).to_owned();
        let message = format!("the keyword `{name}` cannot be {what}");
        let diagnostic = Diagnostic::new(&codes::KEYWORD_AS_NAME, token.span, message).here("a keyword");
        self.session.report(diagnostic);
        self.keyword_names.insert(token.payload);
    }

    /// Makes the next token a name, if it is a keyword that was declared as one and can be nothing else here.
    pub(super) fn name_keyword(&mut self) {
        let token = self.current;
        if is_word(token.kind) && self.keyword_names.contains(&token.payload) {
            let next = self.ahead(1).kind;
            if is_name_between(self.previous.kind, token.kind, next) {
                self.current.kind = TokenKind::Ident;
            }
        }
    }

    /// Reports a declaration that begins after the comma of another one. Returns whether the other one ends there; otherwise its type
    /// was only repeated, and was skipped.
    pub(super) fn ends_at_comma(&mut self, ty: &TypeSpec) -> bool {
        let mut at = 0;
        while at < MOST_QUALIFIERS && is_qualifier(self.ahead(at).kind) {
            at += 1;
        }
        let word = self.ahead(at);
        if word.kind != TokenKind::Type || self.ahead(at + 1).kind != TokenKind::Ident {
            return false;
        }
        let is_same = at == 0 && matches!(ty.base, TypeBase::Keyword(symbol) if symbol == word.symbol());
        let name = self.session.spelling(word).to_owned();
        let help = match is_same {
            true => {
                Advice::new(Applicability::Unsafe, "one type is for all names: leave this one out", Place::Over, "")
            }
            false => "a declaration has one type: write `;` in place of the comma".into(),
        };
        let message = format!("expected the name of a variable, found the type `{name}`");
        let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, word.span, message);
        self.session.report(diagnostic.here("expected the name of a variable").help(help));
        if is_same {
            self.bump();
        }
        self.assumed_semicolon = !is_same;
        !is_same
    }
}

/// Whether a keyword between two tokens can only be a name.
fn is_name_between(before: TokenKind, keyword: TokenKind, after: TokenKind) -> bool {
    use TokenKind::*;
    let begins_what_any_may_follow =
        matches!(keyword, True | False | Void | Case | Default | Return | Struct | Precision | Layout);
    if begins_what_any_may_follow {
        return false;
    }
    let ends = matches!(after, Semicolon | Comma | RightParen | Colon);
    let is_operand = matches!(before, LeftParen | LeftBracket | Comma | Return) || is_operator(before);
    matches!(after, Dot | RightBracket)
        || (is_operator(after) && !is_prefix(after))
        || (ends && is_operand)
        || (is_prefix(after) && is_operand)
}

/// Whether a token is an operator, or assigns.
pub(super) fn is_operator(kind: TokenKind) -> bool {
    kind as u8 >= TokenKind::Question as u8
}

/// Whether an operator may precede its only operand.
fn is_prefix(kind: TokenKind) -> bool {
    use TokenKind::*;
    matches!(kind, Plus | Dash | Bang | Tilde | Increment | Decrement)
}
