//! Packs uniform values into bytes (§4.3.7, OpenGL 3.2 §2.11.4).
//!
//! *In:* a program's interface and the flat values of its roots. *Out:* the bytes of the buffer at each binding, in
//! the reflected layout. *Holds:* every byte comes from a [`UniformLeaf`], so nothing here goes beyond what a host
//! can do with the reflection alone.

use glisten_front::hir::{MatrixLayout, ScalarValue, Types};
use glisten_front::link::{Interface, Program, SlotBinding, UniformLeaf};
use glisten_scene::values::{LeafShape, bits};

/// The bytes of one uniform buffer.
#[derive(Debug, PartialEq)]
pub struct UniformBytes {
    /// The binding.
    pub slot: SlotBinding,
    /// The bytes, a multiple of 16 and at least 16.
    pub bytes: Vec<u8>,
}

/// All uniform buffers of a program, by binding. `framebuffer_height` is in pixels; `texels` are the numbers of
/// texels of the textures in the interface's sampler slots, in order.
pub fn pack(
    program: &Program,
    values: &[Vec<ScalarValue>],
    framebuffer_height: u32,
    texels: &[u32],
) -> Vec<UniformBytes> {
    let interface = &program.interface;
    let mut buffers = buffers(interface);
    for leaf in &interface.uniforms {
        let (Some(buffer), Some(flat)) =
            (buffers.iter_mut().find(|buffer| buffer.slot == leaf.slot), values.get(leaf.root.0 as usize))
        else {
            continue;
        };
        pack_leaf(&program.types, leaf, flat, &mut buffer.bytes);
    }
    if let (Some((slot, _)), Some(offset)) = (interface.loose, interface.framebuffer_height)
        && let Some(buffer) = buffers.iter_mut().find(|buffer| buffer.slot == slot)
    {
        put(&mut buffer.bytes, offset as usize, (framebuffer_height as f32).to_ne_bytes());
    }
    for (sampler, texels) in interface.samplers.iter().zip(texels) {
        if let (Some((slot, _)), Some(offset)) = (interface.loose, sampler.texel_count)
            && let Some(buffer) = buffers.iter_mut().find(|buffer| buffer.slot == slot)
        {
            put(&mut buffer.bytes, offset as usize, texels.to_ne_bytes());
        }
    }
    buffers
}

/// Zeroed buffers for the loose block and for every element of every block.
fn buffers(interface: &Interface) -> Vec<UniformBytes> {
    let zeroed = |slot, size: u32| UniformBytes { slot, bytes: vec![0; size.max(16).next_multiple_of(16) as usize] };
    let mut buffers: Vec<UniformBytes> = interface.loose.iter().map(|&(slot, size)| zeroed(slot, size)).collect();
    for block in &interface.blocks {
        for element in 0..block.array_size.unwrap_or(1) {
            let slot = SlotBinding { binding: block.slot.binding + element, ..block.slot };
            buffers.push(zeroed(slot, block.size));
        }
    }
    buffers.sort_by_key(|buffer| buffer.slot);
    buffers
}

fn pack_leaf(types: &Types, leaf: &UniformLeaf, flat: &[ScalarValue], bytes: &mut [u8]) {
    let Some(LeafShape { columns, rows, elements, .. }) = LeafShape::of(types, leaf) else { return };
    let matrix_stride = leaf.matrix_stride.unwrap_or(16);
    for element in 0..elements {
        let start = leaf.offset + element * leaf.array_stride.unwrap_or(0);
        for column in 0..columns {
            for row in 0..rows {
                let within = match leaf.matrix_layout {
                    MatrixLayout::ColumnMajor => column * matrix_stride + row * 4,
                    MatrixLayout::RowMajor => row * matrix_stride + column * 4,
                };
                let index = leaf.flat_offset + (element * columns + column) * rows + row;
                if let Some(value) = flat.get(index as usize) {
                    put(
                        bytes,
                        (start + if columns == 1 { row * 4 } else { within }) as usize,
                        bits(*value).to_ne_bytes(),
                    );
                }
            }
        }
    }
}

/// Writes four bytes if there is room for them.
fn put(bytes: &mut [u8], offset: usize, value: [u8; 4]) {
    if let Some(place) = bytes.get_mut(offset..offset.saturating_add(4)) {
        place.copy_from_slice(&value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_front::hir::TypeId;
    use glisten_front::link::RootIndex;

    const SLOT: SlotBinding = SlotBinding { group: 0, binding: 0 };

    fn leaf(ty: TypeId) -> UniformLeaf {
        UniformLeaf {
            name: "u".into(),
            ty,
            array_size: None,
            root: RootIndex(0),
            block_element: 0,
            flat_offset: 0,
            slot: SLOT,
            offset: 0,
            array_stride: None,
            matrix_stride: None,
            matrix_layout: MatrixLayout::ColumnMajor,
            active: true,
        }
    }

    fn packed(leaf: &UniformLeaf, values: &[f32], size: usize) -> Vec<f32> {
        let flat: Vec<ScalarValue> = values.iter().copied().map(ScalarValue::Float).collect();
        let mut bytes = vec![0; size];
        pack_leaf(&Types::new(), leaf, &flat, &mut bytes);
        bytes.chunks(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect()
    }

    #[test]
    fn arrays_keep_their_stride() {
        let leaf = UniformLeaf { array_size: Some(2), array_stride: Some(16), offset: 16, ..leaf(TypeId::FLOAT) };
        assert_eq!(packed(&leaf, &[1.0, 2.0], 48), [0., 0., 0., 0., 1., 0., 0., 0., 2., 0., 0., 0.]);
    }

    #[test]
    fn matrices_by_columns_and_by_rows() {
        let columns = UniformLeaf { matrix_stride: Some(16), ..leaf(TypeId::matrix(2, 3)) };
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(packed(&columns, &values, 32), [1., 2., 3., 0., 4., 5., 6., 0.]);
        let rows = UniformLeaf { matrix_layout: MatrixLayout::RowMajor, ..columns };
        assert_eq!(packed(&rows, &values, 48), [1., 4., 0., 0., 2., 5., 0., 0., 3., 6., 0., 0.]);
    }

    #[test]
    fn what_has_no_room_is_left_out() {
        assert_eq!(packed(&leaf(TypeId::VEC4), &[1.0, 2.0, 3.0, 4.0], 8), [1.0, 2.0]);
    }
}
