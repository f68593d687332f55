//! [`SourceMap`] holds all texts of a compilation and translates spans to files, lines and columns.
//!
//! *In:* texts, macro uses and `#line` directives, in the order in which they are read.
//! *Out:* for a [`Span`]: its file, its text, its [`Location`], its macro use.
//!
//! *Holds:* offset 0 belongs to no file; a [`FileId`] or [`ExpansionId`] is valid only in the map that made it.

use super::remarks::Remarks;
use super::{ExpansionId, Span};
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, OnceLock};

/// The handle of a text in a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u32);

impl FileId {
    fn index(self) -> usize {
        self.0 as usize
    }
}

/// A text with its name and the offsets of its line starts.
#[derive(Clone, Debug)]
pub struct SourceFile {
    name: String,
    text: Arc<str>,
    /// The text that people see, if it is another one of the same length.
    shown: Option<Arc<str>>,
    base: u32,
    line_starts: Vec<u32>,
    /// How many characters are before each block of [`BLOCK`] bytes, once a column of a long line was asked for.
    characters: OnceLock<Vec<u32>>,
    /// The comments for glisten, once a finding asked for them.
    remarks: OnceLock<Remarks>,
    /// Whether there is room behind it.
    is_changing: bool,
}

/// The bytes of a text whose characters are counted together.
const BLOCK: usize = 4096;

impl SourceFile {
    /// The name that diagnostics show: the path as the user wrote it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// The text that people see: that of [`SourceMap::show`], or else [`Self::text`]. Lines and columns are those of it.
    pub fn shown(&self) -> &Arc<str> {
        self.shown.as_ref().unwrap_or(&self.text)
    }

    /// The text of line `line`, counted from 1, without its line ending.
    pub fn line(&self, line: u32) -> Option<&str> {
        self.shown().get(self.line_range(line)?).map(|line| line.trim_end_matches(['\n', '\r']))
    }

    /// The number of lines; an empty text has one.
    pub fn line_count(&self) -> u32 {
        self.line_starts.len() as u32
    }

    /// The comments for glisten, which are searched for once.
    pub(crate) fn remarks(&self) -> &Remarks {
        self.remarks.get_or_init(|| Remarks::of((1..=self.line_count()).filter_map(|number| self.line(number))))
    }

    /// The byte range of line `line`, counted from 1, including its line ending, as offsets into [`Self::text`].
    pub fn line_range(&self, line: u32) -> Option<std::ops::Range<usize>> {
        let index = (line as usize).checked_sub(1)?;
        let start = *self.line_starts.get(index)? as usize;
        let end = self.line_starts.get(index + 1).map_or(self.text.len(), |&next| next as usize);
        Some(start..end)
    }

    /// The global offset of the file's first byte.
    pub fn base(&self) -> u32 {
        self.base
    }

    /// The global offset one past the file's last byte.
    pub fn end(&self) -> u32 {
        self.base + self.text.len() as u32
    }

    fn line_at(&self, global: u32) -> u32 {
        let offset = global.saturating_sub(self.base);
        self.line_starts.partition_point(|&start| start <= offset).max(1) as u32
    }

    fn line_and_column(&self, global: u32) -> (u32, u32) {
        let offset = (global.saturating_sub(self.base) as usize).min(self.text.len());
        let line = self.line_starts.partition_point(|&start| start as usize <= offset).max(1);
        let start = self.line_starts.get(line - 1).map_or(0, |&start| start as usize);
        let mut end = offset;
        while !self.shown().is_char_boundary(end) {
            end -= 1;
        }
        (line as u32, self.characters(start, end) as u32 + 1)
    }

    /// The number of characters between two offsets. Of a very long line, it is not counted again for each column.
    fn characters(&self, start: usize, end: usize) -> usize {
        if end.saturating_sub(start) < 2 * BLOCK {
            return self.shown().get(start..end).map_or(0, |text| text.chars().count());
        }
        let bytes = self.shown().as_bytes();
        let begins = |block: &[u8]| block.iter().filter(|byte| (**byte as i8) >= -0x40).count();
        let blocks = self.characters.get_or_init(|| {
            let sums = bytes.chunks(BLOCK).scan(0, |sum, block| {
                let before = *sum;
                *sum += begins(block) as u32;
                Some(before)
            });
            sums.collect()
        });
        let before = |offset: usize| {
            let whole = blocks.get(offset / BLOCK).copied().unwrap_or_default() as usize;
            whole + bytes.get(offset / BLOCK * BLOCK..offset).map_or(0, begins)
        };
        before(end) - before(start)
    }
}

