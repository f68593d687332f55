//! [`State`]: the open documents, the programs that they belong to, and what is known of them.
//!
//! *In:* documents as they change. *Out:* results of the analysis of a document's programs, made when they are asked for and kept until one
//! of their files changes. *Holds:* a header is seen in the programs that include it.

use super::analysis::{Analysis, Place};
use super::client::Client;
use super::cut::{cut, mended};
use super::project::{Piece, ProgramKey, Project};
use super::text::{Encoding, Text};
use super::uri;
use glisten_front::index::Occurrence;
use glisten_front::link::Program;
use glisten_front::source::Span;
use lsp_types::{Location, TextDocumentPositionParams, Uri};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// The number of programs that are kept in any case.
const MAX_KEPT: usize = 64;
/// The largest number of programs in which a header is seen.
const MAX_CONTEXTS: usize = 6;

/// An open document.
pub(crate) struct Document {
    /// Its name as the editor spells it.
    pub(crate) uri: Uri,
    /// Its version.
    pub(crate) version: i32,
    /// Its text.
    pub(crate) text: Text,
}

/// All that the server knows.
pub(crate) struct State<'p> {
    /// The files.
    pub(crate) project: &'p mut dyn Project,
    /// The units of positions.
    pub(crate) encoding: Encoding,
    /// The editor.
    pub(crate) client: Client,
    /// The folders of the workspace.
    pub(crate) folders: Vec<PathBuf>,
    /// The open documents.
    pub(crate) documents: BTreeMap<PathBuf, Document>,
    /// Requests to send to the editor.
    pub(crate) outbox: Vec<(&'static str, Value)>,
    /// Whether diagnostics are to be told again.
    pub(crate) is_changed: bool,
    /// The includers that were chosen for headers.
    shown: BTreeMap<PathBuf, PathBuf>,
    contexts: BTreeMap<PathBuf, Vec<ProgramKey>>,
    analyses: BTreeMap<ProgramKey, Rc<Analysis>>,
    good: BTreeMap<ProgramKey, Rc<Program>>,
}

/// A place of a document that a request is about.
pub(crate) struct Point {
    /// The file.
    pub(crate) path: PathBuf,
    /// The offset.
    pub(crate) offset: usize,
    /// The text.
    pub(crate) text: Text,
    /// The programs of the file, the first one first.
    pub(crate) analyses: Vec<Rc<Analysis>>,
}

impl<'p> State<'p> {
    /// A state without documents.
    pub(crate) fn new(project: &'p mut dyn Project) -> Self {
        let (encoding, client) = (Encoding::default(), Client::default());
        let (folders, documents, contexts) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        let (analyses, good, shown) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        let (outbox, is_changed) = (Vec::new(), false);
        Self { project, encoding, client, folders, documents, outbox, is_changed, shown, contexts, analyses, good }
    }

    /// Opens or changes a document; `None` closes it.
    pub(crate) fn set(&mut self, path: &Path, document: Option<Document>) {
        self.project.overlay().set(path, document.as_ref().map(|document| Arc::clone(&document.text.text)));
        match document {
            Some(document) => {
                let lines = include_lines(&document.text.text);
                if self.project.pieces(path, "").is_some() {
                    // An edit may bring shaders, or take them away.
                    self.contexts.remove(path);
                }
                let before = self.documents.insert(path.to_owned(), document);
                if before.is_none_or(|before| include_lines(&before.text.text) != lines) {
                    self.project.includes_changed(path);
                    self.contexts.clear();
                }
            }
            None => {
                self.documents.remove(path);
                self.contexts.clear();
                self.keep_what_is_open();
            }
        }
        self.forget(path);
    }

    /// Forgets what depends on a file.
    pub(crate) fn forget(&mut self, path: &Path) {
        self.analyses.retain(|key, analysis| !analysis.has(path) && !key.files.iter().any(|file| file == path));
    }

    /// Does what waits until the editor rests. Whether findings changed.
    pub(crate) fn rest(&mut self) -> bool {
        let Some(key) = self.project.find_witnesses() else { return false };
        self.analyses.remove(&key);
        true
    }

    /// Forgets everything but the documents.
    pub(crate) fn reload(&mut self) {
        self.project.reload();
        self.contexts.clear();
        self.analyses.clear();
    }

    /// Makes everything again after a fault.
    pub(crate) fn recover(&mut self) {
        let overlay = self.project.overlay().clone();
        overlay.clear();
        for (path, document) in &self.documents {
            overlay.set(path, Some(Arc::clone(&document.text.text)));
        }
        self.reload();
    }

    /// Forgets a program of which no file is open.
    pub(crate) fn release(&mut self, key: &ProgramKey) {
        let is_open = |analysis: &Rc<Analysis>| self.documents.keys().any(|path| analysis.has(path));
        if !self.analyses.get(key).is_some_and(is_open) {
            self.analyses.remove(key);
            self.good.remove(key);
        }
    }

