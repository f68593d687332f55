//! Error recovery: what to skip after an error, so that the rest is parsed and nothing is reported twice.

use super::types::is_qualifier;
use super::{Between, Mark, Parser, Reported, TokenKind, TokenSource, codes};
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// How many tokens are looked at to find braces that close nothing.
const MAX_SOUGHT: usize = 1 << 18;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Reports, once, that the file ends inside braces.
    pub(super) fn unclosed_brace(&mut self, opening: Span) -> Reported {
        let end = self.behind();
        let diagnostic = Diagnostic::new(&codes::UNCLOSED_DELIMITER, opening, "`{` is not closed")
            .here("this brace is never closed")
            .label(end, "the file ends here");
        self.report_found(diagnostic)
    }

    /// Whether the next `}` would end a function though its statements go on, up to another `}` that closes nothing: one `{` is missing, or
    /// this `}` is too much.
    pub(super) fn ends_too_early(&mut self) -> bool {
        self.braces == 1 && matches!(self.before_lost_brace(1), Some(Between::Statements))
    }

    /// The text from the token `first` on before a `}` that closes nothing; `None` if there is none before the next function. All
    /// searches together look at a bounded number of tokens, so that text with many errors is not read again and again.
    pub(super) fn before_lost_brace(&mut self, first: usize) -> Option<Between> {
        use TokenKind::*;
        let (mut depth, mut begins) = (0_usize, true);
        let mut between = Between::Declarations;
        for at in first.. {
            self.sought = self.sought.checked_add(1).filter(|sought| *sought < MAX_SOUGHT)?;
            let kind = self.ahead(at).kind;
            if begins && depth == 0 {
                match kind {
                    If | Else | For | While | Do | Switch | Return | Break | Continue | Discard => {
                        between = Between::Statements;
                    }
                    Type | Void | Ident if self.ahead(at + 1).kind == Ident => {
                        (self.ahead(at + 2).kind != LeftParen).then_some(())?;
                    }
                    Ident if self.is_named_statement(self.taken.len() + at) => between = Between::Statements,
                    Uniform | In | Out | Attribute | Varying | Layout => return None,
                    _ => {}
                }
            }
            begins = matches!(kind, Semicolon | LeftBrace | RightBrace) || begins && is_qualifier(kind);
            match kind {
                LeftBrace => depth += 1,
                RightBrace if depth == 0 => return Some(between),
                RightBrace => depth -= 1,
                Eof => return None,
                _ => {}
            }
        }
        None
    }

    /// Reports the `}`, and goes on in the function.
    pub(super) fn early_brace(&mut self) {
        let token = self.bump();
        self.braces += 1;
        let diagnostic =
            Diagnostic::new(&codes::STRAY_DELIMITER, token.span, "`}` ends the function, and statements follow")
                .here("the function ends here")
                .label(self.function_brace, "it begins here")
                .help("a `{` is missing above, or this `}` is too much");
        self.session.report(diagnostic);
        // Its `if` is behind the brace.
        self.eat(TokenKind::Else);
    }

    /// Skips the rest of a broken statement or member that began at `start`: up to its `;` or past its `{..}`, but
    /// never a brace that closes the block around it. Otherwise it skips at least one token.
    pub(super) fn recover_statement(&mut self, start: Mark) {
        self.operators.clear();
        // Going back to the start would find the same error again.
        if std::mem::take(&mut self.recovered) && self.consumed > start.consumed {
            return;
        }
        let overdeep = std::mem::take(&mut self.overdeep);
        loop {
            let outside = self.braces <= start.braces;
            match self.kind() {
                TokenKind::Eof => {
                    self.end_reported = true;
                    return;
                }
                TokenKind::RightBrace if outside => return,
                TokenKind::Semicolon if outside && !overdeep => {
                    self.bump();
                    return;
                }
                // A jump is a whole statement, also in the middle of a line: `float x = 1.0 return x;`.
                TokenKind::Return | TokenKind::Break | TokenKind::Continue | TokenKind::Discard
                    if outside && !overdeep && self.consumed > start.consumed =>
                {
                    return;
                }
                _ if outside && !overdeep && self.consumed > start.consumed && self.begins_anew() => return,
                _ => {}
            }
            let closed = self.bump().kind == TokenKind::RightBrace && self.braces <= start.braces;
            if closed && !overdeep {
                return;
            }
        }
    }

    /// Skips the rest of a broken `case` that began at `start`: past its `:`, or up to the next line.
    pub(super) fn recover_label(&mut self, start: Mark) {
        if self.overdeep {
            self.recover_statement(start);
            return;
        }
        self.operators.clear();
        self.recovered = false;
        loop {
            match self.kind() {
                TokenKind::Eof => {
                    self.end_reported = true;
                    return;
                }
                TokenKind::Colon | TokenKind::Semicolon => {
                    self.bump();
                    return;
                }
                TokenKind::LeftBrace | TokenKind::RightBrace => return,
                _ if self.consumed > start.consumed && self.current.starts_line() => return,
                _ => {}
            }
            self.bump();
        }
    }

    /// Skips the rest of a broken declaration: up to its `;`, or past its `{..}` and a `;` after it.
    pub(super) fn recover_declaration(&mut self, start: Mark) {
        self.recover_statement(start);
        match self.kind() {
            // The brace closes the broken declaration, or nothing. Either way, its error has been reported.
            TokenKind::RightBrace => {
                self.bump();
                self.eat(TokenKind::Semicolon);
            }
            TokenKind::Semicolon if self.previous.kind == TokenKind::RightBrace => {
                self.bump();
            }
            _ => {}
        }
    }

    /// Skips the rest of a broken `( .. )` after a keyword. Returns false if it does not end before the body or
    /// within its `;`s.
    pub(super) fn recover_header(&mut self) -> bool {
        self.operators.clear();
        if self.overdeep {
            return false;
        }
        if self.recovered {
            // The header was left unfinished. What is indented is its body.
            self.recovered = self.is_outdented(self.current);
            return !self.recovered;
        }
        let mut parens = 0_usize;
        if self.looks_like_body() {
            return true;
        }
        loop {
            match self.kind() {
                TokenKind::LeftParen => parens += 1,
                TokenKind::RightParen if parens == 0 => {
                    self.bump();
                    return true;
                }
                TokenKind::RightParen => parens -= 1,
                // The `)` was forgotten, and the body follows.
                TokenKind::LeftBrace => return true,
                TokenKind::RightBrace | TokenKind::Eof => return false,
                _ if self.begins_anew() => {
                    self.recovered = self.is_outdented(self.current);
                    return !self.recovered;
                }
                _ => {}
            }
            self.bump();
        }
    }
}
