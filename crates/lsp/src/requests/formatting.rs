//! Formatting of documents and of ranges (LSP 3.17, `textDocument/formatting`, `textDocument/rangeFormatting`).
//!
//! *Holds:* the style is that of `glisten fmt` for the file, whatever the editor's options say. Edits are of whole lines that differ. A
//! range gets those edits that touch its lines; for it, lines that differ are taken apart where both texts have the same signs so far.

use crate::state::State;
use crate::text::{Encoding, Text};
use crate::uri;
use lsp_types::{DocumentRangeFormattingParams, TextEdit, Uri};
use similar::{DiffOp, TextDiff};
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
    let diff = TextDiff::from_lines(&*old.text, new);
    // The lines of the comparison end with `\n` alone.
    let line_ends: Vec<usize> = old.text.match_indices('\n').map(|(at, _)| at + 1).collect();
    let start_of = |line: usize| if line == 0 { 0 } else { line_ends.get(line - 1).copied().unwrap_or(old.text.len()) };
    let (old_lines, new_lines): (Vec<&str>, Vec<&str>) =
        (old.text.split_inclusive('\n').collect(), new.split_inclusive('\n').collect());
    let different = diff.ops().iter().filter(|op| !matches!(op, DiffOp::Equal { .. }));
    let blocks = different.flat_map(|op| {
        let block = (op.old_range(), op.new_range());
        if is_fine { apart(&old_lines, &new_lines, block) } else { vec![block] }
    });
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

/// A block in the smallest parts: each ends where both texts have the same characters so far, white space aside. Formatting changes no others.
fn apart(old: &[&str], new: &[&str], (lines, texts): Block) -> Vec<Block> {
    let (ours, theirs) = (ends(old, &lines), ends(new, &texts));
    let (mut parts, mut from) = (Vec::new(), (lines.start, texts.start));
    let mut other = theirs.iter().peekable();
    for (line, end) in &ours {
        while other.next_if(|(_, their)| their < end).is_some() {}
        if let Some((text, _)) = other.next_if(|(_, their)| their == end) {
            parts.push((from.0..*line, from.1..*text));
            from = (*line, *text);
        }
    }
    parts.push((from.0..lines.end, from.1..texts.end));
    let text = |all: &[&str], lines: &Range<usize>| all.get(lines.clone()).unwrap_or(&[]).concat();
    parts.retain(|(lines, texts)| text(old, lines) != text(new, texts));
    parts
}

/// The ends of some lines, each with the number of characters so far that are not white space.
fn ends(all: &[&str], lines: &Range<usize>) -> Vec<(usize, usize)> {
    let mut count = 0;
    let mut ends = Vec::new();
    for line in lines.clone() {
        count += all.get(line).map_or(0, |text| text.chars().filter(|letter| !letter.is_whitespace()).count());
        ends.push((line + 1, count));
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn lines_that_differ_are_taken_apart() {
        let old = ["a ;\n", "  b=c ;\n", "\n", "d(\n", "e ) ;\n", "f ;\n"];
        let new = ["a;\n", "b = c;\n", "d(e);\n", "f ;\n"];
        let parts = apart(&old, &new, (0..6, 0..4));
        assert_eq!(parts, [(0..1, 0..1), (1..2, 1..2), (2..5, 2..3)]);
        assert_eq!(apart(&old, &["a;b\n"], (0..2, 0..1)), [(0..2, 0..1)]);
    }
}
