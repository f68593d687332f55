//! [`Sections`]: the texts of a program, and what else an input contains, in one text.
//!
//! *In:* a text with lines such as `//# vertex`. *Out:* the text behind each of them; a text before the first one is a fragment
//! shader. *Holds:* every text is an input, so that a fuzzer can do nothing wrong.

use glisten_front::{Source, Stage};

/// The beginning of a line that begins a section.
const MARK: &str = "//# ";

/// An input in parts.
#[derive(Clone, Debug, Default)]
pub struct Sections<'a> {
    parts: Vec<(&'a str, &'a str)>,
}

impl<'a> Sections<'a> {
    /// The parts of a text.
    pub fn of(text: &'a str) -> Self {
        let mut parts: Vec<(&str, &str)> = Vec::new();
        let mut rest = text;
        let mut name = Stage::Fragment.name();
        while !rest.is_empty() {
            let end = if rest.starts_with(MARK) { 0 } else { rest.find("\n//# ").map_or(rest.len(), |at| at + 1) };
            let (part, after) = rest.split_at(end);
            if !part.is_empty() && !parts.iter().any(|(other, _)| *other == name) {
                parts.push((name, part));
            }
            let line = after.lines().next().unwrap_or_default();
            name = line.strip_prefix(MARK).unwrap_or_default().trim();
            rest = after.get(line.len()..).unwrap_or_default().trim_start_matches(['\r', '\n']);
            if rest.is_empty() && !after.is_empty() {
                break;
            }
        }
        Self { parts }
    }

    /// The text of the section of this name.
    pub fn text(&self, name: &str) -> Option<&'a str> {
        self.parts.iter().find(|(other, _)| *other == name).map(|(_, text)| *text)
    }

    /// The shaders, in the order of the pipeline.
    pub fn shaders(&self) -> Vec<Source> {
        let of = |stage: &Stage| {
            let text = self.text(stage.name())?;
            Some(Source { name: format!("fuzzed.{}", extension(*stage)), text: text.into(), stage: *stage })
        };
        [Stage::Vertex, Stage::Geometry, Stage::Fragment].iter().filter_map(of).collect()
    }
}

/// The usual ending of a stage's files.
pub(crate) fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// The texts of shaders, for a message.
#[cfg(feature = "checks")]
pub(crate) fn named(sources: &[Source]) -> String {
    sources.iter().map(|source| format!("{}{}\n", mark(source.stage.name()), source.text)).collect()
}

/// The line that begins a section.
pub(crate) fn mark(name: &str) -> String {
    format!("{MARK}{name}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_part_a_text() {
        let sections = Sections::of("a\nb\n//# vertex\nc\n//# scene\nd");
        assert_eq!(sections.text("fragment"), Some("a\nb\n"));
        assert_eq!(sections.text("vertex"), Some("c\n"));
        assert_eq!(sections.text("scene"), Some("d"));
        let stages: Vec<Stage> = sections.shaders().iter().map(|shader| shader.stage).collect();
        assert_eq!(stages, [Stage::Vertex, Stage::Fragment]);
    }

    #[test]
    fn odd_texts_end() {
        for text in ["", "//# ", "//# x", "//# x\n//# y\n", "\n\n", "//# vertex\n//# vertex\na"] {
            Sections::of(text).shaders();
        }
        assert_eq!(Sections::of("//# vertex\na").text("vertex"), Some("a"));
    }
}
