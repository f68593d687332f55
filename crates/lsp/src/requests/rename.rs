//! Renames (LSP 3.17, `textDocument/rename`): over all files and stages of all programs that share the declaration, over text that
//! conditions leave out, and over the scene files that name it.
//!
//! *Holds:* a rename after which any name would denote something else is refused: the edited texts are compiled, and what each name
//! denotes is compared. Names of the language, and words that it reserves, are refused (GLSL 1.50 §3.6, §3.7).

use super::Failure;
use super::definition::{InProgram, everywhere};
use super::scene;
use super::unread::{Names, unread};
use crate::analysis::{Analysis, Place};
use crate::builtins;
use crate::state::State;
use crate::text::Text;
use glisten_front::analysis::Denoted;
use glisten_front::index::{Occurrence, SymbolId, SymbolKind};
use glisten_front::syntax::keywords;
use lsp_types::{
    DocumentChanges, OneOf, OptionalVersionedTextDocumentIdentifier, PrepareRenameResponse, RenameParams,
    TextDocumentEdit, TextDocumentPositionParams, TextEdit, WorkspaceEdit,
};
use std::collections::{BTreeMap, BTreeSet};
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
        let unread = unread(analysis, places, Names { old: &old, new });
        if let Some(place) = unread.captured {
            return Err(changes_meaning(new, analysis, &place));
        }
        for place in unread.places {
            edits.entry(PathBuf::from(place.file)).or_default().insert((place.start, place.end));
        }
    }
    let texts = texts(state, &all, &edits);
    check(state, &all, &edits, &texts, [&old, new])?;
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

fn changes_meaning(new: &str, analysis: &Analysis, place: &Place) -> Failure {
    Failure::refused(format!("`{new}` would change what a name denotes: {}", shown(analysis, place)))
}

fn shown(analysis: &Analysis, place: &Place) -> String {
    let file = analysis.files(Path::new(&place.file)).next();
    let line = file.map_or(0, |file| analysis.text(file).line_of(place.start) + 1);
    let name = Path::new(&place.file).file_name().map(|name| name.to_string_lossy().into_owned());
    format!("{}:{line}", name.unwrap_or_else(|| place.file.clone()))
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
    [renamed, new]: [&str; 2],
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
        if let Some(place) = first_difference(old, after, edits, [renamed, new]) {
            return Err(changes_meaning(new, old, &place));
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
fn first_difference(old: &Analysis, new: &Analysis, edits: &Edits, [renamed, name]: [&str; 2]) -> Option<Place> {
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
    let (before, after) = (occurrences(old), occurrences(new));
    let (mut forth, mut back) = (BTreeMap::new(), BTreeMap::new());
    for (number, meant) in before.iter().enumerate() {
        let is_same = after.get(number).is_some_and(|other| {
            let (symbol, renamed) = (meant.symbol, other.symbol);
            other.place == moved(&meant.place)
                && other.is_ambiguous == meant.is_ambiguous
                && *forth.entry(symbol).or_insert(renamed) == renamed
                && *back.entry(renamed).or_insert(symbol) == symbol
        });
        // Nobody knows which of its meanings the name of one more use has.
        let is_unsure = meant.is_ambiguous && [name, renamed].contains(&&*old.symbol(meant.symbol).name);
        if !is_same || is_unsure {
            return Some(meant.place.clone());
        }
    }
    let is_more = after.len() > before.len();
    is_more.then(|| Place {
        file: old.key.files.first().map_or_else(String::new, |file| file.to_string_lossy().into_owned()),
        start: 0,
        end: 0,
    })
}

/// A name where it is written.
struct Meant {
    place: Place,
    symbol: SymbolId,
    /// Whether uses of a macro give it several meanings.
    is_ambiguous: bool,
}

/// All names in the order of their files and places. A file that is read several times has its names as often.
fn occurrences(analysis: &Analysis) -> Vec<Meant> {
    let meant = |found: &Occurrence| {
        let place = analysis.named_place(found.span)?;
        Some((found.span.start, Meant { place, symbol: found.symbol, is_ambiguous: found.is_ambiguous }))
    };
    let mut all: Vec<(u32, Meant)> = analysis.index().occurrences().iter().filter_map(meant).collect();
    all.sort_by(|a, b| (&a.1.place, a.0).cmp(&(&b.1.place, b.0)));
    all.into_iter().map(|(_, meant)| meant).collect()
}
