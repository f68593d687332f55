//! The comments next to a declaration or a statement.
//!
//! *In:* the texts, and the span of what a comment belongs to. *Out:* the lines of the comment as they are written.
//! *Holds:* what a macro has put into the text has no comments.

use super::{SourceMap, Span};

/// A comment above something is at most this many lines long.
const MOST_LINES: usize = 40;

/// The text of the file that a span is in, and the span's place in it; nothing for what a macro brought.
fn place(sources: &SourceMap, span: Span) -> Option<(&str, usize, usize)> {
    if !span.is_known() || span.expansion.is_some() {
        return None;
    }
    let file = sources.file(sources.file_of(span)?);
    let (start, end) = (span.start.checked_sub(file.base())? as usize, span.end.checked_sub(file.base())? as usize);
    let text: &str = file.text();
    (text.is_char_boundary(start) && text.is_char_boundary(end)).then_some((text, start, end))
}

/// The lines of the comment directly above something.
pub fn above(sources: &SourceMap, span: Span) -> Vec<String> {
    let Some((text, start, _)) = place(sources, span) else { return Vec::new() };
    let before = text.get(..start).unwrap_or("");
    let mut lines = before.lines().rev();
    if !before.ends_with('\n') {
        // What is in front of it on its own line.
        lines.next();
    }
    let mut comment = Vec::new();
    let mut inside = false;
    for line in lines.take(MOST_LINES) {
        let line = line.trim();
        let starts = line.starts_with("/*");
        let whole = starts && line.ends_with("*/");
        let part = inside || line.starts_with("//") || whole || line.ends_with("*/") && !line.contains(';');
        if !part || line.ends_with('\\') {
            break;
        }
        inside = !whole && !starts && (inside || (line.ends_with("*/") && !line.starts_with("//")));
        comment.push(line.to_owned());
    }
    comment.reverse();
    // If the beginning of a block was not found, this is no comment.
    if inside { Vec::new() } else { comment }
}

/// The comment after something, on its last line.
pub fn behind(sources: &SourceMap, span: Span) -> Option<String> {
    let (text, _, end) = place(sources, span)?;
    let rest = text.get(end..)?.lines().next()?;
    let (code, comment) = rest.split_at(rest.find("//")?);
    let ends = code.trim_start_matches([';', ' ', '\t']).is_empty() || code.trim_end().ends_with(';');
    let one = code.matches(';').count() <= 1;
    let comment = comment.trim_end();
    (ends && one && !comment.ends_with('\\')).then(|| comment.to_owned())
}

/// The comment after something, on its last line, of either kind; of several, all.
pub fn after(sources: &SourceMap, span: Span) -> Option<String> {
    let (text, _, end) = place(sources, span)?;
    let rest = text.get(end..)?.lines().next()?;
    let (mut code, mut at) = (String::new(), 0);
    while let Some(sign) = rest.get(at..)?.chars().next() {
        let (comment, left) = if sign == '/' { taken(rest.get(at..)?) } else { ("", rest) };
        if comment.is_empty() {
            code.push(sign);
            at += sign.len_utf8();
            continue;
        }
        let has_ended = code.trim_end().ends_with(';') && code.matches(';').count() == 1;
        let is_last = left.trim_start().is_empty() || left.trim_start().starts_with('}');
        if has_ended || code.trim().is_empty() && is_last {
            // A block that goes on in the next line belongs to what is there.
            return (!left.trim_start().starts_with("/*") && !comment.ends_with('\\')).then(|| comment.to_owned());
        }
        at = rest.len() - left.len();
    }
    None
}

/// The length in bytes of the comment that a text begins with; 0 if it begins with none. The line break that ends a comment of one
/// line is no part of it. A comment without an end goes on to the end of the text.
pub fn comment_len(text: &str) -> usize {
    let bytes = text.as_bytes();
    match bytes {
        [b'/', b'/', ..] => bytes.iter().take_while(|byte| !matches!(**byte, b'\n' | b'\r')).count(),
        // `/*/` has no end yet.
        [b'/', b'*', inner @ ..] => inner.windows(2).position(|pair| pair == b"*/").map_or(bytes.len(), |end| end + 4),
        _ => 0,
    }
}

