//! Formatting of documents and of ranges (LSP 3.17, `textDocument/formatting`, `textDocument/rangeFormatting`).
//!
//! *Holds:* the style is that of `glisten fmt` for the file, whatever the editor's options say. Edits are of whole lines that differ. A
//! range gets those edits that touch its lines; for it, lines that differ are taken apart where both texts have the same signs so far.

use crate::state::State;
use crate::text::{Encoding, Text};
use crate::uri;
use lsp_types::{DocumentRangeFormattingParams, TextEdit, Uri};
use std::ops::Range;

/// Formats a document.
pub(super) fn whole(state: &mut State<'_>, uri: &Uri) -> Option<Vec<TextEdit>> {
    Some(edits(state, uri, false)?.into_iter().map(|(_, edit)| edit).collect())
}

/// Formats the lines of a range.
pub(super) fn range(state: &mut State<'_>, params: &DocumentRangeFormattingParams) -> Option<Vec<TextEdit>> {
    let (first, mut last) = (params.range.start.line as usize, params.range.end.line as usize);
    // A range up to the beginning of a line has nothing of it.
    if params.range.end.character == 0 && last > first {
        last -= 1;
    }
    let edits = edits(state, &params.text_document.uri, true)?.into_iter();
    let touches = |lines: &Range<usize>| lines.start <= last && lines.end.max(lines.start + 1) > first;
    Some(edits.filter(|(lines, _)| touches(lines)).map(|(_, edit)| edit).collect())
}

/// The edits of lines, with the lines that they replace; as small as they can be if `is_fine`.
fn edits(state: &mut State<'_>, uri: &Uri, is_fine: bool) -> Option<Vec<(Range<usize>, TextEdit)>> {
    let path = uri::path(uri);
    let text = state.documents.get(&path)?.text.clone();
    let style = state.project.style(&path)?;
    let formatted = if state.pieces(&path).is_some() {
        state.project.format_pieces(&path, &text.text, &style)
    } else {
        state.project.format(&path, &text.text, &style).text
    };
    Some(line_edits(&text, &formatted, (state.encoding, is_fine)))
}

/// The edits that make one text of another, by lines.
fn line_edits(old: &Text, new: &str, (encoding, is_fine): (Encoding, bool)) -> Vec<(Range<usize>, TextEdit)> {
    // The lines of the comparison end with `\n` alone.
    let line_ends: Vec<usize> = old.text.match_indices('\n').map(|(at, _)| at + 1).collect();
    let start_of = |line: usize| if line == 0 { 0 } else { line_ends.get(line - 1).copied().unwrap_or(old.text.len()) };
    let (old_lines, new_lines): (Vec<&str>, Vec<&str>) =
        (old.text.split_inclusive('\n').collect(), new.split_inclusive('\n').collect());
    let mut blocks = apart(&old_lines, &new_lines);
    if !is_fine {
        blocks = joined(blocks);
    }
    let mut edits = Vec::new();
    for (lines, texts) in blocks {
        let (start, end) = (start_of(lines.start), start_of(lines.end));
        let range = old.range(start..end, encoding);
        let text: String = new_lines.get(texts).unwrap_or(&[]).concat();
        edits.push((old.line_of(start)..old.line_of(end), TextEdit { range, new_text: text }));
    }
    edits
}

/// Lines of the old text, and those of the new one in their place.
type Block = (Range<usize>, Range<usize>);

/// The differences, in the smallest parts: each ends where both texts have the same characters so far, white space aside. Formatting changes no
/// others. It takes time that grows with the texts, where looking for the fewest lines that differ would take their product.
fn apart(old: &[&str], new: &[&str]) -> Vec<Block> {
    let (ours, theirs) = (ends(old), ends(new));
    let (mut parts, mut from) = (Vec::new(), (0, 0));
    let mut other = theirs.iter().peekable();
    for (line, end) in &ours {
        while other.next_if(|(_, their)| their < end).is_some() {}
        if let Some((text, _)) = other.next_if(|(_, their)| their == end) {
            parts.push((from.0..*line, from.1..*text));
            from = (*line, *text);
        }
    }
    parts.push((from.0..old.len(), from.1..new.len()));
    let changed = parts.into_iter().map(|part| trimmed(old, new, part));
    changed.filter(|(lines, texts)| !lines.is_empty() || !texts.is_empty()).collect()
}

/// A block without the lines at its begin and at its end that are the same.
fn trimmed(old: &[&str], new: &[&str], (mut lines, mut texts): Block) -> Block {
    while !lines.is_empty() && !texts.is_empty() && old.get(lines.start) == new.get(texts.start) {
        (lines.start, texts.start) = (lines.start + 1, texts.start + 1);
    }
    while !lines.is_empty() && !texts.is_empty() && old.get(lines.end - 1) == new.get(texts.end - 1) {
        (lines.end, texts.end) = (lines.end - 1, texts.end - 1);
    }
    (lines, texts)
}

/// The blocks, those that follow each other as one.
fn joined(blocks: Vec<Block>) -> Vec<Block> {
    let mut all: Vec<Block> = Vec::new();
    for (lines, texts) in blocks {
        match all.last_mut().filter(|last| last.0.end == lines.start && last.1.end == texts.start) {
            Some(last) => (last.0.end, last.1.end) = (lines.end, texts.end),
            None => all.push((lines, texts)),
        }
    }
    all
}

/// The ends of the lines, each with the number of characters so far that are not white space.
fn ends(lines: &[&str]) -> Vec<(usize, usize)> {
    let mut count = 0;
    let end = |(line, text): (usize, &&str)| {
        count += text.chars().filter(|letter| !letter.is_whitespace()).count();
        (line + 1, count)
    };
    lines.iter().enumerate().map(end).collect()
}

#[cfg(test)]
mod tests {
    use super::{apart, joined};

    #[test]
    fn lines_that_differ_are_taken_apart() {
        let old = ["a ;\n", "  b=c ;\n", "\n", "d(\n", "e ) ;\n", "f ;\n"];
        let new = ["a;\n", "b = c;\n", "d(e);\n", "f ;\n"];
        let parts = apart(&old, &new);
        assert_eq!(parts, [(0..1, 0..1), (1..2, 1..2), (2..5, 2..3)]);
        assert_eq!(joined(parts), [(0..5, 0..3)]);
        assert_eq!(apart(&old[..2], &["a;b=c;\n"]), [(0..2, 0..1)]);
        assert_eq!(apart(&["a\n", "\n", "\n", "b\n"], &["a\n", "\n", "b\n"]), [(2..3, 2..2)]);
    }
}
