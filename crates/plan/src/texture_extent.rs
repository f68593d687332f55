//! The sizes of textures on the device.

use glisten_emit::BUFFER_WIDTH;
use glisten_front::hir::{SamplerDim, SamplerType};
use glisten_scene::TextureLevel;
use wgpu_types as wgpu;

/// The size of a level on the device.
pub fn extent(kind: SamplerType, level: Option<&TextureLevel>) -> wgpu::Extent3d {
    let (width, height, depth) = level.map_or((1, 1, 1), |level| (level.width, level.height, level.depth));
    if kind.dim == SamplerDim::Buffer {
        let texels = width.saturating_mul(height).max(1);
        return wgpu::Extent3d { width: BUFFER_WIDTH, height: texels.div_ceil(BUFFER_WIDTH), depth_or_array_layers: 1 };
    }
    wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: depth.max(1) }
}
