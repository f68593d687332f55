//! Cuts a text before a break, so that what stands before it can be read.
//!
//! *In:* a text and a place in it. *Out:* the text up to there, with all open brackets closed. *Holds:* GLSL looks back and never
//! ahead (GLSL 1.50 §4.2), so what follows has no effect on what a name before it denotes.

use glisten_front::source::blanked;
use glisten_front::source::comments::comment_len;

/// The open brackets of a text, outside of comments and directives, with their places.
pub(crate) fn open_brackets(text: &str) -> Vec<(usize, char)> {
    let bytes = text.as_bytes();
    let (mut open, mut at, mut starts_line) = (Vec::new(), 0, true);
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'/' if matches!(bytes.get(at + 1), Some(b'/' | b'*')) => {
                at += text.get(at..).map_or(1, comment_len);
                continue;
            }
            b'#' if starts_line => {
                at = end_of_directive(bytes, at);
                continue;
            }
            b'(' | b'[' | b'{' => open.push((at, byte as char)),
            b')' => close(&mut open, '('),
            b']' => close(&mut open, '['),
            b'}' => close(&mut open, '{'),
            _ => {}
        }
        starts_line = byte == b'\n' || starts_line && byte.is_ascii_whitespace();
        at += 1;
    }
    open
}

/// Closes the innermost bracket of a kind. A brace closes what is open inside of it.
fn close(open: &mut Vec<(usize, char)>, kind: char) {
    let inside = open.iter().rposition(|(_, other)| *other == kind);
    let barrier = open.iter().rposition(|(_, other)| *other == '{');
    match inside {
        Some(at) if kind == '{' || barrier.is_none_or(|barrier| barrier < at) => open.truncate(at),
        _ => {}
    }
}

/// The place after a directive, whose lines may be joined by backslashes.
fn end_of_directive(bytes: &[u8], start: usize) -> usize {
    let mut at = start;
    while let Some(&byte) = bytes.get(at) {
        at += 1;
        let before = bytes.get(at.wrapping_sub(2)).copied().filter(|&before| before != b'\r');
        let before = before.or_else(|| bytes.get(at.wrapping_sub(3)).copied());
        if byte == b'\n' && before != Some(b'\\') {
            return at;
        }
    }
    at
}

/// Whether a place is in a comment.
pub(crate) fn is_in_comment(text: &str, offset: usize) -> bool {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < offset {
        let rest = text.get(at..).unwrap_or("");
        let comment = comment_len(rest);
        if comment == 0 {
            at += 1;
            while !text.is_char_boundary(at) {
                at += 1;
            }
            continue;
        }
        let end = at + comment;
        let is_line = rest.starts_with("//");
        if offset < end || is_line && offset == end || end >= bytes.len() && !is_line && !rest.ends_with("*/") {
            return true;
        }
        at = end;
    }
    false
}

/// The text up to a place, `ending` after it, and what closes the open brackets.
pub(crate) fn cut(text: &str, offset: usize, ending: &str) -> String {
    let before = text.get(..offset).unwrap_or(text);
    let mut cut = format!("{before}{ending}");
    let mut ended = false;
    for (_, bracket) in open_brackets(before).into_iter().rev() {
        match bracket {
            '(' => cut.push(')'),
            '[' => cut.push(']'),
            _ => {
                if !ended {
                    cut.push(';');
                    ended = true;
                }
                cut.push('}');
            }
        }
    }
    if !ended {
        cut.push(';');
    }
    cut
}

/// The text with the break before a place taken out, in the ways that it may be: from the line of a bracket that is open at the
/// beginning of the place's line, or the line before it. Offsets stay.
pub(crate) fn mended(text: &str, offset: usize) -> Vec<String> {
    let start = text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
    let before = text.get(..start).unwrap_or("");
    let line_of = |at: usize| before.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
    let open = open_brackets(before);
    let inner = open.iter().rposition(|(_, sign)| *sign == '{').map_or(0, |at| at + 1);
    let bracket = open.get(inner).map(|(at, _)| line_of(*at));
    let last = line_of(before.trim_end().len());
    let mut starts: Vec<usize> = bracket.into_iter().chain([last]).filter(|from| *from < start).collect();
    starts.dedup();
    let blank = |from: usize| blanked(text, std::slice::from_ref(&(from..start))).to_string();
    starts.into_iter().map(blank).collect()
}

#[cfg(test)]
mod tests {
    use super::{cut, is_in_comment, mended, open_brackets};

    #[test]
    fn breaks_are_taken_out() {
        let text = "void f() {\n  a(\n  b\n  c\n";
        let offset = text.find('c').expect("it is there");
        assert_eq!(mended(text, offset), ["void f() {\n    \n   \n  c\n", "void f() {\n  a(\n   \n  c\n"]);
        assert!(mended("c", 0).is_empty());
    }

    #[test]
    fn brackets_are_closed_outside_of_comments_and_directives() {
        let text = "#define A ( \\\n  [\n// {\nvoid f() { if (a[1] /* ( */ && (b";
        assert_eq!(cut(text, text.len(), ".X"), format!("{text}.X));}}"));
        assert_eq!(cut("int a = f(1", 11, ""), "int a = f(1);");
        assert!(open_brackets("{ ( } )").is_empty(), "a brace closes what is open in it");
        assert_eq!(cut("void f() { x", 12, ""), "void f() { x;}");
    }

    #[test]
    fn comments_are_found() {
        let text = "a // é b\nc /* d */ e /* f";
        for (place, is_in) in [("a", false), ("b", true), ("c", false), ("d", true), ("e", false), ("f", true)] {
            let at = text.find(place).expect("it is there");
            assert_eq!(is_in_comment(text, at), is_in, "{place}");
        }
    }
}
