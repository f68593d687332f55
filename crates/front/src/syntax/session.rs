//! [`ParseSession`]: the state that all steps of a parse share, and [`TokenSource`], the interface between them.

use super::names::Names;
use super::token::Token;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::SourceMap;

/// The state that all steps of a parse share.
pub struct ParseSession<'a> {
    /// The texts.
    pub sources: &'a mut SourceMap,
    /// Where diagnostics go.
    pub diagnostics: &'a mut Diagnostics,
    /// The names that have occurred.
    pub names: Names,
}

impl ParseSession<'_> {
    /// Reports a diagnostic.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Whether to look for a similar name to suggest. Not in a source that is wrong all over, where that would
    /// dominate the run time.
    pub(super) fn may_suggest(&self) -> bool {
        self.diagnostics.len() < 50
    }

    /// The spelling of a word or number.
    pub fn spelling(&self, token: Token) -> &str {
        self.names.spelling(token.symbol())
    }
}

/// A source of tokens for the parser: the preprocessor, or a test.
pub trait TokenSource: Send {
    /// The next token; after the last, [`TokenKind::Eof`](super::token::TokenKind::Eof) forever.
    fn next(&mut self, session: &mut ParseSession<'_>) -> Token;
}
