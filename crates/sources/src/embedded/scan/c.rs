//! The strings of C and C++: raw ones (C++11 §2.14.5), which compilers of C take, too, and others, of which those that follow each
//! other are one.

use super::{Cursor, Escape, Literal, escape, is_word, joined_lines};

/// The prefixes of raw strings.
const PREFIXES: &[&str] = &["R", "LR", "uR", "UR", "u8R"];
/// The longest delimiter.
const MAX_DELIMITER: usize = 16;
/// Shorter strings are no shaders.
const MIN_LENGTH: usize = 24;
/// Letters after a `%` in texts that `printf` and its like complete.
const CONVERSIONS: &[char] = &['s', 'd', 'i', 'u', 'f', 'g', 'x', 'l', 'z'];

/// The strings of a text.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut cursor = Cursor::new(text);
    let mut found = Vec::new();
    while !cursor.is_end() {
        let start = cursor.at;
        let word = cursor.word();
        match cursor.byte(0) {
            b'/' if cursor.passes_comment() => {}
            b'"' => found.extend(joined(&mut cursor)),
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

/// Operators by which a program puts strings together.
const JOINING: &[&str] = &["+", "<<"];

/// Whether what is before a place is added to the string there. An assignment such as `+=` may begin a whole one.
fn follows_operator(text: &str, start: usize) -> bool {
    let before = text.get(..start).unwrap_or("").trim_end();
    before.ends_with('+')
}

/// Whether something is added to the string that ends here.
fn precedes_operator(cursor: &Cursor<'_>) -> bool {
    let rest = cursor.rest().trim_start();
    JOINING.iter().any(|operator| rest.starts_with(operator))
}

/// Directives that choose between strings.
const CONDITIONS: &[&str] = &["if", "ifdef", "ifndef", "elif", "else", "endif"];

/// The strings that follow each other from here on, as one: `"a\n" "b"`. A macro between or before them is a text that is not
/// known here, and so is what `printf` would complete, or what a condition of the preprocessor chooses: there is no shader then.
fn joined(cursor: &mut Cursor<'_>) -> Option<Literal> {
    let start = cursor.at;
    let mut literal = Literal { start, owner: cursor.owner(), is_joined: true, ..Literal::default() };
    let is_in_directive = is_in_directive(cursor);
    let mut is_known = !follows_macro(cursor) && !follows_operator(cursor.text, start);
    loop {
        let quote = cursor.at;
        cursor.pass_line_string();
        let end = cursor.at.saturating_sub(1);
        let is_closed = end > quote && cursor.bytes.get(end) == Some(&b'"');
        is_known &= is_closed;
        escapes(cursor.text, quote + 1..end, &mut literal.escapes);
        literal.inside = start + 1..end.max(start + 1);
        if !is_closed {
            break;
        }
        pass_blanks(cursor);
        while !is_in_directive && passes_condition(cursor) {
            is_known = false;
            pass_blanks(cursor);
        }
        if cursor.byte(0) != b'"' {
            // In a directive, `#` makes a string of a macro's argument. On the next line it begins another directive.
            let between = cursor.text.get(end + 1..cursor.at).unwrap_or("");
            let is_one_line = between.matches('\n').count() == between.matches('\\').count();
            let is_followed = cursor.byte(0).is_ascii_alphabetic()
                || cursor.byte(0) == b'_'
                || is_in_directive && is_one_line && cursor.byte(0) == b'#'
                || precedes_operator(cursor);
            is_known &= !is_followed;
            break;
        }
        literal.escapes.push(Escape { range: end..cursor.at + 1, means: Some(b' ') });
    }
    let inside = cursor.text.get(literal.inside.clone())?;
    let is_completed = inside.split('%').skip(1).any(|after| after.starts_with(CONVERSIONS));
    (is_known && !is_completed && inside.len() >= MIN_LENGTH).then_some(literal)
}

/// Whether a name in capitals is before this place: a macro, such as a header of all shaders.
fn follows_macro(cursor: &Cursor<'_>) -> bool {
    let before = cursor.text.get(..cursor.at).unwrap_or("").trim_end();
    let name = before.get(before.trim_end_matches(is_word).len()..).unwrap_or("");
    // `#define NAME "..."` is its definition.
    let line = before.get(before.rfind('\n').map_or(0, |end| end + 1)..).unwrap_or("").trim_start();
    let is_macro = name.len() > 1
        && name.chars().all(|letter| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_');
    is_macro && !line.starts_with('#')
}

/// Whether this place is in the line of a directive, or in one that it is joined with.
fn is_in_directive(cursor: &Cursor<'_>) -> bool {
    let mut lines = cursor.text.get(..cursor.at).unwrap_or("").rsplit('\n');
    let own = lines.next().unwrap_or("");
    let above = lines.take_while(|line| line.trim_end_matches('\r').ends_with('\\')).last();
    above.unwrap_or(own).trim_start().starts_with('#')
}

/// Goes past the line of a condition of the preprocessor, if one is here.
fn passes_condition(cursor: &mut Cursor<'_>) -> bool {
    let rest = cursor.rest();
    let is_one = rest.strip_prefix('#').is_some_and(|rest| {
        let rest = rest.trim_start_matches([' ', '\t']);
        CONDITIONS.contains(&rest.split(|letter: char| !letter.is_ascii_alphabetic()).next().unwrap_or(""))
    });
    if is_one {
        cursor.to("\n");
    }
    is_one
}

/// Goes past white space, comments and joined lines.
fn pass_blanks(cursor: &mut Cursor<'_>) {
    loop {
        match cursor.byte(0) {
            b' ' | b'\t' | b'\r' | b'\n' => cursor.at += 1,
            b'\\' if matches!(cursor.byte(1), b'\r' | b'\n') => cursor.at += 1,
            b'/' if cursor.passes_comment() => {}
            _ => return,
        }
    }
}

/// The escapes in a range of a text.
fn escapes(text: &str, range: std::ops::Range<usize>, list: &mut Vec<Escape>) {
    let mut at = range.start;
    while let Some(place) = text.get(at..range.end).and_then(|rest| rest.find('\\')) {
        let from = at + place;
        let found = joined_lines(text, from).unwrap_or_else(|| escape(text, from));
        at = found.range.end;
        list.push(found);
    }
}
