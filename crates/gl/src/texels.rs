//! Texels in transfer to OpenGL: 32 bits per channel, as in the scene.

use super::api::PixelLayout;
use glisten_front::hir::{SamplerType, Scalar};
use glisten_scene::{Texels, Texture};

/// How the texels of a sampler type are stored.
pub(super) fn layout(kind: SamplerType) -> PixelLayout {
    match kind.texel {
        _ if kind.shadow => PixelLayout {
            internal: glow::DEPTH_COMPONENT32F,
            format: glow::DEPTH_COMPONENT,
            kind: glow::FLOAT,
            bytes: 4,
        },
        Scalar::Int => PixelLayout { internal: glow::RGBA32I, format: glow::RGBA_INTEGER, kind: glow::INT, bytes: 16 },
        Scalar::Uint => {
            PixelLayout { internal: glow::RGBA32UI, format: glow::RGBA_INTEGER, kind: glow::UNSIGNED_INT, bytes: 16 }
        }
        Scalar::Bool | Scalar::Float => {
            PixelLayout { internal: glow::RGBA32F, format: glow::RGBA, kind: glow::FLOAT, bytes: 16 }
        }
    }
}

/// How the texels of a texture are stored.
pub(super) fn stored(kind: SamplerType, texture: &Texture) -> PixelLayout {
    let layout = layout(kind);
    if texture.sampling.fixed_point_depth {
        return PixelLayout { internal: glow::DEPTH_COMPONENT24, ..layout };
    }
    layout
}

/// The bytes of the texels; for depth, only the first channel.
pub(super) fn texel_bytes(texels: &Texels, kind: SamplerType) -> Vec<u8> {
    let channels = if kind.shadow { 1 } else { 4 };
    match texels {
        Texels::Float(texels) => {
            texels.iter().flat_map(|texel| texel.iter().take(channels)).copied().flat_map(f32::to_ne_bytes).collect()
        }
        Texels::Int(texels) => texels.iter().flatten().copied().flat_map(i32::to_ne_bytes).collect(),
        Texels::Uint(texels) => texels.iter().flatten().copied().flat_map(u32::to_ne_bytes).collect(),
    }
}
