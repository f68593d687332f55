//! Clip distances that a host disables between enabled ones (OpenGL 3.2 §2.17): targets enable the first N.
//!
//! *In:* the stage before the rasterizer, and the bits of the disabled distances. *Out:* statements for its end. *Holds:* a
//! distance of 0 clips nothing, so that it has no effect, as GLSL 1.50 §7.1 says of a distance that is not enabled.

use super::statements::{assignment, literal, variable};
use crate::builtin::BuiltinVariable;
use crate::hir::{ArraySize, ExprKind, ScalarValue, Shader, Stmt, Storage, Type, TypeId, Types};
use crate::language::Scalar;
use crate::source::Span;

/// A statement for each disabled distance that the stage has: it becomes 0.
pub(super) fn without_effect(types: &Types, shader: &mut Shader, disabled: u8) -> Vec<Stmt> {
    let is_distance = |shader: &Shader| {
        shader.globals().find_map(|(id, global)| {
            let is_it = global.builtin == Some(BuiltinVariable::ClipDistance) && global.storage == Storage::Out;
            match types.get(global.ty) {
                Type::Array(_, ArraySize::Sized(size)) if is_it => Some((id, size)),
                _ => None,
            }
        })
    };
    let Some((distances, size)) = is_distance(shader).filter(|_| disabled != 0) else { return Vec::new() };
    let each = |index: u32| {
        let array = variable(shader, distances);
        let int = TypeId::vector(Scalar::Int, 1);
        let place = literal(shader, ScalarValue::Int(index.cast_signed()), int);
        let target = shader.push(ExprKind::Index(array, place), TypeId::FLOAT, Span::default());
        let zero = literal(shader, ScalarValue::Float(0.0), TypeId::FLOAT);
        assignment(shader, target, zero)
    };
    (0..size.min(u8::BITS)).filter(|index| disabled >> index & 1 == 1).map(each).collect()
}
