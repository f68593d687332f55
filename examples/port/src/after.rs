//! After: the knot by wgpu, with `ported/shaders.rs`, which `glisten port` wrote.
//!
//! *In:* the folder for the picture. *Out:* `after.png` there. *Holds:* matrices are still OpenGL's; the shaders convert the depth.

#![expect(clippy::print_stdout, reason = "a program prints")]

mod shared;

/// The shaders.
mod shaders {
    include!("../ported/shaders.rs");
}

use shaders::glisten_memory::Bytes;
use shaders::knot;
use shared::{AMBIENT, BACKGROUND, LAMP, PATTERN, SHININESS, SIZE};
use std::error::Error;
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};
use wgpu::{BufferUsages, TextureFormat, TextureUsages};

const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
const DEPTH: TextureFormat = TextureFormat::Depth24Plus;

fn main() -> Result<(), Box<dyn Error>> {
    let picture = pollster::block_on(draw())?;
    let before = shared::write("after.png", &picture)?.with_file_name("before.png");
    if before.exists() {
        let differing = shared::differing(&before, &picture)?;
        println!("{differing} of {} pixels differ from before.png by more than 2/255", SIZE * SIZE);
        if differing > (SIZE * SIZE / 200) as usize {
            return Err("the pictures differ".into());
        }
    }
    Ok(())
}

async fn draw() -> Result<Vec<u8>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
    let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
    let texture = |format, size, usage| wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    };
    let [color, depth] = [(COLOR, TextureUsages::COPY_SRC), (DEPTH, TextureUsages::empty())]
        .map(|(format, more)| device.create_texture(&texture(format, SIZE, TextureUsages::RENDER_ATTACHMENT | more)));

    let state = knot::PipelineState {
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        ..knot::PipelineState::default()
    };
    let pipeline = knot::pipeline(&device, [Some(COLOR.into())], state);
    let mut uniforms = knot::Uniforms::new();
    uniforms.set_view(shared::view().to_cols_array_2d()).set_projection(shared::projection().to_cols_array_2d());
    uniforms.set_lamp(LAMP).set_ambient(AMBIENT).set_shininess(SHININESS);
    let buffer =
        |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let uniforms = buffer(&uniforms.to_bytes(), BufferUsages::UNIFORM);
    let layout = knot::bind_group_0_layout(&device);
    let group_0 = knot::bind_group_0(&device, &layout, &knot::BindGroup0 { uniforms: &uniforms });

    let described = texture(COLOR, PATTERN, TextureUsages::TEXTURE_BINDING);
    let pattern = device.create_texture_with_data(&queue, &described, TextureDataOrder::LayerMajor, &shared::pattern());
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    });
    let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let resources = knot::BindGroup1 { pattern: &view(&pattern), pattern_sampler: &sampler };
    let group_1 = knot::bind_group_1(&device, &knot::bind_group_1_layout(&device), &resources);

    let corners = shared::knot();
    let vertices =
        corners.iter().map(|(p, n, uv)| knot::Vertex { position: p.to_array(), normal: n.to_array(), uv: *uv });
    let vertices = buffer(&vertices.flat_map(|vertex| vertex.to_bytes()).collect::<Vec<_>>(), BufferUsages::VERTEX);

    let [r, g, b, a] = BACKGROUND.map(f64::from);
    let (color_view, depth_view) = (view(&color), view(&depth));
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group_0, &[]);
    pass.set_bind_group(1, &group_1, &[]);
    pass.set_vertex_buffer(0, vertices.slice(..));
    pass.draw(0..corners.len() as u32, 0..1);
    drop(pass);

    // A row of 320 pixels is a multiple of the 256 bytes that copies want.
    let into = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * SIZE * SIZE),
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &into, layout };
    encoder.copy_texture_to_buffer(color.as_image_copy(), to, color.size());
    queue.submit([encoder.finish()]);
    into.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(into.slice(..).get_mapped_range()?.to_vec())
}
