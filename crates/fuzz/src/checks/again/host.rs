//! The host of a program that came back: attributes, uniforms and textures for other names and other shapes.
//!
//! *In:* a draw, and the program that its emitted code became. *Out:* the draw with that program. *Holds:* numbers go as bytes by the
//! reflection of the first program, and are read by the offsets of the second; textures have the shapes that docs/targets.md tells.

use super::Written;
use glisten_emit::BUFFER_WIDTH;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, ScalarValue, Type};
use glisten_front::link::{SlotBinding, UniformRoot};
use glisten_front::{Program, hir::MatrixLayout};
use glisten_plan::uniforms::UniformBytes;
use glisten_plan::{slots, uniforms};
use glisten_scene::values::LeafShape;
use glisten_scene::{Draw, Texels, Texture, TextureLevel};
use naga::{Handle, Module, ScalarKind, TypeInner};
use std::sync::Arc;

/// The groups of blocks and of textures.
const BLOCKS: u32 = 0;
const TEXTURES: u32 = 1;

/// A type of naga with its offsets.
#[derive(Clone, Copy)]
pub(super) struct Layout<'e> {
    pub(super) module: &'e Module,
    pub(super) ty: Handle<naga::Type>,
}

/// The draw with the program that came back.
pub(super) fn with(draw: &Draw, program: Program, written: &[Written<'_>], height: u32) -> Draw {
    let (old, new) = (&draw.program.interface, &program.interface);
    let texels: Vec<u32> = draw.textures.iter().map(|texture| slots::texels(texture.as_deref())).collect();
    let buffers = uniforms::pack(&draw.program, &draw.uniforms, height, &texels);
    let mut values: Vec<Vec<ScalarValue>> = Vec::new();
    for root in &new.roots {
        let mut found = by_layout(root, written, &buffers).unwrap_or_default();
        found.resize(program.types.flat_len(root.ty) as usize, ScalarValue::Uint(0));
        values.push(found);
    }
    by_bindings(&program, &buffers, &mut values);
    let attributes = new.attributes.iter().map(|attribute| {
        let index = old.attributes.iter().position(|known| known.location == attribute.location)?;
        draw.attributes.get(index).cloned().flatten()
    });
    let textures = new.samplers.iter().map(|slot| {
        let named = || {
            let mut all = written.iter().flat_map(|one| &one.textures);
            all.find(|(name, _)| *name == slot.name).map(|(_, binding)| *binding)
        };
        let told = slot.unit.map(|binding| SlotBinding { group: TEXTURES, binding });
        let binding = told.or_else(named)?;
        let index = old.samplers.iter().position(|known| known.texture == binding)?;
        let texture = draw.textures.get(index)?.as_ref()?;
        match program.types.get(slot.ty) {
            Type::Sampler(kind) => Some(shaped(texture, kind)),
            _ => None,
        }
    });
    let (attributes, textures) = (attributes.collect(), textures.collect());
    Draw {
        attributes,
        textures,
        uniforms: values,
        dynamic: Vec::new(),
        fixed: None,
        program: Arc::new(program),
        ..draw.clone()
    }
}

/// The values of a root whose block has a type of naga.
fn by_layout(root: &UniformRoot, written: &[Written<'_>], buffers: &[UniformBytes]) -> Option<Vec<ScalarValue>> {
    let mut blocks = written.iter().flat_map(|one| &one.blocks);
    let (_, slot, layout) = blocks.find(|(name, ..)| *name == root.name)?;
    let buffer = buffers.iter().find(|buffer| buffer.slot == *slot)?;
    let mut flat = Vec::new();
    flatten(layout.module, layout.ty, &buffer.bytes, 0, &mut flat);
    Some(flat)
}

/// Sets the values of blocks that have their bindings in the text, by the offsets of the text.
fn by_bindings(program: &Program, buffers: &[UniformBytes], values: &mut [Vec<ScalarValue>]) {
    let interface = &program.interface;
    for leaf in &interface.uniforms {
        let block = interface.blocks.iter().find(|block| block.root == leaf.root);
        let Some(binding) = block.and_then(|block| block.unit) else { continue };
        let slot = SlotBinding { group: BLOCKS, binding: binding + leaf.block_element };
        let Some(buffer) = buffers.iter().find(|buffer| buffer.slot == slot) else { continue };
        let Some(shape) = LeafShape::of(&program.types, leaf) else { continue };
        let stride = leaf.matrix_stride.unwrap_or(16);
        let Some(flat) = values.get_mut(leaf.root.0 as usize) else { continue };
        for index in 0..shape.n_values() as u32 {
            let (element, row) = (index / shape.n_each() as u32, index % shape.rows);
            let column = index / shape.rows % shape.columns;
            let within = match leaf.matrix_layout {
                _ if shape.columns == 1 => row * 4,
                MatrixLayout::ColumnMajor => column * stride + row * 4,
                MatrixLayout::RowMajor => row * stride + column * 4,
            };
            let offset = leaf.offset + element * leaf.array_stride.unwrap_or(0) + within;
            if let Some(place) = flat.get_mut((leaf.flat_offset + index) as usize) {
                *place = value(shape.scalar, word(&buffer.bytes, offset));
            }
        }
    }
}

fn word(bytes: &[u8], offset: u32) -> u32 {
    let four = bytes.get(offset as usize..offset as usize + 4).and_then(|four| four.try_into().ok());
    u32::from_ne_bytes(four.unwrap_or_default())
}

fn value(scalar: Scalar, word: u32) -> ScalarValue {
    match scalar {
        Scalar::Int => ScalarValue::Int(word.cast_signed()),
        Scalar::Uint => ScalarValue::Uint(word),
        Scalar::Bool => ScalarValue::Bool(word != 0),
        Scalar::Float => ScalarValue::Float(f32::from_bits(word)),
    }
}

/// The scalars of a type in bytes, in the order of GLSL, by naga's offsets.
fn flatten(module: &Module, ty: Handle<naga::Type>, bytes: &[u8], offset: u32, flat: &mut Vec<ScalarValue>) {
    let value = |kind: ScalarKind, offset: u32| {
        let scalar = match kind {
            ScalarKind::Sint => Scalar::Int,
            ScalarKind::Uint => Scalar::Uint,
            ScalarKind::Bool => Scalar::Bool,
            _ => Scalar::Float,
        };
        value(scalar, word(bytes, offset))
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => flat.push(value(scalar.kind, offset)),
        TypeInner::Vector { size, scalar } => {
            flat.extend((0..*size as u32).map(|component| value(scalar.kind, offset + component * 4)));
        }
        TypeInner::Matrix { columns, rows, scalar } => {
            let stride = if *rows as u32 == 2 { 8 } else { 16 };
            for column in 0..*columns as u32 {
                flat.extend((0..*rows as u32).map(|row| value(scalar.kind, offset + column * stride + row * 4)));
            }
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(size), stride } => {
            (0..size.get()).for_each(|index| flatten(module, *base, bytes, offset + index * stride, flat));
        }
        TypeInner::Struct { members, .. } => {
            members.iter().for_each(|member| flatten(module, member.ty, bytes, offset + member.offset, flat));
        }
        _ => {}
    }
}

/// A texture in the shape that emitted code gives it: a texture of one dimension is one row, rectangles are ordinary ones, the faces of a
/// cube of integers are layers, and a buffer is rows of a fixed length.
fn shaped(texture: &Arc<Texture>, kind: SamplerType) -> Arc<Texture> {
    if texture.kind == kind {
        return Arc::clone(texture);
    }
    let is_buffer = texture.kind.dim == SamplerDim::Buffer && kind.dim != SamplerDim::Buffer;
    let levels = texture.levels.iter().map(|level| if is_buffer { rows(level) } else { level.clone() }).collect();
    Arc::new(Texture { kind, levels, ..(**texture).clone() })
}

/// The texels of a buffer in rows of a fixed length; black behind the last.
fn rows(level: &TextureLevel) -> TextureLevel {
    let count = level.width.saturating_mul(level.height).max(1);
    let height = count.div_ceil(BUFFER_WIDTH);
    let len = BUFFER_WIDTH as usize * height as usize;
    fn filled<T: Copy + Default>(texels: &[[T; 4]], len: usize) -> Vec<[T; 4]> {
        let mut filled = texels.to_vec();
        filled.resize(len, [T::default(); 4]);
        filled
    }
    let texels = match &level.texels {
        Texels::Float(texels) => Texels::Float(filled(texels, len)),
        Texels::Int(texels) => Texels::Int(filled(texels, len)),
        Texels::Uint(texels) => Texels::Uint(filled(texels, len)),
    };
    TextureLevel { width: BUFFER_WIDTH, height, depth: 1, texels }
}
