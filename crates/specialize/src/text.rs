//! A residual stage as GLSL 1.50.
//!
//! *In:* a stage, the texts of the original. *Out:* text with the names of the original, and with the comments that stood
//! above or behind what is left.

use glisten_front::hir::{Notes, Shader, Stage, Types, print_with};
use glisten_front::source::{SourceMap, Span};

/// A comment above something is at most so many lines long.
const MOST_LINES: usize = 40;

/// Writes a stage.
pub(crate) fn write(types: &Types, shader: &Shader, sources: Option<&SourceMap>) -> String {
    let mut shader = shader.clone();
    shader.version.number = 150;
    print_with(types, &shader, Some(&Comments(sources)))
}

/// The extension of a stage's files.
pub(crate) fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// The comments of the original.
struct Comments<'a>(Option<&'a SourceMap>);

impl Comments<'_> {
    /// The text of the file that a span is in, and the span's place in it; nothing for what a macro brought.
    fn place(&self, span: Span) -> Option<(&str, usize, usize)> {
        let sources = self.0.filter(|_| span.is_known() && !span.expansion.is_some())?;
        let file = sources.file(sources.file_of(span)?);
        let (start, end) = (span.start.checked_sub(file.base())? as usize, span.end.checked_sub(file.base())? as usize);
        let text: &str = file.text();
        (text.is_char_boundary(start) && text.is_char_boundary(end)).then_some((text, start, end))
    }
}

impl Notes for Comments<'_> {
    fn above(&self, span: Span) -> Vec<String> {
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
