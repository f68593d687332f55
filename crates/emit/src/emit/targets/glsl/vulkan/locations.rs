//! The locations of varyings: between the last stage before the rasterizer and the fragment stage those of the
//! interface, between the vertex and the geometry stage in the order in which the vertex stage declares them.

use super::Layouts;
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Types};
use glisten_front::link::{Program, Varying};

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
    for index in 0..shader.globals.len() {
        let id = GlobalId::new(index);
        if !is_varying(shader.global(id), storage) {
            continue;
        }
        let end = |row: &&Varying| if stage == Stage::Fragment { row.to } else { row.from };
        let rows = program.interface.varyings.iter().filter(|row| end(row).is_some_and(|end| end.global == id));
        let first = rows.min_by_key(|row| end(row).map(|end| end.flat_offset));
        if let Some(row) = first {
            place(shader, id, row.location, (row.component > 0).then_some(row.component), layouts);
        } else if shader.global(id).block.is_some() {
            place(shader, id, next, None, layouts);
            next = next.saturating_add(types.locations(shader.global(id).ty));
        } else {
            keep_inside(shader, id);
        }
    }
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
