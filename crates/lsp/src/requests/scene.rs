//! Scene files that name variables of a program: the keys to change with a rename.
//!
//! *In:* the places of a symbol, and the scenes of the workspace. *Out:* edits. *Holds:* only draws with the program's own files count;
//! a name is a path through members (`lights[0].position`), and the part that is the symbol is changed.

use super::definition::InProgram;
use crate::analysis::Analysis;
use crate::state::State;
use crate::text::Text;
use glisten_front::analysis::Denoted;
use glisten_front::hir::{Storage, Type, TypeId};
use glisten_front::index::SymbolId;
use glisten_scene::roles::AttributeRole;
use lsp_types::TextEdit;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// The tables of a draw whose keys are names of variables.
const TABLES: &[&str] =
    &["uniforms", "textures", "attributes", "attribute_locations", "frag_data_locations", "matrices"];
/// The tables of `[stability]` whose keys are names of uniforms.
const RANGES: &[&str] = &["sweep", "range"];
/// The keys of a draw that name a file of a program.
const FILES: &[&str] = &["vertex", "geometry", "fragment"];

/// The edits of scenes for a symbol's new name.
pub(super) fn edits(state: &mut State<'_>, all: &[InProgram], new: &str) -> Vec<(PathBuf, Vec<TextEdit>)> {
    let can_be_named = all.iter().any(|(analysis, places)| {
        let symbol = places.first().map(|(_, occurrence)| analysis.symbol(occurrence.symbol));
        let denoted = symbol.and_then(|symbol| symbol.places.first());
        matches!(denoted, Some((_, Denoted::Global(_) | Denoted::Member(..) | Denoted::Block(_))))
    });
    if !can_be_named {
        return Vec::new();
    }
    let files: Vec<PathBuf> = all.iter().flat_map(|(analysis, _)| analysis.key.files.clone()).collect();
    let folders = folders(state, &files);
    let mut changes = Vec::new();
    for (path, text) in state.project.scenes(&folders, true) {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for (analysis, places) in all {
            if let Some((_, occurrence)) = places.first() {
                ranges.extend(in_scene(analysis, occurrence.symbol, &path, &text));
            }
        }
        ranges.sort_by_key(|range| range.start);
        ranges.dedup();
        if !ranges.is_empty() {
            let text = Text::new(text);
            let edit = |range| TextEdit { range: text.range(range, state.encoding), new_text: new.to_owned() };
            changes.push((path, ranges.into_iter().map(edit).collect()));
        }
    }
    changes
}

/// The folders in which scenes are looked for: those of the workspace, and those of files outside of it.
pub(super) fn folders(state: &State<'_>, files: &[PathBuf]) -> Vec<PathBuf> {
    let mut folders = state.folders.clone();
    for file in files {
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        if !folders.iter().any(|known| folder.starts_with(known)) {
            folders.push(folder);
        }
    }
    folders
}

/// Whether a draw of a scene has one of these files.
pub(super) fn draws_one_of(path: &Path, text: &str, files: &[PathBuf]) -> bool {
    let mut found = false;
    each_draw(path, text, files, |_| found = true);
    found
}

