//! Formatting of documents and of ranges (LSP 3.17, `textDocument/formatting`, `textDocument/rangeFormatting`).
//!
//! *Holds:* the style is that of `glisten fmt` for the file, whatever the editor's options say. Edits are of whole lines that differ. A
//! range gets those edits that touch its lines.

use crate::state::State;
use crate::text::{Encoding, Text};
use crate::uri;
use lsp_types::{DocumentRangeFormattingParams, TextEdit, Uri};
use similar::{DiffOp, TextDiff};

/// Formats a document.
pub(super) fn whole(state: &mut State<'_>, uri: &Uri) -> Option<Vec<TextEdit>> {
    Some(edits(state, uri)?.into_iter().map(|(_, edit)| edit).collect())
}

/// Formats the lines of a range.
pub(super) fn range(state: &mut State<'_>, params: &DocumentRangeFormattingParams) -> Option<Vec<TextEdit>> {
    let (first, mut last) = (params.range.start.line as usize, params.range.end.line as usize);
    // A range up to the beginning of a line has nothing of it.
    if params.range.end.character == 0 && last > first {
        last -= 1;
    }
    let edits = edits(state, &params.text_document.uri)?.into_iter();
    let touches = |lines: &std::ops::Range<usize>| lines.start <= last && lines.end.max(lines.start + 1) > first;
    Some(edits.filter(|(lines, _)| touches(lines)).map(|(_, edit)| edit).collect())
}

/// The edits of lines, with the lines that they replace.
fn edits(state: &mut State<'_>, uri: &Uri) -> Option<Vec<(std::ops::Range<usize>, TextEdit)>> {
    let path = uri::path(uri);
    let text = state.documents.get(&path)?.text.clone();
    let style = state.project.style(&path)?;
    let formatted = if state.pieces(&path).is_some() {
        state.project.format_pieces(&path, &text.text, &style)
    } else {
        state.project.format(&path, &text.text, &style).text
    };
    Some(line_edits(&text, &formatted, state.encoding))
}

/// The edits that make one text of another, by lines.
fn line_edits(old: &Text, new: &str, encoding: Encoding) -> Vec<(std::ops::Range<usize>, TextEdit)> {
    let diff = TextDiff::from_lines(&*old.text, new);
    // The lines of the comparison end with `\n` alone.
    let line_ends: Vec<usize> = old.text.match_indices('\n').map(|(at, _)| at + 1).collect();
    let start_of = |line: usize| if line == 0 { 0 } else { line_ends.get(line - 1).copied().unwrap_or(old.text.len()) };
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    let mut edits = Vec::new();
    for op in diff.ops() {
        if matches!(op, DiffOp::Equal { .. }) {
            continue;
        }
        let (lines, texts) = (op.old_range(), op.new_range());
        let (start, end) = (start_of(lines.start), start_of(lines.end));
        let range = old.range(start..end, encoding);
        let text: String = new_lines.get(texts).unwrap_or(&[]).concat();
        edits.push((old.line_of(start)..old.line_of(end), TextEdit { range, new_text: text }));
    }
    edits
}
