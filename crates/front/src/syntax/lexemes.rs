//! [`Lexemes`]: the tokens of one text as they are written, with those that the preprocessor skips or replaces.
//!
//! *In:* a text. *Out:* its tokens in order. Words are not told from keywords, and directives are tokens like others.

use super::lexer::{Lexer, Mode};
use super::names::Names;
use super::preprocessor;
use super::token::{Token, TokenFlags, TokenKind};
use crate::language::Feature;
use crate::source::{SourceFile, Span};
use std::sync::Arc;

/// The tokens of a text.
#[derive(Clone, Debug)]
pub struct Lexemes {
    tokens: Vec<Token>,
    names: Names,
    /// Where the occurrences of each word and number begin in `places`, by its symbol.
    starts: Vec<u32>,
    /// The indices of words and numbers in `tokens`: those of a symbol together, in order.
    places: Vec<u32>,
}

impl Lexemes {
    /// Cuts a text into tokens.
    pub fn new(file: &SourceFile) -> Self {
        let mut lexer = Lexer::new(Arc::clone(file.text()), file.base());
        lexer.joins_comments =
            preprocessor::announced(file.text()).is_some_and(|version| version.has(Feature::LineContinuation));
        let (mut names, mut trivia) = (Names::default(), Vec::new());
        let mut tokens = Vec::new();
        let mut mode = Mode::Text;
        loop {
            let token = lexer.next(mode, &mut names, &mut trivia);
            trivia.clear();
            match token.kind {
                TokenKind::Eof => break,
                TokenKind::Newline => mode = Mode::Text,
                _ => {
                    if Self::begins_directive(&token) {
                        mode = Mode::Directive;
                    }
                    tokens.push(token);
                }
            }
        }
        let (starts, places) = index(&tokens);
        Self { tokens, names, starts, places }
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
        self.occurrences(word).len()
    }

    /// How often a word or a number occurs within a span, other than behind a `.`, where it names a member or components.
    pub fn count_within(&self, word: &str, span: Span) -> usize {
        let all = self.occurrences(word);
        let before = |offset: u32| all.partition_point(|place| (*place as usize) < self.from(offset));
        let within = all.get(before(span.start)..before(span.end)).unwrap_or_default();
        let is_selected = |place: &&u32| {
            let previous = (**place as usize).checked_sub(1).and_then(|index| self.tokens.get(index));
            previous.is_some_and(|token| token.kind == TokenKind::Dot)
        };
        within.iter().filter(|place| !is_selected(place)).count()
    }

    /// Where a word occurs.
    pub fn places(&self, word: &str) -> impl Iterator<Item = Span> {
        let tokens = self.occurrences(word).iter().filter_map(|place| self.tokens.get(*place as usize));
        tokens.filter(|token| token.kind == TokenKind::Word).map(|token| token.span)
    }

    /// The indices of the tokens that are a word or a number.
    fn occurrences(&self, word: &str) -> &[u32] {
        let bound = |index: usize| self.starts.get(index).map(|start| *start as usize);
        let range = self.names.get(word).and_then(|symbol| {
            let index = symbol.index();
            Some(bound(index)?..bound(index + 1)?)
        });
        range.and_then(|range| self.places.get(range)).unwrap_or_default()
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

    /// Whether the file defines a macro of a name.
    pub fn defines(&self, name: &str) -> bool {
        let named = |index: usize| self.tokens.get(index + 2).is_some_and(|token| self.spelling(token) == name);
        self.directives().any(|(word, index)| word == "define" && named(index))
    }
}

/// The indices of words and numbers, sorted by their symbols, and where those of each symbol begin.
fn index(tokens: &[Token]) -> (Vec<u32>, Vec<u32>) {
    let symbol = |token: &Token| match token.kind {
        TokenKind::Word | TokenKind::Number => Some(token.symbol().index()),
        _ => None,
    };
    let numbered = (0_u32..).zip(tokens).filter_map(|(place, token)| Some((symbol(token)?, place)));
    let mut all: Vec<(usize, u32)> = numbered.collect();
    all.sort_unstable();
    let mut starts = vec![0; all.last().map_or(0, |(last, _)| last + 2)];
    for (symbol, _) in &all {
        starts.iter_mut().skip(symbol + 1).take(1).for_each(|count| *count += 1);
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    (starts, all.into_iter().map(|(_, place)| place).collect())
}

#[cfg(test)]
mod tests {
    use super::Lexemes;
    use crate::source::{SourceMap, Span};

    #[test]
    fn words_are_counted_where_they_are() {
        let mut sources = SourceMap::default();
        let text = "a b 1 a (b) a 1 b.a";
        let id = sources.add("words", text).expect("there is room");
        let base = sources.file(id).base();
        let lexemes = Lexemes::new(sources.file(id));
        for (word, count) in [("a", 4), ("b", 3), ("1", 2), ("c", 0)] {
            assert_eq!(lexemes.count(word), count, "{word}");
        }
        let starts = |word: &str| lexemes.places(word).map(|span| span.start - base).collect::<Vec<_>>();
        assert_eq!((starts("a"), starts("b"), starts("1")), (vec![0, 6, 12, 18], vec![2, 9, 16], vec![]));
        let within = |word: &str, from: u32, to: u32| lexemes.count_within(word, Span::new(base + from, base + to));
        assert_eq!((within("a", 0, 15), within("a", 1, 12), within("a", 6, 13), within("c", 0, 15)), (3, 1, 2, 0));
        assert_eq!((within("a", 14, 19), within("b", 14, 19)), (0, 1));
    }
}
