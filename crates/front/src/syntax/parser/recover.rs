//! What is skipped after an error, so that the rest can be read and nothing is reported twice.

use super::{Mark, Parser, Reported, TokenKind, TokenSource, codes};
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

    /// Skips the rest of a broken statement or member that began at `start`: its `;` or its `{..}`, but no brace around
    /// it. At least one token is skipped, unless it is such a brace.
    pub(super) fn recover_statement(&mut self, start: Mark) {
        self.operators.clear();
        if std::mem::take(&mut self.recovered) {
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
                _ if outside && !overdeep && self.consumed > start.consumed && self.begins_anew() => return,
                _ => {}
            }
            let closed = self.bump().kind == TokenKind::RightBrace && self.braces <= start.braces;
            if closed && !overdeep {
                return;
            }
        }
    }

    /// Skips the rest of a broken declaration: up to its `;`, or past its `{..}` and a `;` behind that.
    pub(super) fn recover_declaration(&mut self, start: Mark) {
        self.recover_statement(start);
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
        if self.overdeep {
            return false;
        }
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
