//! Definition, declaration, type, references and highlights (LSP 3.17, "Language Features").
//!
//! *Holds:* a name leads through includes, macros and stages: what passes between two stages is declared in both. On the name of an
//! include, the definition is the file.

use crate::analysis::{Analysis, Place};
use crate::project::ProgramKey;
use crate::state::{Point, State};
use glisten_front::analysis::Denoted;
use glisten_front::hir::{Type, TypeId};
use glisten_front::index::{Occurrence, Role, Symbol};
use lsp_types::{
    DocumentHighlight, DocumentHighlightKind, GotoDefinitionResponse, Location, Position, Range, ReferenceParams,
    TextDocumentPositionParams,
};
use std::collections::BTreeSet;
use std::rc::Rc;

/// Where the name is defined. On the definition itself of something that passes between stages, the other side.
pub(super) fn definition(state: &mut State<'_>, at: &TextDocumentPositionParams) -> Option<GotoDefinitionResponse> {
    let point = state.point(at)?;
    if let Some(target) = included(state, &point) {
        return Some(GotoDefinitionResponse::Scalar(target));
    }
    let (analysis, found) = state.occurrence(&point)?;
    let places = declarations(&analysis, analysis.symbol(found.symbol));
    let mut chosen: Vec<&Place> = own_side(&analysis, &point, &places);
    let here = analysis.named_place(found.span);
    let is_here = |place: &&Place| Some(*place) == here.as_ref();
    if chosen.iter().all(is_here) && places.len() > 1 {
        chosen = places.iter().filter(|place| !is_here(place)).collect();
    }
    respond(state, &analysis, &chosen)
}

/// All declarations of the name, in all stages.
pub(super) fn declaration(state: &mut State<'_>, at: &TextDocumentPositionParams) -> Option<GotoDefinitionResponse> {
    let point = state.point(at)?;
    if let Some(target) = included(state, &point) {
        return Some(GotoDefinitionResponse::Scalar(target));
    }
    let (analysis, found) = state.occurrence(&point)?;
    let places = declarations(&analysis, analysis.symbol(found.symbol));
    respond(state, &analysis, &places.iter().collect::<Vec<_>>())
}

/// Where the struct of the name's type is declared.
pub(super) fn type_definition(
    state: &mut State<'_>,
    at: &TextDocumentPositionParams,
) -> Option<GotoDefinitionResponse> {
    let point = state.point(at)?;
    let (analysis, found) = state.occurrence(&point)?;
    let symbol = analysis.symbol(found.symbol);
    let types = &analysis.compiled.inspection.types;
    let mut ty = symbol.places.iter().find_map(|&(view, denoted)| type_of(&analysis, view, denoted))?;
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    let Type::Struct(id) = types.get(ty) else { return None };
    let location = state.location(&analysis, types.structure(id).span)?;
    Some(GotoDefinitionResponse::Scalar(location))
}

/// The type of what a name denotes.
pub(super) fn type_of(analysis: &Analysis, view: usize, denoted: Denoted) -> Option<TypeId> {
    let inspection = &analysis.compiled.inspection;
    let shader = &inspection.view(view)?.shader;
    Some(match denoted {
        Denoted::Global(id) => shader.globals.get(id.index())?.ty,
        Denoted::Local(function, local) => shader.functions.get(function.index())?.locals.get(local.index())?.ty,
        Denoted::Function(function) => shader.functions.get(function.index())?.ret,
        Denoted::Member(structure, member) => inspection.types.structure(structure).members.get(member as usize)?.ty,
        Denoted::Components(ty) | Denoted::Length(ty) => ty,
        Denoted::Struct(_) | Denoted::Block(_) | Denoted::Builtin | Denoted::Broken(_) => return None,
    })
}

/// The declarations of a symbol, definitions first.
fn declarations(analysis: &Analysis, symbol: &Symbol) -> Vec<Place> {
    let mut places = Vec::new();
    for place in symbol.declarations.iter().filter_map(|span| analysis.named_place(*span)) {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// Those declarations that the file sees: its own, or those that its stage reads; all if there are none.
fn own_side<'p>(analysis: &Analysis, point: &Point, places: &'p [Place]) -> Vec<&'p Place> {
    let own: Vec<&Place> = places.iter().filter(|place| point.path.as_os_str() == place.file.as_str()).collect();
    if !own.is_empty() {
        // A prototype stands before its definition.
        return own.into_iter().take(1).collect();
    }
    let views = analysis.views_of(&point.path);
    let read: Vec<&Place> = places
        .iter()
        .filter(|place| {
            let others = analysis.views_of(place.file.as_ref());
            others.iter().any(|other| views.iter().any(|view| view.file == other.file))
        })
        .collect();
    if read.is_empty() { places.iter().collect() } else { read.into_iter().take(1).collect() }
}

