//! Writes diagnostics for people: message, excerpt with carets, labels, notes, help, the section of the
//! specification.
//!
//! *Holds:* source text never reaches a terminal unfiltered. Control characters are replaced, and an overlong line is
//! cut to the part around the label.

use super::hostile::{clean, is_hostile};
use super::{Finding, labels, section};
use crate::diagnostic::{Diagnostic, Severity};
use crate::source::{FileId, SourceMap, Span};
use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term;
use std::ops::Range;

/// The length in bytes above which only a part of a line is shown.
const LONG_LINE: usize = 300;
/// How many characters are shown on either side of a label in such a line.
const AROUND: usize = 80;

/// Writes the diagnostics for people, each followed by an empty line; with `color`, uses ANSI escapes.
pub fn human<'a>(sources: &SourceMap, diagnostics: impl IntoIterator<Item = &'a Diagnostic>, color: bool) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics {
        text.push_str(&one(sources, diagnostic, color));
    }
    text
}

fn one(sources: &SourceMap, diagnostic: &Diagnostic, color: bool) -> String {
    let mut excerpts = Excerpts { sources, cuts: Vec::new() };
    let primary = sources.call_site(diagnostic.primary.span);
    let mut shown = Vec::new();
    let mut has_primary = false;
    for label in labels(sources, diagnostic) {
        let is_primary = !has_primary && label.span == primary;
        has_primary |= is_primary;
        shown.extend(excerpts.label(label.span, &label.message, is_primary));
    }
    if !has_primary {
        // The excerpts are in the order of the files of the labels: that of the diagnostic comes first.
        shown.splice(0..0, excerpts.label(primary, "", true));
    }
    let located = !shown.is_empty();
    let message = clean(&diagnostic.message);
    let rendered = codespan::Diagnostic::new(severity(diagnostic.severity))
        .with_code(diagnostic.code.id)
        .with_message(&message)
        .with_labels(shown)
        .with_notes(notes(sources, diagnostic, located));
    emit(&excerpts, &rendered, color).unwrap_or_else(|_| {
        let region = Finding::new(sources, diagnostic).region;
        let head = format!("{}[{}]: {message}", diagnostic.severity, diagnostic.code);
        format!("{head}\n  --> {}:{}:{}\n\n", region.file, region.line, region.column)
    })
}

fn emit(excerpts: &Excerpts<'_>, diagnostic: &codespan::Diagnostic<Excerpt>, color: bool) -> Result<String, Error> {
    let config = term::Config { tab_width: 4, ..term::Config::default() };
    if !color {
        return term::emit_into_string(&config, excerpts, diagnostic);
    }
    let mut buffer = term::termcolor::Ansi::new(Vec::new());
    let styles = term::Styles::default();
    term::emit_to_write_style(&mut term::StylesWriter::new(&mut buffer, &styles), &config, excerpts, diagnostic)?;
    Ok(String::from_utf8_lossy(&buffer.into_inner()).into_owned())
}

fn severity(severity: Severity) -> codespan::Severity {
    match severity {
        Severity::Note => codespan::Severity::Note,
        Severity::Warning => codespan::Severity::Warning,
        Severity::Error => codespan::Severity::Error,
    }
}

fn notes(sources: &SourceMap, diagnostic: &Diagnostic, located: bool) -> Vec<String> {
    let mut notes: Vec<String> = diagnostic.notes.iter().map(|note| clean(note)).collect();
    let presented = sources.presented_line(sources.call_site(diagnostic.primary.span));
    if let Some(line) = diagnostic.presented_line.or(presented) {
        notes.push(format!("`#line` calls this line {line}"));
    }
    if let Some(help) = &diagnostic.help {
        notes.push(format!("help: {}", clean(help)));
    }
    let section = section(sources, diagnostic);
    if !section.is_empty() {
        notes.push(format!("see {section}"));
    }
    if !located && sources.files().next().is_some() {
        let region = Finding::new(sources, diagnostic).region;
        if !diagnostic.message.contains(&region.file) {
            notes.push(format!("in {}", clean(&region.file)));
        }
    }
    notes
}

/// A text from which an excerpt is taken.
#[derive(Clone, Copy, PartialEq)]
enum Excerpt {
    /// A whole source.
    Whole(FileId),
    /// A part of a line, with unsuitable characters replaced.
    Cut(usize),
}

/// A part of a line of a source.
struct Cut {
    file: FileId,
    text: String,
    /// The line, counted from 1.
    line: u32,
    /// The column of the label's first character, counted from 1, and its byte in `text`.
    column: u32,
    label_start: usize,
}

struct Excerpts<'a> {
    sources: &'a SourceMap,
    cuts: Vec<Cut>,
}

