//! The strings of Python in three quotes (The Python Language Reference §2.4).
//!
//! *Holds:* in an f-string, and in one that `.format(` follows, `{{` is a brace and `{..}` an interpolation. In one that `%` completes,
//! `%%` is a percent sign and a conversion such as `%d` or `%(name)s` an interpolation (The Python Standard Library, "printf-style String
//! Formatting").

use super::rust::add_fields;
use super::{Cursor, Escape, Literal, escape, find, is_word, joined_lines};
use crate::engines::code::without_comments;

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
                add_conversions(text, &mut literal, after.starts_with('%'));
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

/// Notes the conversions of a string that `%` completes, right behind it or later. One that is completed later is known by conversions with
/// names, or by one in a place where GLSL has no `%`.
fn add_conversions(text: &str, literal: &mut Literal, is_completed: bool) {
    let inside = text.get(literal.inside.clone()).unwrap_or("");
    if !inside.contains('%') {
        return;
    }
    let is_completed = is_completed || is_foreign(&without_comments(inside));
    let mut at = 0;
    while let Some(sign) = inside.get(at..).and_then(|rest| rest.find('%')).map(|sign| at + sign) {
        let rest = inside.get(sign + 1..).unwrap_or("");
        let length = conversion(rest).filter(|_| is_completed || rest.starts_with('('));
        at = sign + 1 + length.unwrap_or(0);
        let range = literal.inside.start + sign..literal.inside.start + at;
        if length.is_some() {
            literal.holes.push(range);
        } else if is_completed && rest.starts_with('%') {
            at += 1;
            literal.escapes.push(Escape { range: range.start..range.end + 1, means: Some(b'%') });
        }
    }
    literal.sort();
}

/// Whether a conversion is where GLSL has no operator: after no operand, or in the line of a directive.
fn is_foreign(code: &str) -> bool {
    code.match_indices('%').any(|(at, _)| {
        let before = code.get(..at).unwrap_or("");
        let is_directive = before.rsplit('\n').next().unwrap_or("").trim_start().starts_with('#');
        let is_after_operand =
            before.trim_end().ends_with(|sign: char| is_word(sign) || matches!(sign, ')' | ']' | '.' | '%'));
        let rest = code.get(at + 1..).unwrap_or("");
        (is_directive || !is_after_operand) && !rest.starts_with(' ') && conversion(rest).is_some()
    })
}

/// The length of a conversion after its `%`.
fn conversion(rest: &str) -> Option<usize> {
    let mut after = rest;
    if let Some(name) = rest.strip_prefix('(') {
        after = name.get(name.find(')')? + 1..)?;
    }
    let after = after.trim_start_matches(|sign: char| "#0- +".contains(sign));
    let after = after.trim_start_matches(|sign: char| sign.is_ascii_digit() || matches!(sign, '*' | '.'));
    let after = after.trim_start_matches(['h', 'l', 'L']);
    after.starts_with(|kind: char| "diouxXeEfFgGcrsa".contains(kind)).then(|| rest.len() - after.len() + 1)
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
            b'\\' if is_raw => {
                cursor.at += 1;
                cursor.step();
            }
            b'\\' => {
                let escape = joined_lines(cursor.text, cursor.at).unwrap_or_else(|| escape(cursor.text, cursor.at));
                cursor.at = escape.range.end;
                literal.escapes.push(escape);
            }
            _ => cursor.step(),
        }
    }
    None
}