    /// Forgets the programs of which no file is open.
    fn keep_what_is_open(&mut self) {
        let documents = &self.documents;
        let is_open = |analysis: &Analysis| documents.keys().any(|path| analysis.has(path));
        self.analyses.retain(|_, analysis| is_open(analysis));
        let analyses = &self.analyses;
        self.good.retain(|key, _| analyses.contains_key(key));
    }

    /// The program of a key as it is now.
    pub(crate) fn analysis(&mut self, key: &ProgramKey) -> Rc<Analysis> {
        if let Some(known) = self.analyses.get(key) {
            return Rc::clone(known);
        }
        let compiled = self.project.compile(key);
        let before = self.good.get(key).cloned();
        let analysis = Rc::new(Analysis::new(key.clone(), compiled, before));
        if let Some(good) = &analysis.good {
            self.good.insert(key.clone(), Rc::clone(good));
        }
        self.analyses.insert(key.clone(), Rc::clone(&analysis));
        analysis
    }

    /// The programs that a file belongs to: its own, else those that include it, else itself alone.
    pub(crate) fn analyses_of(&mut self, path: &Path) -> Vec<Rc<Analysis>> {
        if let Some(known) = self.contexts.get(path).cloned() {
            return known.iter().map(|key| self.analysis(key)).collect();
        }
        let own = self.project.programs_of(path);
        let own: Vec<Rc<Analysis>> = own.iter().map(|key| self.analysis(key)).collect();
        if self.project.pieces(path, "").is_some() {
            self.contexts.insert(path.to_owned(), own.iter().map(|analysis| analysis.key.clone()).collect());
            return own;
        }
        // What others include is checked there, if it is wrong alone.
        let is_whole = |analysis: &Rc<Analysis>| {
            let has_main = analysis.compiled.inspection.views().any(|(_, view)| view.shader.main.is_some());
            has_main || analysis.compiled.findings.iter().all(|finding| !finding.is_error())
        };
        let found = if !own.is_empty() && own.iter().any(is_whole) {
            own
        } else {
            let mut including = self.including(path);
            if let Some(shown) = self.shown.get(path) {
                let is_it = |analysis: &Rc<Analysis>| analysis.has(shown);
                if including.iter().any(is_it) {
                    including.retain(is_it);
                }
            }
            match (including.is_empty(), own.is_empty()) {
                (false, _) => including,
                (true, false) => own,
                (true, true) => {
                    let key = self.project.alone(path);
                    vec![self.analysis(&key)]
                }
            }
        };
        self.contexts.insert(path.to_owned(), found.iter().map(|analysis| analysis.key.clone()).collect());
        found
    }

    fn including(&mut self, path: &Path) -> Vec<Rc<Analysis>> {
        let folders = self.folders_of(path);
        // Open programs are known to be of interest.
        let open: Vec<PathBuf> = self.documents.keys().filter(|other| *other != path).cloned().collect();
        let mut keys: Vec<ProgramKey> = Vec::new();
        for other in open {
            keys.extend(self.project.programs_of(&other));
        }
        keys.extend(self.project.includers_of(path, &folders));
        let mut found: Vec<Rc<Analysis>> = Vec::new();
        for key in keys {
            if found.len() >= MAX_CONTEXTS {
                break;
            }
            let is_new = found.iter().all(|analysis| analysis.key != key);
            let analysis = self.analysis(&key);
            if is_new && analysis.has(path) && !key.files.iter().any(|file| file == path) {
                found.push(analysis);
            }
        }
        found
    }

    /// The files of the programs that include a file.
    pub(crate) fn includers(&mut self, path: &Path) -> Vec<PathBuf> {
        let mut files = Vec::new();
        for analysis in self.including(path) {
            // Of a program's files only some include it.
            for (number, _) in analysis.compiled.inspection.views() {
                let Some(read) = analysis.compiled.read.get(number) else { continue };
                let mut names = read.iter().map(|file| PathBuf::from(analysis.sources().file(*file).name()));
                if let Some(own) = names.next().filter(|_| names.any(|name| name == path)) {
                    files.push(own);
                }
            }
        }
        files
    }

    /// The includer that a header is seen in, if one was chosen.
    pub(crate) fn shown_in(&self, path: &Path) -> Option<PathBuf> {
        self.shown.get(path).cloned()
    }

    /// Chooses the includer that a header is seen in.
    pub(crate) fn show_in(&mut self, path: &Path, includer: Option<PathBuf>) {
        match includer {
            Some(includer) => self.shown.insert(path.to_owned(), includer),
            None => self.shown.remove(path),
        };
        self.contexts.remove(path);
    }

    /// All programs that read a file and use one of these words: its own, and those that include it. The second value is whether
    /// there are too many.
    pub(crate) fn programs_with(&mut self, path: &Path, words: &[&str]) -> (Vec<Rc<Analysis>>, bool) {
        let own = self.project.programs_of(path);
        let mut found: Vec<Rc<Analysis>> = own.iter().map(|key| self.analysis(key)).collect();
        found.extend(self.including(path));
        let (users, is_cut) = self.project.users_of(path, &self.folders_of(path), words);
        for key in users {
            let analysis = self.analysis(&key);
            if analysis.has(path) {
                found.push(analysis);
            }
        }
        (found, is_cut)
    }

