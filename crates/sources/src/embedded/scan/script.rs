//! The template strings of JavaScript and TypeScript (ECMA-262 §12.9.6).
//!
//! *Holds:* an interpolation is passed over whole, with the strings, templates and brackets in it. Whether a slash begins a regular
//! expression is told by what is before it.

use super::{Cursor, Literal, escape, is_word, joined_lines};

/// Words after which a slash begins a regular expression.
const BEFORE_EXPRESSIONS: &[&str] =
    &["return", "typeof", "case", "in", "of", "delete", "void", "instanceof", "new", "throw", "else", "do", "yield"];

/// A bracket or a template inside of an interpolation.
enum Inner {
    Brace,
    Template,
}

/// The template strings of a text.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut cursor = Cursor::new(text);
    let mut found = Vec::new();
    // The last thing that is no blank and no comment: its place.
    let mut last = 0..0;
    while !cursor.is_end() {
        let at = cursor.at;
        match cursor.byte(0) {
            _ if cursor.passes_comment() => continue,
            b'"' | b'\'' => cursor.pass_line_string(),
            b'`' => {
                let tag = text.get(last.clone()).filter(|tag| last.end == at && tag.starts_with(is_word)).unwrap_or("");
                let start = if tag.is_empty() { at } else { last.start };
                let is_raw = tag == "raw";
                let Some(literal) = template(&mut cursor, is_raw) else { return found };
                let is_tagged = !tag.is_empty() && !is_raw;
                found.push(Literal { start, tag: tag.to_owned(), is_tagged, ..literal });
            }
            b'/' if begins_pattern(text.get(last.clone()).unwrap_or("")) => pass_pattern(&mut cursor),
            byte if byte.is_ascii_whitespace() => {
                cursor.step();
                continue;
            }
            _ => {
                let word = cursor.word().len();
                cursor.note_bracket();
                if word > 0 { cursor.at += word } else { cursor.step() }
            }
        }
        last = at..cursor.at;
    }
    found
}

fn begins_pattern(before: &str) -> bool {
    let sign = before.chars().next_back();
    BEFORE_EXPRESSIONS.contains(&before) || sign.is_none_or(|sign| "(,=:[!&|?{};+-*%~^>".contains(sign))
}

/// Goes past a regular expression; a slash without another one on its line is an operator.
fn pass_pattern(cursor: &mut Cursor<'_>) {
    let start = cursor.at;
    let mut in_class = false;
    cursor.at += 1;
    while !cursor.is_end() && cursor.byte(0) != b'\n' {
        match cursor.byte(0) {
            b'\\' => cursor.step(),
            b'[' => in_class = true,
            b']' => in_class = false,
            b'/' if !in_class => {
                cursor.at += 1;
                return;
            }
            _ => {}
        }
        cursor.step();
    }
    cursor.at = start + 1;
}

/// The template that begins here. Nothing if it is not closed.
fn template(cursor: &mut Cursor<'_>, is_raw: bool) -> Option<Literal> {
    let mut literal = Literal { owner: cursor.owner(), ..Literal::default() };
    cursor.at += 1;
    let start = cursor.at;
    while !cursor.is_end() {
        match cursor.byte(0) {
            b'`' => {
                literal.inside = start..cursor.at;
                cursor.at += 1;
                return Some(literal);
            }
            b'\\' if is_raw => {
                cursor.at += 1;
                cursor.step();
            }
            b'\\' => {
                let escape = joined_lines(cursor.text, cursor.at).unwrap_or_else(|| escape(cursor.text, cursor.at));
                cursor.at = escape.range.end;
                literal.escapes.push(escape);
            }
            b'$' if cursor.byte(1) == b'{' => {
                let hole = cursor.at;
                pass_hole(cursor);
                literal.holes.push(hole..cursor.at);
            }
            _ => cursor.step(),
        }
    }
    None
}

/// Goes past an interpolation.
fn pass_hole(cursor: &mut Cursor<'_>) {
    let mut open = vec![Inner::Brace];
    cursor.at += 2;
    while let Some(inner) = open.last() {
        if cursor.is_end() {
            return;
        }
        match (inner, cursor.byte(0)) {
            (Inner::Brace, b'/') if cursor.passes_comment() => continue,
            (Inner::Brace, b'"' | b'\'') => {
                cursor.pass_line_string();
                continue;
            }
            (Inner::Brace, b'`') => open.push(Inner::Template),
            (Inner::Brace, b'{') => open.push(Inner::Brace),
            (Inner::Brace, b'}') | (Inner::Template, b'`') => {
                open.pop();
            }
            (Inner::Template, b'\\') => cursor.step(),
            (Inner::Template, b'$') if cursor.byte(1) == b'{' => {
                cursor.at += 1;
                open.push(Inner::Brace);
            }
            _ => {}
        }
        cursor.step();
    }
}
