//! Draws the lit sphere into a texture and reads it back.
//!
//! *In:* vertices and uniforms, in the types of the shaders' module. *Out:* pixels, RGBA, the top row first.

use super::SIZE;
use super::shaders::lit;
use std::error::Error;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

pub(crate) async fn draw(
    vertices: &[lit::Vertex],
    uniforms: &lit::Uniforms,
    light: &lit::Light,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
    let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
    let buffer =
        |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let vertex_buffer = buffer(bytemuck::cast_slice(vertices), wgpu::BufferUsages::VERTEX);
    let resources = lit::BindGroup0 {
        uniforms: &buffer(bytemuck::bytes_of(uniforms), wgpu::BufferUsages::UNIFORM),
        light: &buffer(bytemuck::bytes_of(light), wgpu::BufferUsages::UNIFORM),
    };
    let group = lit::bind_group_0(&device, &lit::bind_group_0_layout(&device), &resources);
    let state = lit::PipelineState {
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..wgpu::PrimitiveState::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        ..lit::PipelineState::default()
    };
    let pipeline = lit::pipeline(&device, [Some(COLOR.into())], state);
    let texture = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
            view_formats: &[],
        })
    };
    let (color, depth) = (texture(COLOR, wgpu::TextureUsages::COPY_SRC), texture(DEPTH, wgpu::TextureUsages::empty()));
    let [color_view, depth_view] =
        [&color, &depth].map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let clear = wgpu::Color { r: 0.02, g: 0.02, b: 0.04, a: 1.0 };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, vertex_buffer.slice(..));
    pass.draw(0..vertices.len() as u32, 0..1);
    drop(pass);
    read(&device, &queue, encoder, &color)
}

/// Submits the work and reads the texture.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, Box<dyn Error>> {
    // A row of 128 pixels is a multiple of the 256 bytes that copies want.
    let row = 4 * SIZE;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * SIZE),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    let slice = buffer.slice(..);
    slice.map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(slice.get_mapped_range()?.to_vec())
}
