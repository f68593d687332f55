//! [`ParseSession`]: the state that all steps of a parse share, and [`TokenSource`], the interface between them.

use super::names::Names;
use super::token::Token;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::language::{Extensions, Version};
use crate::source::SourceMap;
use rustc_hash::FxHashMap;

/// The state that all steps of a parse share.
pub struct ParseSession<'a> {
    /// The texts.
    pub sources: &'a mut SourceMap,
    /// Where diagnostics go.
    pub diagnostics: &'a mut Diagnostics,
    /// The version of the language, as far as it has been read.
    pub version: Version,
    /// The names that have occurred.
    pub names: Names,
    /// The sets of extensions that were enabled somewhere, in the order of the text; the first is empty.
    pub extension_sets: ExtensionSets,
}

/// The sets of extensions that tokens refer to by number.
#[derive(Clone, Debug, Default)]
pub struct ExtensionSets {
    /// The sets after the empty one.
    list: Vec<Extensions>,
    numbers: FxHashMap<Extensions, u16>,
}

impl ExtensionSets {
    /// The number of a set. A text that has more than 65,535 different ones keeps the last number.
    pub fn number(&mut self, set: Extensions) -> u16 {
        if set.is_empty() {
            return 0;
        }
        if let Some(&number) = self.numbers.get(&set) {
            return number;
        }
        let Ok(number) = u16::try_from(self.list.len() + 1) else { return u16::MAX };
        self.list.push(set);
        self.numbers.insert(set, number);
        number
    }

    fn set(&self, number: u16) -> Extensions {
        let index = usize::from(number).checked_sub(1);
        index.and_then(|index| self.list.get(index)).copied().unwrap_or_default()
    }
}

impl ParseSession<'_> {
    /// Reports a diagnostic.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// The extensions that are enabled at a token.
    pub fn extensions_at(&self, token: Token) -> Extensions {
        self.extension_sets.set(token.extensions)
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
