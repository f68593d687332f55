//! Textures and samplers on the device, in the form that the lowering expects.
//!
//! *In:* a scene's [`Texture`] and the sampler slot that reads it. *Out:* a view and a sampler. One-dimensional
//! textures become two-dimensional ones of height 1, rectangles ordinary ones, buffers
//! [`BUFFER_WIDTH`](glisten_emit::BUFFER_WIDTH) texels wide; shadow samplers get a depth texture. A slot without a
//! texture (an inactive one) gets a single black texel, so that every binding of the layout is filled.

use super::{Error, Gpu, multisample_upload, shadow_upload};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_plan::slots::{black_texel, sampler, view_dimension};
use glisten_plan::texels::{texel_bytes, texel_format};
use glisten_plan::texture_extent::extent;
use glisten_scene::Texture;

/// The resources of a sampler slot.
pub(super) struct Bound {
    /// The texture.
    pub(super) view: wgpu::TextureView,
    /// The sampler.
    pub(super) sampler: wgpu::Sampler,
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
    Ok(Bound { view, sampler: gpu.device.create_sampler(&sampler(kind, texture)) })
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
