//! The lexemes of a source: tokens, comments and directives, with the blanks between them counted.
//!
//! *In:* any text. *Out:* [`Lexeme`]s, whose texts and blanks add up to it. *Holds:* nothing is skipped; what GLSL has no token for
//! (GLSL 1.50 §3.1) is [`Kind::Other`].

use super::BYTE_ORDER_MARK;

/// The kind of a lexeme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An identifier, a keyword, or a number.
    Word,
    /// An operator or punctuation.
    Sign,
    /// `// ...`, without the end of its line.
    LineComment,
    /// `/* ... */`.
    BlockComment,
    /// A whole line that begins with `#`, and the lines that continue it (§3.3).
    Directive,
    /// No token of GLSL, or text that is kept.
    Other,
}

/// A piece of a source that is not blank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lexeme<'t> {
    /// Its kind.
    pub kind: Kind,
    /// Its text.
    pub text: &'t str,
    /// The offset of its first byte.
    pub start: usize,
    /// The number of line ends between the lexeme before and this one.
    pub(crate) lines: usize,
    /// Whether there is anything between the lexeme before and this one.
    pub(crate) spaced: bool,
}

impl Lexeme<'_> {
    pub(crate) fn is(&self, text: &str) -> bool {
        matches!(self.kind, Kind::Word | Kind::Sign) && self.text == text
    }

    pub(crate) fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::LineComment | Kind::BlockComment)
    }

    /// The offset after its last byte.
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }
}

/// The operators of more than one character, the longest first (§5.1).
const SIGNS: &[&str] = &[
    "<<=", ">>=", "++", "--", "<=", ">=", "==", "!=", "&&", "||", "^^", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
    "<<", ">>", "##", "::",
];

/// The lexemes of a text.
pub fn scan(text: &str) -> Vec<Lexeme<'_>> {
    let mut lexemes = Vec::new();
    let (mut at, mut lines, mut spaced, mut starts_line) = (0, 0, false, true);
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        // A byte order mark is one at the beginning alone.
        let rest = if at == 0 { rest.strip_prefix(BYTE_ORDER_MARK).unwrap_or(rest) } else { rest };
        at = text.len() - rest.len();
        let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n', '\x0b', '\x0c']).len();
        if blank > 0 {
            let ends = line_ends(rest.get(..blank).unwrap_or(""));
            lines += ends;
            starts_line |= ends > 0;
            spaced = true;
            at += blank;
            continue;
        }
        let (kind, length) = lexeme(rest, starts_line);
        let piece = rest.get(..length).unwrap_or(rest);
        lexemes.push(Lexeme { kind, text: piece, start: at, lines, spaced });
        at += piece.len();
        starts_line = kind == Kind::BlockComment && starts_line;
        (lines, spaced) = (0, false);
    }
    lexemes
}

/// The number of line ends in a text: `\n`, `\r`, or both together (§3.1).
fn line_ends(text: &str) -> usize {
    text.matches(['\n', '\r']).count() - text.matches("\r\n").count()
}

/// The length of the line end that a text begins with.
fn line_end_length(text: &str) -> usize {
    if text.starts_with("\r\n") { 2 } else { usize::from(text.starts_with(['\n', '\r'])) }
}

fn lexeme(rest: &str, starts_line: bool) -> (Kind, usize) {
    if rest.starts_with("//") {
        return (Kind::LineComment, line_length(rest));
    }
    if rest.starts_with("/*") {
        let length = rest.get(2..).and_then(|inner| inner.find("*/")).map(|end| end + 4);
        return length.map_or((Kind::Other, rest.len()), |length| (Kind::BlockComment, length));
    }
    if rest.starts_with('#') && starts_line {
        return (Kind::Directive, directive_length(rest));
    }
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first = rest.chars().next().unwrap_or(' ');
    let is_number = first.is_ascii_digit() || first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit());
    if is_number {
        return (Kind::Word, number_length(rest));
    }
    if is_word(first) {
        return (Kind::Word, rest.find(|c| !is_word(c)).unwrap_or(rest.len()));
    }
    if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        return (Kind::Sign, sign.len());
    }
    let kind = if "()[]{}.,;:+-*/%<>=!&|^~?".contains(first) { Kind::Sign } else { Kind::Other };
    (kind, first.len_utf8())
}

/// The length of a number, with its exponent and suffix (§4.1.3, §4.1.4).
fn number_length(rest: &str) -> usize {
    let is_hex = rest.starts_with("0x") || rest.starts_with("0X");
    let mut before = ' ';
    let end = rest.find(|c: char| {
        let is_sign = (c == '+' || c == '-') && !is_hex && matches!(before, 'e' | 'E');
        before = c;
        !(c.is_ascii_alphanumeric() || c == '_' || c == '.' || is_sign)
    });
    end.unwrap_or(rest.len())
}

/// The length of a line without its end. A backslash at its end continues a comment, too.
fn line_length(rest: &str) -> usize {
    let mut start = 0;
    loop {
        let line = rest.get(start..).unwrap_or("");
        let Some(end) = line.find(['\n', '\r']) else { return rest.len() };
        let (bare, after) = line.split_at(end);
        if !bare.ends_with('\\') {
            return start + end;
        }
        start += end + line_end_length(after);
    }
}

/// The length of a directive: to the end of the line, which a backslash or a comment may move.
fn directive_length(rest: &str) -> usize {
    let mut at = 0;
    while let Some(here) = rest.get(at..).filter(|here| !here.is_empty()) {
        if here.starts_with("//") {
            return at + line_length(here);
        }
        if here.starts_with("/*") {
            at += here.get(2..).and_then(|inner| inner.find("*/")).map_or(here.len(), |end| end + 4);
        } else if let Some(end) = here.strip_prefix('\\').map(line_end_length).filter(|end| *end > 0) {
            at += 1 + end;
        } else if here.starts_with(['\n', '\r']) {
            break;
        } else {
            at += here.chars().next().map_or(1, char::len_utf8);
        }
    }
    rest.get(..at).unwrap_or(rest).trim_end_matches([' ', '\t']).len()
}
