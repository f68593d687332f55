//! Uploads multisample textures by drawing, since WebGPU cannot copy to them.
//!
//! *In:* a texture with an image for each sample. *Out:* a view of a texture with [`SAMPLES`] samples. Each image is drawn
//! with a sample mask that lets only its own sample through. *Holds:* a texture may have more samples than the scene's, as
//! with `glTexImage2DMultisample`; a shader that asks for those gets an undefined value.

use super::{Error, Gpu};
use glisten_front::hir::{SamplerType, Scalar};
use glisten_plan::texels::{texel_bytes, texel_format};
use glisten_scene::{Texture, TextureLevel};

/// The samples of a texture on the device: WebGPU has textures of one sample and of four.
const SAMPLES: u32 = 4;

const COPY: &str = "
@group(0) @binding(0) var source: texture_2d<T>;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn texel(@builtin(position) place: vec4<f32>) -> @location(0) vec4<T> {
    return textureLoad(source, vec2<i32>(place.xy), 0);
}
";

/// Reports what WebGPU cannot hold.
pub(super) fn refuse(kind: SamplerType, texture: Option<&Texture>) -> Result<(), Error> {
    if kind.arrayed {
        return Err(Error::Unsupported(format!(
            "the texture of a `{}`: WebGPU has no multisample arrays",
            kind.name()
        )));
    }
    let samples = texture.map_or(1, |texture| texture.levels.len());
    if samples > SAMPLES as usize {
        return Err(Error::Unsupported(format!("a texture of {samples} samples: WebGPU has at most {SAMPLES}")));
    }
    Ok(())
}

/// Uploads the images of all samples. Samples that the scene does not have are 0.
pub(super) fn upload(gpu: &Gpu, kind: SamplerType, texture: &Texture) -> wgpu::TextureView {
    let format = texel_format(kind.texel);
    let size = texture.levels.first().map_or(wgpu::Extent3d::default(), extent);
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: SAMPLES,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    for (sample, level) in texture.levels.iter().enumerate().take(SAMPLES as usize) {
        let pipeline = pipeline(gpu, kind.texel, sample as u32);
        let group = source(gpu, &pipeline, kind.texel, level, size);
        let load = if sample == 0 { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    view
}

fn extent(level: &TextureLevel) -> wgpu::Extent3d {
    wgpu::Extent3d { width: level.width.max(1), height: level.height.max(1), depth_or_array_layers: 1 }
}

/// Copies texels to one sample.
fn pipeline(gpu: &Gpu, texel: Scalar, sample: u32) -> wgpu::RenderPipeline {
    let name = match texel {
        Scalar::Int => "i32",
        Scalar::Uint => "u32",
        Scalar::Bool | Scalar::Float => "f32",
    };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("multisample upload"),
        source: wgpu::ShaderSource::Wgsl(COPY.replace("<T>", &format!("<{name}>")).into()),
    });
    let layout = layout(gpu, texel);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("multisample upload"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState { count: SAMPLES, mask: 1 << sample, alpha_to_coverage_enabled: false },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(texel_format(texel).into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// One texture, which is not filtered.
fn layout(gpu: &Gpu, texel: Scalar) -> wgpu::PipelineLayout {
    let sample_type = match texel {
        Scalar::Int => wgpu::TextureSampleType::Sint,
        Scalar::Uint => wgpu::TextureSampleType::Uint,
        Scalar::Bool | Scalar::Float => wgpu::TextureSampleType::Float { filterable: false },
    };
    let group = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        }],
    });
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&group)],
        immediate_size: 0,
    })
}

/// The texels of a sample as a texture to load from.
fn source(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    texel: Scalar,
    level: &TextureLevel,
    size: wgpu::Extent3d,
) -> wgpu::BindGroup {
    let source = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: texel_format(texel),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut bytes = texel_bytes(&level.texels, texel);
    bytes.resize(size.width as usize * size.height as usize * 16, 0);
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size.width * 16), rows_per_image: None };
    gpu.queue.write_texture(source.as_image_copy(), &bytes, rows, size);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&source.create_view(&wgpu::TextureViewDescriptor::default())),
        }],
    })
}
