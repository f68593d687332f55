//! The size of `gl_TexCoord` (GLSL 1.20 §7.6): "its size can be a maximum of gl_MaxTextureCoords", and without a declaration it is
//! the largest constant index plus one.
//!
//! *In:* the merged stages, in which the array has eight elements. *Out:* the same stages with as many as the program
//! names: one varying for `gl_TexCoord[0]` alone. *Holds:* all stages have the same size, the largest that one of them needs.
//! With an index that is not constant and no declaration, all eight stay.

use crate::builtin::fixed::TEX_COORD;
use crate::hir::{ArraySize, ExprKind, GlobalId, ScalarValue, Shader, Stage, Type, TypeId, Types, VarRef};

/// Sizes the array in all stages.
pub(super) fn size(types: &mut Types, stages: &mut [Shader]) {
    // A geometry stage has it in blocks, whose members have one size for all shaders.
    if stages.iter().any(|shader| shader.stage == Stage::Geometry) {
        return;
    }
    let found: Vec<Vec<GlobalId>> = stages.iter().map(coordinates).collect();
    let Some(full) = stages.iter().zip(&found).find_map(|(shader, ids)| Some(shader.global(*ids.first()?).ty)) else {
        return;
    };
    let Type::Array(element, ArraySize::Sized(most)) = types.get(full) else { return };
    let needed = stages.iter().zip(&found).filter(|(_, ids)| !ids.is_empty());
    let Some(size) = needed.map(|(shader, ids)| needed_by(shader, ids, most)).max() else { return };
    if size >= most {
        return;
    }
    let ty = types.array(element, ArraySize::Sized(size));
    for (shader, ids) in stages.iter_mut().zip(&found) {
        resize(shader, ids, ty);
    }
}

fn coordinates(shader: &Shader) -> Vec<GlobalId> {
    shader.globals().filter(|(_, global)| global.is_fixed() && global.name == TEX_COORD).map(|(id, _)| id).collect()
}

/// How many elements a shader declares or names.
fn needed_by(shader: &Shader, ids: &[GlobalId], most: u32) -> u32 {
    let is_array = |kind: &ExprKind| matches!(kind, ExprKind::Var(VarRef::Global(id)) if ids.contains(id));
    let (mut size, mut whole, mut indexed) = (1, 0_usize, 0_usize);
    let declared = shader.tex_coords;
    for expr in &shader.exprs {
        match &expr.kind {
            kind if is_array(kind) => whole += 1,
            ExprKind::Index(base, index) if is_array(&shader.expr(*base).kind) => {
                indexed += 1;
                let index = match shader.expr(*index).kind {
                    ExprKind::Literal(ScalarValue::Int(index)) => u32::try_from(index).ok(),
                    ExprKind::Literal(ScalarValue::Uint(index)) => Some(index),
                    _ => None,
                };
                size = size.max(index.map_or(declared.unwrap_or(most), |index| index.saturating_add(1)));
            }
            _ => {}
        }
    }
    // The array as a whole.
    let size = if whole > indexed { size.max(declared.unwrap_or(most)) } else { size };
    size.max(declared.unwrap_or(1)).min(most)
}

fn resize(shader: &mut Shader, ids: &[GlobalId], ty: TypeId) {
    for id in ids {
        if let Some(global) = shader.globals.get_mut(id.index()) {
            global.ty = ty;
        }
    }
    for expr in &mut shader.exprs {
        if matches!(expr.kind, ExprKind::Var(VarRef::Global(id)) if ids.contains(&id)) {
            expr.ty = ty;
        }
    }
}
