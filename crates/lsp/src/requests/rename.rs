//! Renames (LSP 3.17, `textDocument/rename`): over all files and stages of all programs that share the declaration, over text that
//! conditions leave out, and over the scene files that name it.
//!
//! *Holds:* a rename after which any name would denote something else is refused: the edited texts are compiled, and what each name
//! denotes is compared. Names of the language, and words that it reserves, are refused (GLSL 1.50 §3.6, §3.7).

use super::Failure;
use super::definition::{InProgram, everywhere};
use super::scene;
use crate::analysis::{Analysis, Place};
use crate::builtins;
use crate::state::State;
use crate::text::Text;
use glisten_front::analysis::Denoted;
use glisten_front::index::{Index, Occurrence, SymbolId, SymbolKind};
use glisten_front::source::FileId;
use glisten_front::syntax::keywords;
use lsp_types::{
    DocumentChanges, OneOf, OptionalVersionedTextDocumentIdentifier, PrepareRenameResponse, RenameParams,
    TextDocumentEdit, TextDocumentPositionParams, TextEdit, WorkspaceEdit,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The places to change, by file.
type Edits = BTreeMap<PathBuf, BTreeSet<(usize, usize)>>;

/// Whether the name at a place can be renamed, and where it is.
pub(super) fn prepare(
    state: &mut State<'_>,
    at: &TextDocumentPositionParams,
) -> Result<Option<PrepareRenameResponse>, Failure> {
    let Some(point) = state.point(at) else { return Ok(None) };
    let Some((analysis, found)) = state.occurrence(&point) else { return Ok(None) };
    refuse_fixed(&analysis, &found)?;
    let Some(place) = analysis.named_place(found.span) else { return Ok(None) };
    Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
        range: point.text.range(place.start..place.end, state.encoding),
        placeholder: analysis.symbol(found.symbol).name.clone(),
    }))
}

/// Refuses names that are not the author's.
fn refuse_fixed(analysis: &Analysis, found: &Occurrence) -> Result<(), Failure> {
    let symbol = analysis.symbol(found.symbol);
    let name = &symbol.name;
    if symbol.kind == SymbolKind::Builtin || name.starts_with("gl_") {
        return Err(Failure::refused(format!("`{name}` is a name of the language")));
    }
    if name == "main" && matches!(symbol.places.first(), Some((_, Denoted::Function(_)))) {
        return Err(Failure::refused("`main` is where a shader begins"));
    }
    if symbol.kind == SymbolKind::Macro && symbol.declarations.is_empty() {
        return Err(Failure::refused(format!("no text defines the macro `{name}`")));
    }
    for span in &symbol.declarations {
        let Some(place) = analysis.named_place(*span) else { continue };
        if place.file.starts_with('<') {
            return Err(Failure::refused(format!("`{name}` is declared in {}, which is no file", place.file)));
        }
    }
    Ok(())
}

/// Refuses what is no name, or not the author's to give.
fn refuse_name(analysis: &Analysis, name: &str) -> Result<(), Failure> {
    let starts = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    if !starts || !name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
        return Err(Failure::refused(format!("`{name}` is not an identifier")));
    }
    if name.starts_with("gl_") || name.contains("__") || name.starts_with("GL_") {
        return Err(Failure::refused(format!("`{name}` is reserved (GLSL 1.50 §3.7)")));
    }
    if keywords::TABLE.iter().any(|row| row.spelling == name) {
        return Err(Failure::refused(format!("`{name}` is a word of the language")));
    }
    for (_, view) in analysis.compiled.inspection.views() {
        let is_known = builtins::describe(name, view.shader.version, view.shader.stage).is_some();
        let is_here = builtins::list(view.shader.version, builtins::extensions(view), view.shader.stage);
        if is_known && is_here.iter().any(|listed| listed.name == name) {
            return Err(Failure::refused(format!("`{name}` is built in: it would be hidden")));
        }
    }
    Ok(())
}