/// The comments at the beginning of a text, as far as they end in it, and what is after them.
fn taken(text: &str) -> (&str, &str) {
    let mut at = 0;
    while let Some(rest) = text.get(at..).map(str::trim_start) {
        let begins = text.len() - rest.len();
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(inner) = rest.strip_prefix("/*") {
            match inner.find("*/") {
                Some(end) => end + 4,
                None => break,
            }
        } else {
            break;
        };
        at = begins + length;
    }
    let (found, left) = text.split_at_checked(at).unwrap_or((text, ""));
    (found.trim(), left)
}

/// The comments around the body of a function that belong to none of its statements.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AroundBody {
    /// Between the `)` and the `{`.
    pub head: String,
    /// The lines directly above the `}`.
    pub last: Vec<String>,
    /// Behind the `}`, on its line.
    pub behind: String,
}

/// The comments around the body of the function of this name.
pub fn around_body(sources: &SourceMap, name: Span) -> Option<AroundBody> {
    let (text, _, end) = place(sources, name)?;
    let rest = text.get(end..)?;
    let (head, body) = taken(rest.get(closing(rest, ['(', ')'])? + 1..)?);
    let opening = text.len() - body.trim_start().len();
    let last = opening + closing(text.get(opening..)?, ['{', '}'])?;
    let base = name.end.checked_sub(end as u32)?;
    let brace = Span::new(base + last as u32, base + last as u32 + 1);
    let is_first = text.get(..last)?.rsplit('\n').next().is_none_or(|line| line.trim().is_empty());
    let (behind, _) = taken(text.get(last + 1..)?.lines().next().unwrap_or_default());
    let last = if is_first { above(sources, brace) } else { Vec::new() };
    Some(AroundBody { head: head.to_owned(), last, behind: behind.to_owned() })
}

/// The place of the bracket that closes the one at the beginning of a text, outside of comments.
fn closing(text: &str, [opening, closing]: [char; 2]) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = text.len() - text.trim_start().len();
    if !text.get(at..)?.starts_with(opening) {
        return None;
    }
    while let Some(sign) = text.get(at..)?.chars().next() {
        let (comment, left) = if sign == '/' { taken(text.get(at..)?) } else { ("", "") };
        if !comment.is_empty() {
            at = text.len() - left.len();
            continue;
        }
        depth = if sign == opening { depth + 1 } else { depth };
        if sign == closing {
            depth = depth.checked_sub(1)?;
            if depth == 0 {
                return Some(at);
            }
        }
        at += sign.len_utf8();
    }
    None
}

/// The comments at the end of a text, after everything else.
pub fn trailing(text: &str) -> Vec<String> {
    let mut comment = Vec::new();
    let mut inside = false;
    for line in text.trim_end().lines().rev() {
        let trimmed = line.trim();
        let begins = trimmed.starts_with("/*");
        let ends = trimmed.ends_with("*/") && !trimmed.starts_with("//");
        if !(inside
            || trimmed.starts_with("//")
            || begins && ends
            || ends && !trimmed.contains("/*")
            || trimmed.is_empty())
        {
            break;
        }
        inside = !begins && (inside || ends);
        comment.push(line.trim_end().to_owned());
    }
    comment.reverse();
    let first = comment.iter().position(|line| !line.is_empty()).unwrap_or(comment.len());
    if inside { Vec::new() } else { comment.split_off(first) }
}

/// The comments at the beginning of a text, before and after its `#version` line: titles, authors, licenses. If there are
/// several paragraphs, one directly above the first declaration belongs to that declaration.
pub fn leading(text: &str) -> Vec<String> {
    let mut comment: Vec<String> = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        let trimmed = line.trim();
        let is_comment = inside || trimmed.starts_with("//") || trimmed.starts_with("/*");
        if !is_comment && !trimmed.is_empty() && !trimmed.starts_with("#version") {
            let attached = comment.iter().rposition(String::is_empty);
            if let Some(blank) = attached.filter(|_| comment.last().is_some_and(|last| !last.is_empty())) {
                comment.truncate(blank);
            }
            break;
        }
        if !is_comment {
            // A blank line separates paragraphs; several count as one.
            if comment.last().is_some_and(|last| !last.is_empty()) {
                comment.push(String::new());
            }
            continue;
        }
        if let Some(end) = block_end(trimmed, &mut inside)
            && !trimmed.get(end..).unwrap_or("").trim().is_empty()
        {
            break;
        }
        comment.push(line.trim_end().to_owned());
    }
    // Without its end, this is no comment.
    if inside {
        return Vec::new();
    }
    while comment.last().is_some_and(String::is_empty) {
        comment.pop();
    }
    comment
}

