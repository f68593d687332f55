//! Which output of the vertex stage each input of the geometry stage reads (GLSL 1.50 §4.3.4, §7.1).
//!
//! *In:* both stages, after their declarations were matched. *Out:* a [`GeometryInput`] for each variable, and for each
//! member of `gl_in`. *Holds:* both ends are within the flat layouts of their variables.

use super::matching::Outputs;
use super::program::{GeometryInput, VaryingEnd};
use crate::builtin::BuiltinVariable;
use crate::hir::{GlobalId, Shader, Storage, Type, TypeId, Types};

/// The inputs of the geometry stage that a vertex stage feeds.
pub(super) fn connect(types: &Types, vertex: &Shader, geometry: &Shader) -> Vec<GeometryInput> {
    let outputs = Outputs::new(vertex);
    let mut list = Vec::new();
    for (id, global) in geometry.globals().filter(|(_, global)| global.storage == Storage::In) {
        let Some(element) = types.element(global.ty) else { continue };
        if global.builtin == Some(BuiltinVariable::In) {
            add_members(types, vertex, id, element, &mut list);
        } else if let (None, Some((from, output))) = (global.builtin, outputs.partner(global)) {
            let scalars = types.flat_len(element).min(types.flat_len(output.ty));
            list.push(GeometryInput { from: end(from, 0), to: end(id, 0), scalars });
        }
    }
    list
}

/// The members of `gl_in`: the built-in outputs with their names.
fn add_members(types: &Types, vertex: &Shader, id: GlobalId, element: TypeId, list: &mut Vec<GeometryInput>) {
    let Type::Struct(block) = types.get(element) else { return };
    let mut offset = 0;
    for member in &types.structure(block).members {
        let output = vertex.globals().find(|(_, global)| {
            let is_built_in = global.builtin.is_some() || global.is_fixed();
            global.storage == Storage::Out && is_built_in && global.name == member.name
        });
        if let Some((from, output)) = output {
            let scalars = types.flat_len(member.ty).min(types.flat_len(output.ty));
            list.push(GeometryInput { from: end(from, 0), to: end(id, offset), scalars });
        }
        offset += types.flat_len(member.ty);
    }
}

fn end(global: GlobalId, flat_offset: u32) -> VaryingEnd {
    VaryingEnd { global, flat_offset }
}
