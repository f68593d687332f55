//! [`listing`]: the texts of a scene's shaders, with what each line loses in f32, and where the causes are.
//!
//! *In:* the figures of every expression, the causes, the texts. *Out:* [`Text`]s of [`Row`]s. *Holds:* all lines of a shader, and of
//! a file in which something was evaluated, are there, in order; code is escaped. An expression belongs to the line on which it begins,
//! one from a macro to the line that uses the macro.

use super::super::{CAUSE_BITS, Findings, SpanError};
use glisten_front::hir::{Shader, Stage};
use glisten_front::source::{FileId, Location, SourceMap, Span};
use glisten_page::highlight::{Comments, Language, html};
use glisten_scene::Scene;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The number of expressions that are told for a line.
const MOST_EXPRESSIONS: usize = 8;
/// The number of causes that are marked in a line.
const MOST_MARKS: usize = 8;
/// The characters of a line that are shown.
const MOST_CHARACTERS: usize = 1000;
/// The characters of an expression that are shown.
const MOST_OF_EXPRESSION: usize = 72;
/// Lines in sequence in which nothing is evaluated are folded if they are more.
const MOST_IDLE: usize = 14;
/// The lines that stay before and after a fold.
const AROUND: usize = 3;
/// The least loss of an expression that is told.
const LEAST_BITS: f64 = 0.05;

/// A file.
pub(super) struct Text {
    pub(super) name: String,
    /// The stages that evaluate expressions of it.
    pub(super) stages: Vec<&'static str>,
    pub(super) rows: Vec<Row>,
    /// Lines that no expression was evaluated on, by their position in the rows.
    pub(super) folds: Vec<Range<usize>>,
    /// Whether a cause is in it.
    pub(super) has_causes: bool,
}

/// A line.
pub(super) struct Row {
    pub(super) number: u32,
    /// The code as HTML.
    pub(super) code: String,
    /// The positions of the causes that begin or go on here, and whether they begin.
    pub(super) causes: Vec<(usize, bool)>,
    /// The loss here, if something was evaluated.
    pub(super) loss: Option<Loss>,
}

/// The loss of a line: the worst of its expressions.
#[derive(Default)]
pub(super) struct Loss {
    /// The largest number of bits.
    pub(super) bits: f64,
    /// The largest mean.
    pub(super) mean_bits: f64,
    pub(super) births: u64,
    pub(super) disagreements: u64,
    pub(super) expressions: Vec<Expression>,
    /// The number of those left out.
    pub(super) more: usize,
}

/// An expression with its figures.
pub(super) struct Expression {
    pub(super) text: String,
    pub(super) from_macro: bool,
    pub(super) figures: SpanError,
}

/// The texts of the shaders, and of all files in which something was evaluated, in the order in which they were read.
pub(super) fn listing(scene: &Scene, sources: &SourceMap, spans: &[SpanError], findings: &Findings) -> Vec<Text> {
    let mut by_file: BTreeMap<FileId, Vec<(u32, &SpanError)>> = BTreeMap::new();
    let mut stages: BTreeMap<FileId, BTreeSet<Stage>> = BTreeMap::new();
    for (stage, shader) in stages_of(scene) {
        let main = shader.functions.iter().find(|function| function.name == "main" && function.body.is_some());
        let Some(file) = main.and_then(|main| sources.file_of(sources.call_site(main.span))) else { continue };
        by_file.entry(file).or_default();
        stages.entry(file).or_default().insert(stage);
    }
    for figures in spans {
        let Some(location) = sources.location(sources.call_site(figures.span)) else { continue };
        by_file.entry(location.file).or_default().push((location.line, figures));
        stages.entry(location.file).or_default().insert(figures.stage);
    }
    let stages_of = |file: &FileId| stages.get(file).into_iter().flatten().map(|stage| stage.name()).collect();
    by_file
        .iter()
        .map(|(file, figures)| Text { stages: stages_of(file), ..text(sources, *file, figures, findings) })
        .collect()
}