/// A macro use: the macro, where it is used, and where it is defined.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// The macro's name.
    pub name: Arc<str>,
    /// The use (name and arguments), which may itself lie inside another expansion.
    pub call: Span,
    /// The name in the `#define`.
    pub definition: Span,
}

/// A position for people: file, lines and columns. All are counted from 1, columns in Unicode scalar values (a tab is
/// one); the end is exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Location {
    /// The file.
    pub file: FileId,
    /// First line.
    pub line: u32,
    /// First column.
    pub column: u32,
    /// Last line.
    pub end_line: u32,
    /// One past the last column.
    pub end_column: u32,
}

/// All texts of a compilation.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
    expansions: Vec<Expansion>,
    rare: Box<Rare>,
    /// The languages of the texts from an offset on, sorted by it.
    languages: Vec<(u32, Language)>,
}

/// Facts that most texts have few of.
#[derive(Clone, Debug, Default)]
struct Rare {
    /// The macro uses that are in no other one: from where to where.
    uses: BTreeMap<u32, u32>,
    /// Sorted by offset.
    renumberings: Vec<Renumbering>,
}

/// The state of a map, as far as the places of what is added later depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Mark {
    files: usize,
    next: u32,
    expansions: usize,
    renumberings: usize,
    languages: usize,
}

/// The texts and facts that were added to a map since a [`Mark`].
#[derive(Clone, Debug)]
pub(crate) struct Addition {
    from: Mark,
    files: Vec<SourceFile>,
    expansions: Vec<Expansion>,
    renumberings: Vec<Renumbering>,
    languages: Vec<(u32, Language)>,
}

/// The language of a text, as its `#version` line states it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Language {
    /// 150 for 1.50.
    pub number: u16,
    /// Whether it is that of OpenGL ES.
    pub es: bool,
}

/// A `#line` directive: the line after it counts as `number`.
#[derive(Clone, Copy, Debug, Hash)]
struct Renumbering {
    /// The global offset of the directive.
    offset: u32,
    /// The line that the directive is on, counted from 1.
    line: u32,
    /// The number of the next line.
    number: u32,
}

/// The hash of all texts that somebody wrote, and of where macros are used: the macros of the command line are no part of it.
impl Hash for SourceMap {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let Self { files, expansions, rare, languages } = self;
        files.len().hash(state);
        for SourceFile { name, text, shown, base, line_starts: _, characters: _, remarks: _, is_changing: _ } in files {
            let written = (name != Self::COMMAND_LINE).then_some((text, shown));
            (name, written, base).hash(state);
        }
        expansions.len().hash(state);
        expansions.iter().for_each(|Expansion { name, call, definition: _ }| (name, call).hash(state));
        (&rare.renumberings, languages).hash(state);
    }
}

impl SourceMap {
    /// The largest total size of all texts in bytes, 1 GiB. Each file, and the preprocessor, has a far smaller budget
    /// of its own.
    pub const MAX_BYTES: u32 = 1 << 30;

    /// The name of the text that contains the macros defined from outside. It is not the name of a file.
    pub const COMMAND_LINE: &'static str = "<command line>";

    /// The name of a shader that is read from standard input. Other names in angle brackets are those of texts that nobody edits.
    pub const STDIN: &'static str = "<stdin>";

    /// Adds a text. Returns `None` if the map has no room for it ([`Self::MAX_BYTES`]).
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> Option<FileId> {
        let text = text.into();
        let base = self.next_base();
        if text.len() >= (Self::MAX_BYTES - base.min(Self::MAX_BYTES)) as usize {
            return None;
        }
        let line_starts = line_starts(&text);
        let id = FileId(self.files.len() as u32);
        let name = name.into();
        let is_changing = name == Self::COMMAND_LINE;
        let (characters, remarks) = (OnceLock::new(), OnceLock::new());
        self.files.push(SourceFile { name, text, shown: None, base, line_starts, characters, remarks, is_changing });
        Some(id)
    }

