//! [`StructArray`]: arrays of structs in uniform memory, each once, with a stride.
//!
//! *In:* a [`Program`]. *Out:* one entry for each array of structs, nested arrays inside it. *Holds:* the offset of a
//! member of element `i` is `offset + i * array_stride` plus the offset of the member; the rows of
//! [`Reflection::uniforms`](super::Reflection::uniforms) say the same for each element.

use glisten_front::hir::{ArraySize, MatrixLayout, StructId, Type, TypeId, Types};
use glisten_front::link::{Interface, Program, UniformLeaf, UniformRoot};
use serde::{Deserialize, Serialize};

/// An array of structs in a uniform buffer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StructArray {
    /// The path that hosts use, without an index: `light`, `Block.light`.
    pub name: String,
    /// The name of the struct.
    #[serde(rename = "type")]
    pub ty: String,
    /// The number of elements.
    pub array_size: u32,
    /// The stride in bytes between elements.
    pub array_stride: u32,
    /// The block's name; none for a loose uniform.
    pub block: Option<String>,
    /// The group of the buffer.
    pub group: u32,
    /// The binding of the buffer.
    pub binding: u32,
    /// The offset in bytes of the first element.
    pub offset: u32,
    /// The members of one element.
    pub members: Vec<StructMember>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A member of an element; members of structs in it are listed one by one, as `inner.member`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StructMember {
    /// The path inside the element.
    pub name: String,
    /// The GLSL type of one element.
    #[serde(rename = "type")]
    pub ty: String,
    /// The number of elements, if it is an array.
    pub array_size: Option<u32>,
    /// The offset in bytes from the start of the element that it is in.
    pub offset: u32,
    /// The stride in bytes between elements.
    pub array_stride: Option<u32>,
    /// The stride in bytes between columns; in `row_major`, between rows.
    pub matrix_stride: Option<u32>,
    /// Whether a matrix is stored by rows.
    pub row_major: bool,
    /// The members, if it is itself an array of structs.
    pub members: Vec<Self>,
}

/// All arrays of structs of a program, in the order of its uniforms.
pub(super) fn arrays(program: &Program) -> Vec<StructArray> {
    let Program { types, interface, .. } = program;
    let mut found = Vec::new();
    let mut of_roots: Vec<Vec<&UniformLeaf>> = vec![Vec::new(); interface.roots.len()];
    for leaf in &interface.uniforms {
        if let Some(leaves) = of_roots.get_mut(leaf.root.0 as usize) {
            leaves.push(leaf);
        }
    }
    for (root, leaves) in interface.roots.iter().zip(of_roots) {
        for (path, ty) in starts(types, interface, root) {
            below(types, &path, ty, &mut |path, ty, size| {
                found.extend(array(types, interface, root, &leaves, path, ty, size));
            });
        }
    }
    found
}

/// The paths at which the memory of a root starts: one for each element of an array of blocks.
fn starts(types: &Types, interface: &Interface, root: &UniformRoot) -> Vec<(String, TypeId)> {
    let Some(block) = root.block.and_then(|index| interface.blocks.get(index.0 as usize)) else {
        return vec![(root.name.clone(), root.ty)];
    };
    match types.get(root.ty) {
        Type::Array(element, ArraySize::Sized(size)) => {
            (0..size).map(|index| (format!("{}[{index}]", block.name), element)).collect()
        }
        // Members of a block without an instance name are names of their own.
        _ if block.instance.is_none() => vec![(String::new(), root.ty)],
        _ => vec![(block.name.clone(), root.ty)],
    }
}

/// Calls `visit` with the outermost arrays of structs at and below a path.
fn below(types: &Types, path: &str, ty: TypeId, visit: &mut dyn FnMut(&str, StructId, u32)) {
    match types.get(ty) {
        Type::Array(element, ArraySize::Sized(size)) => {
            if let Type::Struct(id) = types.get(element) {
                visit(path, id, size);
            }
        }
        Type::Struct(id) => {
            for member in &types.structure(id).members {
                below(types, &joined(path, &member.name), member.ty, visit);
            }
        }
        _ => {}
    }
}