fn stages_of(scene: &Scene) -> impl Iterator<Item = (Stage, &Shader)> {
    let draws = scene.draws.iter();
    draws
        .flat_map(|draw| [Stage::Vertex, Stage::Fragment].map(|stage| (stage, draw.program.stage(stage))))
        .filter_map(|(stage, shader)| Some((stage, shader?)))
}

fn text(sources: &SourceMap, file: FileId, figures: &[(u32, &SpanError)], findings: &Findings) -> Text {
    let mut lines: BTreeMap<u32, Vec<&SpanError>> = BTreeMap::new();
    for (line, figures) in figures {
        lines.entry(*line).or_default().push(figures);
    }
    let causes: Vec<(usize, Location)> = causes_in(sources, file, findings);
    let mut comments = Comments::default();
    let count = sources.file(file).line_count();
    let mut rows: Vec<Row> = (1..=count)
        .map(|number| {
            let whole = sources.file(file).line(number).unwrap_or("");
            let marks = marks(number, whole, &causes);
            Row {
                number,
                code: code(whole, &marks, &mut comments),
                causes: marks.iter().map(|mark| (mark.cause, mark.begins)).collect(),
                loss: lines.get(&number).map(|spans| loss(sources, spans)),
            }
        })
        .collect();
    // A text that ends with a line break has an empty last line.
    if rows.last().is_some_and(|last| last.code.is_empty()) {
        rows.pop();
    }
    Text {
        name: sources.file(file).name().to_owned(),
        stages: Vec::new(),
        folds: folds(&rows),
        has_causes: !causes.is_empty(),
        rows,
    }
}

fn causes_in(sources: &SourceMap, file: FileId, findings: &Findings) -> Vec<(usize, Location)> {
    let places = findings.causes.iter().enumerate().filter_map(|(index, cause)| {
        let location = sources.location(sources.call_site(cause.diagnostic.primary.span))?;
        (location.file == file).then_some((index, location))
    });
    places.collect()
}

/// The marked part of a line: characters, counted from 0.
#[derive(Clone, Debug, PartialEq)]
struct Mark {
    range: Range<usize>,
    cause: usize,
    begins: bool,
}

/// The marks of a line, outer ones before those in them. One that would cut another is left out.
fn marks(number: u32, line: &str, causes: &[(usize, Location)]) -> Vec<Mark> {
    let length = line.chars().count().min(MOST_CHARACTERS);
    let indent = line.chars().take_while(|character| character.is_whitespace()).count();
    let mut marks: Vec<Mark> = Vec::new();
    for (cause, place) in causes.iter().filter(|(_, place)| (place.line..=place.end_line).contains(&number)) {
        let begins = place.line == number;
        let start = if begins { place.column.saturating_sub(1) as usize } else { indent };
        let end = if place.end_line == number { place.end_column.saturating_sub(1) as usize } else { length };
        let range = start.min(length)..end.min(length).max(start.min(length));
        let fits = |other: &Mark| {
            let (a, b) = (&other.range, &range);
            let apart = a.end <= b.start || b.end <= a.start;
            apart || (a.start <= b.start && b.end <= a.end) || (b.start <= a.start && a.end <= b.end)
        };
        if marks.len() < MOST_MARKS && !range.is_empty() && marks.iter().all(fits) {
            marks.push(Mark { range, cause: *cause, begins });
        }
    }
    marks.sort_by_key(|mark| (mark.range.start, usize::MAX - mark.range.end, mark.cause));
    marks
}

/// A line as HTML, with `<mark>` around what is marked.
fn code(line: &str, marks: &[Mark], comments: &mut Comments) -> String {
    let characters: Vec<char> = line.trim_end_matches(['\n', '\r']).chars().take(MOST_CHARACTERS).collect();
    let cut = if line.chars().count() > MOST_CHARACTERS + 2 { "<span class=\"com\">\u{2026}</span>" } else { "" };
    let part = |range: Range<usize>| characters.get(range).map_or_else(String::new, |part| part.iter().collect());
    if marks.is_empty() {
        return comments.html(&part(0..characters.len())) + cut;
    }
    comments.passes(line);
    let mut out = String::new();
    let mut at = 0;
    let mut open: Vec<usize> = Vec::new();
    let close = |until: usize, at: &mut usize, open: &mut Vec<usize>, out: &mut String| {
        while let Some(end) = open.last().copied().filter(|end| *end <= until) {
            out.push_str(&html(&part(*at..end), Language::Glsl));
            out.push_str("</mark>");
            *at = end;
            open.pop();
        }
    };
    for mark in marks {
        close(mark.range.start, &mut at, &mut open, &mut out);
        out.push_str(&html(&part(at..mark.range.start), Language::Glsl));
        out.push_str("<mark>");
        at = mark.range.start;
        open.push(mark.range.end.min(characters.len()));
    }
    close(characters.len(), &mut at, &mut open, &mut out);
    out.push_str(&html(&part(at..characters.len()), Language::Glsl));
    out + cut
}

