//! Splits a variable into its scalars, vectors, matrices and arrays of these, with the names that the host uses.

use crate::hir::{ArraySize, MatrixLayout, Type, TypeId, Types};

/// A part that is neither a struct nor an array of structs.
pub(super) struct Part {
    /// The path: `light[1].position`.
    pub(super) name: String,
    /// The type; arrays of scalars, vectors, matrices and samplers stay whole.
    pub(super) ty: TypeId,
    /// The index of its first scalar in the variable's flat layout.
    pub(super) flat_offset: u32,
    /// The matrix layout, from the nearest member of a block.
    pub(super) matrix_layout: MatrixLayout,
}

/// The parts of a variable in flat order. The caller must have bounded the size of the type.
pub(super) fn parts(types: &Types, name: &str, ty: TypeId, matrix_layout: MatrixLayout) -> Vec<Part> {
    let mut list = Vec::new();
    walk(types, name.to_owned(), ty, 0, matrix_layout, &mut list);
    list
}

fn walk(types: &Types, name: String, ty: TypeId, flat_offset: u32, layout: MatrixLayout, list: &mut Vec<Part>) {
    match types.get(ty) {
        Type::Struct(id) => {
            let mut offset = flat_offset;
            for member in &types.structure(id).members {
                walk(types, join(&name, &member.name), member.ty, offset, layout, list);
                offset = offset.saturating_add(types.flat_len(member.ty));
            }
        }
        Type::Array(element, ArraySize::Sized(size)) if !is_leaf(types, element) => {
            let stride = types.flat_len(element);
            for index in 0..size {
                let offset = flat_offset.saturating_add(index.saturating_mul(stride));
                walk(types, format!("{name}[{index}]"), element, offset, layout, list);
            }
        }
        _ => list.push(Part { name, ty, flat_offset, matrix_layout: layout }),
    }
}

/// `name.member`, or the member alone if the whole has no name (a block without an instance name).
pub(super) fn join(name: &str, member: &str) -> String {
    if name.is_empty() { member.to_owned() } else { format!("{name}.{member}") }
}

fn is_leaf(types: &Types, ty: TypeId) -> bool {
    !matches!(types.get(ty), Type::Struct(_) | Type::Array(..))
}