/// The lines of the comment directly above something, unless they are among the [`leading`] ones of the file.
pub fn above_but_not_leading(sources: &SourceMap, span: Span) -> Vec<String> {
    let lines = above(sources, span);
    let Some((text, ..)) = place(sources, span).filter(|_| !lines.is_empty()) else { return lines };
    let leading: Vec<String> = leading(text).iter().map(|line| line.trim().to_owned()).collect();
    if leading.ends_with(&lines) { Vec::new() } else { lines }
}

/// Follows block comments through a line. Returns the offset of the end of a block that ends on it.
fn block_end(line: &str, inside: &mut bool) -> Option<usize> {
    let mut from = 0;
    if !*inside {
        if !line.starts_with("/*") {
            return None;
        }
        *inside = true;
        from = 2;
    }
    let end = line.get(from..)?.find("*/")? + from + 2;
    *inside = false;
    Some(end)
}

#[cfg(test)]
mod tests {
    use super::{AroundBody, after, around_body, leading, trailing};
    use crate::source::{SourceMap, Span};

    /// The span of a word in a text, which is the only one.
    fn placed(text: &str, word: &str) -> (SourceMap, Span) {
        let mut sources = SourceMap::default();
        let base = sources.add("a.frag", text).map_or(0, |id| sources.file(id).base());
        let at = base + text.find(word).expect("it is there") as u32;
        (sources, Span::new(at, at + word.len() as u32))
    }

    #[test]
    fn comments_of_both_kinds_are_after_something() {
        for (text, comment) in [
            ("x; /* stays */", Some("/* stays */")),
            ("x; /* stays */ }", Some("/* stays */")),
            ("x; /* one */ // two", Some("/* one */ // two")),
            ("x; // two", Some("// two")),
            ("x; /* goes on\n*/", None),
            ("x = 1.0; /* stays */", Some("/* stays */")),
            ("x /* inside */ = 1.0; // two", Some("// two")),
            ("x, /* of y */ y;", None),
            ("x; y; // of y", None),
        ] {
            let (sources, span) = placed(text, "x");
            assert_eq!(after(&sources, span).as_deref(), comment, "{text}");
        }
    }

    #[test]
    fn the_end_of_a_body_is_found_outside_of_comments() {
        let around = |text: &str| {
            let (sources, span) = placed(text, "f(");
            around_body(&sources, Span::new(span.start, span.start + 1))
        };
        let body = "{ // }\n    if (true) { }\n    return a; // }\n    // last\n} // f";
        let found = around(&format!("float f(float a /* ) */) /* sig */\n{body}\n")).expect("there is a body");
        assert_eq!((found.head.as_str(), found.behind.as_str()), ("/* sig */", "// f"));
        assert_eq!(found.last, ["// last"]);
        let one = around("// above\nfloat f() { return 1.0; }").expect("there is a body");
        assert_eq!(one, AroundBody::default());
        assert!(around("float f();").is_none());
    }

    #[test]
    fn comments_at_the_end_of_a_file_are_found() {
        assert_eq!(trailing("void main() {}\n// end\n\n"), ["// end"]);
        assert_eq!(trailing("void main() {} // main\n\n/* two\n   lines */\n"), ["/* two", "   lines */"]);
        assert!(trailing("void main() {} // main\n").is_empty() && trailing("x */\n").is_empty());
    }

    #[test]
    fn a_license_is_found_around_the_version() {
        let text = "// Copyright\n#version 150\n/* Two\n   lines */\n\n\n// A title\nin vec4 p; // no\n";
        assert_eq!(leading(text), ["// Copyright", "", "/* Two", "   lines */"]);
        assert_eq!(leading("#version 150\n// Licensed.\nin vec4 p;\n"), ["// Licensed."]);
        assert!(leading("#version 150\nin vec4 p;\n// later\n").is_empty());
        assert!(leading("/* without an end\n").is_empty());
        assert_eq!(leading("// one\n/* two */ in vec4 p;\n"), ["// one"]);
    }
}
