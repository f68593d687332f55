//! [`Token`], which the lexer and the preprocessor hand to the parser, and [`Symbol`], its name.
//!
//! *Holds:* every word and every number is interned, so that two of them are equal exactly if their symbols are.

use crate::source::Span;

/// An interned name; its spelling is in the [`Names`](super::names::Names) of the tree it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(pub(super) u32);

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
    /// After the last token. The payload is 1 if the tokens ended because of an error, which has been reported.
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
    Sample "sample",
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
    /// `unsigned`, which GL_EXT_gpu_shader4 puts before `int`.
    Unsigned "unsigned",
    /// A keyword of a feature that glisten does not support.
    Foreign "keyword",
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
        /// An error has been reported at the token, or at what was dropped before it.
        const REPORTED = 8;
    }
}

/// A token. Twenty bytes.
#[derive(Clone, Copy, Debug)]
pub struct Token {
    /// The kind.
    pub kind: TokenKind,
    /// The context.
    pub flags: TokenFlags,
    /// The number of the set of extensions that are enabled here, in the
    /// [session](super::session::ParseSession::extensions_at).
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

    /// Whether it is the first token on its line.
    pub fn starts_line(self) -> bool {
        self.flags.contains(TokenFlags::LINE_START)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_small() {
        assert_eq!(size_of::<Token>(), 20);
    }
}
