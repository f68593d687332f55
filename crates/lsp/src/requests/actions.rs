//! Fixes of diagnostics (LSP 3.17, `textDocument/codeAction`): each by itself, all safe ones at once (`source.fixAll`), and a comment
//! that allows a finding.

use super::diagnostics::{diagnostic, location};
use super::rename::workspace_edit;
use crate::analysis::Analysis;
use crate::state::State;
use crate::uri;
use glisten_front::diagnostic::{Applicability, Diagnostic as Finding, Fix};
use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams, Position, Range, TextEdit, WorkspaceEdit,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Answers the request.
pub(super) fn actions(state: &mut State<'_>, params: &CodeActionParams) -> Option<Vec<CodeActionOrCommand>> {
    let path = uri::path(&params.text_document.uri);
    let analyses = state.analyses_of(&path);
    let wants = |kind: &CodeActionKind| {
        let is_in = |only: &CodeActionKind| {
            kind.as_str() == only.as_str() || kind.as_str().starts_with(&format!("{}.", only.as_str()))
        };
        params.context.only.as_ref().is_none_or(|only| only.iter().any(is_in))
    };
    let mut actions: Vec<CodeAction> = Vec::new();
    if wants(&CodeActionKind::QUICKFIX) {
        for analysis in &analyses {
            for finding in &analysis.compiled.findings {
                if is_at(state, analysis, finding, &path, &params.range) {
                    quick(state, analysis, finding, &path, &mut actions);
                }
            }
        }
    }
    let asks_for_all =
        params.context.only.as_ref().is_some_and(|only| only.iter().any(|kind| kind.as_str().starts_with("source")));
    if asks_for_all && wants(&CodeActionKind::SOURCE_FIX_ALL) {
        actions.extend(all(state, &analyses, &path));
    }
    Some(actions.into_iter().map(CodeActionOrCommand::CodeAction).collect())
}

/// Whether a finding is of a file, in a range.
fn is_at(state: &State<'_>, analysis: &Analysis, finding: &Finding, path: &Path, range: &Range) -> bool {
    let Some(found) = location(state, analysis, finding.primary.span) else { return false };
    uri::path(&found.uri) == path && found.range.start <= range.end && range.start <= found.range.end
}

fn quick(state: &State<'_>, analysis: &Rc<Analysis>, finding: &Finding, path: &Path, actions: &mut Vec<CodeAction>) {
    let shown = diagnostic(state, analysis, finding);
    let mut add = |title: String, edit: WorkspaceEdit, is_preferred: bool| {
        let is_known = actions.iter().any(|action| action.title == title && action.edit.as_ref() == Some(&edit));
        if !is_known {
            actions.push(CodeAction {
                title,
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![shown.clone()]),
                edit: Some(edit),
                is_preferred: Some(is_preferred),
                ..CodeAction::default()
            });
        }
    };
    for fix in &finding.fixes {
        if let Some(changes) = changes(state, analysis, fix) {
            let is_safe = fix.applicability == Applicability::Safe;
            add(fix.title.clone(), workspace_edit(state, changes.into_iter().collect()), is_safe);
        }
    }
    let can_be_allowed = !finding.is_error() || finding.severity != finding.code.severity;
    if let Some(edit) = can_be_allowed.then(|| allowing(state, finding, path, shown.range.start)).flatten() {
        let title = format!("Allow {} ({}) here", finding.code.id, finding.code.name);
        add(title, workspace_edit(state, vec![(path.to_owned(), vec![edit])]), false);
    }
}

/// The comment that allows a finding, above its line: above the first one, if `\` joins several. Nothing if that is in no shader, and a
/// host has other comments.
fn allowing(state: &State<'_>, finding: &Finding, path: &Path, start: Position) -> Option<TextEdit> {
    let text = &state.documents.get(path)?.text;
    let line = text.first_joined(start.line as usize);
    let place = text.start_of(line);
    let offset = text.offset(start, state.encoding);
    let pieces = state.pieces(path).unwrap_or_default();
    let piece = pieces.iter().find(|piece| piece.inside.start <= offset && offset <= piece.inside.end);
    if piece.is_some_and(|piece| place < piece.inside.start && !piece.has_own_comments) {
        return None;
    }
    let code = text.line(line);
    let indent = code.get(..code.len() - code.trim_start().len()).unwrap_or("");
    let at = Position { line: u32::try_from(line).ok()?, character: 0 };
    let new_text = format!("{indent}// glisten: allow({})\n", finding.code.id);
    Some(TextEdit { range: Range { start: at, end: at }, new_text })
}

/// The edits of a fix by file; `None` if one of them is in no file, or in a macro's body.
fn changes(state: &State<'_>, analysis: &Analysis, fix: &Fix) -> Option<BTreeMap<PathBuf, Vec<TextEdit>>> {
    let mut changes: BTreeMap<PathBuf, Vec<TextEdit>> = BTreeMap::new();
    for edit in &fix.edits {
        let place = analysis.named_place(edit.span).filter(|place| !place.file.starts_with('<'))?;
        if edit.span.expansion.is_some() {
            return None;
        }
        let found = state.location_of(analysis, &place)?;
        let list = changes.entry(PathBuf::from(place.file)).or_default();
        list.push(TextEdit { range: found.range, new_text: edit.text.clone() });
    }
    (!changes.is_empty()).then_some(changes)
}

/// All safe fixes of a document, those that overlap an earlier one left out.
fn all(state: &State<'_>, analyses: &[Rc<Analysis>], path: &Path) -> Option<CodeAction> {
    let mut edits: Vec<TextEdit> = Vec::new();
    for analysis in analyses {
        for fix in analysis.compiled.findings.iter().flat_map(|finding| finding.fixes.first()) {
            let Some(mut changes) = changes(state, analysis, fix) else { continue };
            let own = changes.remove(path).unwrap_or_default();
            let overlaps = |new: &TextEdit| {
                edits.iter().any(|old| new.range.start <= old.range.end && old.range.start <= new.range.end)
            };
            let is_safe = fix.applicability == Applicability::Safe;
            if is_safe && changes.is_empty() && !own.iter().any(overlaps) {
                edits.extend(own);
            }
        }
    }
    if edits.is_empty() {
        return None;
    }
    edits.sort_by_key(|edit| edit.range.start);
    Some(CodeAction {
        title: "Apply all safe fixes".to_owned(),
        kind: Some(CodeActionKind::SOURCE_FIX_ALL),
        edit: Some(workspace_edit(state, vec![(path.to_owned(), edits)])),
        ..CodeAction::default()
    })
}
