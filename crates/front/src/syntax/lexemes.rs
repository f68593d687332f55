//! [`Lexemes`]: the tokens of one text as they are written, with those that the preprocessor skips or replaces.
//!
//! *In:* a text. *Out:* its tokens in order. Words are not told from keywords, and directives are tokens like others.

use super::lexer::{Lexer, Mode};
use super::names::Names;
use super::token::{Token, TokenFlags, TokenKind};
use crate::source::{SourceFile, Span};
use std::sync::Arc;

/// The tokens of a text.
#[derive(Clone, Debug)]
pub struct Lexemes {
    tokens: Vec<Token>,
    names: Names,
    /// How often each word and number occurs, by its symbol.
    counts: Vec<u32>,
}

impl Lexemes {
    /// Cuts a text into tokens.
    pub fn new(file: &SourceFile) -> Self {
        let mut lexer = Lexer::new(Arc::clone(file.text()), file.base());
        let (mut names, mut trivia) = (Names::default(), Vec::new());
        let (mut tokens, mut counts) = (Vec::new(), Vec::new());
        loop {
            let token = lexer.next(Mode::Text, &mut names, &mut trivia);
            trivia.clear();
            match token.kind {
                TokenKind::Eof => return Self { tokens, names, counts },
                TokenKind::Word | TokenKind::Number => {
                    let index = token.symbol().index();
                    counts.resize(counts.len().max(index + 1), 0);
                    counts.iter_mut().skip(index).take(1).for_each(|count| *count += 1);
                }
                _ => {}
            }
            tokens.push(token);
        }
    }

    /// All tokens, in order.
    pub fn tokens(&self) -> &[Token] {
        &self.tokens
    }

    /// The spelling of a word or a number; empty for other tokens.
    pub fn spelling(&self, token: &Token) -> &str {
        match token.kind {
            TokenKind::Word | TokenKind::Number => self.names.spelling(token.symbol()),
            _ => "",
        }
    }

    /// How often a word or a number occurs.
    pub fn count(&self, word: &str) -> usize {
        let count = self.names.get(word).and_then(|symbol| self.counts.get(symbol.index()));
        count.map_or(0, |count| *count as usize)
    }

    /// Where a word occurs.
    pub fn places(&self, word: &str) -> impl Iterator<Item = Span> {
        let symbol = self.names.get(word);
        let is_it = move |token: &&Token| token.kind == TokenKind::Word && Some(token.symbol()) == symbol;
        self.tokens.iter().filter(is_it).map(|token| token.span)
    }

    /// The index of the first token that begins at an offset or after it.
    pub fn from(&self, offset: u32) -> usize {
        self.tokens.partition_point(|token| token.span.start < offset)
    }

    /// The tokens that begin within a span.
    pub fn within(&self, span: Span) -> &[Token] {
        self.tokens.get(self.from(span.start)..self.from(span.end)).unwrap_or(&[])
    }

    /// Whether a token is the `#` of a directive.
    pub fn begins_directive(token: &Token) -> bool {
        token.kind == TokenKind::Hash && token.flags.contains(TokenFlags::LINE_START)
    }

    /// The directives: the word after each `#`, and the tokens behind the word on its line, as far as `is_same_line` tells.
    pub fn directives(&self) -> impl Iterator<Item = (&str, usize)> {
        self.tokens
            .iter()
            .enumerate()
            .filter(|(_, token)| Self::begins_directive(token))
            .map(|(index, _)| (self.tokens.get(index + 1).map_or("", |word| self.spelling(word)), index))
    }
}
