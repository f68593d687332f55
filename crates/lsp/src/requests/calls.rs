//! Who calls a function, and whom it calls (LSP 3.17, `textDocument/prepareCallHierarchy`).

use super::definition::everywhere;
use crate::analysis::Analysis;
use crate::describe;
use crate::state::{Point, State};
use crate::uri;
use glisten_front::analysis::Denoted;
use glisten_front::index::{Occurrence, Role, SymbolId};
use glisten_front::source::Span;
use glisten_front::syntax::ast::DeclarationKind;
use lsp_types::{
    CallHierarchyIncomingCall, CallHierarchyItem, CallHierarchyOutgoingCall, Range, SymbolKind,
    TextDocumentPositionParams,
};
use std::rc::Rc;

/// The function at a place.
pub(super) fn prepare(state: &mut State<'_>, at: &TextDocumentPositionParams) -> Option<Vec<CallHierarchyItem>> {
    let point = state.point(at)?;
    let (analysis, found) = state.occurrence(&point)?;
    Some(vec![item(state, &analysis, found.symbol)?])
}

/// The item of a function.
fn item(state: &State<'_>, analysis: &Analysis, symbol: SymbolId) -> Option<CallHierarchyItem> {
    let found = analysis.symbol(symbol);
    let &(view, denoted @ Denoted::Function(_)) = found.places.first()? else { return None };
    let own = *found.declarations.first()?;
    let whole = function_around(analysis, own).map_or(own, |(_, whole)| whole);
    let location = state.location(analysis, own)?;
    let range = state.location(analysis, whole).map_or(location.range, |whole| whole.range);
    Some(CallHierarchyItem {
        name: found.name.clone(),
        kind: SymbolKind::FUNCTION,
        tags: None,
        detail: describe::declaration(analysis, view, denoted),
        uri: location.uri,
        range,
        selection_range: location.range,
        data: None,
    })
}

/// The function, with its name, in which a place is.
pub(super) fn function_around(analysis: &Analysis, span: Span) -> Option<(Span, Span)> {
    for (_, view) in analysis.compiled.inspection.views() {
        for declaration in &view.ast.declarations {
            let (DeclarationKind::Function(header, _) | DeclarationKind::Prototype(header)) = &declaration.kind else {
                continue;
            };
            let whole = analysis.sources().call_site(declaration.span);
            if whole.start <= span.start && span.end <= whole.end {
                return Some((header.name.span, whole));
            }
        }
    }
    None
}

/// The function of an item, found again at its place.
fn again(state: &mut State<'_>, item: &CallHierarchyItem) -> Option<(Rc<Analysis>, Occurrence)> {
    let path = uri::path(&item.uri);
    let analyses = state.analyses_of(&path);
    for analysis in &analyses {
        let Some(file) = analysis.files(&path).next() else { continue };
        let text = (*analysis.text(file)).clone();
        let offset = text.offset(item.selection_range.start, state.encoding);
        let point = Point { path: path.clone(), offset, text, analyses: vec![Rc::clone(analysis)] };
        if let Some(found) = state.occurrence(&point) {
            return Some(found);
        }
    }
    None
}

/// The calls of a function.
pub(super) fn incoming(state: &mut State<'_>, of: &CallHierarchyItem) -> Option<Vec<CallHierarchyIncomingCall>> {
    let (analysis, found) = again(state, of)?;
    let mut calls: Vec<CallHierarchyIncomingCall> = Vec::new();
    for (analysis, places) in everywhere(state, &analysis, &found, None).0 {
        for (_, occurrence) in places.iter().filter(|(_, occurrence)| occurrence.role == Role::Read) {
            let Some((name, _)) = function_around(&analysis, occurrence.span) else { continue };
            let Some(caller) = analysis.index().at(name.start) else { continue };
            let Some(from) = item(state, &analysis, caller.symbol) else { continue };
            let Some(range) = state.location(&analysis, occurrence.span).map(|location| location.range) else {
                continue;
            };
            match calls
                .iter_mut()
                .find(|call| call.from.uri == from.uri && call.from.selection_range == from.selection_range)
            {
                Some(call) => add(&mut call.from_ranges, range),
                None => calls.push(CallHierarchyIncomingCall { from, from_ranges: vec![range] }),
            }
        }
    }
    Some(calls)
}

/// The functions that a function calls.
pub(super) fn outgoing(state: &mut State<'_>, of: &CallHierarchyItem) -> Option<Vec<CallHierarchyOutgoingCall>> {
    let (analysis, found) = again(state, of)?;
    let own = *analysis.symbol(found.symbol).declarations.first()?;
    let (_, whole) = function_around(&analysis, own)?;
    let mut calls: Vec<CallHierarchyOutgoingCall> = Vec::new();
    for occurrence in analysis.index().within(whole.start, whole.end).iter().filter(|found| found.role == Role::Read) {
        let Some(to) = item(state, &analysis, occurrence.symbol) else { continue };
        let Some(range) = state.location(&analysis, occurrence.span).map(|location| location.range) else { continue };
        match calls.iter_mut().find(|call| call.to.uri == to.uri && call.to.selection_range == to.selection_range) {
            Some(call) => add(&mut call.from_ranges, range),
            None => calls.push(CallHierarchyOutgoingCall { to, from_ranges: vec![range] }),
        }
    }
    Some(calls)
}

fn add(ranges: &mut Vec<Range>, range: Range) {
    if !ranges.contains(&range) {
        ranges.push(range);
    }
}
