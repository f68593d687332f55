//! [`Lexer`] cuts text into preprocessing tokens (GLSL 1.50 §3.1, §3.4, §3.5).
//!
//! *In:* one text. *Out:* one token per call. Words and numbers are interned spellings: whether a word is a keyword
//! or a number is well formed is checked only for those that reach the parser. Operators have kinds of their own; all
//! else is [`TokenKind::Unknown`]. Comments and white space are skipped; what later phases need to know about them is
//! left in [`Trivia`].
//!
//! *Holds:* the lexer never fails, never recurses, and reads each byte a bounded number of times.

use super::names::Names;
use super::token::{Token, TokenFlags, TokenKind};
use crate::source::{Span, line_end_length};
use std::sync::Arc;

/// Skipped text that later phases need to know about.
#[derive(Clone, Copy, Debug)]
pub(super) enum Trivia {
    /// A comment that begins with `glisten:`.
    Pragma(Span),
    /// A backslash and the end of its line, outside comments (the flag is false) or at the end of a `//` comment.
    Continuation(Span, bool),
    /// `/*` without an end; the span is that of the `/*`.
    Unterminated(Span),
    /// The `/*` of a comment over several lines after which a directive goes on.
    Crossed(Span),
}

/// How to treat the end of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// As white space.
    Text,
    /// As a token, which is not consumed: the next call returns it again.
    Directive,
}

/// Reads a text from start to end.
#[derive(Clone, Debug)]
pub(super) struct Lexer {
    text: Arc<str>,
    base: u32,
    pos: usize,
    /// The offset at which the last token ended.
    last_end: u32,
    /// Whether this line has held only white space and comments so far.
    at_line_start: bool,
    /// Whether a `//` comment that ends in a backslash continues on the next line (4.20 and 420pack).
    pub(super) joins_comments: bool,
}

/// The beginning of a comment for glisten, in any case.
pub(super) const PRAGMA: &str = "glisten:";

/// Whether a comment's text is for glisten.
fn is_pragma(text: &str) -> bool {
    let start = text.trim_start().get(..PRAGMA.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(PRAGMA))
}

const WORD: u8 = 1;
const DIGIT: u8 = 2;

static CLASS: [u8; 256] = {
    let mut class = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let b = byte as u8;
        if b.is_ascii_alphabetic() || b == b'_' {
            class[byte] = WORD;
        } else if b.is_ascii_digit() {
            class[byte] = DIGIT;
        }
        byte += 1;
    }
    class
};

fn class(byte: u8) -> u8 {
    CLASS[byte as usize]
}

/// The quotes of strings, opening and closing, those of word processors among them. GLSL has none.
pub(super) const QUOTES: &[(char, char)] =
    &[('"', '"'), ('\'', '\''), ('\u{201c}', '\u{201d}'), ('\u{2018}', '\u{2019}')];

impl Lexer {
    /// A lexer for `text`, whose first byte has the global offset `base`.
    pub(super) fn new(text: Arc<str>, base: u32) -> Self {
        // A byte order mark at the start names the encoding and is not part of the text.
        let pos = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { text, base, pos, last_end: base, at_line_start: true, joins_comments: false }
    }

    fn at(&self, offset: usize) -> Option<u8> {
        self.text.as_bytes().get(self.pos + offset).copied()
    }

    /// The byte at `offset` from here. Past the end it is 0, which no valid text contains.
    fn peek(&self, offset: usize) -> u8 {
        self.at(offset).unwrap_or(0)
    }

    fn span_from(&self, start: usize) -> Span {
        Span::new(self.base + start as u32, self.base + self.pos as u32)
    }

    /// Continues at a place in the text, which is between tokens.
    pub(super) fn go_to(&mut self, pos: usize) {
        self.pos = pos;
        self.last_end = self.base + pos as u32;
        self.at_line_start = false;
    }

