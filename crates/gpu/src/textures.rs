//! Textures and samplers on the device, in the form that the lowering expects.
//!
//! *In:* a scene's [`Texture`] and the sampler slot that reads it. *Out:* a view and a sampler. One-dimensional
//! textures become two-dimensional ones of height 1, rectangles ordinary ones, buffers
//! [`BUFFER_WIDTH`](glisten_emit::BUFFER_WIDTH) texels wide; shadow samplers get a depth texture. A slot without a
//! texture (an inactive one) gets a single black texel, so that every binding of the layout is filled.

use super::states::{address_mode, compare, filter_mode};
use super::texels::{texel_bytes, texel_format};
use super::texture_extent::extent;
use super::{Error, Gpu, multisample_upload, shadow_upload};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_scene::{Compare, Filter, Sampling, Texels, Texture, TextureLevel, Wrap};

/// The resources of a sampler slot.
pub(super) struct Bound {
    /// The texture.
    pub(super) view: wgpu::TextureView,
    /// The sampler.
    pub(super) sampler: wgpu::Sampler,
}

/// The binding type of a sampler type's texture.
pub(super) fn texture_binding(kind: SamplerType) -> wgpu::BindingType {
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
pub(super) fn sampler_binding(kind: SamplerType) -> wgpu::BindingType {
    wgpu::BindingType::Sampler(if kind.shadow {
        wgpu::SamplerBindingType::Comparison
    } else {
        wgpu::SamplerBindingType::Filtering
    })
}

fn view_dimension(kind: SamplerType) -> wgpu::TextureViewDimension {
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

/// Uploads a texture, or a black texel if there is none.
pub(super) fn bind(gpu: &Gpu, kind: SamplerType, texture: Option<&Texture>) -> Result<Bound, Error> {
    let black;
    let texture = match texture {
        Some(texture) => texture,
        None => {
            black = black_texel(kind);
            &black
        }
    };
    if kind.texel == Scalar::Float && !kind.shadow && kind.dim != SamplerDim::Buffer {
        gpu.require(wgpu::Features::FLOAT32_FILTERABLE, "filtering of 32-bit float textures")?;
    }
    let view = if kind.dim == SamplerDim::Multisample {
        multisample_upload::upload(gpu, kind, texture)
    } else if kind.shadow {
        shadow_upload::upload(gpu, texture, view_dimension(kind))
    } else {
        color_view(gpu, kind, texture)
    };
    Ok(Bound { view, sampler: sampler(gpu, kind, texture) })
}

fn black_texel(kind: SamplerType) -> Texture {
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

fn sampler(gpu: &Gpu, kind: SamplerType, texture: &Texture) -> wgpu::Sampler {
    let wrap = address_mode(texture.wrap);
    let filter = filter_mode(texture.filter);
    let blended = texture.filter.blends_levels();
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
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
    })
}

fn color_view(gpu: &Gpu, kind: SamplerType, texture: &Texture) -> wgpu::TextureView {
    let size = extent(kind, texture.levels.first());
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: texture.levels.len().max(1) as u32,
        sample_count: 1,
        dimension: if kind.dim == SamplerDim::D3 { wgpu::TextureDimension::D3 } else { wgpu::TextureDimension::D2 },
        format: texel_format(kind.texel),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (mip_level, level) in texture.levels.iter().enumerate() {
        let size = extent(kind, Some(level));
        let mut bytes = texel_bytes(&level.texels, kind.texel);
        bytes.resize(size.width as usize * size.height as usize * size.depth_or_array_layers as usize * 16, 0);
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: mip_level as u32, ..target.as_image_copy() },
            &bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(size.width * 16),
                rows_per_image: Some(size.height),
            },
            size,
        );
    }
    target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(view_dimension(kind)),
        ..wgpu::TextureViewDescriptor::default()
    })
}

/// The number of texels of the base level; 0 without a texture.
pub(super) fn texels(texture: Option<&Texture>) -> u32 {
    let level = texture.and_then(|texture| texture.levels.first());
    level.map_or(0, |level| level.width.saturating_mul(level.height).saturating_mul(level.depth.max(1)))
}
