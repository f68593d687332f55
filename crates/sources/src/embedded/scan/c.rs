//! The raw strings of C++ (C++11 §2.14.5), which compilers of C take, too.

use super::{Cursor, Literal};

/// The prefixes of raw strings.
const PREFIXES: &[&str] = &["R", "LR", "uR", "UR", "u8R"];
/// The longest delimiter.
const MAX_DELIMITER: usize = 16;

/// The raw strings of a text.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut cursor = Cursor::new(text);
    let mut found = Vec::new();
    while !cursor.is_end() {
        let start = cursor.at;
        let word = cursor.word();
        match cursor.byte(0) {
            b'/' if cursor.passes_comment() => {}
            b'"' => cursor.pass_line_string(),
            // In a number it groups digits.
            b'\'' if cursor.is_in_word() => cursor.at += 1,
            b'\'' => cursor.pass_line_string(),
            _ if PREFIXES.contains(&word) && cursor.byte(word.len()) == b'"' => {
                cursor.at += word.len() + 1;
                found.extend(raw(&mut cursor, start));
            }
            _ if !word.is_empty() => cursor.at += word.len(),
            _ => {
                cursor.note_bracket();
                cursor.step();
            }
        }
    }
    found
}

/// The raw string whose delimiter is here, if it is closed.
fn raw(cursor: &mut Cursor<'_>, start: usize) -> Option<Literal> {
    let rest = cursor.rest();
    let length = rest.bytes().take(MAX_DELIMITER + 1).position(|byte| byte == b'(')?;
    let tag = rest.get(..length).filter(|tag| !tag.contains([' ', '\\', ')', '\n', '"']))?;
    let inside = cursor.at + length + 1;
    let close = format!("){tag}\"");
    let Some(end) = super::find(cursor.bytes, inside, close.as_bytes()) else {
        cursor.at = cursor.bytes.len();
        return None;
    };
    cursor.at = end + close.len();
    Some(Literal { start, inside: inside..end, tag: tag.to_owned(), owner: cursor.owner(), ..Literal::default() })
}