fn respond(state: &State<'_>, analysis: &Analysis, places: &[&Place]) -> Option<GotoDefinitionResponse> {
    let mut locations: Vec<Location> = places.iter().filter_map(|place| state.location_of(analysis, place)).collect();
    match locations.len() {
        0 => None,
        1 => locations.pop().map(GotoDefinitionResponse::Scalar),
        _ => Some(GotoDefinitionResponse::Array(locations)),
    }
}

/// The file that the include at a place names.
fn included(state: &State<'_>, point: &Point) -> Option<Location> {
    for analysis in &point.analyses {
        for view in analysis.views_of(&point.path) {
            for include in &view.ast.directives.includes {
                let Some(place) = analysis.named_place(include.span) else { continue };
                let is_here = point.path.as_os_str() == place.file.as_str();
                if is_here && place.start <= point.offset && point.offset <= place.end {
                    let path = state.path_of(analysis.sources().file(include.file?).name())?;
                    let zero = Position::default();
                    return Some(Location { uri: state.uri(&path)?, range: Range { start: zero, end: zero } });
                }
            }
        }
    }
    None
}

/// All places of the name, in all programs of the document.
pub(super) fn references(state: &mut State<'_>, params: &ReferenceParams) -> Option<Vec<Location>> {
    let point = state.point(&params.text_document_position)?;
    let (analysis, found) = state.occurrence(&point)?;
    let mut locations = Vec::new();
    let mut known = BTreeSet::new();
    for (analysis, places) in everywhere(state, &analysis, &found, None).0 {
        for (place, occurrence) in places {
            let is_declaration = matches!(occurrence.role, Role::Declaration | Role::Definition);
            if (params.context.include_declaration || !is_declaration)
                && known.insert(place.clone())
                && let Some(location) = state.location_of(&analysis, &place)
            {
                locations.push(location);
            }
        }
    }
    Some(locations)
}

/// A program, and the places of a symbol in it.
pub(super) type InProgram = (Rc<Analysis>, Vec<(Place, Occurrence)>);

/// The places of a symbol in its program, and in all other programs that share one of its declarations and use its name, or the
/// new one. The second value is whether there are too many of them.
pub(super) fn everywhere(
    state: &mut State<'_>,
    analysis: &Rc<Analysis>,
    found: &Occurrence,
    new: Option<&str>,
) -> (Vec<InProgram>, bool) {
    let mut result = vec![(Rc::clone(analysis), analysis.places_of(found.symbol))];
    let symbol = analysis.symbol(found.symbol);
    let declared: Vec<Place> = declarations(analysis, symbol);
    let words: Vec<&str> = std::iter::once(symbol.name.as_str()).chain(new).collect();
    let (mut others, mut is_cut): (Vec<Rc<Analysis>>, bool) = (Vec::new(), false);
    for place in &declared {
        if !place.file.starts_with('<') {
            let (found, is_more) = state.programs_with(place.file.as_ref(), &words);
            others.extend(found);
            is_cut |= is_more;
        }
    }
    let mut known: BTreeSet<ProgramKey> = BTreeSet::from([analysis.key.clone()]);
    for other in others {
        if !known.insert(other.key.clone()) {
            continue;
        }
        let same = declared.iter().find_map(|place| other.occurrence(place.file.as_ref(), place.start));
        if let Some(same) = same.filter(|same| other.symbol(same.symbol).name == symbol.name) {
            let places = other.places_of(same.symbol);
            result.push((other, places));
        }
    }
    (result, is_cut)
}

/// The places of the name in the document.
pub(super) fn highlights(state: &mut State<'_>, at: &TextDocumentPositionParams) -> Option<Vec<DocumentHighlight>> {
    let point = state.point(at)?;
    let (analysis, found) = state.occurrence(&point)?;
    let places = analysis.places_of(found.symbol).into_iter();
    let own = places.filter(|(place, _)| point.path.as_os_str() == place.file.as_str());
    let highlight = |(place, occurrence): (Place, Occurrence)| DocumentHighlight {
        range: point.text.range(place.start..place.end, state.encoding),
        kind: Some(match occurrence.role {
            Role::Write | Role::Declaration | Role::Definition => DocumentHighlightKind::WRITE,
            Role::Read => DocumentHighlightKind::READ,
        }),
    };
    Some(own.map(highlight).collect())
}
