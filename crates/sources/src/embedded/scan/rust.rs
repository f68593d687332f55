//! The strings of Rust: raw ones, and others of several lines (The Rust Reference, "Tokens").
//!
//! *Holds:* in a string that `format!` or its like takes, `{{` is a brace and `{..}` an interpolation.

use super::{Cursor, Literal, escape};
use crate::embedded::Escape;
use std::ops::Range;

/// Macros whose first string is a format.
const FORMATS: &[&str] = &["format", "print", "println", "format_args", "panic"];

/// The strings of a text.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut cursor = Cursor::new(text);
    let mut found = Vec::new();
    while !cursor.is_end() {
        let word = cursor.word();
        let start = cursor.at;
        match cursor.byte(0) {
            b'/' if cursor.starts("/*") => pass_nested_comment(&mut cursor),
            b'/' if cursor.passes_comment() => {}
            b'"' => {
                let Some(literal) = plain(&mut cursor, start) else { return found };
                found.extend(literal);
            }
            b'\'' => pass_quote(&mut cursor),
            _ if ["r", "br", "cr"].contains(&word) => {
                cursor.at += word.len();
                let Some(literal) = raw(&mut cursor, start) else { continue };
                found.push(literal);
            }
            _ if !word.is_empty() => cursor.at += word.len(),
            _ => {
                cursor.note_bracket();
                cursor.step();
            }
        }
    }
    found.iter_mut().for_each(|literal| add_format(text, literal));
    found
}

fn pass_nested_comment(cursor: &mut Cursor<'_>) {
    let mut depth = 0usize;
    while !cursor.is_end() {
        if cursor.starts("/*") {
            depth += 1;
            cursor.at += 2;
        } else if cursor.starts("*/") {
            depth -= 1;
            cursor.at += 2;
            if depth == 0 {
                return;
            }
        } else {
            cursor.step();
        }
    }
}

/// Goes past a character, or the quote of a lifetime.
fn pass_quote(cursor: &mut Cursor<'_>) {
    cursor.at += 1;
    let is_escape = cursor.byte(0) == b'\\';
    let start = cursor.at;
    cursor.step();
    if is_escape {
        cursor.step();
        while !cursor.is_end() && !matches!(cursor.byte(0), b'\'' | b'\n') {
            cursor.step();
        }
        cursor.step();
    } else if cursor.byte(0) == b'\'' {
        cursor.at += 1;
    } else {
        cursor.at = start;
    }
}

/// The raw string whose signs are here, if there is one.
fn raw(cursor: &mut Cursor<'_>, start: usize) -> Option<Literal> {
    let signs = cursor.rest().bytes().take_while(|byte| *byte == b'#').count();
    if cursor.byte(signs) != b'"' {
        return None;
    }
    let owner = cursor.owner();
    cursor.at += signs + 1;
    let inside = cursor.at;
    cursor.to(&format!("\"{}", "#".repeat(signs)));
    let end = cursor.at;
    cursor.at = (end + signs + 1).min(cursor.bytes.len());
    Some(Literal { start, inside: inside..end, owner, ..Literal::default() })
}

/// A string that is not raw; the outer value is nothing if it is not closed, the inner one if it is on one line.
fn plain(cursor: &mut Cursor<'_>, start: usize) -> Option<Option<Literal>> {
    let mut literal = Literal { start, owner: cursor.owner(), ..Literal::default() };
    cursor.at += 1;
    let inside = cursor.at;
    let mut has_lines = false;
    while !cursor.is_end() {
        match cursor.byte(0) {
            b'"' => {
                literal.inside = inside..cursor.at;
                cursor.at += 1;
                return Some(has_lines.then_some(literal));
            }
            b'\\' if matches!(cursor.byte(1), b'\n' | b'\r') => {
                // The line end is left out, but one that is written stands before it almost always.
                literal.escapes.push(Escape { range: cursor.at..cursor.at + 1, means: Some(b' ') });
                has_lines = true;
                cursor.step();
            }
            b'\\' => {
                let escape = escape(cursor.text, cursor.at);
                cursor.at = escape.range.end;
                literal.escapes.push(escape);
            }
            byte => {
                has_lines |= byte == b'\n';
                cursor.step();
            }
        }
    }
    None
}

/// Notes the interpolations of a format.
fn add_format(text: &str, literal: &mut Literal) {
    let before = text.get(..literal.start).unwrap_or("").trim_end();
    let Some(before) = before.strip_suffix('(').and_then(|before| before.trim_end().strip_suffix('!')) else { return };
    if FORMATS.iter().any(|name| before.ends_with(name)) {
        add_fields(text, literal);
    }
}

/// Notes `{..}`, and `{{` and `}}`, which are braces.
pub(super) fn add_fields(text: &str, literal: &mut Literal) {
    let inside: Range<usize> = literal.inside.clone();
    let bytes = text.as_bytes();
    let mut at = inside.start;
    while at < inside.end {
        match (bytes.get(at), bytes.get(at + 1)) {
            (Some(b'{'), Some(b'{')) | (Some(b'}'), Some(b'}')) => {
                literal.escapes.push(Escape { range: at..at + 2, means: bytes.get(at).copied() });
                at += 2;
            }
            (Some(b'{'), _) => {
                let end =
                    super::find(bytes, at, b"}").filter(|end| *end < inside.end).map_or(inside.end, |end| end + 1);
                literal.holes.push(at..end);
                at = end;
            }
            _ => at += 1,
        }
    }
    literal.sort();
}
