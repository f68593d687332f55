//! The sizes of a geometry stage's inputs when several shaders form the stage (GLSL 1.50 §4.3.8.1): one of them
//! declares the input primitive, which sizes the arrays of all.

use crate::diagnostic::{Diagnostic, codes};
use crate::fold;
use crate::hir::{ArraySize, ExprKind, GlobalId, ScalarValue, Shader, Storage, Type, Types, VarRef};

/// Sizes the inputs, and reports inputs of another size and constant indices past the last element.
pub(super) fn size_inputs(types: &mut Types, shader: &mut Shader, found: &mut Vec<Diagnostic>) {
    let Some(input) = shader.geometry.input else { return };
    let vertices = input.vertices();
    for global in shader.globals.iter_mut().filter(|global| global.storage == Storage::In) {
        match types.get(global.ty) {
            Type::Array(element, ArraySize::Unsized) => global.ty = types.array(element, ArraySize::Sized(vertices)),
            Type::Array(_, ArraySize::Sized(size)) if size != vertices => {
                let message =
                    format!("`{}` has {size} elements, and the input primitive {vertices} vertices", global.name);
                found.push(Diagnostic::new(&codes::link::GEOMETRY_INPUT_SIZE, global.span, message));
            }
            _ => {}
        }
    }
    super::remap::retype_globals(types, shader);
    check_indices(types, shader, vertices, found);
}

fn check_indices(types: &Types, shader: &Shader, vertices: u32, found: &mut Vec<Diagnostic>) {
    for expr in &shader.exprs {
        let ExprKind::Index(base, index) = expr.kind else { continue };
        let ExprKind::Var(VarRef::Global(id)) = shader.expr(base).kind else { continue };
        if !is_input_array(types, shader, id) {
            continue;
        }
        let value = fold::evaluate(shader, types, index, &|_| None);
        let beyond = match value.and_then(|value| value.scalars.first().copied()) {
            Some(ScalarValue::Int(index)) => index < 0 || index as u32 >= vertices,
            Some(ScalarValue::Uint(index)) => index >= vertices,
            _ => false,
        };
        if beyond {
            let name = &shader.global(id).name;
            let message = format!("`{name}` is indexed beyond the {vertices} vertices of the input primitive");
            found.push(Diagnostic::new(&codes::link::GEOMETRY_INPUT_SIZE, shader.expr(index).span, message));
        }
    }
}

fn is_input_array(types: &Types, shader: &Shader, id: GlobalId) -> bool {
    let global = shader.global(id);
    global.storage == Storage::In && matches!(types.get(global.ty), Type::Array(..))
}
