//! Sampler slots: the types of their bindings, their samplers, the texel of a slot without a texture.
//!
//! *In:* a sampler type, a scene's [`Texture`]. *Out:* what a host makes of them. *Holds:* one-dimensional textures become two-dimensional
//! ones of height 1, rectangles ordinary ones, buffers [`BUFFER_WIDTH`](glisten_emit::BUFFER_WIDTH) texels wide; shadow samplers get a depth
//! texture.

use crate::states::{address_mode, compare, filter_mode};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_scene::{Compare, Filter, Sampling, Texels, Texture, TextureLevel, Wrap};
use wgpu_types as wgpu;

/// The binding type of a sampler type's texture.
pub fn texture_binding(kind: SamplerType) -> wgpu::BindingType {
    let multisampled = kind.dim == SamplerDim::Multisample;
    let sample_type = match kind.texel {
        _ if kind.shadow => wgpu::TextureSampleType::Depth,
        Scalar::Int => wgpu::TextureSampleType::Sint,
        Scalar::Uint => wgpu::TextureSampleType::Uint,
        Scalar::Bool | Scalar::Float => {
            wgpu::TextureSampleType::Float { filterable: !multisampled && kind.dim != SamplerDim::Buffer }
        }
    };
    wgpu::BindingType::Texture { sample_type, view_dimension: view_dimension(kind), multisampled }
}

/// The binding type of a sampler type's sampler.
pub fn sampler_binding(kind: SamplerType) -> wgpu::BindingType {
    wgpu::BindingType::Sampler(if kind.shadow {
        wgpu::SamplerBindingType::Comparison
    } else {
        wgpu::SamplerBindingType::Filtering
    })
}

/// The dimension of a view of a sampler type's texture.
pub fn view_dimension(kind: SamplerType) -> wgpu::TextureViewDimension {
    match (kind.dim, kind.arrayed) {
        (SamplerDim::D3, _) => wgpu::TextureViewDimension::D3,
        // Texels cannot be loaded from a cube, and integer texels are only loaded.
        (SamplerDim::Cube, _) if kind.texel != Scalar::Float => wgpu::TextureViewDimension::D2Array,
        (SamplerDim::Cube, false) => wgpu::TextureViewDimension::Cube,
        (SamplerDim::Cube, true) => wgpu::TextureViewDimension::CubeArray,
        (_, false) => wgpu::TextureViewDimension::D2,
        (_, true) => wgpu::TextureViewDimension::D2Array,
    }
}

/// A single black texel.
pub fn black_texel(kind: SamplerType) -> Texture {
    let depth = match (kind.dim, kind.arrayed) {
        (SamplerDim::Cube, _) => 6,
        _ => 1,
    };
    let texels = Texels::Float(vec![[0.0; 4]; depth as usize]);
    Texture {
        kind,
        levels: vec![TextureLevel { width: 1, height: 1, depth, texels }],
        filter: Filter::Nearest,
        wrap: Wrap::ClampToEdge,
        compare: Compare::Always,
        sampling: Sampling::default(),
    }
}

/// The sampler of a slot.
pub fn sampler(kind: SamplerType, texture: &Texture) -> wgpu::SamplerDescriptor<Option<&'static str>> {
    let wrap = address_mode(texture.wrap);
    let filter = filter_mode(texture.filter);
    let blended = texture.filter.blends_levels();
    wgpu::SamplerDescriptor {
        label: None,
        address_mode_u: wrap,
        address_mode_v: wrap,
        address_mode_w: wrap,
        mag_filter: if texture.sampling.magnifies_linearly(texture.filter) {
            wgpu::FilterMode::Linear
        } else {
            wgpu::FilterMode::Nearest
        },
        min_filter: filter,
        mipmap_filter: if blended { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest },
        lod_min_clamp: 0.0,
        // OpenGL's NEAREST and LINEAR never leave the base level, whatever level is requested.
        lod_max_clamp: if texture.filter.uses_levels() { 1000.0 } else { 0.0 },
        compare: kind.shadow.then(|| compare(texture.compare)),
        ..wgpu::SamplerDescriptor::default()
    }
}

/// The number of texels of the base level; 0 without a texture.
pub fn texels(texture: Option<&Texture>) -> u32 {
    let level = texture.and_then(|texture| texture.levels.first());
    level.map_or(0, |level| level.width.saturating_mul(level.height).saturating_mul(level.depth.max(1)))
}
