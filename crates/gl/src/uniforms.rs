//! Sets uniform values (OpenGL 3.2 §2.11.4).
//!
//! *In:* a linked program and the flat values of its roots. *Out:* loose uniforms set by name, and a buffer for each
//! element of each block. *Holds:* for every layout, the offsets of block members are those that the driver reports;
//! glisten's own offsets are not used. Uniforms that the driver calls inactive are skipped.

use super::Error;
use super::api::Api;
use glisten_front::hir::{Scalar, ScalarValue};
use glisten_front::link::{Block, UniformLeaf};
use glisten_scene::Draw;
use glisten_scene::values::{LeafShape, bits, of_leaf};

/// Sets all uniforms but samplers. The program must be current.
pub(super) fn set(api: &Api, linked: glow::Program, draw: &Draw) -> Result<(), Error> {
    let program = &draw.program;
    for leaf in &program.interface.uniforms {
        let Some(root) = program.interface.roots.get(leaf.root.0 as usize) else { continue };
        // State of the fixed-function pipeline is no uniform that a host may set.
        if root.block.is_none()
            && !(api.old().is_some() && root.name.starts_with("gl_"))
            && let Some(location) = api.get_uniform_location(linked, &leaf.name)
            && let Some(shape) = LeafShape::of(&program.types, leaf)
        {
            set_loose(api, &location, shape, of_leaf(&draw.uniforms, leaf, shape));
        }
    }
    api.check("setting uniforms")?;
    let mut binding = 0;
    for block in &program.interface.blocks {
        for element in 0..block.array_size.unwrap_or(1) {
            binding += u32::from(set_block(api, linked, draw, block, element, binding)?);
        }
    }
    api.check("filling uniform blocks")
}

fn set_loose(api: &Api, location: &glow::UniformLocation, shape: LeafShape, values: &[ScalarValue]) {
    let at = Some(location);
    match shape.scalar {
        Scalar::Float => {
            let values: Vec<f32> = values.iter().map(|value| f32::from_bits(bits(*value))).collect();
            match (shape.columns, shape.rows) {
                (1, 1) => api.uniform_1_f32_slice(at, &values),
                (1, 2) => api.uniform_2_f32_slice(at, &values),
                (1, 3) => api.uniform_3_f32_slice(at, &values),
                (1, _) => api.uniform_4_f32_slice(at, &values),
                (2, 2) => api.uniform_matrix_2_f32_slice(at, false, &values),
                (2, 3) => api.uniform_matrix_2x3_f32_slice(at, false, &values),
                (2, _) => api.uniform_matrix_2x4_f32_slice(at, false, &values),
                (3, 2) => api.uniform_matrix_3x2_f32_slice(at, false, &values),
                (3, 3) => api.uniform_matrix_3_f32_slice(at, false, &values),
                (3, _) => api.uniform_matrix_3x4_f32_slice(at, false, &values),
                (_, 2) => api.uniform_matrix_4x2_f32_slice(at, false, &values),
                (_, 3) => api.uniform_matrix_4x3_f32_slice(at, false, &values),
                _ => api.uniform_matrix_4_f32_slice(at, false, &values),
            }
        }
        // A boolean is set as an integer.
        Scalar::Int | Scalar::Bool => {
            let values: Vec<i32> = values.iter().map(|value| bits(*value).cast_signed()).collect();
            match shape.rows {
                1 => api.uniform_1_i32_slice(at, &values),
                2 => api.uniform_2_i32_slice(at, &values),
                3 => api.uniform_3_i32_slice(at, &values),
                _ => api.uniform_4_i32_slice(at, &values),
            }
        }
        Scalar::Uint => {
            let values: Vec<u32> = values.iter().map(|value| bits(*value)).collect();
            match shape.rows {
                1 => api.uniform_1_u32_slice(at, &values),
                2 => api.uniform_2_u32_slice(at, &values),
                3 => api.uniform_3_u32_slice(at, &values),
                _ => api.uniform_4_u32_slice(at, &values),
            }
        }
    }
}

/// Fills one element of a block. Returns whether the driver has it at all.
fn set_block(
    api: &Api,
    linked: glow::Program,
    draw: &Draw,
    block: &Block,
    element: u32,
    binding: u32,
) -> Result<bool, Error> {
    let name = match block.array_size {
        Some(_) => format!("{}[{element}]", block.name),
        None => block.name.clone(),
    };
    let Some(index) = api.get_uniform_block_index(linked, &name) else { return Ok(false) };
    let size = api.get_active_uniform_block_parameter_i32(linked, index, glow::UNIFORM_BLOCK_DATA_SIZE);
    let mut bytes = vec![0; usize::try_from(size).unwrap_or(0).max(16)];
    let leaves = draw.program.interface.uniforms.iter();
    for leaf in leaves.filter(|leaf| leaf.root == block.root && leaf.block_element == element) {
        let Some(shape) = LeafShape::of(&draw.program.types, leaf) else { continue };
        if let Some(place) = MemberLayout::of(api, linked, block, leaf) {
            place.fill(shape, of_leaf(&draw.uniforms, leaf, shape), &mut bytes);
        }
    }
    let buffer = api.create_buffer().map_err(Error::Refused)?;
    api.bind_buffer(glow::UNIFORM_BUFFER, Some(buffer));
    api.buffer_data_u8_slice(glow::UNIFORM_BUFFER, &bytes, glow::STATIC_DRAW);
    api.uniform_block_binding(linked, index, binding);
    api.bind_buffer_base(glow::UNIFORM_BUFFER, binding, Some(buffer));
    Ok(true)
}

/// The layout of a member in the driver, in bytes.
struct MemberLayout {
    offset: usize,
    array_stride: usize,
    matrix_stride: usize,
    row_major: bool,
}

impl MemberLayout {
    fn of(api: &Api, linked: glow::Program, block: &Block, leaf: &UniformLeaf) -> Option<Self> {
        // All elements of an array of blocks have the same layout, and OpenGL uses the names of the block's members
        // without an index.
        let element = format!("{}[{}].", block.name, leaf.block_element);
        let name = match leaf.name.strip_prefix(&element) {
            Some(member) if block.array_size.is_some() => format!("{}.{member}", block.name),
            _ => leaf.name.clone(),
        };
        let index = api.get_uniform_indices(linked, &[&name]).first().copied().flatten()?;
        let asked = |what: u32| {
            let told = api.get_active_uniforms_parameter(linked, &[index], what).first().copied();
            told.and_then(|number| usize::try_from(number).ok())
        };
        Some(Self {
            offset: asked(glow::UNIFORM_OFFSET)?,
            array_stride: asked(glow::UNIFORM_ARRAY_STRIDE).unwrap_or(0),
            matrix_stride: asked(glow::UNIFORM_MATRIX_STRIDE).unwrap_or(0),
            row_major: asked(glow::UNIFORM_IS_ROW_MAJOR) == Some(1),
        })
    }

    fn fill(&self, shape: LeafShape, values: &[ScalarValue], bytes: &mut [u8]) {
        for (number, value) in values.iter().enumerate() {
            let (rows, columns) = (shape.rows as usize, shape.columns as usize);
            let (row, column) = (number % rows, number / rows % columns);
            let element = number / (rows * columns);
            let (line, along) = if self.row_major { (row, column) } else { (column, row) };
            let offset = self.offset + element * self.array_stride + line * self.matrix_stride + along * 4;
            if let Some(layout) = bytes.get_mut(offset..offset + 4) {
                layout.copy_from_slice(&bits(*value).to_ne_bytes());
            }
        }
    }
}