    /// Adds a text that changes more often than those that are added later. There is room behind it, so that the places of later
    /// texts stay. Returns `None` if the map has no room for it.
    pub fn add_changing(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> Option<FileId> {
        let id = self.add(name, text)?;
        self.files.iter_mut().skip(id.index()).for_each(|file| file.is_changing = true);
        Some(id)
    }

    /// The offset of the next text. The macros of the command line change, too: the places of later texts do not depend on their
    /// values.
    fn next_base(&self) -> u32 {
        const ROOM: u32 = 4096;
        self.files.last().map_or(1, |file| match file.end() + 1 {
            end if file.is_changing => end.next_multiple_of(ROOM),
            end => end,
        })
    }

    /// The state of the map now.
    pub(crate) fn mark(&self) -> Mark {
        Mark {
            files: self.files.len(),
            next: self.next_base(),
            expansions: self.expansions.len(),
            renumberings: self.rare.renumberings.len(),
            languages: self.languages.len(),
        }
    }

    /// All that was added since a state of this map. Rows of later texts stand behind those of earlier ones.
    pub(crate) fn since(&self, from: Mark) -> Addition {
        Addition {
            from,
            files: self.files.iter().skip(from.files).cloned().collect(),
            expansions: self.expansions.iter().skip(from.expansions).cloned().collect(),
            renumberings: self.rare.renumberings.iter().skip(from.renumberings).copied().collect(),
            languages: self.languages.iter().skip(from.languages).copied().collect(),
        }
    }

    /// Adds again what was added to a map in the same state. Returns whether this one is in it.
    pub(crate) fn append(&mut self, addition: &Addition) -> bool {
        let fits = self.mark() == addition.from;
        if fits {
            self.files.extend_from_slice(&addition.files);
            addition.expansions.iter().for_each(|expansion| {
                self.add_expansion(expansion.clone());
            });
            self.rare.renumberings.extend_from_slice(&addition.renumberings);
            self.languages.extend_from_slice(&addition.languages);
        }
        fits
    }

    /// Shows `text` instead of the texts called `name` that are as long: they are a part of it, at its place, with everything else
    /// blank. Lines and columns then are those of `text`.
    pub fn show(&mut self, name: &str, text: &Arc<str>) {
        for file in self.files.iter_mut().filter(|file| file.name == name && file.text.len() == text.len()) {
            file.line_starts = line_starts(text);
            file.shown = Some(Arc::clone(text));
            (file.characters, file.remarks) = (OnceLock::new(), OnceLock::new());
        }
    }

    /// The text of a handle that [`Self::add`] returned.
    pub fn file(&self, id: FileId) -> &SourceFile {
        // Only `add` of this map makes a `FileId`.
        &self.files[id.index()]
    }

    /// All texts in the order in which they were added.
    pub fn files(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(index, file)| (FileId(index as u32), file))
    }

    /// Records a macro use.
    pub fn add_expansion(&mut self, expansion: Expansion) -> ExpansionId {
        if !expansion.call.expansion.is_some() {
            self.add_use(expansion.call);
        }
        self.expansions.push(expansion);
        ExpansionId::new(self.expansions.len() as u32)
    }

    /// Records a macro use outside of macros. One that the text of another one begins, as `SQ` in `F (x)` with `#define F SQ`, is
    /// one with it.
    fn add_use(&mut self, call: Span) {
        let (mut start, mut end) = (call.start, call.end);
        while let Some((&other, &until)) = self.rare.uses.range(..end).next_back().filter(|(_, until)| **until > start)
        {
            if other <= start && end <= until {
                return;
            }
            self.rare.uses.remove(&other);
            (start, end) = (start.min(other), end.max(until));
        }
        self.rare.uses.insert(start, end);
    }

    /// Whether the texts use any macro.
    pub(crate) fn has_uses(&self) -> bool {
        !self.rare.uses.is_empty()
    }

    /// The outermost macro use that put a token where it is: that of its macro, or the one in whose arguments it is written.
    pub(crate) fn use_around(&self, token: Span) -> Option<Span> {
        let site = self.call_site(token);
        let (start, end) = self.rare.uses.range(..=site.start).next_back().filter(|(_, end)| site.end <= **end)?;
        (site.start < *end).then(|| Span::new(*start, *end))
    }

    /// The macro use that a span's expansion number names.
    pub fn expansion(&self, id: ExpansionId) -> Option<&Expansion> {
        self.expansions.get(id.index()?)
    }

    /// All macro uses, in the order in which they were read.
    pub fn expansions(&self) -> impl Iterator<Item = &Expansion> {
        self.expansions.iter()
    }

