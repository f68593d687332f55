//! The std140 layout (OpenGL 3.2 §2.11.4, rules 1 to 10), used for every uniform block and for the loose uniforms.
//!
//! `shared` and `packed` blocks have the same layout, since any layout is valid for them. A `bool` takes four bytes,
//! a sampler none.

use crate::hir::{ArraySize, MatrixLayout, StructId, Type, TypeId, Types};

/// The largest size of a uniform block in bytes: what WebGPU guarantees for a uniform binding.
pub const MAX_BLOCK_BYTES: u32 = 64 << 10;

const VEC4_ALIGN: u32 = 16;

/// The alignment and size of a type, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) align: u32,
    pub(super) size: u32,
}

/// `offset` rounded up to a multiple of `align`, saturating.
pub(super) fn round_up(offset: u32, align: u32) -> u32 {
    offset.checked_next_multiple_of(align).unwrap_or(u32::MAX)
}

fn vector_extent(components: u8) -> Extent {
    let size = u32::from(components) * 4;
    // Rules 1 to 3: a vector of three components is aligned like one of four.
    let align = if components == 3 { VEC4_ALIGN } else { size };
    Extent { align, size }
}

/// The stride in bytes between columns (in `row_major`, rows): by rules 5 and 7 a matrix is stored as an array of
/// vectors.
pub(super) fn matrix_stride() -> u32 {
    VEC4_ALIGN
}

/// The alignment and size of a type by rules 1 to 10.
pub(super) fn extent(types: &Types, ty: TypeId, layout: MatrixLayout) -> Extent {
    match types.get(ty) {
        Type::Error | Type::Void | Type::Sampler(_) | Type::Array(_, ArraySize::Unsized) => {
            Extent { align: 1, size: 0 }
        }
        Type::Scalar(_) => vector_extent(1),
        Type::Vector(_, size) => vector_extent(size),
        Type::Matrix(columns, rows) => {
            let vectors = if layout == MatrixLayout::RowMajor { rows } else { columns };
            Extent { align: VEC4_ALIGN, size: u32::from(vectors) * matrix_stride() }
        }
        Type::Array(element, ArraySize::Sized(count)) => {
            let size = array_stride(types, element, layout).saturating_mul(count);
            Extent { align: extent(types, element, layout).align.max(VEC4_ALIGN), size }
        }
        Type::Struct(id) => {
            let size = struct_members(types, id, layout).last().map_or(0, |member| member.end);
            Extent { align: VEC4_ALIGN, size: round_up(size, VEC4_ALIGN) }
        }
    }
}

/// The alignment and the size in bytes of a type as a member of a std140 block.
pub fn std140(types: &Types, ty: TypeId) -> (u32, u32) {
    let Extent { align, size } = extent(types, ty, MatrixLayout::ColumnMajor);
    (align, size)
}

/// The stride in bytes between elements of an array: rule 4.
pub(super) fn array_stride(types: &Types, element: TypeId, layout: MatrixLayout) -> u32 {
    round_up(extent(types, element, layout).size, VEC4_ALIGN)
}

/// The offset of a member in its struct.
pub(super) struct Placed {
    pub(super) offset: u32,
    pub(super) end: u32,
    pub(super) layout: MatrixLayout,
}

/// The members of a struct in order. The members of a block have a matrix layout of their own, which the members of
/// nested structs inherit.
pub(super) fn struct_members(types: &Types, id: StructId, inherited: MatrixLayout) -> Vec<Placed> {
    let structure = types.structure(id);
    let mut end = 0;
    let mut placed = Vec::with_capacity(structure.members.len());
    for member in &structure.members {
        let layout = if structure.is_block { member.matrix_layout } else { inherited };
        let Extent { align, size } = extent(types, member.ty, layout);
        let offset = if structure.is_block { member.place.start(end, align) } else { round_up(end, align) };
        end = offset.saturating_add(size);
        // The member after an array or a struct is aligned to that one's alignment (rules 4 and 9).
        if matches!(types.get(member.ty), Type::Array(..) | Type::Struct(_)) {
            end = round_up(end, align);
        }
        placed.push(Placed { offset, end, layout });
    }
    placed
}

