//! A residual stage as GLSL 1.50.
//!
//! *In:* a stage, the texts of the original. *Out:* text with the names of the original, with the comments that were above
//! or next to what is left, and for each line the place in the original that it comes from.

use glisten_front::hir::{Notes, Shader, Stage, Types, print_with};
use glisten_front::source::{SourceMap, Span};
use std::cell::RefCell;

/// A comment above something is at most so many lines long.
const MOST_LINES: usize = 40;
/// The beginning of a line that says where the next one comes from. No source has it: control characters are replaced.
const MARK: &str = "//\u{1}";

/// Writes a stage. Lines that come from nowhere, such as closing braces, have an unknown span.
pub(crate) fn write(types: &Types, shader: &Shader, sources: Option<&SourceMap>) -> (String, Vec<Span>) {
    let mut shader = shader.clone();
    shader.version.number = 150;
    let comments = Comments { sources, marks: RefCell::default() };
    let marked = print_with(types, &shader, Some(&comments));
    let marks = comments.marks.into_inner();
    let (mut text, mut lines) = (String::with_capacity(marked.len()), Vec::new());
    let mut next = Span::default();
    for line in marked.lines() {
        if let Some(number) = line.trim_start().strip_prefix(MARK) {
            next = number.parse().ok().and_then(|number: usize| marks.get(number).copied()).unwrap_or_default();
            continue;
        }
        text.push_str(line);
        text.push('\n');
        lines.push(std::mem::take(&mut next));
    }
    (text, lines)
}

/// The extension of a stage's files.
pub(crate) fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// The comments of the original, and marks for what is printed below them.
struct Comments<'a> {
    sources: Option<&'a SourceMap>,
    marks: RefCell<Vec<Span>>,
}

impl Comments<'_> {
    /// The text of the file that a span is in, and the span's place in it; nothing for what a macro brought.
    fn place(&self, span: Span) -> Option<(&str, usize, usize)> {
        let sources = self.sources.filter(|_| span.is_known() && !span.expansion.is_some())?;
        let file = sources.file(sources.file_of(span)?);
        let (start, end) = (span.start.checked_sub(file.base())? as usize, span.end.checked_sub(file.base())? as usize);
        let text: &str = file.text();
        (text.is_char_boundary(start) && text.is_char_boundary(end)).then_some((text, start, end))
    }
}

impl Notes for Comments<'_> {
    fn above(&self, span: Span) -> Vec<String> {
        let mut lines = self.comment(span);
        let mut marks = self.marks.borrow_mut();
        lines.push(format!("{MARK}{}", marks.len()));
        marks.push(span);
        lines
    }

    fn behind(&self, span: Span) -> Option<String> {
        let (text, _, end) = self.place(span)?;
        let rest = text.get(end..)?.lines().next()?;
        let (code, comment) = rest.split_at(rest.find("//")?);
        let ends = code.trim_start_matches([';', ' ', '\t']).is_empty() || code.trim_end().ends_with(';');
        let one = code.matches(';').count() <= 1;
        let comment = comment.trim_end();
        (ends && one && !comment.ends_with('\\')).then(|| comment.to_owned())
    }
}

impl Comments<'_> {
    /// The comment above something.
    fn comment(&self, span: Span) -> Vec<String> {
        let Some((text, start, _)) = self.place(span) else { return Vec::new() };
        let before = text.get(..start).unwrap_or("");
        let mut lines = before.lines().rev();
        if !before.ends_with('\n') {
            // What stands before it on its own line.
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
        // A block of which the beginning was not found is none.
        if inside { Vec::new() } else { comment }
    }
}
