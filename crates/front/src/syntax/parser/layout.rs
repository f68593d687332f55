//! Layout as a witness: where a statement ended that its author did not finish.
//!
//! *In:* the tokens of the statement that has an error. *Out:* an error at the end of the unfinished line, and the tokens behind it put
//! back, so that they are parsed as what they are.
//!
//! *Holds:* nothing here decides whether there is an error. Once there is one, a line inside of the statement that begins another one
//! tells that the statement was left unfinished before it: `vec3 n = normalize(`, and the next line is `float d = 1.0;`.

use super::types::is_qualifier;
use super::{Parser, Reported, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::syntax::ast::Ident;

/// How many tokens are looked at to tell whether a line begins a statement.
const MAX_LOOK: usize = 256;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// The token with a number in the current statement, which may not have been read yet.
    fn token(&mut self, number: usize) -> Token {
        match self.taken.get(number) {
            Some(token) => *token,
            None => self.ahead(number - self.taken.len()),
        }
    }

    /// Whether the line that begins with a token certainly begins a statement or declaration.
    pub(super) fn certainly_begins(&mut self, number: usize) -> bool {
        use TokenKind::*;
        let first = self.token(number);
        if !first.starts_line() {
            return false;
        }
        match first.kind {
            // Between the parentheses of a function, `vec3 a` is a parameter.
            Type | Void | Ident if self.in_parameters => {
                self.token(number + 1).kind == Ident && self.token(number + 2).kind == LeftParen
            }
            Const | In | Out | Inout | Highp | Mediump | Lowp | Precise if self.in_parameters => false,
            If | For | While | Do | Switch | Return | Break | Continue | Discard | Precision | Struct => true,
            Type | Void => self.token(number + 1).kind == Ident,
            kind => is_qualifier(kind),
        }
    }

    /// Whether the line that begins with a token begins another statement than the one before it, as far as its look tells.
    pub(super) fn begins_another(&mut self, number: usize) -> bool {
        self.certainly_begins(number) || self.seems_to_begin(number)
    }

    /// Whether the line that begins with a token looks like a statement: a declaration of a type with a name, an assignment, a call.
    /// It begins no further right than the statement that it interrupts.
    fn seems_to_begin(&mut self, number: usize) -> bool {
        let first = self.token(number);
        if !first.starts_line() || self.in_parameters {
            return false;
        }
        let looks = match first.kind {
            TokenKind::Increment | TokenKind::Decrement => self.token(number + 1).kind == TokenKind::Ident,
            TokenKind::Ident => self.is_named_statement(number),
            TokenKind::Else | TokenKind::Case | TokenKind::Default => true,
            _ => false,
        };
        looks && self.is_outdented(first)
    }

    /// Whether `S a`, `a.b[i] =`, `a++;` or `f(..);` is there.
    pub(super) fn is_named_statement(&mut self, number: usize) -> bool {
        use TokenKind::*;
        let mut at = number + 1;
        if self.token(at).kind == Ident {
            return !self.token(at).starts_line();
        }
        let mut was_call = false;
        while at < number + MAX_LOOK {
            match self.token(at).kind {
                Dot => at += 2,
                LeftBracket => at = self.past(at, LeftBracket, RightBracket),
                LeftParen if !was_call => {
                    at = self.past(at, LeftParen, RightParen);
                    was_call = true;
                }
                Increment | Decrement => return self.token(at + 1).kind == Semicolon,
                Semicolon => return was_call,
                Equal | MulAssign | DivAssign | ModAssign | AddAssign | SubAssign | LeftAssign | RightAssign
                | AndAssign | XorAssign | OrAssign => return true,
                _ => return false,
            }
        }
        false
    }

    /// The number of the token behind the bracket that closes the one at `at`.
    fn past(&mut self, at: usize, open: TokenKind, close: TokenKind) -> usize {
        let mut depth = 0_usize;
        for number in at..at + MAX_LOOK {
            let kind = self.token(number).kind;
            if kind == open {
                depth += 1;
            } else if kind == close {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return number + 1;
                }
            } else if matches!(
                kind,
                TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace | TokenKind::Eof
            ) {
                return number;
            }
        }
        at + MAX_LOOK
    }

    /// The columns before the first character of a token's line.
    fn indentation(&self, span: Span) -> usize {
        let sources = &self.session.sources;
        let line = sources.line_of(sources.call_site(span)).map_or("", |line| sources.snippet(line));
        let blanks = line.chars().take_while(|c| c.is_whitespace());
        blanks.map(|c| if c == '\t' { 4 } else { 1 }).sum()
    }

    /// Whether a token's line is indented no more than that of the statement.
    pub(super) fn is_outdented(&self, token: Token) -> bool {
        self.taken.first().is_some_and(|first| self.indentation(token.span) <= self.indentation(first.span))
    }

    /// Whether the next token begins a line that begins a statement or declaration of its own.
    pub(super) fn begins_anew(&mut self) -> bool {
        let next = self.taken.len();
        self.certainly_begins(next) || self.seems_to_begin(next)
    }

    /// Whether the next token begins a line with a whole statement, further right than the one that it is in: the body of a header
    /// whose `)` is missing.
    pub(super) fn looks_like_body(&mut self) -> bool {
        let next = self.taken.len();
        self.current.starts_line()
            && !self.in_parameters
            && self.kind() == TokenKind::Ident
            && !self.is_outdented(self.current)
            && self.is_named_statement(next)
    }

    /// The number of the first token that begins another statement, if the current one was left unfinished before it.
    fn unfinished_before(&mut self) -> Option<usize> {
        let is_brace = |token: &Token| matches!(token.kind, TokenKind::LeftBrace | TokenKind::RightBrace);
        let first = self.taken.iter().rposition(is_brace).map_or(0, |brace| brace + 1);
        let mut depth = 0_usize;
        for number in first..=self.taken.len() {
            if number > 0 {
                let before = self.token(number - 1).kind;
                let is_next = number == self.taken.len();
                let wants_more = depth > 0 || continues(before);
                // In a list of variables, `b = 1.0` is the next one.
                let may_seem = depth > 0 || before != TokenKind::Comma;
                if (is_next || wants_more)
                    && before != TokenKind::RightBrace
                    && (depth > 0 || before != TokenKind::Semicolon)
                    && (self.certainly_begins(number) || may_seem && wants_more && self.seems_to_begin(number))
                {
                    return Some(number);
                }
                if is_next && wants_more && self.current.starts_line() && self.kind() == TokenKind::RightBrace {
                    return Some(number);
                }
            }
            match self.token(number).kind {
                TokenKind::LeftParen | TokenKind::LeftBracket => depth += 1,
                TokenKind::RightParen | TokenKind::RightBracket => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        None
    }

    /// Reports an error of the statement at the end of the line where it was left unfinished, and goes back there. `expected` is what
    /// could be instead of the next token.
    pub(super) fn left_unfinished(&mut self, expected: &str) -> Option<Reported> {
        let number = self.unfinished_before()?;
        let target = self.token(number).span;
        if !self.returned_to.insert(target) {
            return None;
        }
        let is_next = number == self.taken.len();
        let before = self.token(number - 1);
        let open = self.open_bracket(number);
        let expected = match before.kind {
            TokenKind::Dot => "the name of a member or a swizzle",
            kind if !continues(kind) && is_next && open.is_none() => expected,
            _ => "an expression",
        };
        let at = self.between(before.span, target);
        let closes = !continues(before.kind) || matches!(before.kind, TokenKind::Comma) || open_kind(before.kind);
        let diagnostic = match open.filter(|_| closes) {
            Some(opening) => unclosed(opening, at),
            None => {
                let message = format!("expected {expected} before the end of the line");
                Diagnostic::new(&codes::UNEXPECTED_TOKEN, at, message).here(format!("expected {expected}"))
            }
        };
        if self.kind() != TokenKind::Eof || !self.end_reported {
            self.session.report(diagnostic);
        }
        self.go_back(number);
        Some(Reported)
    }

    /// The innermost bracket that is open before a token of the statement.
    fn open_bracket(&self, number: usize) -> Option<Token> {
        let mut open = Vec::new();
        for token in self.taken.iter().take(number) {
            match token.kind {
                TokenKind::LeftParen | TokenKind::LeftBracket => open.push(*token),
                TokenKind::RightParen | TokenKind::RightBracket => {
                    open.pop();
                }
                TokenKind::LeftBrace | TokenKind::RightBrace => open.clear(),
                _ => {}
            }
        }
        open.pop()
    }

    /// The bracket that a macro in the statement opens and does not close, where it is written, and the macro's name.
    pub(super) fn open_in_macro(&self) -> Option<(Span, &str)> {
        let mut open: Vec<Token> = Vec::new();
        for token in &self.taken {
            match token.kind {
                TokenKind::LeftParen | TokenKind::LeftBracket => open.push(*token),
                TokenKind::RightParen | TokenKind::RightBracket => {
                    let partner = open.pop()?.span;
                    if partner.expansion != token.span.expansion
                        && let Some(expansion) = self.session.sources.expansion(partner.expansion)
                    {
                        return Some((Span::new(partner.start, partner.end), &expansion.name));
                    }
                }
                _ => {}
            }
        }
        None
    }

    /// Puts the tokens of the statement from a number on back. There are no braces among them.
    fn go_back(&mut self, number: usize) {
        self.recovered = true;
        let Some(&first) = self.taken.get(number) else { return };
        self.consumed = self.consumed.saturating_sub(self.taken.len() - number);
        let is_behind = |name: &Ident| self.taken.iter().skip(number).any(|token| token.span == name.span);
        let names: Vec<Ident> = self.declaring.iter().filter(|name| !is_behind(name)).copied().collect();
        if names.len() < self.declaring.len() {
            // They are declared by the line that is read once more.
            self.declaring = names;
            self.unfinished = None;
        }
        self.ahead.push_front(self.current);
        for token in self.taken.drain(number..).skip(1).rev() {
            self.ahead.push_front(token);
        }
        self.current = first;
        if let Some(before) = self.taken.last() {
            self.previous = *before;
        }
        self.note_seam();
    }
}

/// Whether an expression goes on behind a token.
fn continues(kind: TokenKind) -> bool {
    use TokenKind::*;
    open_kind(kind)
        || kind as u8 >= Equal as u8 && !matches!(kind, Increment | Decrement)
        || matches!(kind, Dot | Comma | Question | Colon)
}

fn open_kind(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::LeftParen | TokenKind::LeftBracket)
}

/// A bracket that nothing closes before a place.
pub(super) fn unclosed(opening: Token, at: Span) -> Diagnostic {
    let bracket = opening.kind.spelling();
    let closing = match opening.kind {
        TokenKind::LeftParen => ")",
        TokenKind::LeftBrace => "}",
        _ => "]",
    };
    Diagnostic::new(&codes::UNCLOSED_DELIMITER, at, format!("`{bracket}` is not closed"))
        .here(format!("expected `{closing}`"))
        .label(opening.span, "opened here")
}
