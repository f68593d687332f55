//! [`Token`], which the lexer and the preprocessor hand to the parser, and [`Names`], the spellings of a tree.
//!
//! *Holds:* every word and every number is interned, so that two of them are equal exactly if their symbols are. The
//! words of the [keyword table](super::keywords) come first in [`Names::with_keywords`], in the table's order.

use super::ast::Extensions;
use super::keywords;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::{SourceMap, Span};
use std::hash::Hasher;
use std::sync::LazyLock;

/// An interned name; its spelling is in the [`Names`] of the tree it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(u32);

impl Symbol {
    /// The index among the names, in the order of first occurrence.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The symbol as the payload of a token.
    pub(crate) fn bits(self) -> u32 {
        self.0
    }
}

/// The spellings of [`Symbol`]s: one text for all, and an open-addressing hash table over it, so that a copy of the
/// prepared keywords is three plain copies of memory.
#[derive(Clone, Debug, Default)]
pub struct Names {
    text: String,
    /// The end of each spelling in the text, and its hash.
    entries: Vec<(u32, u32)>,
    /// The slots of the hash table, a power of two of them: symbol + 1, or 0.
    slots: Vec<u32>,
}

static KEYWORDS: LazyLock<Names> = LazyLock::new(|| {
    let mut names = Names::default();
    for row in keywords::TABLE {
        names.intern(row.spelling);
    }
    names
});

impl Names {
    /// Names that begin with the words of the keyword table, so that symbol *n* is row *n*.
    pub fn with_keywords() -> Self {
        KEYWORDS.clone()
    }

    /// The symbol of a spelling.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if (self.entries.len() + 1) * 2 > self.slots.len() {
            self.grow();
        }
        let hash = hash(name);
        match self.probe(name, hash) {
            Ok(symbol) => symbol,
            Err(slot) => {
                self.text.push_str(name);
                self.entries.push((self.text.len() as u32, hash));
                if let Some(place) = self.slots.get_mut(slot) {
                    *place = self.entries.len() as u32;
                }
                Symbol(self.entries.len() as u32 - 1)
            }
        }
    }

    /// The symbol of a spelling, if it has occurred.
    pub fn get(&self, name: &str) -> Option<Symbol> {
        if self.slots.is_empty() { None } else { self.probe(name, hash(name)).ok() }
    }

    /// The spelling of a symbol.
    pub fn spelling(&self, symbol: Symbol) -> &str {
        let index = symbol.index();
        let start = index.checked_sub(1).and_then(|before| self.entries.get(before)).map_or(0, |entry| entry.0);
        let end = self.entries.get(index).map_or(start, |entry| entry.0);
        self.text.get(start as usize..end as usize).unwrap_or("")
    }

    /// The number of names.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The symbol, or the empty slot where it belongs. The table must be neither empty nor full.
    fn probe(&self, name: &str, hash: u32) -> Result<Symbol, usize> {
        let mask = self.slots.len() - 1;
        let mut slot = hash as usize & mask;
        loop {
            let Some(number) = self.slots.get(slot).copied().filter(|&number| number != 0) else { return Err(slot) };
            let symbol = Symbol(number - 1);
            if self.entries.get(symbol.index()).is_some_and(|entry| entry.1 == hash) && self.spelling(symbol) == name {
                return Ok(symbol);
            }
            slot = (slot + 1) & mask;
        }
    }

    fn grow(&mut self) {
        let places = (self.slots.len() * 2).max(64);
        let mut slots = vec![0; places];
        for (index, (_, hash)) in self.entries.iter().enumerate() {
            let mut slot = *hash as usize & (places - 1);
            while slots.get(slot).is_some_and(|&number| number != 0) {
                slot = (slot + 1) & (places - 1);
            }
            if let Some(place) = slots.get_mut(slot) {
                *place = index as u32 + 1;
            }
        }
        self.slots = slots;
    }
}

fn hash(name: &str) -> u32 {
    let mut hasher = rustc_hash::FxHasher::default();
    hasher.write(name.as_bytes());
    let hash = hasher.finish();
    (hash ^ (hash >> 32)) as u32
}