/// The byte offset, from the start of a value, of the part whose first scalar has this index in the flat layout. The
/// part must be a scalar, vector, matrix or array of those.
pub(super) fn byte_offset(types: &Types, ty: TypeId, flat_offset: u32, layout: MatrixLayout) -> u32 {
    match types.get(ty) {
        Type::Struct(id) => {
            let mut first = 0;
            for (member, placed) in types.structure(id).members.iter().zip(struct_members(types, id, layout)) {
                let next = first + types.flat_len(member.ty);
                if flat_offset < next {
                    return placed.offset + byte_offset(types, member.ty, flat_offset - first, placed.layout);
                }
                first = next;
            }
            0
        }
        Type::Array(element, _) if matches!(types.get(element), Type::Struct(_) | Type::Array(..)) => {
            let len = types.flat_len(element).max(1);
            let index = flat_offset / len;
            index * array_stride(types, element, layout) + byte_offset(types, element, flat_offset % len, layout)
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hir::{Member, MemberPlace, Scalar, StructType};
    use crate::source::Span;

    fn member(name: &str, ty: TypeId) -> Member {
        Member {
            name: name.into(),
            ty,
            matrix_layout: MatrixLayout::ColumnMajor,
            interpolation: None,
            sampling: crate::hir::Sampling::Center,
            invariant: false,
            implicitly_sized: false,
            place: MemberPlace::default(),
            span: Span::default(),
        }
    }

    fn offsets(types: &mut Types, members: &[TypeId]) -> (Vec<u32>, u32) {
        let members = members.iter().map(|&ty| member("m", ty)).collect();
        let ty = types.add_struct(StructType { name: "B".into(), members, is_block: true, span: Span::default() });
        let Type::Struct(id) = types.get(ty) else { panic!("a struct was added") };
        let placed = struct_members(types, id, MatrixLayout::ColumnMajor);
        (placed.iter().map(|member| member.offset).collect(), extent(types, ty, MatrixLayout::ColumnMajor).size)
    }

    #[test]
    fn a_float_fills_the_gap_behind_a_vec3_but_not_behind_an_array() {
        let mut types = Types::new();
        let floats = types.array(TypeId::FLOAT, ArraySize::Sized(3));
        assert_eq!(offsets(&mut types, &[TypeId::VEC3, TypeId::FLOAT, TypeId::VEC2]), (vec![0, 12, 16], 32));
        assert_eq!(offsets(&mut types, &[TypeId::FLOAT, floats, TypeId::FLOAT]), (vec![0, 16, 64], 80));
    }

    #[test]
    fn a_matrix_is_an_array_of_columns() {
        let mut types = Types::new();
        let (mat2, mat3) = (TypeId::matrix(2, 2), TypeId::matrix(3, 3));
        assert_eq!(offsets(&mut types, &[TypeId::BOOL, mat2, TypeId::FLOAT]), (vec![0, 16, 48], 64));
        assert_eq!(offsets(&mut types, &[mat3, TypeId::FLOAT]), (vec![0, 48], 64));
        let row_major = extent(&types, TypeId::matrix(2, 4), MatrixLayout::RowMajor);
        assert_eq!(row_major, Extent { align: 16, size: 64 });
    }

    #[test]
    fn a_struct_is_aligned_and_padded_to_a_vec4() {
        let mut types = Types::new();
        let members = vec![member("a", TypeId::FLOAT), member("b", TypeId::vector(Scalar::Int, 2))];
        let inner = StructType { name: "S".into(), members, is_block: false, span: Span::default() };
        let inner = types.add_struct(inner);
        let array = types.array(inner, ArraySize::Sized(2));
        assert_eq!(offsets(&mut types, &[TypeId::FLOAT, inner, TypeId::FLOAT]), (vec![0, 16, 32], 48));
        assert_eq!(offsets(&mut types, &[TypeId::FLOAT, array, TypeId::FLOAT]), (vec![0, 16, 48], 64));
    }

    #[test]
    fn absurd_sizes_saturate() {
        let mut types = Types::new();
        let huge = types.array(TypeId::matrix(4, 4), ArraySize::Sized(u32::MAX));
        assert_eq!(extent(&types, huge, MatrixLayout::ColumnMajor).size, u32::MAX);
    }
}