fn loss(sources: &SourceMap, spans: &[&SpanError]) -> Loss {
    let largest = |figure: fn(&SpanError) -> f64| spans.iter().map(|span| figure(span)).fold(0.0, f64::max);
    let mut telling: Vec<&SpanError> = spans
        .iter()
        .copied()
        .filter(|span| span.lost_bits >= LEAST_BITS || span.births > 0 || span.disagreements > 0 || span.error > 0.0)
        .collect();
    telling.sort_by(|a, b| {
        let key = |span: &SpanError| (span.births > 0 || span.disagreements > 0, span.lost_bits >= CAUSE_BITS);
        let place = |span: Span| (span.start, span.end);
        key(b).cmp(&key(a)).then(b.lost_bits.total_cmp(&a.lost_bits)).then(place(a.span).cmp(&place(b.span)))
    });
    let more = telling.len().saturating_sub(MOST_EXPRESSIONS);
    telling.truncate(MOST_EXPRESSIONS);
    Loss {
        bits: largest(|span| span.lost_bits),
        mean_bits: largest(|span| span.mean_lost_bits),
        births: spans.iter().map(|span| span.births).sum(),
        disagreements: spans.iter().map(|span| span.disagreements).sum(),
        expressions: telling.into_iter().map(|span| expression(sources, span)).collect(),
        more,
    }
}

fn expression(sources: &SourceMap, figures: &SpanError) -> Expression {
    let written = sources.snippet(figures.span).split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text: String = written.chars().take(MOST_OF_EXPRESSION).collect();
    if text.len() < written.len() {
        text.push('\u{2026}');
    }
    Expression { text, from_macro: figures.span.expansion.is_some(), figures: *figures }
}

/// Long sequences of rows on which nothing is evaluated, without the lines around them.
fn folds(rows: &[Row]) -> Vec<Range<usize>> {
    let mut folds = Vec::new();
    let mut start = 0;
    let ends = rows.iter().enumerate().filter(|(_, row)| row.loss.is_some() || !row.causes.is_empty());
    for end in ends.map(|(at, _)| at).chain([rows.len()]) {
        if end.saturating_sub(start) > MOST_IDLE {
            let first = if start == 0 { 0 } else { start + AROUND };
            let last = if end == rows.len() { end } else { end - AROUND };
            folds.push(first..last);
        }
        start = end + 1;
    }
    folds
}

#[cfg(test)]
mod tests {
    use super::{Comments, Mark, code};

    fn mark(range: std::ops::Range<usize>) -> Mark {
        Mark { range, cause: 0, begins: true }
    }

    #[test]
    fn marks_nest_and_nothing_is_lost() {
        let line = "x = a<b+(c);";
        let marked = code(line, &[mark(4..11), mark(4..5), mark(8..11)], &mut Comments::default());
        assert_eq!(marked, "x = <mark><mark>a</mark>&lt;b+<mark>(c)</mark></mark>;");
        assert_eq!(code(line, &[mark(0..12)], &mut Comments::default()), "<mark>x = a&lt;b+(c);</mark>");
    }

    #[test]
    fn a_line_of_any_length_ends() {
        let long = "a+".repeat(100_000);
        assert!(code(&long, &[], &mut Comments::default()).len() < 10_000);
        assert!(code(&long, &[mark(3..1000)], &mut Comments::default()).ends_with("\u{2026}</span>"));
    }
}
