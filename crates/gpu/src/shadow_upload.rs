//! Uploads depth textures by drawing, since WebGPU cannot copy to a 32-bit depth texture.
//!
//! *In:* a texture for a shadow sampler, with depth in R. *Out:* a view of a depth texture. Each layer of each level
//! is drawn once with a fragment shader that reads R and writes it as the depth. Depths are clamped to [0, 1].

use super::Gpu;
use glisten_plan::texels::depths;
use glisten_plan::texture_extent::extent;
use glisten_scene::Texture;

const BLIT: &str = "
@group(0) @binding(0) var source: texture_2d<f32>;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn depth(@builtin(position) place: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureLoad(source, vec2<i32>(place.xy), 0).r;
}
";

/// Uploads all levels and layers.
pub(super) fn upload(gpu: &Gpu, texture: &Texture, dimension: wgpu::TextureViewDimension) -> wgpu::TextureView {
    // A driver clamps the reference of a comparison for a fixed-point format alone.
    let fixed = texture.sampling.fixed_point_depth;
    let format = if fixed { wgpu::TextureFormat::Depth24Plus } else { wgpu::TextureFormat::Depth32Float };
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(texture.kind, texture.levels.first()),
        mip_level_count: texture.levels.len().max(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let pipeline = pipeline(gpu, format);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    for (mip_level, level) in texture.levels.iter().enumerate() {
        let size = extent(texture.kind, Some(level));
        let depths = depths(&level.texels);
        let layer_len = size.width as usize * size.height as usize;
        for layer in 0..size.depth_or_array_layers {
            let start = layer as usize * layer_len;
            let layer_depths = depths.get(start..start + layer_len).unwrap_or_default();
            let view = target.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: mip_level as u32,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            });
            draw_layer(gpu, &pipeline, &mut encoder, (&view, size), layer_depths);
        }
    }
    gpu.queue.submit([encoder.finish()]);
    target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension),
        ..wgpu::TextureViewDescriptor::default()
    })
}

fn pipeline(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("depth upload"),
        source: wgpu::ShaderSource::Wgsl(BLIT.into()),
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("depth upload"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn draw_layer(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    encoder: &mut wgpu::CommandEncoder,
    (target, size): (&wgpu::TextureView, wgpu::Extent3d),
    depths: &[f32],
) {
    let size = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
    let source = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size.width * 4), rows_per_image: None };
    gpu.queue.write_texture(source.as_image_copy(), bytemuck::cast_slice(depths), layout, size);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&source.create_view(&wgpu::TextureViewDescriptor::default())),
        }],
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: target,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}
