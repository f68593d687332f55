//! Which things of two stages are one (GLSL 1.50 §4.3.4 to §4.3.7): uniforms, what passes between stages, blocks, and the structs
//! and members that they consist of.

use super::Inspection;
use crate::analysis::Denoted;
use crate::hir::{Global, GlobalId, Shader, Storage, StructId, Type, TypeId, Types};

/// The deepest nesting of types that is followed; the analysis allows no deeper one.
const MAX_DEPTH: usize = 64;

/// A thing of a view.
pub(super) type Place = (usize, Denoted);

/// Calls `unite` for each two things of different views that are one.
pub(super) fn unite(inspection: &Inspection, unite: &mut dyn FnMut(Place, Place)) {
    let views: Vec<(usize, &Shader)> = inspection.views().map(|(number, view)| (number, &view.shader)).collect();
    let types = &inspection.types;
    for (index, &(left, first)) in views.iter().enumerate() {
        for &(right, second) in views.get(index + 1..).unwrap_or(&[]) {
            for (a, global) in first.globals() {
                if global.builtin.is_some() || global.is_fixed() {
                    continue;
                }
                let partner = second.globals().find(|(_, other)| fits(&views, (first, global), (second, other)));
                if let Some((b, other)) = partner {
                    pair(types, (left, a, global), (right, b, other), unite);
                }
            }
        }
    }
}

/// Whether two globals of two shaders are one.
fn fits(views: &[(usize, &Shader)], (first, a): (&Shader, &Global), (second, b): (&Shader, &Global)) -> bool {
    let is_one_name = a.match_name() == b.match_name() && a.block.is_some() == b.block.is_some();
    if !is_one_name || b.builtin.is_some() {
        return false;
    }
    if first.stage == second.stage {
        // Files of one stage are one shader.
        return a.storage == b.storage;
    }
    let follows = |from: &Shader, to: &Shader| {
        from.stage < to.stage && !views.iter().any(|(_, other)| from.stage < other.stage && other.stage < to.stage)
    };
    match (a.storage, b.storage) {
        (Storage::Uniform, Storage::Uniform) => true,
        (Storage::Out, Storage::In) => follows(first, second),
        (Storage::In, Storage::Out) => follows(second, first),
        _ => false,
    }
}

fn pair(
    types: &Types,
    (left, a, global): (usize, GlobalId, &Global),
    (right, b, other): (usize, GlobalId, &Global),
    unite: &mut dyn FnMut(Place, Place),
) {
    // Blocks match by their names; the instances are each stage's own.
    if global.block.is_none() {
        unite((left, Denoted::Global(a)), (right, Denoted::Global(b)));
    } else if let (Some(one), Some(two)) = (structure(types, global.ty), structure(types, other.ty)) {
        unite((left, Denoted::Block(one)), (right, Denoted::Block(two)));
    }
    unite_types(types, (left, global.ty), (right, other.ty), unite, MAX_DEPTH);
}

fn structure(types: &Types, ty: TypeId) -> Option<StructId> {
    let mut ty = ty;
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    if let Type::Struct(id) = types.get(ty) { Some(id) } else { None }
}

fn unite_types(
    types: &Types,
    (left, a): (usize, TypeId),
    (right, b): (usize, TypeId),
    unite: &mut dyn FnMut(Place, Place),
    depth: usize,
) {
    let (Some(a), Some(b)) = (structure(types, a), structure(types, b)) else { return };
    if a == b || depth == 0 {
        return;
    }
    let (first, second) = (types.structure(a), types.structure(b));
    if first.name == second.name && !first.name.is_empty() && !first.is_block {
        unite((left, Denoted::Struct(a)), (right, Denoted::Struct(b)));
    }
    for (index, member) in first.members.iter().enumerate() {
        let Some(other) = second.members.iter().position(|other| other.name == member.name) else { continue };
        unite((left, Denoted::Member(a, index as u32)), (right, Denoted::Member(b, other as u32)));
        if let Some(same) = second.members.get(other) {
            unite_types(types, (left, member.ty), (right, same.ty), unite, depth - 1);
        }
    }
}