    /// The global offset of the next byte.
    pub(super) fn offset(&self) -> u32 {
        self.base + self.pos as u32
    }

    /// The next token.
    pub(super) fn next(&mut self, mode: Mode, names: &mut Names, trivia: &mut Vec<Trivia>) -> Token {
        let mut flags = TokenFlags::empty();
        if let Some(newline) = self.skip_space(mode, &mut flags, trivia) {
            return newline;
        }
        if std::mem::take(&mut self.at_line_start) {
            flags |= TokenFlags::LINE_START;
        }
        let start = self.pos;
        let Some(byte) = self.at(0) else {
            // An empty file has no byte to point at; one past the end shows the last line.
            return Token { flags, ..Token::new(TokenKind::Eof, self.span_from(start)) };
        };
        let kind = match class(byte) {
            WORD => self.word(),
            DIGIT => self.number(),
            _ if byte >= 0x80 && self.foreign_letter().is_some() => self.word(),
            _ if (matches!(byte, b'"' | b'\'') || byte >= 0x80) && self.opens_string() => self.string(),
            _ if byte == b'.' && class(self.peek(self.joined(1))) == DIGIT => self.number(),
            _ => self.operator(byte, trivia),
        };
        let mut token = Token { flags, ..Token::new(kind, self.span_from(start)) };
        if matches!(kind, TokenKind::Word | TokenKind::Number | TokenKind::Invalid) {
            token.payload = self.intern(start, names, trivia).bits();
            token.span = self.span_from(start);
        }
        self.last_end = token.span.end;
        token
    }

    /// Reads a word. A word with non-ASCII letters is [`TokenKind::Invalid`].
    fn word(&mut self) -> TokenKind {
        let mut kind = TokenKind::Word;
        loop {
            let next = self.joined(0);
            if class(self.peek(next)) != 0 {
                self.pos += next + 1;
            } else if let Some(length) = self.foreign_letter() {
                self.pos += length;
                kind = TokenKind::Invalid;
            } else {
                return kind;
            }
        }
    }

    /// The length of the next character if it is a non-ASCII letter or digit.
    fn foreign_letter(&self) -> Option<usize> {
        if self.peek(0) < 0x80 {
            return None;
        }
        let character = self.text.get(self.pos..)?.chars().next()?;
        character.is_alphanumeric().then(|| character.len_utf8())
    }

    /// Whether a quote is next.
    fn opens_string(&self) -> bool {
        let rest = self.text.get(self.pos..).unwrap_or("");
        QUOTES.iter().any(|pair| rest.starts_with(pair.0))
    }

    /// Reads a string or a character of C; a quote without a partner is a single character.
    fn string(&mut self) -> TokenKind {
        let mut letters = self.text.get(self.pos..).unwrap_or("").char_indices();
        let opening = letters.next().map_or('"', |(_, letter)| letter);
        let closing = QUOTES.iter().find(|pair| pair.0 == opening).map_or(opening, |pair| pair.1);
        let ends = |letter: char| letter == closing || matches!(letter, '\n' | '\r');
        match letters.find(|(_, letter)| ends(*letter)).filter(|(_, letter)| *letter == closing) {
            Some((length, _)) => {
                self.pos += length + closing.len_utf8();
                TokenKind::Invalid
            }
            None => {
                self.pos += opening.len_utf8();
                TokenKind::Unknown
            }
        }
    }

    /// Interns what was read since `start`, without the line continuations in it.
    fn intern(&mut self, start: usize, names: &mut Names, trivia: &mut Vec<Trivia>) -> super::token::Symbol {
        let end = self.pos;
        let raw = self.text.get(start..end).unwrap_or("");
        if !raw.contains(['\n', '\r']) {
            return names.intern(raw);
        }
        let joined: String = raw.chars().filter(|letter| !matches!(letter, '\\' | '\n' | '\r')).collect();
        self.tell_continuations(start, trivia);
        names.intern(&joined)
    }

