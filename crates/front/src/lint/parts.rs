//! Which components of a vector a shader ever writes.
//!
//! *In:* l-values. *Out:* components as bits, the lowest for `x`. *Holds:* what is not known counts as all of them.

use crate::hir::{ExprId, ExprKind, ScalarValue, Shader, Type, TypeId, Types, VarRef};

/// All components.
pub(super) const ALL: u8 = 0xf;

/// All components of a vector; `None` for another type.
pub(super) fn of_type(types: &Types, ty: TypeId) -> Option<u8> {
    match types.get(ty) {
        Type::Vector(_, size @ 2..=4) => Some(ALL >> (4 - size)),
        _ => None,
    }
}

/// The variable of a place, and the components of it that the place names.
pub(super) fn of_place(shader: &Shader, place: ExprId) -> Option<(VarRef, u8)> {
    let of_variable = |base: ExprId, components: u8| match shader.expr(base).kind {
        ExprKind::Var(variable) => Some((variable, components)),
        _ => shader.root_variable(base).map(|variable| (variable, ALL)),
    };
    match &shader.expr(place).kind {
        ExprKind::Swizzle(base, swizzle) => {
            of_variable(*base, swizzle.as_slice().iter().fold(0, |bits, component| bits | 1 << component))
        }
        ExprKind::Index(base, index) => of_variable(*base, index_of(shader, *index).map_or(ALL, |index| 1 << index)),
        _ => of_variable(place, ALL),
    }
}

/// A constant index of a vector.
fn index_of(shader: &Shader, index: ExprId) -> Option<u32> {
    let index = match shader.expr(index).kind {
        ExprKind::Literal(ScalarValue::Int(index)) => u32::try_from(index).ok(),
        ExprKind::Literal(ScalarValue::Uint(index)) => Some(index),
        _ => None,
    };
    index.filter(|index| *index < 4)
}

/// The names of components, of a color or of a place.
pub(super) fn named(components: u8, letters: &str) -> String {
    letters.chars().enumerate().filter(|(at, _)| components >> at & 1 == 1).map(|(_, letter)| letter).collect()
}
