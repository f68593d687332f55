//! What is skipped after an error, so that the rest can be read and nothing is reported twice.

use super::{Parser, Reported, TokenKind, TokenSource, codes};
use crate::diagnostic::Diagnostic;
use crate::source::Span;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Reports, once, that the file ends inside braces.
    pub(super) fn unclosed_brace(&mut self, opening: Span) -> Reported {
        let end = self.previous.span.after();
        let diagnostic = Diagnostic::new(&codes::UNCLOSED_DELIMITER, opening, "`{` is not closed")
            .here("this brace is never closed")
            .label(end, "the file ends here");
        self.report_found(diagnostic)
    }

    /// Whether a statement or declaration surely begins with the next token, which is the first of its line.
    fn begins_anew(&mut self) -> bool {
        if !self.current.starts_line() {
            return false;
        }
        match self.kind() {
            TokenKind::If
            | TokenKind::For
            | TokenKind::While
            | TokenKind::Do
            | TokenKind::Switch
            | TokenKind::Return
            | TokenKind::Break
            | TokenKind::Continue
            | TokenKind::Discard => true,
            TokenKind::Type | TokenKind::Void => self.ahead(1).kind == TokenKind::Ident,
            _ => false,
        }
    }

    /// Skips the rest of a broken statement or member: its `;` or its `{..}`, but no brace around it. `before` is how
    /// much was read when it began: at least one token is always skipped.
    pub(super) fn recover_statement(&mut self, before: usize) {
        self.operators.clear();
        if std::mem::take(&mut self.recovered) {
            return;
        }
        let mut braces = 0_usize;
        loop {
            match self.kind() {
                TokenKind::Eof => {
                    self.end_reported = true;
                    return;
                }
                TokenKind::RightBrace if braces == 0 => return,
                TokenKind::Semicolon if braces == 0 => {
                    self.bump();
                    return;
                }
                TokenKind::LeftBrace => braces += 1,
                TokenKind::RightBrace if braces == 1 => {
                    self.bump();
                    return;
                }
                TokenKind::RightBrace => braces -= 1,
                _ if braces == 0 && self.consumed > before && self.begins_anew() => return,
                _ => {}
            }
            self.bump();
        }
    }

    /// Skips the rest of a broken declaration: up to its `;`, or past its `{..}` and a `;` behind that.
    pub(super) fn recover_declaration(&mut self, before: usize) {
        self.recover_statement(before);
        match self.kind() {
            // The brace closes what was broken, or nothing: in both cases it has had its error.
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

    /// Skips the rest of a broken `( .. )` behind a keyword; false if it has no end before the body or the `;`s.
    pub(super) fn recover_header(&mut self) -> bool {
        self.operators.clear();
        let mut parens = 0_usize;
        loop {
            match self.kind() {
                TokenKind::LeftParen => parens += 1,
                TokenKind::RightParen if parens == 0 => {
                    self.bump();
                    return true;
                }
                TokenKind::RightParen => parens -= 1,
                // The `)` was forgotten: the body is there all the same.
                TokenKind::LeftBrace => return true,
                TokenKind::RightBrace | TokenKind::Eof => return false,
                _ if self.begins_anew() => return true,
                _ => {}
            }
            self.bump();
        }
    }
}