    /// Notes the line continuations between `start` and the place that was reached.
    fn tell_continuations(&mut self, start: usize, trivia: &mut Vec<Trivia>) {
        let end = std::mem::replace(&mut self.pos, start);
        while self.pos < end {
            match self.continuation_length(0) {
                Some(_) => self.continuation(trivia),
                None => self.pos += 1,
            }
        }
    }

    /// The offset of the first byte from `offset` on that no line continuation hides: lines are joined before there are tokens, so
    /// that a token may go on in the next line (GLSL 4.20 §3.2, GLSL ES 3.00 §3.1).
    fn joined(&self, mut offset: usize) -> usize {
        while let Some(length) = self.continuation_length(offset) {
            offset += length;
        }
        offset
    }

    /// The length of a backslash and the line end after it, if they are at an offset.
    fn continuation_length(&self, offset: usize) -> Option<usize> {
        if self.peek(offset) != b'\\' {
            return None;
        }
        match self.line_end_length(offset + 1) {
            0 => None,
            length => Some(1 + length),
        }
    }

    /// The length of the line end at an offset, or 0.
    fn line_end_length(&self, offset: usize) -> usize {
        line_end_length(self.text.as_bytes().get(self.pos + offset..).unwrap_or(&[]))
    }

    fn continuation(&mut self, trivia: &mut Vec<Trivia>) {
        if let Some(length) = self.continuation_length(0) {
            let start = self.pos;
            self.pos += 1;
            trivia.push(Trivia::Continuation(self.span_from(start), false));
            self.pos += length - 1;
        }
    }

    /// Skips white space and comments. In a directive, returns the end of the line. A comment is one space there, whatever lines it has:
    /// comments are replaced before directives are read (GLSL 4.60 §3.1, GLSL ES 3.00 §3.1).
    fn skip_space(&mut self, mode: Mode, flags: &mut TokenFlags, trivia: &mut Vec<Trivia>) -> Option<Token> {
        let mut crossed = None;
        loop {
            match self.peek(0) {
                b' ' | b'\t' | 0x0B | 0x0C => self.pos += 1,
                b'\n' | b'\r' if mode == Mode::Directive => {
                    return Some(Token::new(TokenKind::Newline, Span::new(self.last_end, self.last_end)));
                }
                b'\n' | b'\r' => {
                    self.pos += 1;
                    self.at_line_start = true;
                }
                b'/' if self.comment_sign() == b'/' => self.line_comment(trivia),
                b'/' if self.comment_sign() == b'*' => {
                    let start = self.offset();
                    if self.block_comment(trivia) {
                        match mode {
                            Mode::Text => self.at_line_start = true,
                            Mode::Directive => crossed = Some(Span::new(start, start + 2)),
                        }
                    }
                }
                b'\\' if self.continuation_length(0).is_some() => self.continuation(trivia),
                _ => {
                    let goes_on = self.at(0).is_some();
                    trivia.extend(crossed.filter(|_| goes_on).map(Trivia::Crossed));
                    return None;
                }
            }
            flags.insert(TokenFlags::SPACE);
        }
    }

    /// The offset of the second byte of a comment's sign, which may be on the next line where comments are joined.
    fn second(&self) -> usize {
        if self.joins_comments { self.joined(1) } else { 1 }
    }

    /// The second byte of a comment's sign.
    fn comment_sign(&self) -> u8 {
        self.peek(self.second())
    }

    fn line_comment(&mut self, trivia: &mut Vec<Trivia>) {
        let start = self.pos;
        self.pos += self.second() + 1;
        let opening = self.pos;
        loop {
            self.skip_to_line_end();
            let before = self.pos.checked_sub(1).and_then(|last| self.text.as_bytes().get(last)).copied();
            if before != Some(b'\\') || self.at(0).is_none() || self.ends_in_foreign_backslash() {
                break;
            }
            let span = Span::new(self.offset() - 1, self.offset());
            trivia.push(Trivia::Continuation(span, true));
            if !self.joins_comments {
                break;
            }
            self.pos += self.line_end_length(0).max(1);
        }
        let text = self.text.get(opening..self.pos).unwrap_or("");
        if is_pragma(text) {
            trivia.push(Trivia::Pragma(self.span_from(start)));
        }
    }

