//! When two types in different shaders are the same (§4.3.5, §4.3.7, §4.3.9): if they are equal except for their
//! positions.
//!
//! A struct that two shaders declare has two handles. It matches if it has the same name and the same members in the
//! same order.

use crate::hir::{Member, ScalarValue, StructId, Type, TypeId, Types, Value};

/// Whether two types match across shaders.
pub(super) fn same_type(types: &Types, a: TypeId, b: TypeId) -> bool {
    if a == b {
        return true;
    }
    match (types.get(a), types.get(b)) {
        (Type::Error, _) | (_, Type::Error) => true,
        (Type::Array(a, a_size), Type::Array(b, b_size)) => a_size == b_size && same_type(types, a, b),
        (Type::Struct(a), Type::Struct(b)) => same_struct(types, a, b),
        _ => false,
    }
}

fn same_struct(types: &Types, a: StructId, b: StructId) -> bool {
    let (a, b) = (types.structure(a), types.structure(b));
    a.name == b.name
        && a.members.len() == b.members.len()
        && a.members.iter().zip(&b.members).all(|(a, b)| a.name == b.name && same_type(types, a.ty, b.ty))
}

/// Whether two values are equal bit by bit: a NaN equals itself, and 0 differs from -0.
pub(super) fn same_value(a: &Value, b: &Value) -> bool {
    let bits = |value: &ScalarValue| match *value {
        ScalarValue::Bool(value) => u32::from(value),
        ScalarValue::Int(value) => value as u32,
        ScalarValue::Uint(value) => value,
        ScalarValue::Float(value) => value.to_bits(),
    };
    a.scalars.iter().map(bits).eq(b.scalars.iter().map(bits))
}

/// The struct of a block's type, and the size of an array of blocks.
pub(super) fn block_parts(types: &Types, ty: TypeId) -> Option<(StructId, Option<crate::hir::ArraySize>)> {
    match types.get(ty) {
        Type::Struct(id) => Some((id, None)),
        Type::Array(element, size) => match types.get(element) {
            Type::Struct(id) => Some((id, Some(size))),
            _ => None,
        },
        _ => None,
    }
}

/// The first difference between the members of two declarations of one block.
pub(super) enum MemberDifference<'a> {
    /// One has more members.
    Count(usize, usize),
    /// Members at the same index differ in name or type.
    Declaration(&'a Member, &'a Member),
    /// Members differ in interpolation, `centroid` or `sample`, invariance or matrix layout.
    Qualifiers(&'a Member, &'a Member),
}

/// The qualifiers in which an output may differ from the input that it feeds.
#[derive(Clone, Copy, Default)]
pub(super) struct Free {
    /// An output may be invariant alone (GLSL 4.20 §4.8.1).
    pub(super) invariant: bool,
    /// "Interpolation qualification (e.g., flat) .. may differ" (GLSL 4.30 §4.3.4).
    pub(super) interpolation: bool,
    /// "Auxiliary qualification (e.g. centroid) may differ" (GLSL 4.30 §4.3.4; ES 3.10 §4.3.4).
    pub(super) sampling: bool,
}

/// Compares the members of two declarations of one block (§4.3.7), the output's first.
pub(super) fn compare_members(types: &Types, a: StructId, b: StructId, free: Free) -> Option<MemberDifference<'_>> {
    let (a, b) = (&types.structure(a).members, &types.structure(b).members);
    for (a, b) in a.iter().zip(b) {
        if a.name != b.name || !same_type(types, a.ty, b.ty) {
            return Some(MemberDifference::Declaration(a, b));
        }
        let has_matrix = contains_matrix(types, a.ty);
        if (has_matrix && a.matrix_layout != b.matrix_layout)
            || a.interpolation != b.interpolation && !free.interpolation
            || a.sampling != b.sampling && !free.sampling
            || a.invariant != b.invariant && !(free.invariant && a.invariant)
            || a.place != b.place
        {
            return Some(MemberDifference::Qualifiers(a, b));
        }
    }
    (a.len() != b.len()).then_some(MemberDifference::Count(a.len(), b.len()))
}

fn contains_matrix(types: &Types, ty: TypeId) -> bool {
    match types.get(ty) {
        Type::Matrix(..) => true,
        Type::Array(element, _) => contains_matrix(types, element),
        Type::Struct(id) => types.structure(id).members.iter().any(|member| contains_matrix(types, member.ty)),
        Type::Error | Type::Void | Type::Scalar(_) | Type::Vector(..) | Type::Sampler(_) => false,
    }
}