    /// The file in which a span is written.
    pub fn file_of(&self, span: Span) -> Option<FileId> {
        if !span.is_known() {
            return None;
        }
        let index = self.files.partition_point(|file| file.base <= span.start).checked_sub(1)?;
        (span.start <= self.files.get(index)?.end()).then_some(FileId(index as u32))
    }

    /// Records a `#line` directive at `directive`: the line after it counts as `number`. Locations remain those of
    /// the text; [`Self::presented_line`] returns the number.
    pub fn renumber(&mut self, directive: Span, number: u32) {
        let Some(line) = self.line(directive) else { return };
        let row = Renumbering { offset: directive.start, line, number };
        let index = self.rare.renumberings.partition_point(|other| other.offset < row.offset);
        match self.rare.renumberings.get_mut(index).filter(|other| other.offset == row.offset) {
            Some(same) => *same = row,
            None => self.rare.renumberings.insert(index, row),
        }
    }

    /// The `#line` directives: the offset of each and the number that it gives to the line after it.
    pub(crate) fn renumbered(&self) -> impl Iterator<Item = (u32, u32)> {
        self.rare.renumberings.iter().map(|row| (row.offset, row.number))
    }

    /// Records the language of a text and of those that were added after it, which it includes.
    pub fn set_language(&mut self, file: FileId, language: Language) {
        let base = self.file(file).base;
        let index = self.languages.partition_point(|(other, _)| *other <= base);
        self.languages.insert(index, (base, language));
    }

    /// The language in which a span is written; that of the first text for an unknown span.
    pub fn language_of(&self, span: Span) -> Option<Language> {
        let after = self.languages.partition_point(|(base, _)| *base <= span.start);
        self.languages.get(after.saturating_sub(1)).map(|(_, language)| *language)
    }

    /// The languages, each with the offset that it begins at.
    pub(crate) fn languages(&self) -> impl Iterator<Item = (u32, Language)> {
        self.languages.iter().copied()
    }

    /// Records a language that begins at an offset, after all others.
    pub(crate) fn restore_language(&mut self, base: u32, language: Language) {
        self.languages.push((base, language));
    }

    /// The line on which a span begins, counted from 1. Cheaper than [`Self::location`], which counts columns.
    pub fn line(&self, span: Span) -> Option<u32> {
        Some(self.file(self.file_of(span)?).line_at(span.start))
    }

    /// The line of the text that a span begins in, with its end.
    pub fn line_of(&self, span: Span) -> Option<Span> {
        let file = self.file(self.file_of(span)?);
        let range = file.line_range(file.line_at(span.start))?;
        Some(Span { start: file.base + range.start as u32, end: file.base + range.end as u32, ..span })
    }

    /// The number that an earlier `#line` directive of its file gave to the line of a span, if there is such a
    /// directive.
    pub fn presented_line(&self, span: Span) -> Option<u32> {
        let index = self.rare.renumberings.partition_point(|row| row.offset < span.start).checked_sub(1)?;
        let row = self.rare.renumberings.get(index)?;
        let file = self.file(self.file_of(span)?);
        let line = (row.offset >= file.base).then(|| file.line_at(span.start))?;
        (line > row.line).then(|| row.number.saturating_add(line - row.line - 1))
    }

    /// The text that a span covers at the place where it is written.
    pub fn snippet(&self, span: Span) -> &str {
        let Some(file) = self.file_of(span).map(|id| self.file(id)) else { return "" };
        let start = span.start.saturating_sub(file.base) as usize;
        let end = (span.end.saturating_sub(file.base) as usize).min(file.text.len());
        file.text.get(start..end).unwrap_or("")
    }

    /// The place outside all macros to show to a user: the outermost use that produced this text.
    pub fn call_site(&self, span: Span) -> Span {
        let mut outer = span;
        // The call of an expansion lies in an earlier expansion, so the loop ends.
        while let Some(expansion) = self.expansion(outer.expansion) {
            outer = expansion.call;
        }
        Span { expansion: outer.expansion.plain(), ..outer }
    }

    /// The smallest span from the start of `first` to the end of `last`. If they come from different macro uses or
    /// files, this joins their call sites; if those lie in two files, it is `first`.
    pub fn join(&self, first: Span, last: Span) -> Span {
        let joined = self.joined(
            Span { expansion: first.expansion.plain(), ..first },
            Span { expansion: last.expansion.plain(), ..last },
        );
        let expansion = joined.expansion.marked_as(first.expansion).marked_as(last.expansion);
        Span { expansion, ..joined }
    }