macro_rules! token_kinds {
    ($($(#[$doc:meta])* $kind:ident $spelling:literal,)*) => {
        /// The kinds of tokens.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        #[expect(missing_docs, reason = "the spelling says it")]
        pub enum TokenKind {
            $($(#[$doc])* $kind,)*
        }

        impl TokenKind {
            /// The spelling, or a description.
            pub fn spelling(self) -> &'static str {
                match self {
                    $(Self::$kind => $spelling,)*
                }
            }
        }
    };
}

token_kinds! {
    /// After the last token. The payload is 1 if the preprocessor gave up and its error has been reported.
    Eof "end of file",
    /// The end of a line, only inside directives.
    Newline "end of line",
    /// A word that may turn out to be a keyword. The parser never sees one.
    Word "word",
    /// A number before conversion. The parser never sees one.
    Number "number",
    /// A character that the language does not have. The parser never sees one.
    Unknown "character",
    /// A word or a string that no version of GLSL has; the payload is its symbol. It has been reported and counts as
    /// a name or a value.
    Invalid "invalid token",
    /// A parameter in the body of a macro; the payload is its index. The parser never sees one.
    Param "parameter",
    Hash "#",
    HashHash "##",

    /// A name; the payload is its symbol.
    Ident "identifier",
    /// A word that is reserved for future use (§3.6); the payload is its symbol.
    Reserved "reserved word",
    /// A type keyword; the payload is its symbol.
    Type "type",
    /// The payload is the bits of the value, as in all literals.
    Int "integer",
    Uint "unsigned integer",
    Float "number",
    True "true",
    False "false",
    Void "void",

    Attribute "attribute",
    Const "const",
    Uniform "uniform",
    Varying "varying",
    Layout "layout",
    Centroid "centroid",
    Flat "flat",
    Smooth "smooth",
    Noperspective "noperspective",
    Break "break",
    Continue "continue",
    Do "do",
    For "for",
    While "while",
    Switch "switch",
    Case "case",
    Default "default",
    If "if",
    Else "else",
    In "in",
    Out "out",
    Inout "inout",
    Invariant "invariant",
    Precise "precise",
    Discard "discard",
    Return "return",
    Lowp "lowp",
    Mediump "mediump",
    Highp "highp",
    Precision "precision",
    Struct "struct",

    LeftParen "(",
    RightParen ")",
    LeftBracket "[",
    RightBracket "]",
    LeftBrace "{",
    RightBrace "}",
    Dot ".",
    Comma ",",
    Colon ":",
    Semicolon ";",
    Question "?",
    Equal "=",
    MulAssign "*=",
    DivAssign "/=",
    ModAssign "%=",
    AddAssign "+=",
    SubAssign "-=",
    LeftAssign "<<=",
    RightAssign ">>=",
    AndAssign "&=",
    XorAssign "^=",
    OrAssign "|=",
    Bang "!",
    Tilde "~",
    Plus "+",
    Dash "-",
    Star "*",
    Slash "/",
    Percent "%",
    LeftAngle "<",
    RightAngle ">",
    VerticalBar "|",
    Caret "^",
    Ampersand "&",
    Increment "++",
    Decrement "--",
    LeftOp "<<",
    RightOp ">>",
    LessEqual "<=",
    GreaterEqual ">=",
    EqualEqual "==",
    NotEqual "!=",
    AndAnd "&&",
    XorXor "^^",
    OrOr "||",
}

bitflags::bitflags! {
    /// The context of a token.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct TokenFlags: u8 {
        /// The token is the first on its line.
        const LINE_START = 1;
        /// White space comes before it.
        const SPACE = 2;
        /// The name of a macro inside its own expansion, which is never expanded again.
        const NO_EXPAND = 4;
    }
}

/// A token. Twenty bytes.
#[derive(Clone, Copy, Debug)]
pub struct Token {
    /// The kind.
    pub kind: TokenKind,
    /// The context.
    pub flags: TokenFlags,
    /// The extensions that are enabled here, as [`Extensions`] bits.
    pub(super) extensions: u16,
    /// A symbol or the bits of a value, depending on the kind.
    pub payload: u32,
    /// Where it was written, and which macro use put it here.
    pub span: Span,
}

impl Token {
    /// A token without a payload.
    pub fn new(kind: TokenKind, span: Span) -> Self {
        Self { kind, flags: TokenFlags::empty(), extensions: 0, payload: 0, span }
    }

    /// The symbol of a word.
    pub fn symbol(self) -> Symbol {
        Symbol(self.payload)
    }

    /// The extensions that are enabled here.
    pub fn extensions(self) -> Extensions {
        Extensions::from_bits_truncate(u32::from(self.extensions))
    }

    /// This token with these extensions enabled.
    #[must_use]
    pub fn with_extensions(self, extensions: Extensions) -> Self {
        Self { extensions: extensions.bits() as u16, ..self }
    }

    /// Whether it is the first token on its line.
    pub fn starts_line(self) -> bool {
        self.flags.contains(TokenFlags::LINE_START)
    }
}

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
    /// The next token; after the last, [`TokenKind::Eof`] forever.
    fn next(&mut self, session: &mut ParseSession<'_>) -> Token;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spellings_have_equal_symbols() {
        let mut names = Names::with_keywords();
        let before = names.len();
        let symbols: Vec<_> = (0..1000).map(|n| names.intern(&format!("name{n}"))).collect();
        assert_eq!(names.len(), before + 1000);
        for (n, symbol) in symbols.into_iter().enumerate() {
            assert_eq!(names.spelling(symbol), format!("name{n}"));
            assert_eq!(names.intern(&format!("name{n}")), symbol);
            assert_eq!(names.get(&format!("name{n}")), Some(symbol));
        }
        assert_eq!(names.get("absent"), None);
        assert_eq!(Names::default().get("absent"), None);
    }

    #[test]
    fn a_token_is_small() {
        assert_eq!(size_of::<Token>(), 20);
    }
}
