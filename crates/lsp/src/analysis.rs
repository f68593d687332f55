//! [`Analysis`]: a compiled program with the index of its names, and the places of its spans in documents.
//!
//! *In:* what the compiler says of a program. *Out:* symbols at places of files, and places of spans. *Holds:* a file may be in a
//! program several times, as with a file of several stages; the same bytes then have the same offsets.

use super::project::{Compiled, ProgramKey};
use super::text::Text;
use glisten_front::index::{Index, Occurrence, Symbol, SymbolId, View, index};
use glisten_front::link::Program;
use glisten_front::source::{FileId, SourceMap, Span};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    /// The name of the file, as the compiler has it.
    pub(crate) file: String,
    /// The first byte.
    pub(crate) start: usize,
    /// One past the last byte.
    pub(crate) end: usize,
}

/// A compiled program.
pub(crate) struct Analysis {
    /// Its key.
    pub(crate) key: ProgramKey,
    /// The compiler's findings.
    pub(crate) compiled: Compiled,
    /// The last program without errors.
    pub(crate) good: Option<Rc<Program>>,
    index: OnceCell<Index>,
    texts: RefCell<BTreeMap<FileId, Rc<Text>>>,
}

impl Analysis {
    /// The analysis of a program; `before` is the last one that had no errors.
    pub(crate) fn new(key: ProgramKey, mut compiled: Compiled, before: Option<Rc<Program>>) -> Self {
        let good = compiled.program.take().map(Rc::new).or(before);
        Self { key, compiled, good, index: OnceCell::new(), texts: RefCell::default() }
    }

    /// The texts.
    pub(crate) fn sources(&self) -> &SourceMap {
        &self.compiled.sources
    }

    /// The names.
    pub(crate) fn index(&self) -> &Index {
        self.index.get_or_init(|| index(&self.compiled.sources, &self.compiled.inspection))
    }

    /// The texts of a file.
    pub(crate) fn files(&self, path: &Path) -> impl Iterator<Item = FileId> {
        let name = path.to_string_lossy().into_owned();
        self.sources().files().filter(move |(_, file)| file.name() == name).map(|(id, _)| id)
    }

    /// Whether the program has a file.
    pub(crate) fn has(&self, path: &Path) -> bool {
        self.files(path).next().is_some()
    }

    /// The paths of all files.
    pub(crate) fn paths(&self) -> Vec<PathBuf> {
        let mut paths: Vec<PathBuf> = self.sources().files().map(|(_, file)| PathBuf::from(file.name())).collect();
        paths.sort();
        paths.dedup();
        paths
    }

    /// The text of a file with its lines.
    pub(crate) fn text(&self, file: FileId) -> Rc<Text> {
        let new = || {
            let source = self.sources().file(file);
            Rc::new(Text::new(source.shown().clone()).with_part(source.text().clone()))
        };
        Rc::clone(self.texts.borrow_mut().entry(file).or_insert_with(new))
    }

    /// Where a span is written, whatever macro use brought it.
    pub(crate) fn place(&self, span: Span) -> Option<(FileId, Range<usize>)> {
        let id = self.sources().file_of(span)?;
        let base = self.sources().file(id).base();
        Some((id, (span.start.checked_sub(base)?) as usize..(span.end.max(span.start).checked_sub(base)?) as usize))
    }

    /// Where a span is written, by the name of the file.
    pub(crate) fn named_place(&self, span: Span) -> Option<Place> {
        let (id, range) = self.place(span)?;
        Some(Place { file: self.sources().file(id).name().to_owned(), start: range.start, end: range.end })
    }

    /// The occurrence of a name at an offset of a file.
    pub(crate) fn occurrence(&self, path: &Path, offset: usize) -> Option<Occurrence> {
        let bases = self.files(path).map(|id| self.sources().file(id).base());
        bases.filter_map(|base| self.index().at(base + offset as u32).copied()).next()
    }

    /// The occurrences of names in a file, by the offsets at which they begin.
    pub(crate) fn occurrences(&self, path: &Path) -> BTreeMap<usize, Occurrence> {
        let mut found = BTreeMap::new();
        for id in self.files(path) {
            let file = self.sources().file(id);
            for occurrence in self.index().within(file.base(), file.end() + 1) {
                found.entry((occurrence.span.start - file.base()) as usize).or_insert(*occurrence);
            }
        }
        found
    }

    /// The symbol of an occurrence.
    pub(crate) fn symbol(&self, id: SymbolId) -> &Symbol {
        self.index().symbol(id)
    }

    /// The views that read a file.
    pub(crate) fn views_of(&self, path: &Path) -> Vec<&View> {
        let files: Vec<FileId> = self.files(path).collect();
        let all = self.compiled.inspection.views();
        let reads = |number: usize| {
            self.compiled.read.get(number).is_some_and(|read| files.iter().any(|file| read.contains(file)))
        };
        all.filter(|(number, _)| reads(*number)).map(|(_, view)| view).collect()
    }

    /// The occurrences of a symbol, each place once.
    pub(crate) fn places_of(&self, symbol: SymbolId) -> Vec<(Place, Occurrence)> {
        let mut places: Vec<(Place, Occurrence)> =
            self.index().of(symbol).filter_map(|found| Some((self.named_place(found.span)?, *found))).collect();
        places.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.role.cmp(&b.1.role)));
        places.dedup_by(|a, b| a.0 == b.0);
        places
    }
}
