//! When two types in different shaders are the same (§4.3.5, §4.3.7, §4.3.9): if they are equal except for their
//! positions.
//!
//! A struct that two shaders declare has two handles. It matches if it has the same name and the same members in the
//! same order.

use crate::diagnostic::Diagnostic;
use crate::hir::{Interpolation, Member, ScalarValue, Stage, StructId, Type, TypeId, Types, Value};

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

/// The first members in which two structs of one name differ, at any depth; `None` for one that a struct does not have.
fn differing_members(types: &Types, a: TypeId, b: TypeId) -> Option<(Option<&Member>, Option<&Member>)> {
    match (types.get(a), types.get(b)) {
        (Type::Array(a, a_size), Type::Array(b, b_size)) if a_size == b_size => differing_members(types, a, b),
        (Type::Struct(a), Type::Struct(b)) if types.structure(a).name == types.structure(b).name => {
            let (a, b) = (&types.structure(a).members, &types.structure(b).members);
            let same = |a: &Member, b: &Member| a.name == b.name && same_type(types, a.ty, b.ty);
            let differs = |&index: &usize| !a.get(index).zip(b.get(index)).is_some_and(|(a, b)| same(a, b));
            let index = (0..a.len().max(b.len())).find(differs)?;
            let (a, b) = (a.get(index), b.get(index));
            let inside = a.zip(b).filter(|(a, b)| a.name == b.name);
            inside.and_then(|(a, b)| differing_members(types, a.ty, b.ty)).or(Some((a, b)))
        }
        _ => None,
    }
}

/// Labels the first members in which two structs differ: each type with its stage.
pub(super) fn with_members(
    diagnostic: Diagnostic,
    types: &Types,
    (ours, our_stage): (TypeId, Stage),
    (theirs, their_stage): (TypeId, Stage),
) -> Diagnostic {
    let Some((our, their)) = differing_members(types, ours, theirs) else { return diagnostic };
    let sides = [(our, our_stage, their), (their, their_stage, our)];
    sides.into_iter().fold(diagnostic, |diagnostic, (member, stage, other)| match (member, other) {
        (Some(member), _) => {
            let text = format!("`{} {}` in the {} stage", types.name(member.ty), member.name, stage.name());
            diagnostic.label(member.span, text)
        }
        (None, Some(other)) => diagnostic.note(format!("the {} stage has no `{}`", stage.name(), other.name)),
        (None, None) => diagnostic,
    })
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
    /// `smooth` may be left out (GLSL ES 3.10 §4.5).
    pub(super) smooth: bool,
}

impl Free {
    /// The interpolation qualifier that has to match the other stage's.
    pub(super) fn interpolation_of(self, written: Option<Interpolation>) -> Option<Interpolation> {
        written.or(self.smooth.then_some(Interpolation::Smooth))
    }
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
            || free.interpolation_of(a.interpolation) != free.interpolation_of(b.interpolation) && !free.interpolation
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
