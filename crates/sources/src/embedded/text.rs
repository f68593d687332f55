//! The text of a shader in a string: everything else of the file is blank, escapes are what they stand for, and interpolations are filled.
//!
//! *Holds:* the text has the length of the file; each byte of the shader is at its place.

use super::{Escape, Hole, Shader};
use glisten_front::source::blanked;
use std::ops::Range;
use std::sync::Arc;

/// The text that stands for interpolations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Filling {
    /// A name that nothing declares.
    #[default]
    Name,
    /// A whole number.
    Whole,
    /// A number with a point.
    Number,
    /// A type.
    Type,
}

impl Filling {
    /// The fillings after the first one.
    pub const OTHERS: [Self; 3] = [Self::Whole, Self::Number, Self::Type];
}

impl Shader {
    /// The text of the shader, as long as the text of its file.
    pub fn text(&self, file: &str, filling: Filling) -> Arc<str> {
        let outside = [0..self.inside.start, self.inside.end..file.len()];
        let mut bytes = blanked(file, &outside).as_bytes().to_vec();
        replace(&mut bytes, &self.escapes, 0);
        for hole in &self.holes {
            fill(&mut bytes, hole, self.inside.start, filling);
        }
        // Whole characters were replaced by those of ASCII.
        String::from_utf8_lossy(&bytes).into()
    }

    /// Whether a range is in what the text does not have as the file has it.
    pub(crate) fn is_changed(&self, range: &Range<usize>) -> bool {
        let meets = |other: &Range<usize>| range.start < other.end && other.start < range.end.max(range.start + 1);
        self.escapes.iter().any(|escape| meets(&escape.range)) || self.holes.iter().any(|hole| meets(&hole.range))
    }
}

/// The text of a string without interpolations, with what its escapes stand for; it begins at an offset of its file.
pub(super) fn decoded(inside: &str, start: usize, escapes: &[Escape]) -> String {
    let mut bytes = inside.as_bytes().to_vec();
    replace(&mut bytes, escapes, start);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Replaces escapes by what they stand for, in a text that begins at an offset of their file.
fn replace(bytes: &mut [u8], escapes: &[Escape], start: usize) {
    for Escape { range, means } in escapes {
        let range = range.start.saturating_sub(start)..range.end.saturating_sub(start);
        match means {
            // What is between two strings is one space, and no line ends there.
            Some(b' ') => bytes.get_mut(range).unwrap_or(&mut []).fill(b' '),
            means => {
                blank(bytes, &range);
                if let (Some(means), Some(last)) = (means, bytes.get_mut(range.end.saturating_sub(1))) {
                    *last = *means;
                }
            }
        }
    }
}

fn blank(bytes: &mut [u8], range: &Range<usize>) {
    for byte in bytes.get_mut(range.clone()).unwrap_or(&mut []) {
        if !matches!(byte, b'\n' | b'\r') {
            *byte = b' ';
        }
    }
}

/// Fills an interpolation in the text that begins at `start`.
fn fill(bytes: &mut [u8], hole: &Hole, start: usize, filling: Filling) {
    let Range { start: from, end } = hole.range;
    let is_word = |byte: Option<&u8>| byte.is_some_and(|byte| byte.is_ascii_alphanumeric() || *byte == b'_');
    let joins_before = from > start && is_word(bytes.get(from - 1));
    let next = bytes.get(end).copied();
    let joins_after = is_word(next.as_ref());
    let is_directive = {
        let before = bytes.get(start..from).unwrap_or(&[]);
        let line = before.rsplit(|byte| *byte == b'\n').next().unwrap_or(&[]);
        line.trim_ascii_start().starts_with(b"#")
    };
    // What is on the first line of it.
    let width =
        bytes.get(from..end).map_or(0, |hole| hole.iter().position(|byte| *byte == b'\n').unwrap_or(hole.len()));
    blank(bytes, &hole.range);
    if hole.is_alone {
        return;
    }
    // `${x}.0` is a number.
    let is_number = next == Some(b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
    let filling = if is_number && !joins_before { Filling::Whole } else { filling };
    let filling = if is_directive && filling == Filling::Name { Filling::Whole } else { filling };
    let word: Vec<u8> = match filling {
        Filling::Whole | Filling::Number if joins_after || next == Some(b'.') => vec![b'1'; width],
        Filling::Whole => vec![b'1'],
        Filling::Number if joins_before => vec![b'1'],
        Filling::Number => b"1.0".to_vec(),
        Filling::Type if !joins_before && !joins_after => {
            if width >= 5 {
                b"float".to_vec()
            } else {
                b"int".to_vec()
            }
        }
        Filling::Name | Filling::Type => [vec![b'h'], vec![b'o'; width.saturating_sub(1)]].concat(),
    };
    let end = from + width.min(word.len());
    if let Some(place) = bytes.get_mut(from..end) {
        place.copy_from_slice(word.get(..place.len()).unwrap_or(&[]));
    }
}
