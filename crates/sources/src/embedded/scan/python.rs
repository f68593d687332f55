//! The strings of Python in three quotes (The Python Language Reference §2.4).
//!
//! *Holds:* in an f-string, and in one that `.format(` follows, `{{` is a brace and `{..}` an interpolation.

use super::rust::add_fields;
use super::{Cursor, Literal, escape, find};

/// The strings of a text.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut cursor = Cursor::new(text);
    let mut found = Vec::new();
    while !cursor.is_end() {
        let start = cursor.at;
        let word = cursor.word();
        let is_prefix = word.len() <= 2 && word.bytes().all(|letter| b"rRbBuUfFtT".contains(&letter));
        let quote = cursor.bytes.get(start + word.len()).copied().unwrap_or(0);
        match cursor.byte(0) {
            b'#' => cursor.to("\n"),
            _ if is_prefix && matches!(quote, b'"' | b'\'') => {
                let prefix = word.to_ascii_lowercase();
                cursor.at += word.len();
                let three = if quote == b'"' { "\"\"\"" } else { "'''" };
                if !cursor.starts(three) {
                    cursor.pass_line_string();
                    continue;
                }
                // A string that nothing takes is documentation.
                let line = text.get(..start).map_or("", |before| before.rsplit('\n').next().unwrap_or(""));
                let is_taken = !line.trim().is_empty() || cursor.owner() > 0;
                let Some(mut literal) = long(&mut cursor, three, prefix.contains('r')) else { return found };
                literal.start = start;
                let after = cursor.rest().trim_start();
                add_templates(text, &mut literal);
                if prefix.contains(['f', 't']) || after.starts_with(".format(") {
                    add_fields(text, &mut literal);
                }
                if is_taken {
                    found.push(literal);
                }
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

/// Notes `$name` and `${name}`, which templates of Python have (`string.Template`) and GLSL has not.
fn add_templates(text: &str, literal: &mut Literal) {
    let mut at = literal.inside.start;
    while let Some(sign) = find(text.as_bytes(), at, b"$").filter(|sign| *sign < literal.inside.end) {
        let rest = text.get(sign + 1..literal.inside.end).unwrap_or("");
        let length = match rest.strip_prefix('{') {
            Some(inner) => inner.find('}').map_or(0, |end| end + 2),
            None => rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len()),
        };
        at = sign + 1 + length;
        if length > 0 {
            literal.holes.push(sign..at);
        }
    }
}

/// The string in three quotes that begins here. Nothing if it is not closed.
fn long(cursor: &mut Cursor<'_>, three: &str, is_raw: bool) -> Option<Literal> {
    let mut literal = Literal { owner: cursor.owner(), ..Literal::default() };
    cursor.at += three.len();
    let start = cursor.at;
    while !cursor.is_end() {
        if cursor.starts(three) {
            literal.inside = start..cursor.at;
            cursor.at += three.len();
            return Some(literal);
        }
        match cursor.byte(0) {
            b'\\' if is_raw || matches!(cursor.byte(1), b'\n' | b'\r') => {
                cursor.at += 1;
                cursor.step();
            }
            b'\\' => {
                let escape = escape(cursor.text, cursor.at);
                cursor.at = escape.range.end;
                literal.escapes.push(escape);
            }
            _ => cursor.step(),
        }
    }
    None
}
