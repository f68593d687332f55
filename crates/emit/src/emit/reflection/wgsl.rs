//! Names and types in emitted WGSL, for hosts that write bind group layouts, vertex buffers and structs.
//!
//! *In:* uniforms and attributes, or the text of a module. *Out:* WGSL's words for them. *Holds:* names come from the
//! text itself, types in memory follow the same rules as the lowering (`lower/uniforms.rs`).

use super::{Binding, Reflection};
use glisten_front::hir::{MatrixLayout, Scalar, Type, TypeId, Types};
use glisten_front::link::UniformLeaf;
use serde::{Deserialize, Serialize};

/// A variable in WGSL.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WgslVariable {
    /// The name.
    pub name: String,
    /// The type.
    #[serde(rename = "type")]
    pub ty: String,
}

/// The variables of a texture and its sampler in WGSL.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WgslTexture {
    /// The texture.
    pub texture: WgslVariable,
    /// The sampler; none if there is none.
    pub sampler: Option<WgslVariable>,
}

/// The format of a vertex attribute at one location, in WebGPU's terms: `float32x4`.
pub(super) fn vertex_format(types: &Types, ty: TypeId) -> String {
    let mut leaf = ty;
    while !matches!(types.get(leaf), Type::Scalar(_) | Type::Vector(..)) {
        match types.element(leaf) {
            Some(element) => leaf = element,
            None => return String::new(),
        }
    }
    let kind = match types.scalar_of(leaf) {
        Some(Scalar::Int) => "sint32",
        Some(Scalar::Uint | Scalar::Bool) => "uint32",
        _ => "float32",
    };
    match types.flat_len(leaf) {
        1 => kind.to_owned(),
        size => format!("{kind}x{size}"),
    }
}

/// The type of a uniform's memory in WGSL.
pub(super) fn memory_type(types: &Types, leaf: &UniformLeaf) -> String {
    let element = element_type(types, leaf);
    match leaf.array_size {
        Some(size) => format!("array<{element}, {size}>"),
        None => element,
    }
}

fn element_type(types: &Types, leaf: &UniformLeaf) -> String {
    let scalar = match types.scalar_of(leaf.ty) {
        Some(Scalar::Int) => "i32",
        Some(Scalar::Uint | Scalar::Bool) => "u32",
        _ => "f32",
    };
    match types.get(leaf.ty) {
        Type::Matrix(columns, rows) => {
            let (lines, width) = match leaf.matrix_layout {
                MatrixLayout::ColumnMajor => (columns, rows),
                MatrixLayout::RowMajor => (rows, columns),
            };
            match width {
                2 => format!("array<vec4<f32>, {lines}>"),
                _ => format!("mat{lines}x{width}<f32>"),
            }
        }
        _ => match types.flat_len(leaf.ty) {
            // Elements of arrays are 16 bytes apart.
            1 | 2 if leaf.array_size.is_some() => format!("vec4<{scalar}>"),
            1 => scalar.to_owned(),
            size => format!("vec{size}<{scalar}>"),
        },
    }
}

impl Reflection {
    /// Takes over the names that a stage's WGSL gives to buffers, textures and samplers.
    pub fn name_in_wgsl(&mut self, text: &str) {
        for (place, variable) in text.lines().filter_map(variable_of) {
            let at = |group, binding| place == Binding { group, binding };
            if let Some(block) = self.loose_block.as_mut().filter(|block| at(block.group, block.binding)) {
                block.wgsl.get_or_insert_with(|| variable.clone());
            }
            for block in self.blocks.iter_mut().filter(|block| at(block.group, block.binding)) {
                block.wgsl.get_or_insert_with(|| variable.clone());
            }
            for row in self.samplers.iter_mut() {
                if row.texture == place && row.wgsl.is_none() {
                    row.wgsl = Some(WgslTexture { texture: variable.clone(), sampler: None });
                } else if row.sampler == place && row.sampler != row.texture {
                    let names = row.wgsl.as_mut().filter(|names| names.sampler.is_none());
                    if let Some(names) = names {
                        names.sampler = Some(variable.clone());
                    }
                }
            }
        }
    }
}

/// The binding and the variable of a line `@group(0) @binding(1) var<uniform> name: Type;`.
fn variable_of(line: &str) -> Option<(Binding, WgslVariable)> {
    let (group, rest) = line.trim_start().strip_prefix("@group(")?.split_once(')')?;
    let (binding, rest) = rest.trim_start().strip_prefix("@binding(")?.split_once(')')?;
    let rest = rest.trim_start().strip_prefix("var")?;
    let declaration = rest.strip_prefix("<uniform>").unwrap_or(rest);
    let (name, ty) = declaration.trim().trim_end_matches(';').split_once(':')?;
    let place = Binding { group: group.parse().ok()?, binding: binding.parse().ok()? };
    Some((place, WgslVariable { name: name.trim().to_owned(), ty: ty.trim().to_owned() }))
}