impl Excerpts<'_> {
    /// Adds a label at `span`, unless that is unknown or in an empty text. Of several lines, marks the first.
    fn label(&mut self, span: Span, message: &str, primary: bool) -> Option<codespan::Label<Excerpt>> {
        let at = self.sources.location(span)?;
        let file = self.sources.file(at.file);
        if file.shown().is_empty() {
            return None;
        }
        let line = file.line(at.line)?;
        let line_start = file.line_range(at.line)?.start;
        let offset = |global: u32| (global.saturating_sub(file.base()) as usize).min(file.shown().len());
        let (start, mut end) = (offset(span.start), offset(span.end));
        let mut message = clean(message);
        if at.end_line > at.line {
            end = line_start + line.len();
        }
        end = end.max(start);
        let (excerpt, range) = if line.len() > LONG_LINE || line.chars().any(|c| c != '\t' && is_hostile(c)) {
            self.cut(at.file, at.line, at.column, line, start - line_start..(end - line_start).min(line.len()))
        } else {
            (Excerpt::Whole(at.file), start..end)
        };
        if primary && at.end_line > at.line && message.is_empty() {
            message = "starts here".to_owned();
        }
        let style = if primary { codespan::LabelStyle::Primary } else { codespan::LabelStyle::Secondary };
        Some(codespan::Label::new(style, excerpt, range).with_message(message))
    }

    fn cut(
        &mut self,
        file: FileId,
        line: u32,
        column: u32,
        text: &str,
        label: Range<usize>,
    ) -> (Excerpt, Range<usize>) {
        let start = label.start.min(text.len());
        let before: Vec<char> = text.get(..start).unwrap_or("").chars().rev().take(AROUND).collect();
        let mut shown = String::new();
        if before.len() == AROUND {
            shown.push('…');
        }
        let push = |shown: &mut String, character: char| {
            shown.push(if character == '\t' || is_hostile(character) { '\u{fffd}' } else { character });
        };
        before.iter().rev().for_each(|&character| push(&mut shown, character));
        let label_start = shown.len();
        let marked = text.get(start..label.end).unwrap_or("");
        marked.chars().take(AROUND).for_each(|character| push(&mut shown, character));
        let label_end = shown.len();
        let after = text.get(label.end..).unwrap_or("");
        after.chars().take(AROUND).for_each(|character| push(&mut shown, character));
        if after.chars().nth(AROUND).is_some() {
            shown.push('…');
        }
        self.cuts.push(Cut { file, text: shown, line, column, label_start });
        (Excerpt::Cut(self.cuts.len() - 1), label_start..label_end)
    }

    fn cut_at(&self, index: usize) -> Result<&Cut, Error> {
        self.cuts.get(index).ok_or(Error::FileMissing)
    }
}

impl<'a> Files<'a> for Excerpts<'_> {
    type FileId = Excerpt;
    type Name = String;
    type Source = &'a str;

    fn name(&'a self, id: Excerpt) -> Result<String, Error> {
        let file = match id {
            Excerpt::Whole(file) => file,
            Excerpt::Cut(index) => self.cut_at(index)?.file,
        };
        Ok(clean(self.sources.file(file).name()))
    }

    fn source(&'a self, id: Excerpt) -> Result<&'a str, Error> {
        match id {
            Excerpt::Whole(file) => Ok(self.sources.file(file).shown()),
            Excerpt::Cut(index) => Ok(&self.cut_at(index)?.text),
        }
    }

    fn line_index(&'a self, id: Excerpt, byte: usize) -> Result<usize, Error> {
        let Excerpt::Whole(file) = id else { return Ok(0) };
        let start = self.sources.file(file).base() + byte as u32;
        let at = self.sources.location(Span::new(start, start.max(1))).ok_or(Error::FileMissing)?;
        Ok(at.line as usize - 1)
    }

    fn line_number(&'a self, id: Excerpt, line_index: usize) -> Result<usize, Error> {
        match id {
            Excerpt::Whole(_) => Ok(line_index + 1),
            Excerpt::Cut(index) => Ok(self.cut_at(index)?.line as usize),
        }
    }

    fn column_number(&'a self, id: Excerpt, line_index: usize, byte: usize) -> Result<usize, Error> {
        let range = self.line_range(id, line_index)?;
        let text = self.source(id)?;
        let columns = |range: Range<usize>| text.get(range).map_or(0, |text| text.chars().count());
        match id {
            Excerpt::Whole(_) => Ok(columns(range.start..byte) + 1),
            Excerpt::Cut(index) => {
                let cut = self.cut_at(index)?;
                let (column, start) = (cut.column as usize, cut.label_start);
                let back = columns(byte.min(start)..start);
                Ok((column + columns(start..byte.max(start))).saturating_sub(back).max(1))
            }
        }
    }

    fn line_range(&'a self, id: Excerpt, line_index: usize) -> Result<Range<usize>, Error> {
        match id {
            Excerpt::Whole(file) => {
                let file = self.sources.file(file);
                let too_large = Error::LineTooLarge { given: line_index, max: file.line_count() as usize };
                file.line_range(line_index as u32 + 1).ok_or(too_large)
            }
            Excerpt::Cut(index) => Ok(0..self.cut_at(index)?.text.len()),
        }
    }
}