/// Visits the draws of a scene that have one of these files.
pub(super) fn each_draw(path: &Path, text: &str, files: &[PathBuf], mut visit: impl FnMut(&DeTable<'_>)) {
    let Ok(document) = DeTable::parse(text) else { return };
    let draws = document.get_ref().get("draw").and_then(|node| node.get_ref().as_array());
    let folder = path.parent().unwrap_or(Path::new(""));
    for draw in draws.into_iter().flatten().filter_map(|draw| draw.get_ref().as_table()) {
        let named = FILES.iter().filter_map(|key| draw.get(*key)?.get_ref().as_str());
        if named.into_iter().any(|name| files.contains(&plain(&folder.join(name)))) {
            visit(draw);
        }
    }
}

/// The declarations for what a draw gives to its program: the first word, the type that the values have, the name.
pub(super) fn declarations(draw: &DeTable<'_>) -> Vec<(&'static str, String, String)> {
    let mut found = Vec::new();
    for (table, word) in [("uniforms", "uniform"), ("textures", "uniform"), ("attributes", "in")] {
        let Some(values) = draw.get(table).and_then(|node| node.get_ref().as_table()) else { continue };
        for (key, value) in values {
            let name = key.get_ref();
            let is_name = name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
            let ty = if table == "textures" { sampler(value.get_ref()) } else { type_of(value.get_ref()) };
            if let Some(ty) = ty.filter(|_| is_name) {
                found.push((word, ty, name.to_string()));
            }
        }
    }
    found
}

/// The type of a value: by its `size` if it has one, or by the count of its numbers.
fn type_of(value: &DeValue<'_>) -> Option<String> {
    let count = match value {
        DeValue::Float(_) | DeValue::Integer(_) => 1,
        DeValue::Boolean(_) => return Some("bool".to_owned()),
        DeValue::Array(numbers) => numbers.len(),
        DeValue::Table(table) => match table.get("size").map(|size| size.get_ref()) {
            Some(DeValue::Integer(size)) => size.as_str().parse().ok()?,
            _ => return None,
        },
        _ => return None,
    };
    Some(match count {
        1 => "float".to_owned(),
        2..=4 => format!("vec{count}"),
        9 => "mat3".to_owned(),
        16 => "mat4".to_owned(),
        _ => return None,
    })
}

fn sampler(texture: &DeValue<'_>) -> Option<String> {
    let kind = texture.as_table()?.get("kind").and_then(|kind| kind.get_ref().as_str()).unwrap_or("2d");
    Some(match kind.strip_prefix("shadow_") {
        Some(_) => "sampler2DShadow".to_owned(),
        None if kind == "cube" => "samplerCube".to_owned(),
        None if kind == "3d" => "sampler3D".to_owned(),
        None if kind == "2d" => "sampler2D".to_owned(),
        None => return None,
    })
}

/// Where a scene names a symbol.
fn in_scene(analysis: &Analysis, symbol: SymbolId, path: &Path, text: &str) -> Vec<Range<usize>> {
    let (mut names, mut is_drawn) = (Vec::new(), false);
    each_draw(path, text, &analysis.key.files, |draw| {
        is_drawn = true;
        names.extend(named_in_draw(draw));
    });
    if is_drawn {
        names.extend(named_elsewhere(text));
    }
    names.into_iter().filter_map(|name| in_name(analysis, symbol, text, name)).collect()
}

/// The names of variables in a draw: keys, and values that are names.
fn named_in_draw(draw: &DeTable<'_>) -> Vec<Range<usize>> {
    let mut names: Vec<Range<usize>> = TABLES.iter().flat_map(|key| keys(draw, key)).collect();
    if let Some(DeValue::Array(all)) = draw.get("dynamic").map(|node| node.get_ref()) {
        names.extend(all.iter().map(|name| name.span()));
    }
    if let Some(mesh) = table(draw, "mesh") {
        names.extend(AttributeRole::ALL.iter().filter_map(|role| mesh.get(role.name())).map(|name| name.span()));
    }
    let textures = table(draw, "textures").into_iter().flat_map(DeTable::values);
    let depths = textures.filter_map(|texture| table(texture.get_ref().as_table()?, "depths"));
    names.extend(depths.filter_map(|depths| depths.get("matrix")).map(|name| name.span()));
    names
}

/// The names of variables outside of draws: in the ranges that a scene states, and in what a way of its report sets.
fn named_elsewhere(text: &str) -> Vec<Range<usize>> {
    let Ok(document) = DeTable::parse(text) else { return Vec::new() };
    let stability = table(document.get_ref(), "stability").into_iter();
    let ranges = stability.flat_map(|stability| RANGES.iter().flat_map(|key| keys(stability, key)));
    let report = table(document.get_ref(), "report").and_then(|report| report.get("way")?.get_ref().as_array());
    let ways = report.into_iter().flatten().filter_map(|way| table(way.get_ref().as_table()?, "set"));
    ranges.chain(ways.flat_map(named_in_draw)).collect()
}

fn table<'d, 't>(within: &'d DeTable<'t>, key: &str) -> Option<&'d DeTable<'t>> {
    within.get(key)?.get_ref().as_table()
}

/// The places of the keys of a table.
fn keys(within: &DeTable<'_>, key: &str) -> Vec<Range<usize>> {
    table(within, key).into_iter().flat_map(DeTable::keys).map(|key| key.span()).collect()
}

/// The part of a name that is the symbol.
fn in_name(analysis: &Analysis, symbol: SymbolId, text: &str, name: Range<usize>) -> Option<Range<usize>> {
    let written = text.get(name.clone())?;
    let quotes = written.len() - written.trim_start_matches(['"', '\'']).len();
    let path = written.trim_matches(['"', '\'']);
    let mut parts: Vec<Range<usize>> = Vec::new();
    let mut at = name.start + quotes;
    for part in path.split('.') {
        let name = part.split('[').next().unwrap_or("");
        parts.push(at..at + name.len());
        at += part.len() + 1;
    }
    for (number, view) in analysis.compiled.inspection.views() {
        let types = &analysis.compiled.inspection.types;
        for (id, global) in view.shader.globals().filter(|(_, global)| global.storage != Storage::Private) {
            let mut rest = parts.iter();
            let is_anonymous = global.block.as_ref().is_some_and(|block| block.instance.is_none());
            let own = global.block.as_ref().map_or(global.name.as_str(), |block| block.name.as_str());
            if !is_anonymous {
                let first = rest.next()?;
                if text.get(first.clone()) != Some(own) {
                    continue;
                }
                let structure = structure(analysis, global.ty);
                let denoted = match (&global.block, structure) {
                    (Some(_), Some(id)) => Denoted::Block(id),
                    _ => Denoted::Global(id),
                };
                if is_symbol(analysis, symbol, number, denoted) {
                    return Some(first.clone());
                }
            }
            let mut ty = global.ty;
            for part in rest {
                let Some(id) = structure(analysis, ty) else { break };
                let members = &types.structure(id).members;
                let Some(index) =
                    members.iter().position(|member| Some(member.name.as_str()) == text.get(part.clone()))
                else {
                    break;
                };
                if is_symbol(analysis, symbol, number, Denoted::Member(id, index as u32)) {
                    return Some(part.clone());
                }
                ty = members.get(index)?.ty;
            }
        }
    }
    None
}

fn structure(analysis: &Analysis, ty: TypeId) -> Option<glisten_front::hir::StructId> {
    let types = &analysis.compiled.inspection.types;
    let mut ty = ty;
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    if let Type::Struct(id) = types.get(ty) { Some(id) } else { None }
}

fn is_symbol(analysis: &Analysis, symbol: SymbolId, view: usize, denoted: Denoted) -> bool {
    analysis.symbol(symbol).places.contains(&(view, denoted))
}

/// The path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            _ => plain.push(component),
        }
    }
    plain
}