    fn joined(&self, first: Span, last: Span) -> Span {
        if !first.is_known() {
            return last;
        }
        if !last.is_known() {
            return first;
        }
        if first.expansion == last.expansion && (first.expansion == ExpansionId::NONE || first.start <= last.start) {
            if !first.expansion.is_some() && self.file_of(first) != self.file_of(last) {
                return first;
            }
            return Span { start: first.start, end: last.end.max(first.end), expansion: first.expansion };
        }
        let (first, last) = (self.call_site(first), self.call_site(last));
        if self.file_of(first) != self.file_of(last) {
            return first;
        }
        Span::new(first.start, last.end.max(first.end))
    }

    /// The lines and columns at which a span is written.
    pub fn location(&self, span: Span) -> Option<Location> {
        let id = self.file_of(span)?;
        let file = self.file(id);
        let (line, column) = file.line_and_column(span.start);
        let (end_line, end_column) = file.line_and_column(span.end.max(span.start));
        Some(Location { file: id, line, column, end_line, end_column })
    }
}

fn line_starts(text: &str) -> Vec<u32> {
    let bytes = text.as_bytes();
    let mut starts = vec![0];
    let mut at = 0;
    while let Some(found) = bytes.get(at..).and_then(|rest| rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')))
    {
        at += found;
        at += line_end_length(bytes.get(at..).unwrap_or(&[])).max(1);
        starts.push(at as u32);
    }
    starts
}

/// The length of the line end that a text begins with, or 0. A line feed or a carriage return ends a line, and both together end a single one,
/// in either order (GLSL 1.50 §3.1). A line feed before `\r\n` is a line end of its own.
pub fn line_end_length(text: &[u8]) -> usize {
    match text {
        [b'\n', b'\r', b'\n', ..] => 1,
        [b'\r', b'\n', ..] | [b'\n', b'\r', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    }
}

/// The form in which an include names its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum IncludeForm {
    /// `#include "x"`: next to the including file, then along the search path.
    Quoted,
    /// `#include <x>`: along the search path, then among the embedded modules.
    Angled,
}

/// A file that an include found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Included {
    /// The name to show and to resolve further includes against.
    pub name: String,
    /// Its text.
    pub text: Arc<str>,
}

/// Finds the files that `#include` names. The compiler itself does no I/O.
pub trait IncludeResolver {
    /// The file that `path` names in the file called `from`.
    ///
    /// # Errors
    /// A sentence for people, without a full stop, that says what was looked for, where, and why it was not found.
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String>;

    /// The help for a file that was not found, such as the folder where it is.
    fn remedy(&self, _path: &str, _from: &str) -> Option<String> {
        None
    }

    /// Whether the file is there, and cannot be taken since it is no text. [`Self::resolve`] says so in words.
    fn finds_no_text(&self, _path: &str, _form: IncludeForm, _from: &str) -> bool {
        false
    }
}

/// A resolver that finds nothing, for sources without includes.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoIncludes;

impl IncludeResolver for NoIncludes {
    fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
        Err(format!("no include path is set up, so `{path}` cannot be found"))
    }
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, SourceMap, Span};

    #[test]
    fn a_line_feed_and_a_carriage_return_end_one_line() {
        for (text, starts) in [
            ("a\nb", vec![0, 2]),
            ("a\rb", vec![0, 2]),
            ("a\r\nb", vec![0, 3]),
            ("a\n\rb\n\r", vec![0, 3, 6]),
            ("a\n\r\nb", vec![0, 2, 4]),
            ("a\r\n\r\nb", vec![0, 3, 5]),
            ("\n\n\r\r", vec![0, 1, 3, 4]),
        ] {
            assert_eq!(super::line_starts(text), starts, "{text:?}");
        }
    }

    #[test]
    fn columns_of_long_lines_count_characters() {
        let line = "aé😀b".repeat(3 * BLOCK);
        let text = format!("// short\n{line}\nend");
        let mut sources = SourceMap::default();
        let id = sources.add("long", text.clone()).expect("there is room");
        let base = sources.file(id).base();
        let places = text.char_indices().skip(9).enumerate().step_by(977);
        for (column, (offset, _)) in places.take_while(|(column, _)| *column < 12 * BLOCK) {
            let at = base + offset as u32;
            let found = sources.location(Span::new(at, at)).expect("it is in the text");
            assert_eq!((found.line, found.column as usize), (2, column + 1));
        }
    }
}
