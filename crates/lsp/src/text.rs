//! Texts of an editor: documents, and positions in them.
//!
//! *In:* texts and changes of them as the protocol has them (Language Server Protocol 3.17, "Text Documents"). *Out:* byte offsets,
//! and positions in the encoding that was agreed on. *Holds:* a position outside of the text counts as the nearest one in it.

use lsp_types::{Position, PositionEncodingKind, Range, TextDocumentContentChangeEvent};
use std::sync::Arc;

/// The units of a position's characters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, unless another encoding was agreed on.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The encoding of a name in the protocol.
    pub(crate) fn named(name: &str) -> Option<Self> {
        [Self::Utf8, Self::Utf16, Self::Utf32].into_iter().find(|encoding| encoding.kind().as_str() == name)
    }

    /// The name in the protocol.
    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// The units that a text takes.
    pub(crate) fn units(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
            Self::Utf32 => text.chars().count(),
        }
    }

    /// The bytes that so many units of a text take.
    fn bytes(self, text: &str, units: usize) -> usize {
        let mut left = units;
        for (at, letter) in text.char_indices() {
            let width = match self {
                Self::Utf8 => letter.len_utf8(),
                Self::Utf16 => letter.len_utf16(),
                Self::Utf32 => 1,
            };
            if left < width {
                return at;
            }
            left -= width;
        }
        text.len()
    }
}

/// A text with the offsets of its lines.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    /// The text.
    pub(crate) text: Arc<str>,
    /// The text of the document, if that above is a part of it at its place.
    document: Option<Arc<str>>,
    starts: Vec<usize>,
    /// Whether every character is a byte, so that the units of all encodings are the same.
    is_ascii: bool,
}

impl Text {
    /// A text. Its lines end as the protocol says: `\n`, `\r\n` or `\r`.
    pub(crate) fn new(text: impl Into<Arc<str>>) -> Self {
        let text = text.into();
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for (at, &byte) in bytes.iter().enumerate() {
            if byte == b'\n' || byte == b'\r' && bytes.get(at + 1) != Some(&b'\n') {
                starts.push(at + 1);
            }
        }
        let is_ascii = text.is_ascii();
        Self { text, document: None, starts, is_ascii }
    }

    /// A part of this text, as long as it, with everything else blank. Positions are those of this text.
    pub(crate) fn with_part(self, part: Arc<str>) -> Self {
        if part.len() != self.text.len() {
            return self;
        }
        Self { document: Some(self.text), text: part, ..self }
    }

    /// The text that positions are in.
    fn document(&self) -> &str {
        self.document.as_ref().unwrap_or(&self.text)
    }

    /// The line of an offset, counted from 0.
    pub(crate) fn line_of(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// Where a line begins.
    pub(crate) fn start_of(&self, line: usize) -> usize {
        self.starts.get(line).copied().unwrap_or(self.text.len())
    }

    /// A line without its end.
    pub(crate) fn line(&self, line: usize) -> &str {
        let range = self.start_of(line)..self.start_of(line + 1);
        self.document().get(range).unwrap_or("").trim_end_matches(['\n', '\r'])
    }

    /// The first of the lines that `\` joins with this one.
    pub(crate) fn first_joined(&self, line: usize) -> usize {
        (0..line).rev().take_while(|above| self.line(*above).ends_with('\\')).last().unwrap_or(line)
    }

    /// The offset of a position.
    pub(crate) fn offset(&self, position: Position, encoding: Encoding) -> usize {
        let line = position.line as usize;
        if line >= self.starts.len() {
            return self.text.len();
        }
        let (text, units) = (self.line(line), position.character as usize);
        self.start_of(line) + if self.is_ascii { units.min(text.len()) } else { encoding.bytes(text, units) }
    }

    /// The position of an offset.
    pub(crate) fn position(&self, offset: usize, encoding: Encoding) -> Position {
        let mut offset = offset.min(self.text.len());
        while !self.document().is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line_of(offset);
        let before = self.document().get(self.start_of(line)..offset).unwrap_or("");
        let units = if self.is_ascii { before.len() } else { encoding.units(before) };
        Position { line: line as u32, character: units as u32 }
    }

    /// The range of two offsets.
    pub(crate) fn range(&self, range: std::ops::Range<usize>, encoding: Encoding) -> Range {
        Range { start: self.position(range.start, encoding), end: self.position(range.end, encoding) }
    }

    /// The text after changes, one after the other.
    pub(crate) fn changed(self, changes: Vec<TextDocumentContentChangeEvent>, encoding: Encoding) -> Self {
        changes.into_iter().fold(self, |text, change| text.changed_once(change, encoding))
    }

    fn changed_once(self, change: TextDocumentContentChangeEvent, encoding: Encoding) -> Self {
        let Some(range) = change.range else { return Self::new(change.text) };
        let start = self.offset(range.start, encoding);
        let end = self.offset(range.end, encoding).max(start);
        let (before, after) = (self.text.get(..start).unwrap_or(""), self.text.get(end..).unwrap_or(""));
        let mut text = String::with_capacity(before.len() + change.text.len() + after.len());
        text.push_str(before);
        text.push_str(&change.text);
        text.push_str(after);
        Self::new(text)
    }

    /// The word around an offset, or one that ends there.
    pub(crate) fn word_at(&self, offset: usize) -> Option<std::ops::Range<usize>> {
        let (before, after) = (self.text.get(..offset)?, self.text.get(offset..)?);
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let start = before.len() - before.chars().rev().take_while(|&letter| is_part(letter)).count();
        let end = offset + after.chars().take_while(|&letter| is_part(letter)).count();
        (start < end).then_some(start..end)
    }
}

#[cfg(test)]
mod tests {
    use super::{Encoding, Text};
    use lsp_types::{Position, Range, TextDocumentContentChangeEvent};

    #[test]
    fn positions_count_in_the_encoding() {
        let text = Text::new("a\r\né𝄞x\rlast");
        for (encoding, character) in [(Encoding::Utf8, 6), (Encoding::Utf16, 3), (Encoding::Utf32, 2)] {
            let position = Position { line: 1, character };
            assert_eq!(text.offset(position, encoding), 9);
            assert_eq!(text.position(9, encoding), position);
        }
        assert_eq!(text.offset(Position { line: 1, character: 99 }, Encoding::Utf16), 10, "the end of the line");
        assert_eq!(text.offset(Position { line: 9, character: 0 }, Encoding::Utf16), 15);
        assert_eq!(text.position(5, Encoding::Utf8), Position { line: 1, character: 2 }, "not inside of a character");
    }

    #[test]
    fn changes_are_applied_in_order() {
        let at = |line, start, end| {
            Some(Range { start: Position { line, character: start }, end: Position { line, character: end } })
        };
        let change =
            |range, text: &str| TextDocumentContentChangeEvent { range, range_length: None, text: text.into() };
        let changes = vec![change(at(0, 1, 1), "b\n"), change(at(1, 0, 1), ""), change(at(0, 9, 9), "!")];
        assert_eq!(&*Text::new("ac").changed(changes, Encoding::Utf16).text, "ab!\n");
    }
}
