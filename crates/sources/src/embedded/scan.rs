//! The strings of a host language that may contain a shader.
//!
//! *In:* a text. *Out:* [`Literal`]s with their escapes and interpolations, in order. *Holds:* comments and other strings are passed
//! over; a string that is not closed ends the search, as it ends what a compiler of the host understands. No recursion.

mod c;
mod python;
mod rust;
mod script;

use super::{Escape, Host};
use std::ops::Range;

/// A string.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Literal {
    /// Where it begins: its prefix or tag, or its quote.
    pub(super) start: usize,
    /// The range between the quotes.
    pub(super) inside: Range<usize>,
    /// The word that belongs to it: the tag of a template, the delimiter of a raw string.
    pub(super) tag: String,
    /// Whether the tag is a function that makes something of the string.
    pub(super) is_tagged: bool,
    /// The offset of the bracket of the host that it is in, plus 1; 0 for none.
    pub(super) owner: usize,
    /// Whether it is made of strings that follow each other, so that its text is known only with its escapes.
    pub(super) is_joined: bool,
    pub(super) escapes: Vec<Escape>,
    pub(super) holes: Vec<Range<usize>>,
}

impl Literal {
    /// Puts escapes and interpolations in order; of those that overlap, the first one counts.
    fn sort(&mut self) {
        self.escapes.sort_by_key(|escape| escape.range.start);
        self.holes.sort_by_key(|hole| hole.start);
        self.holes.dedup_by(|next, hole| next.start < hole.end);
    }
}

/// The strings of a text.
pub(super) fn literals(host: Host, text: &str) -> Vec<Literal> {
    match host {
        Host::Script => script::literals(text),
        Host::Rust => rust::literals(text),
        Host::Python => python::literals(text),
        Host::C => c::literals(text),
    }
}

/// A place in a text.
struct Cursor<'t> {
    text: &'t str,
    bytes: &'t [u8],
    at: usize,
    /// The open brackets, by their offsets.
    open: Vec<usize>,
}

impl<'t> Cursor<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, bytes: text.as_bytes(), at: 0, open: Vec::new() }
    }

    fn byte(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    fn is_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn starts(&self, word: &str) -> bool {
        self.bytes.get(self.at..).is_some_and(|rest| rest.starts_with(word.as_bytes()))
    }

    /// Goes on by one character.
    fn step(&mut self) {
        self.at += 1;
        while self.at < self.bytes.len() && !self.text.is_char_boundary(self.at) {
            self.at += 1;
        }
    }

    /// Goes on to the next place of a word, or to the end.
    fn to(&mut self, word: &str) {
        self.at = find(self.bytes, self.at, word.as_bytes()).unwrap_or(self.bytes.len());
    }

    /// Goes past `//` or `/*`, if one of them is here.
    fn passes_comment(&mut self) -> bool {
        if self.starts("//") {
            self.to("\n");
        } else if self.starts("/*") {
            self.at += 2;
            self.to("*/");
            self.at = (self.at + 2).min(self.bytes.len());
        } else {
            return false;
        }
        true
    }

    /// Goes past a string on one line, from its quote; one that is not closed ends with its line.
    fn pass_line_string(&mut self) {
        let quote = self.byte(0);
        self.at += 1;
        while !self.is_end() && !matches!(self.byte(0), b'\n') {
            let byte = self.byte(0);
            if byte == b'\\' {
                self.step();
                if self.byte(0) == b'\r' && self.byte(1) == b'\n' {
                    self.step();
                }
                self.step();
                continue;
            }
            self.step();
            if byte == quote {
                return;
            }
        }
    }

    /// Notes a bracket, if one is here.
    fn note_bracket(&mut self) {
        match self.byte(0) {
            b'(' | b'[' | b'{' => self.open.push(self.at),
            b')' | b']' | b'}' => {
                self.open.pop();
            }
            _ => {}
        }
    }

    fn owner(&self) -> usize {
        self.open.last().map_or(0, |at| at + 1)
    }

    /// The word that is here.
    fn word(&self) -> &'t str {
        let rest = self.rest();
        rest.get(..rest.find(|letter: char| !is_word(letter)).unwrap_or(rest.len())).unwrap_or("")
    }

    /// Whether a letter of a word is before this place.
    fn is_in_word(&self) -> bool {
        self.text.get(..self.at).is_some_and(|before| before.ends_with(is_word))
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '$'
}

fn find(bytes: &[u8], from: usize, word: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.windows(word.len()).position(|window| window == word).map(|at| from + at)
}

/// The escape at a backslash before the end of a line, if there is one here. The language of the host joins both lines and drops the two.
fn joined_lines(text: &str, at: usize) -> Option<Escape> {
    let rest = text.get(at + 1..)?;
    let end = ["\r\n", "\n", "\r"].into_iter().find(|end| rest.starts_with(end))?;
    Some(Escape { range: at..at + 1 + end.len(), means: Some(b' ') })
}

/// The escape at a backslash of a language that has those of C.
fn escape(text: &str, at: usize) -> Escape {
    let rest = text.get(at + 1..).unwrap_or("");
    let first = rest.chars().next().unwrap_or(' ');
    // The length of a number of at most so many digits, from an offset on, and the character that it is.
    let number = |from: usize, digits: usize, radix: u32| {
        let rest = rest.get(from..).unwrap_or("");
        let digits = rest.chars().take(digits).take_while(|digit| digit.is_digit(radix)).count();
        let value = rest.get(..digits).and_then(|text| u32::from_str_radix(text, radix).ok());
        let ascii = value.and_then(|value| u8::try_from(value).ok()).filter(u8::is_ascii);
        (from + digits, ascii.map(|sign| if sign == 0 { b' ' } else { sign }))
    };
    let (length, means) = match first {
        'n' => (1, Some(b'\n')),
        'r' => (1, Some(b'\r')),
        't' => (1, Some(b'\t')),
        'f' | 'v' | 'b' | 'a' => (1, Some(b' ')),
        '0'..='7' => number(0, 3, 8),
        'x' => number(1, 2, 16),
        'u' if rest.starts_with("u{") => {
            let end = rest.find('}').unwrap_or(1);
            let value = rest.get(2..end).and_then(|text| u32::from_str_radix(text, 16).ok());
            (end + 1, value.and_then(|value| u8::try_from(value).ok()).filter(u8::is_ascii))
        }
        'u' => number(1, 4, 16),
        'U' => number(1, 8, 16),
        other if other.is_ascii() => (1, Some(other as u8)),
        other => (other.len_utf8(), None),
    };
    Escape { range: at..(at + 1 + length).min(text.len()), means }
}
