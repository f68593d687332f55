//! The locations of varyings: between the last stage before the rasterizer and the fragment stage those of the
//! interface, between the vertex and the geometry stage in the order in which the vertex stage declares them.

use super::Layouts;
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Type, TypeId, Types};
use glisten_front::link::{Program, Varying, VaryingEnd};

/// Gives every varying of a stage its location.
pub(super) fn assign(types: &Types, shader: &mut Shader, program: &Program, layouts: &mut Layouts) {
    let stage = shader.stage;
    let has_geometry = program.stage(Stage::Geometry).is_some();
    if stage == Stage::Vertex && has_geometry {
        for (id, location) in in_order(types, shader) {
            place(shader, id, location, None, layouts);
        }
        return;
    }
    if stage == Stage::Geometry {
        inputs(types, shader, program, layouts);
    }
    let storage = if stage == Stage::Fragment { Storage::In } else { Storage::Out };
    let ends = program.interface.varyings.iter().map(|row| row.location.saturating_add(1));
    let mut next = ends.max().unwrap_or(0);
    let scattered = scattered(types, shader, program, &mut next);
    for index in 0..shader.globals.len() {
        let id = GlobalId::new(index);
        if !is_varying(shader.global(id), storage) {
            continue;
        }
        if let Some((_, location)) = scattered.iter().find(|(other, _)| *other == id) {
            place(shader, id, *location, None, layouts);
        } else if let Some(row) = rows(program, stage, id).first() {
            place(shader, id, row.location, (row.component > 0).then_some(row.component), layouts);
        } else if shader.global(id).block.is_some() {
            place(shader, id, next, None, layouts);
            next = next.saturating_add(types.locations(shader.global(id).ty));
        } else {
            keep_inside(shader, id);
        }
    }
}

/// The rows of a variable, in the order of its scalars.
fn rows(program: &Program, stage: Stage, id: GlobalId) -> Vec<&Varying> {
    let mut rows: Vec<&Varying> =
        program.interface.varyings.iter().filter(|row| global_of(row, stage) == Some(id)).collect();
    rows.sort_by_key(|row| end_of(row, stage).map(|end| end.flat_offset));
    rows
}

/// The end of a varying in a stage.
fn end_of(row: &Varying, stage: Stage) -> Option<VaryingEnd> {
    if stage == Stage::Fragment { row.to } else { row.from }
}

fn global_of(row: &Varying, stage: Stage) -> Option<GlobalId> {
    end_of(row, stage).map(|end| end.global)
}

/// The variables whose parts the interface has packed so that no location says where they all are. Each gets locations of its
/// own from `next` on, in the order of the interface, which is the same in both stages.
fn scattered(types: &Types, shader: &Shader, program: &Program, next: &mut u32) -> Vec<(GlobalId, u32)> {
    let mut found: Vec<(GlobalId, u32)> = Vec::new();
    let mut seen: Vec<GlobalId> = Vec::new();
    for row in &program.interface.varyings {
        let Some(id) = global_of(row, shader.stage).filter(|id| !seen.contains(id)) else { continue };
        seen.push(id);
        let global = shader.global(id);
        if !is_in_one_piece(types, global, &rows(program, shader.stage, id)) {
            found.push((id, *next));
            *next = next.saturating_add(types.locations(global.ty));
        }
    }
    found
}

/// Whether the rows follow each other from the first location on, from its component on. Structs and matrices have no component
/// (GLSL 4.50 §4.4.1). Places that the source states are kept.
fn is_in_one_piece(types: &Types, global: &Global, rows: &[&Varying]) -> bool {
    let Some(first) = rows.first() else { return true };
    let is_stated = global.location.is_some() || global.block.is_some() && has_stated_members(types, global.ty);
    let follow = (first.location..)
        .zip(rows)
        .all(|(location, row)| (row.location, row.component) == (location, first.component));
    is_stated || follow && (first.component == 0 || may_have_component(types, global))
}

fn has_stated_members(types: &Types, ty: TypeId) -> bool {
    match types.get(types.element(ty).unwrap_or(ty)) {
        Type::Struct(id) => types.structure(id).members.iter().any(|member| member.place.location.is_some()),
        _ => false,
    }
}

fn may_have_component(types: &Types, global: &Global) -> bool {
    let mut ty = global.ty;
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    matches!(types.get(ty), Type::Scalar(_) | Type::Vector(..))
}

/// An output that no stage declares as its input is a variable of its own stage.
fn keep_inside(shader: &mut Shader, id: GlobalId) {
    if let Some(global) = shader.globals.get_mut(id.index()) {
        global.storage = Storage::Private;
        (global.location, global.component) = (None, None);
        (global.interpolation_written, global.invariant) = (false, false);
        global.sampling = Default::default();
    }
}

fn is_varying(global: &Global, storage: Storage) -> bool {
    global.builtin.is_none() && global.storage == storage
}

fn place(shader: &mut Shader, id: GlobalId, location: u32, component: Option<u32>, layouts: &mut Layouts) {
    let Some(global) = shader.globals.get_mut(id.index()) else { return };
    if global.block.is_some() {
        layouts.add(id, format!("location = {location}"));
    } else {
        (global.location, global.component) = (Some(location), component);
    }
}

/// The outputs of the vertex stage with locations that follow each other.
fn in_order(types: &Types, shader: &Shader) -> Vec<(GlobalId, u32)> {
    let mut next = 0_u32;
    let outputs = shader.globals().filter(|(_, global)| is_varying(global, Storage::Out));
    outputs
        .map(|(id, global)| {
            let location = next;
            next = next.saturating_add(types.locations(global.ty));
            (id, location)
        })
        .collect()
}

/// The inputs of the geometry stage have the locations of the outputs that they read.
fn inputs(types: &Types, shader: &mut Shader, program: &Program, layouts: &mut Layouts) {
    let Some(vertex) = program.stage(Stage::Vertex) else {
        // A lone stage: in the order of its own inputs, each of which is an array of vertices.
        let mut next = 0_u32;
        for index in 0..shader.globals.len() {
            let id = GlobalId::new(index);
            if is_varying(shader.global(id), Storage::In) {
                let ty = shader.global(id).ty;
                place(shader, id, next, None, layouts);
                next = next.saturating_add(types.locations(types.element(ty).unwrap_or(ty)));
            }
        }
        return;
    };
    for (from, location) in in_order(types, vertex) {
        let name = vertex.global(from).match_name().to_owned();
        let to = shader.globals().find(|(_, global)| is_varying(global, Storage::In) && global.match_name() == name);
        if let Some((id, _)) = to {
            place(shader, id, location, None, layouts);
        }
    }
}