/// Answers the request.
pub(super) fn rename(state: &mut State<'_>, params: &RenameParams) -> Result<Option<WorkspaceEdit>, Failure> {
    let Some(point) = state.point(&params.text_document_position) else { return Ok(None) };
    let Some((analysis, found)) = state.occurrence(&point) else { return Ok(None) };
    refuse_fixed(&analysis, &found)?;
    let (old, new) = (analysis.symbol(found.symbol).name.clone(), params.new_name.as_str());
    if old == new {
        return Ok(None);
    }
    refuse_name(&analysis, new)?;
    let (all, is_cut) = everywhere(state, &analysis, &found, Some(new));
    if is_cut {
        return Err(Failure::refused(format!("too many programs use `{old}` or `{new}`")));
    }
    let mut edits = Edits::new();
    for (analysis, places) in &all {
        for (place, occurrence) in places {
            if occurrence.is_ambiguous {
                let message = format!("in the macro at {}, `{old}` has several meanings", shown(analysis, place));
                return Err(Failure::refused(message));
            }
            refuse_fixed(analysis, occurrence)?;
            edits.entry(PathBuf::from(&place.file)).or_default().insert((place.start, place.end));
        }
        add_unread(analysis, places, &old, &mut edits);
    }
    let texts = texts(state, &all, &edits);
    check(state, &all, &edits, &texts, new)?;
    let mut changes: Vec<(PathBuf, Vec<TextEdit>)> = Vec::new();
    for (path, places) in &edits {
        let Some(text) = texts.get(path) else { continue };
        let edit = |&(start, end): &(usize, usize)| TextEdit {
            range: text.range(start..end, state.encoding),
            new_text: new.to_owned(),
        };
        changes.push((path.clone(), places.iter().map(edit).collect()));
    }
    changes.extend(scene::edits(state, &all, new));
    Ok(Some(workspace_edit(state, changes)))
}

/// Edits of files as the editor wants them.
pub(super) fn workspace_edit(state: &State<'_>, changes: Vec<(PathBuf, Vec<TextEdit>)>) -> WorkspaceEdit {
    let mut edit = WorkspaceEdit::default();
    if state.client.versions {
        let document = |(path, edits): (PathBuf, Vec<TextEdit>)| {
            Some(TextDocumentEdit {
                text_document: OptionalVersionedTextDocumentIdentifier {
                    uri: state.uri(&path)?,
                    version: state.documents.get(&path).map(|document| document.version),
                },
                edits: edits.into_iter().map(OneOf::Left).collect(),
            })
        };
        edit.document_changes = Some(DocumentChanges::Edits(changes.into_iter().filter_map(document).collect()));
    } else {
        let change = |(path, edits): (PathBuf, Vec<TextEdit>)| Some((state.uri(&path)?, edits));
        edit.changes = Some(changes.into_iter().filter_map(change).collect());
    }
    edit
}

fn shown(analysis: &Analysis, place: &Place) -> String {
    let file = analysis.files(Path::new(&place.file)).next();
    let line = file.map_or(0, |file| analysis.text(file).line_of(place.start) + 1);
    let name = Path::new(&place.file).file_name().map(|name| name.to_string_lossy().into_owned());
    format!("{}:{line}", name.unwrap_or_else(|| place.file.clone()))
}

/// Adds the places of the name in text that the compiler does not read: left out by conditions, or in macros that nothing uses.
fn add_unread(analysis: &Analysis, places: &[(Place, Occurrence)], old: &str, edits: &mut Edits) {
    let Some((_, first)) = places.first() else { return };
    let symbol = analysis.symbol(first.symbol);
    let is_local =
        matches!(symbol.places.first(), Some((_, Denoted::Local(..)))) || symbol.kind == SymbolKind::MacroParameter;
    let is_member = matches!(symbol.places.first(), Some((_, Denoted::Member(..))));
    for (_, view) in analysis.compiled.inspection.views() {
        let directives = &view.ast.directives;
        let bodies = directives.definitions.iter().map(|definition| definition.body);
        for span in directives.inactive.iter().copied().chain(bodies.filter(|span| span.is_known())) {
            let Some((file, range)) = analysis.place(span) else { continue };
            let name = analysis.sources().file(file).name();
            let own = || places.iter().filter(|(place, _)| place.file == name);
            let (low, high) = (own().map(|(place, _)| place.start).min(), own().map(|(place, _)| place.end).max());
            let is_between = low.zip(high).is_some_and(|(low, high)| low <= range.start && range.end <= high);
            if name.starts_with('<') || low.is_none() || is_local && !is_between {
                continue;
            }
            for found in unread(analysis, file, range, old, is_member) {
                edits.entry(PathBuf::from(name)).or_default().insert(found);
            }
        }
    }
}

/// The places of a word in a range that the index does not have; for a member, those after a dot.
fn unread(analysis: &Analysis, file: FileId, range: Range<usize>, word: &str, is_member: bool) -> Vec<(usize, usize)> {
    let source = analysis.sources().file(file);
    let text = source.text().get(range.clone()).unwrap_or("");
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut found = Vec::new();
    for (at, _) in text.match_indices(word) {
        let (before, after) = (text.get(..at).unwrap_or(""), text.get(at + word.len()..).unwrap_or(""));
        let is_whole = !before.ends_with(is_part) && !after.starts_with(is_part);
        let is_after_dot = before.trim_end().ends_with('.');
        let start = range.start + at;
        let is_known = analysis.index().at(source.base() + start as u32).is_some();
        if is_whole && is_after_dot == is_member && !is_known && !crate::cut::is_in_comment(text, at) {
            found.push((start, start + word.len()));
        }
    }
    found
}