    /// Whether the backslash before this belongs to a character of a legacy encoding: in Shift_JIS, Big5 and GBK it may be
    /// the second byte of one. Its first byte, which is not UTF-8, has become U+FFFD.
    fn ends_in_foreign_backslash(&self) -> bool {
        self.text.get(..self.pos.saturating_sub(1)).is_some_and(|before| before.ends_with('\u{fffd}'))
    }

    fn skip_to_line_end(&mut self) {
        let rest = self.text.as_bytes().get(self.pos..).unwrap_or(&[]);
        self.pos += rest.iter().position(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(rest.len());
    }

    /// Skips a block comment. Returns whether it contained a line end.
    fn block_comment(&mut self, trivia: &mut Vec<Trivia>) -> bool {
        let start = self.pos;
        self.pos += self.second() + 1;
        let (opening, begin) = (self.span_from(start), self.pos);
        let mut lines = false;
        loop {
            match self.at(0) {
                None => {
                    trivia.push(Trivia::Unterminated(opening));
                    return lines;
                }
                Some(b'*') if self.comment_sign() == b'/' => {
                    let is_pragma = self.text.get(begin..self.pos).is_some_and(is_pragma);
                    self.pos += self.second() + 1;
                    if is_pragma {
                        trivia.push(Trivia::Pragma(self.span_from(start)));
                    }
                    return lines;
                }
                Some(byte) => {
                    lines |= byte == b'\n' || byte == b'\r';
                    self.pos += 1;
                }
            }
        }
    }

    /// Reads everything that can belong to a number, by C++'s rule for preprocessing numbers. Whether it is one is
    /// checked later.
    fn number(&mut self) -> TokenKind {
        let hexadecimal = self.peek(0) == b'0' && matches!(self.peek(self.joined(1)), b'x' | b'X');
        // After a point or an exponent, another point with a word selects components: `1.0.xxx` (4.20 §5.5).
        let mut is_float = self.peek(0) == b'.';
        self.pos += 1;
        loop {
            let here = self.joined(0);
            let (byte, next) = (self.peek(here), self.joined(here + 1));
            let exponent = matches!(byte, b'e' | b'E') && !hexadecimal;
            if byte == b'.' && is_float && class(self.peek(next)) == WORD {
                return TokenKind::Number;
            }
            is_float |= byte == b'.' || exponent;
            if exponent && matches!(self.peek(next), b'+' | b'-') {
                self.pos += next + 1;
            } else if class(byte) != 0 || byte == b'.' {
                self.pos += here + 1;
            } else {
                return TokenKind::Number;
            }
        }
    }

    fn operator(&mut self, byte: u8, trivia: &mut Vec<Trivia>) -> TokenKind {
        use TokenKind::*;
        let one = self.joined(1);
        let two = self.joined(one + 1);
        let (next, third) = (self.peek(one), self.peek(two));
        let (kind, length) = match (byte, next) {
            (b'(', _) => (LeftParen, 1),
            (b')', _) => (RightParen, 1),
            (b'[', _) => (LeftBracket, 1),
            (b']', _) => (RightBracket, 1),
            (b'{', _) => (LeftBrace, 1),
            (b'}', _) => (RightBrace, 1),
            (b'.', _) => (Dot, 1),
            (b',', _) => (Comma, 1),
            (b':', _) => (Colon, 1),
            (b';', _) => (Semicolon, 1),
            (b'?', _) => (Question, 1),
            (b'~', _) => (Tilde, 1),
            (b'=', b'=') => (EqualEqual, 2),
            (b'=', _) => (Equal, 1),
            (b'*', b'=') => (MulAssign, 2),
            (b'*', _) => (Star, 1),
            (b'/', b'=') => (DivAssign, 2),
            (b'/', _) => (Slash, 1),
            (b'%', b'=') => (ModAssign, 2),
            (b'%', _) => (Percent, 1),
            (b'+', b'+') => (Increment, 2),
            (b'+', b'=') => (AddAssign, 2),
            (b'+', _) => (Plus, 1),
            (b'-', b'-') => (Decrement, 2),
            (b'-', b'=') => (SubAssign, 2),
            (b'-', _) => (Dash, 1),
            (b'<', b'<') if third == b'=' => (LeftAssign, 3),
            (b'<', b'<') => (LeftOp, 2),
            (b'<', b'=') => (LessEqual, 2),
            (b'<', _) => (LeftAngle, 1),
            (b'>', b'>') if third == b'=' => (RightAssign, 3),
            (b'>', b'>') => (RightOp, 2),
            (b'>', b'=') => (GreaterEqual, 2),
            (b'>', _) => (RightAngle, 1),
            (b'!', b'=') => (NotEqual, 2),
            (b'!', _) => (Bang, 1),
            (b'&', b'&') => (AndAnd, 2),
            (b'&', b'=') => (AndAssign, 2),
            (b'&', _) => (Ampersand, 1),
            (b'|', b'|') => (OrOr, 2),
            (b'|', b'=') => (OrAssign, 2),
            (b'|', _) => (VerticalBar, 1),
            (b'^', b'^') => (XorXor, 2),
            (b'^', b'=') => (XorAssign, 2),
            (b'^', _) => (Caret, 1),
            (b'#', b'#') => (HashHash, 2),
            (b'#', _) => (Hash, 1),
            _ => (Unknown, self.text.get(self.pos..).and_then(|rest| rest.chars().next()).map_or(1, char::len_utf8)),
        };
        let start = self.pos;
        match length {
            2 if one > 1 => self.pos += one + 1,
            3 if two > 2 => self.pos += two + 1,
            _ => self.pos += length,
        }
        if self.pos - start > length {
            self.tell_continuations(start, trivia);
        }
        kind
    }

    /// Skips to the next `#` that begins a line, outside comments. Returns false at the end of the text.
    pub(super) fn skip_to_directive(&mut self, trivia: &mut Vec<Trivia>) -> bool {
        let mut flags = TokenFlags::empty();
        loop {
            self.skip_space(Mode::Text, &mut flags, trivia);
            match self.at(0) {
                None => return false,
                Some(b'#') if self.at_line_start => return true,
                Some(_) => {
                    self.at_line_start = false;
                    self.skip_plain_text();
                }
            }
        }
    }

    /// Skips bytes up to where white space or a comment may matter.
    fn skip_plain_text(&mut self) {
        self.pos += 1;
        while !matches!(self.peek(0), 0 | b'\n' | b'\r' | b'/' | b'\\') {
            self.pos += 1;
        }
    }

    /// Skips the rest of a directive's line, including a comment that continues past it.
    pub(super) fn skip_line(&mut self, names: &mut Names, trivia: &mut Vec<Trivia>) {
        while !matches!(self.next(Mode::Directive, names, trivia).kind, TokenKind::Newline | TokenKind::Eof) {}
    }

    /// Reads the quoted name in `#include "name"` or `#include <name>`.
    pub(super) fn header_name(&mut self) -> Option<Span> {
        while matches!(self.peek(0), b' ' | b'\t') {
            self.pos += 1;
        }
        let close = match self.peek(0) {
            b'"' => b'"',
            b'<' => b'>',
            _ => return None,
        };
        let start = self.pos;
        let rest = self.text.as_bytes().get(start + 1..).unwrap_or(&[]);
        let end = rest.iter().position(|&byte| byte == close || byte == b'\n' || byte == b'\r')?;
        if rest.get(end) != Some(&close) {
            return None;
        }
        self.pos = start + end + 2;
        Some(self.span_from(start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lex(text: &str) -> (Vec<String>, Vec<Trivia>) {
        let (mut names, mut trivia) = (Names::default(), Vec::new());
        let mut lexer = Lexer::new(text.into(), 1);
        let mut tokens = Vec::new();
        loop {
            let token = lexer.next(Mode::Text, &mut names, &mut trivia);
            match token.kind {
                TokenKind::Eof => return (tokens, trivia),
                TokenKind::Word | TokenKind::Number => tokens.push(names.spelling(token.symbol()).to_owned()),
                _ => tokens.push(text[token.span.start as usize - 1..token.span.end as usize - 1].to_owned()),
            }
        }
    }

    #[test]
    fn longest_match() {
        let (tokens, trivia) = lex("a<<=b>>c^^d++-1.5e-3f 0x1E+2 .5.0x/**/1e1.x\0#");
        let expected = ["a", "<<=", "b", ">>", "c", "^^", "d", "++", "-", "1.5e-3f", "0x1E", "+", "2", ".5.0x", "1e1"];
        assert_eq!(tokens[..15], expected);
        assert_eq!(tokens[15..], [".", "x", "\0", "#"]);
        assert!(trivia.is_empty());
    }

    #[test]
    fn continued_lines_join_words() {
        let (tokens, trivia) = lex("ab\\\ncd \\\r\n e // x \\\nf");
        assert_eq!(tokens, ["abcd", "e", "f"]);
        assert_eq!(trivia.len(), 3);
    }

    #[test]
    fn continued_lines_join_every_token() {
        let (tokens, trivia) = lex("1\\\n.5e\\\n-3\\\nf .\\\n5 0\\\nx1f <\\\n<\\\r\n= -\\\n- +\\\n \\\n+ a\\\n\\\nb");
        assert_eq!(tokens[..3], ["1.5e-3f", ".5", "0x1f"]);
        assert_eq!(tokens[3..], ["<\\\n<\\\r\n=", "-\\\n-", "+", "+", "ab"]);
        assert_eq!(trivia.len(), 12);
    }

    #[test]
    fn continued_lines_join_the_signs_of_comments() {
        let cut = |joins: bool| {
            let (mut names, mut trivia) = (Names::default(), Vec::new());
            let mut lexer = Lexer::new("/\\\n/ a\n/\\\n* b *\\\n/ c /* d *\\\n/ e".into(), 1);
            lexer.joins_comments = joins;
            let mut words = Vec::new();
            loop {
                let token = lexer.next(Mode::Text, &mut names, &mut trivia);
                match token.kind {
                    TokenKind::Eof => return words,
                    TokenKind::Word => words.push(names.spelling(token.symbol()).to_owned()),
                    _ => {}
                }
            }
        };
        assert_eq!(cut(true), ["c", "e"]);
        assert_eq!(cut(false), ["a", "b", "c"]);
    }

    #[test]
    fn comments() {
        let (tokens, trivia) = lex("a // b\n/* c \n*/ d /* e");
        assert_eq!(tokens, ["a", "d"]);
        assert!(matches!(trivia[..], [Trivia::Unterminated(span)] if span == Span::new(19, 21)));
    }

    #[test]
    fn a_comment_in_a_directive_is_a_space() {
        let (mut names, mut trivia) = (Names::default(), Vec::new());
        let mut lexer = Lexer::new("a /* b\n */ c /*\n*/\nd".into(), 1);
        let mut kind = || lexer.next(Mode::Directive, &mut names, &mut trivia).kind;
        assert_eq!([kind(), kind(), kind()], [TokenKind::Word, TokenKind::Word, TokenKind::Newline]);
        assert!(matches!(trivia[..], [Trivia::Crossed(span)] if span == Span::new(3, 5)));
    }
}