fn joined(path: &str, member: &str) -> String {
    if path.is_empty() { member.to_owned() } else { format!("{path}.{member}") }
}

fn array(
    types: &Types,
    interface: &Interface,
    root: &UniformRoot,
    leaves: &[&UniformLeaf],
    path: &str,
    structure: StructId,
    size: u32,
) -> Option<StructArray> {
    let (offset, stride) = extent(types, leaves, path)?;
    let slot = leaves.iter().find(|leaf| leaf.name.starts_with(&format!("{path}[0].")))?.slot;
    let block = root.block.and_then(|index| interface.blocks.get(index.0 as usize));
    Some(StructArray {
        name: path.to_owned(),
        ty: types.structure(structure).name.clone(),
        array_size: size,
        array_stride: stride,
        block: block.map(|block| block.name.clone()),
        group: slot.group,
        binding: slot.binding,
        offset,
        members: members(types, leaves, &format!("{path}[0]"), "", structure, offset),
        active: root.active,
    })
}

/// The offset of an array of structs, and its stride: in std140, the size of a struct is a multiple of 16.
fn extent(types: &Types, leaves: &[&UniformLeaf], path: &str) -> Option<(u32, u32)> {
    let first = format!("{path}[0].");
    let own = leaves.iter().filter(|leaf| leaf.name.starts_with(&first));
    let start = own.clone().map(|leaf| leaf.offset).min()?;
    let end = own.map(|leaf| leaf.offset.saturating_add(size_of(types, leaf))).max()?;
    Some((start, end.saturating_sub(start).next_multiple_of(16)))
}

/// The number of bytes from the first to the last of a leaf.
pub(super) fn size_of(types: &Types, leaf: &UniformLeaf) -> u32 {
    let one = match types.get(leaf.ty) {
        Type::Matrix(columns, rows) => {
            let (lines, width) = match leaf.matrix_layout {
                MatrixLayout::ColumnMajor => (columns, rows),
                MatrixLayout::RowMajor => (rows, columns),
            };
            let stride = leaf.matrix_stride.unwrap_or(16);
            stride.saturating_mul(u32::from(lines).saturating_sub(1)).saturating_add(4 * u32::from(width))
        }
        _ => 4 * types.flat_len(leaf.ty),
    };
    match (leaf.array_size, leaf.array_stride) {
        // The last element of an array has its padding, too (rule 4).
        (Some(size), Some(stride)) => stride.saturating_mul(size),
        _ => one,
    }
}

/// The members of a struct at a path, whose element starts at `base`.
fn members(
    types: &Types,
    leaves: &[&UniformLeaf],
    path: &str,
    prefix: &str,
    structure: StructId,
    base: u32,
) -> Vec<StructMember> {
    let mut list = Vec::new();
    for member in &types.structure(structure).members {
        let (path, name) = (joined(path, &member.name), joined(prefix, &member.name));
        if let Type::Struct(id) = types.get(member.ty) {
            list.extend(members(types, leaves, &path, &name, id, base));
            continue;
        }
        let inner = match types.get(member.ty) {
            Type::Array(element, ArraySize::Sized(size)) => match types.get(element) {
                Type::Struct(id) => Some((id, size)),
                _ => None,
            },
            _ => None,
        };
        if let Some((id, size)) = inner {
            let Some((offset, stride)) = extent(types, leaves, &path) else { continue };
            list.push(StructMember {
                name,
                ty: types.structure(id).name.clone(),
                array_size: Some(size),
                offset: offset.saturating_sub(base),
                array_stride: Some(stride),
                matrix_stride: None,
                row_major: false,
                members: members(types, leaves, &format!("{path}[0]"), "", id, offset),
            });
            continue;
        }
        // Samplers have no place in memory.
        let Some(leaf) = leaves.iter().find(|leaf| leaf.name == path) else { continue };
        list.push(StructMember {
            name,
            ty: types.name(leaf.ty),
            array_size: leaf.array_size,
            offset: leaf.offset.saturating_sub(base),
            array_stride: leaf.array_stride,
            matrix_stride: leaf.matrix_stride,
            row_major: leaf.matrix_layout == MatrixLayout::RowMajor,
            members: Vec::new(),
        });
    }
    list
}