/// The texts of the files to change.
fn texts(state: &State<'_>, all: &[InProgram], edits: &Edits) -> BTreeMap<PathBuf, Text> {
    let mut texts = BTreeMap::new();
    for path in edits.keys() {
        let open = state.documents.get(path).map(|document| document.text.clone());
        let read = || {
            let found = all.iter().find_map(|(analysis, _)| Some((analysis, analysis.files(path).next()?)));
            found.map(|(analysis, file)| (*analysis.text(file)).clone())
        };
        if let Some(text) = open.or_else(read) {
            texts.insert(path.clone(), text);
        }
    }
    texts
}

/// Compiles the edited texts, and refuses if any name then denotes something else.
fn check(
    state: &mut State<'_>,
    all: &[InProgram],
    edits: &Edits,
    texts: &BTreeMap<PathBuf, Text>,
    new: &str,
) -> Result<(), Failure> {
    let overlay = state.project.overlay().clone();
    let before: Vec<(PathBuf, Option<Arc<str>>)> =
        texts.keys().map(|path| (path.clone(), overlay.text(path))).collect();
    for (path, text) in texts {
        overlay.set(path, Some(edited(&text.text, edits.get(path), new).into()));
    }
    let compiled: Vec<Analysis> = all
        .iter()
        .map(|(analysis, _)| Analysis::new(analysis.key.clone(), state.project.compile(&analysis.key), None))
        .collect();
    for (path, text) in before {
        overlay.set(&path, text);
    }
    for ((old, _), after) in all.iter().zip(&compiled) {
        if let Some(place) = first_difference(old, after, edits, new) {
            let message = format!("`{new}` would change what a name denotes: {}", shown(old, &place));
            return Err(Failure::refused(message));
        }
        let n_errors =
            |analysis: &Analysis| analysis.compiled.findings.iter().filter(|finding| finding.is_error()).count();
        if n_errors(after) > n_errors(old) {
            let error = after.compiled.findings.iter().find(|finding| finding.is_error());
            let message = error.map_or(String::new(), |error| error.message.clone());
            return Err(Failure::refused(format!("`{new}` would be an error: {message}")));
        }
    }
    Ok(())
}

fn edited(text: &str, places: Option<&BTreeSet<(usize, usize)>>, new: &str) -> String {
    let (mut result, mut at) = (String::with_capacity(text.len()), 0);
    for &(start, end) in places.into_iter().flatten() {
        result.push_str(text.get(at..start).unwrap_or(""));
        result.push_str(new);
        at = end;
    }
    result.push_str(text.get(at..).unwrap_or(""));
    result
}

/// The first name whose meaning differs before and after.
fn first_difference(old: &Analysis, new: &Analysis, edits: &Edits, name: &str) -> Option<Place> {
    let none = BTreeSet::new();
    let moved = |place: &Place| {
        let places = edits.get(Path::new(&place.file)).unwrap_or(&none);
        let (mut start, mut is_renamed) = (place.start as isize, false);
        for &(from, to) in places {
            if to <= place.start {
                start += name.len() as isize - (to - from) as isize;
            }
            is_renamed |= from == place.start && to == place.end;
        }
        let length = if is_renamed { name.len() } else { place.end - place.start };
        Place { file: place.file.clone(), start: start as usize, end: start as usize + length }
    };
    let after: BTreeMap<Place, SymbolId> = occurrences(new, new.index()).into_iter().collect();
    let (mut forth, mut back) = (BTreeMap::new(), BTreeMap::new());
    let before = occurrences(old, old.index());
    if before.len() != after.len() {
        return before
            .into_iter()
            .map(|(place, _)| place)
            .find(|place| !after.contains_key(&moved(place)))
            .or_else(|| Some(Place { file: old.key.files.first()?.to_string_lossy().into_owned(), start: 0, end: 0 }));
    }
    for (place, symbol) in before {
        let Some(&other) = after.get(&moved(&place)) else { return Some(place) };
        let is_same = *forth.entry(symbol).or_insert(other) == other && *back.entry(other).or_insert(symbol) == symbol;
        if !is_same {
            return Some(place);
        }
    }
    None
}

/// The places of all names, each once.
fn occurrences(analysis: &Analysis, index: &Index) -> Vec<(Place, SymbolId)> {
    let mut all: Vec<(Place, SymbolId)> = index
        .occurrences()
        .iter()
        .filter_map(|found| Some((analysis.named_place(found.span)?, found.symbol)))
        .collect();
    all.sort();
    all.dedup_by(|a, b| a.0 == b.0);
    all
}