    /// The folders of the workspace, and that of a file outside of it.
    fn folders_of(&self, path: &Path) -> Vec<PathBuf> {
        let mut folders = self.folders.clone();
        if !folders.iter().any(|folder| path.starts_with(folder)) {
            folders.extend(path.parent().map(Path::to_owned));
        }
        folders
    }

    /// Forgets programs that no document is seen in, if there are many.
    pub(crate) fn trim(&mut self) {
        if self.analyses.len() > MAX_KEPT {
            let contexts = &self.contexts;
            self.analyses.retain(|key, _| contexts.values().any(|keys| keys.contains(key)));
            let analyses = &self.analyses;
            self.good.retain(|key, _| analyses.contains_key(key));
        }
    }

    /// The files of the programs of a document.
    pub(crate) fn known_files(&mut self, path: &Path) -> Vec<PathBuf> {
        let files = self.analyses_of(path).into_iter().flat_map(|analysis| analysis.paths());
        files.filter(|path| path.is_absolute()).collect()
    }

    /// Whether the programs of a file are those that include it, or none.
    pub(crate) fn is_header(&mut self, path: &Path) -> bool {
        let analyses = self.analyses_of(path);
        analyses.iter().all(|analysis| {
            !analysis.key.files.iter().any(|file| file == path) || analysis.key.name.ends_with(" alone")
        })
    }

    /// The place that a request is about.
    pub(crate) fn point(&mut self, at: &TextDocumentPositionParams) -> Option<Point> {
        let path = uri::path(&at.text_document.uri);
        let mut text = self.documents.get(&path)?.text.clone();
        let offset = text.offset(at.position, self.encoding);
        let mut analyses = self.analyses_of(&path);
        if let Some(pieces) = self.pieces(&path) {
            let is_here = |piece: &Piece| piece.inside.start <= offset && offset <= piece.inside.end;
            let piece = pieces.into_iter().find(is_here)?;
            text = text.with_part(piece.text);
            analyses.retain(|analysis| analysis.key.name == piece.program);
        }
        Some(Point { path, offset, text, analyses })
    }

    /// The shaders in the strings of an open document of another language.
    pub(crate) fn pieces(&self, path: &Path) -> Option<Vec<Piece>> {
        self.project.pieces(path, &self.documents.get(path)?.text.text)
    }

    /// The name at a place. Where the text is broken, it is cut after the name and read again.
    pub(crate) fn occurrence(&mut self, point: &Point) -> Option<(Rc<Analysis>, Occurrence)> {
        let found = |analysis: &Rc<Analysis>| {
            analysis.occurrence(&point.path, point.offset).map(|found| (Rc::clone(analysis), found))
        };
        if let Some(found) = point.analyses.iter().find_map(found) {
            return Some(found);
        }
        let word = point.text.word_at(point.offset)?;
        let first = point.analyses.first()?;
        let is_sound = first.compiled.findings.iter().all(|finding| !finding.is_error());
        let own = point.text.text.to_string();
        let texts = if is_sound { Vec::new() } else { mended(&own, word.end) };
        for text in std::iter::once(own).chain(texts) {
            let text = cut(&text, word.end, "");
            let Some(compiled) = self.project.probe(&first.key, &point.path, text.into(), None) else { continue };
            let analysis = Rc::new(Analysis::new(first.key.clone(), compiled, first.good.clone()));
            if let Some(found) = analysis.occurrence(&point.path, point.offset) {
                return Some((analysis, found));
            }
        }
        None
    }

    /// The URI of a file, as the editor spells it.
    pub(crate) fn uri(&self, path: &Path) -> Option<Uri> {
        self.documents.get(path).map(|document| document.uri.clone()).or_else(|| uri::of(path))
    }

    /// The path of a file that the compiler names: that of an embedded module is a copy.
    pub(crate) fn path_of(&self, name: &str) -> Option<PathBuf> {
        if name.starts_with('<') {
            return self.project.embedded(name);
        }
        Some(PathBuf::from(name))
    }

    /// The location of a span.
    pub(crate) fn location(&self, analysis: &Analysis, span: Span) -> Option<Location> {
        let (file, range) = analysis.place(span)?;
        let path = self.path_of(analysis.sources().file(file).name())?;
        Some(Location { uri: self.uri(&path)?, range: analysis.text(file).range(range, self.encoding) })
    }

    /// The location of a place.
    pub(crate) fn location_of(&self, analysis: &Analysis, place: &Place) -> Option<Location> {
        let file = analysis.files(Path::new(&place.file)).next()?;
        let path = self.path_of(&place.file)?;
        let range = analysis.text(file).range(place.start..place.end, self.encoding);
        Some(Location { uri: self.uri(&path)?, range })
    }
}

/// The lines of a text that may include files.
fn include_lines(text: &str) -> Vec<String> {
    let is_one =
        |line: &&str| line.trim_start().starts_with('#') && (line.contains("include") || line.contains("import"));
    text.lines().filter(is_one).map(str::to_owned).collect()
}
