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
    use super::leading;

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
