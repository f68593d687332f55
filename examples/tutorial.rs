//! Draws two shaders of OpenGL 3.2 with wgpu: the program of `docs/tutorial.md`.
//!
//! ```sh
//! cargo run --example tutorial -- target/tutorial.png
//! ```

use glisten::emit::{Conventions, Emitted, Reflection, Target, emit, reflect};
use glisten::{Compiler, Options, Source, Stage};
use glisten_scene::picture::{ImageFormat, Picture};
use wgpu::util::DeviceExt;

const SIDE: u32 = 256;

/// The data that the application passed to OpenGL, by the names in the shaders.
pub struct Globe {
    /// Names and values, matrices by columns.
    pub uniforms: Vec<(&'static str, Vec<f32>)>,
    /// Names, numbers of components, values.
    pub attributes: Vec<(&'static str, usize, Vec<f32>)>,
    /// Three vertices a triangle.
    pub indices: Vec<u32>,
    /// Width, height, RGBA.
    pub surface: (u32, u32, Vec<f32>),
}

/// The shaders in WGSL, and what the host has to know.
pub struct Translated {
    /// The vertex stage.
    pub vertex: String,
    /// The fragment stage.
    pub fragment: String,
    /// Locations, offsets and bindings.
    pub reflection: Reflection,
}

fn main() {
    let path = std::env::args().nth(1).unwrap_or_else(|| "tutorial.png".to_owned());
    let picture = draw(&translate(), &globe());
    let png = picture.encode(0, ImageFormat::Png).expect("a picture of bytes is a PNG");
    std::fs::write(&path, png).expect("the file can be written");
}

// [translate]
/// Translates both shaders.
pub fn translate() -> Translated {
    let source = |name: &str, stage, text: &str| Source { name: name.to_owned(), text: text.into(), stage };
    let compilation = Compiler::new(Options::default()).compile(&[
        source("globe.vert", Stage::Vertex, include_str!("../fixtures/tutorial/globe.vert")),
        source("globe.frag", Stage::Fragment, include_str!("../fixtures/tutorial/globe.frag")),
    ]);
    let program = compilation.program.expect("the shaders have no errors");
    let conventions = Conventions::default();
    let wgsl = |stage| match emit(&program, stage, Target::Wgsl, &conventions) {
        Ok(Emitted::Text(text)) => text,
        _ => panic!("WGSL is text"),
    };
    Translated {
        vertex: wgsl(Stage::Vertex),
        fragment: wgsl(Stage::Fragment),
        reflection: reflect(&program, &conventions),
    }
}
// [translate]

// [uniforms]
/// The bytes of the uniform buffer: each value where the reflection says.
fn uniform_bytes(reflection: &Reflection, globe: &Globe) -> Vec<u8> {
    let size = reflection.loose_block.as_ref().map_or(0, |block| block.size as usize);
    let mut bytes = vec![0; size];
    for uniform in &reflection.uniforms {
        let Some((_, values)) = globe.uniforms.iter().find(|(name, _)| *name == uniform.name) else { continue };
        // Columns of matrices are `matrix_stride` apart; a vector is one column.
        let columns = if uniform.matrix_stride.is_some() { values.len().isqrt() } else { 1 };
        let rows = values.len() / columns;
        for (index, value) in values.iter().enumerate() {
            let column = (index / rows) as u32 * uniform.matrix_stride.unwrap_or(0);
            let at = (uniform.offset + column) as usize + 4 * (index % rows);
            bytes[at..at + 4].copy_from_slice(&value.to_ne_bytes());
        }
    }
    bytes
}
// [uniforms]

// [device]
fn device() -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options)).expect("a GPU, or Mesa's software driver");
    let descriptor = wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() };
    pollster::block_on(adapter.request_device(&descriptor)).expect("a device")
}
// [device]

// [pipeline]
fn pipeline(device: &wgpu::Device, translated: &Translated) -> wgpu::RenderPipeline {
    let module = |text: &str| {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    };
    // One buffer for each attribute, at the location that the reflection assigns.
    let formats = |ty: &str| match ty {
        "vec2" => (wgpu::VertexFormat::Float32x2, 8),
        "vec3" => (wgpu::VertexFormat::Float32x3, 12),
        _ => (wgpu::VertexFormat::Float32x4, 16),
    };
    let attributes: Vec<([wgpu::VertexAttribute; 1], u64)> = (translated.reflection.attributes.iter())
        .map(|attribute| {
            let (format, stride) = formats(&attribute.ty);
            ([wgpu::VertexAttribute { format, offset: 0, shader_location: attribute.location }], stride)
        })
        .collect();
    let buffers: Vec<Option<wgpu::VertexBufferLayout<'_>>> = (attributes.iter())
        .map(|(attributes, stride)| {
            Some(wgpu::VertexBufferLayout {
                array_stride: *stride,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes,
            })
        })
        .collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module(&translated.vertex),
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        fragment: Some(wgpu::FragmentState {
            module: &module(&translated.fragment),
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
        }),
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: None,
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    })
}
// [pipeline]

/// Draws the globe.
pub fn draw(translated: &Translated, globe: &Globe) -> Picture {
    let (device, queue) = device();
    let pipeline = pipeline(&device, translated);
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    };
    let bytes = |values: &[f32]| values.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>();
    let reflection = &translated.reflection;
    // [bindings]
    let uniforms = buffer(&uniform_bytes(reflection, globe), wgpu::BufferUsages::UNIFORM);
    let view = texture(&device, &queue, &globe.surface);
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        ..Default::default()
    });
    let mut entries: Vec<(u32, wgpu::BindGroupEntry<'_>)> = Vec::new();
    if let Some(block) = &reflection.loose_block {
        let resource = uniforms.as_entire_binding();
        entries.push((block.group, wgpu::BindGroupEntry { binding: block.binding, resource }));
    }
    for slot in &reflection.samplers {
        let texture = wgpu::BindingResource::TextureView(&view);
        entries.push((slot.texture.group, wgpu::BindGroupEntry { binding: slot.texture.binding, resource: texture }));
        let sampler = wgpu::BindingResource::Sampler(&sampler);
        entries.push((slot.sampler.group, wgpu::BindGroupEntry { binding: slot.sampler.binding, resource: sampler }));
    }
    let mut groups: Vec<u32> = entries.iter().map(|(group, _)| *group).collect();
    groups.sort_unstable();
    groups.dedup();
    let groups: Vec<(u32, wgpu::BindGroup)> = (groups.into_iter())
        .map(|group| {
            let of_group: Vec<wgpu::BindGroupEntry<'_>> =
                entries.iter().filter(|(of, _)| *of == group).map(|(_, entry)| entry.clone()).collect();
            let layout = pipeline.get_bind_group_layout(group);
            let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &of_group };
            (group, device.create_bind_group(&descriptor))
        })
        .collect();
    // [bindings]
    let vertices: Vec<wgpu::Buffer> = (reflection.attributes.iter())
        .filter_map(|attribute| globe.attributes.iter().find(|(name, ..)| *name == attribute.name))
        .map(|(_, _, values)| buffer(&bytes(values), wgpu::BufferUsages::VERTEX))
        .collect();
    let indices: Vec<u8> = globe.indices.iter().flat_map(|index| index.to_ne_bytes()).collect();
    let indices = buffer(&indices, wgpu::BufferUsages::INDEX);
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = target.create_view(&Default::default());
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let attachment = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        };
        let descriptor = wgpu::RenderPassDescriptor { color_attachments: &[Some(attachment)], ..Default::default() };
        let mut pass = encoder.begin_render_pass(&descriptor);
        pass.set_pipeline(&pipeline);
        for (index, group) in &groups {
            pass.set_bind_group(*index, group, &[]);
        }
        for (slot, vertices) in (0..).zip(&vertices) {
            pass.set_vertex_buffer(slot, vertices.slice(..));
        }
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..globe.indices.len() as u32, 0, 0..1);
    }
    read_back(&device, &queue, encoder, &target)
}

fn texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    (width, height, texels): &(u32, u32, Vec<f32>),
) -> wgpu::TextureView {
    let bytes: Vec<u8> = texels.iter().map(|value| (value * 255.0).round() as u8).collect();
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    device.create_texture_with_data(queue, &descriptor, order, &bytes).create_view(&Default::default())
}

fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    target: &wgpu::Texture,
) -> Picture {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIDE * SIDE * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIDE * 4), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        target.size(),
    );
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("the buffer can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the GPU finishes");
    let bytes = buffer.slice(..).get_mapped_range().expect("the buffer is mapped");
    let color = |pixel: &[u8]| std::array::from_fn(|channel| f64::from(pixel[channel]) / 255.0);
    Picture::of_colors(SIDE, SIDE, bytes.chunks(4).map(color).collect())
}

// [globe]
/// A sphere with a checkered surface, as the application of that time would have built it.
pub fn globe() -> Globe {
    let (segments, rings) = (48_u32, 24_u32);
    let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..=rings {
        for segment in 0..=segments {
            let (u, v) = (segment as f32 / segments as f32, ring as f32 / rings as f32);
            let (longitude, latitude) = (u * std::f32::consts::TAU, (v - 0.5) * std::f32::consts::PI);
            let around = latitude.cos();
            positions.extend([around * longitude.sin(), latitude.sin(), around * longitude.cos()]);
            uvs.extend([u, v]);
        }
    }
    for (ring, segment) in (0..rings).flat_map(|ring| (0..segments).map(move |segment| (ring, segment))) {
        let [a, b] = [ring, ring + 1].map(|ring| ring * (segments + 1) + segment);
        indices.extend([a, a + 1, b + 1, a, b + 1, b]);
    }
    let checker = (0..8 * 16).flat_map(|texel| match (texel % 16 + texel / 16) % 2 {
        0 => [0.9, 0.6, 0.2, 1.0],
        _ => [0.2, 0.4, 0.8, 1.0],
    });
    Globe {
        uniforms: vec![
            // Columns. Orthographic: x and y are scaled, z is turned around as in OpenGL.
            (
                "modelViewProjection",
                vec![0.8, 0.0, 0.0, 0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0, 1.0],
            ),
            ("turn", vec![0.8, 0.0, -0.6, 0.18, 0.954, 0.24, 0.572, -0.3, 0.763]),
            ("towardsLight", vec![0.48, 0.6, 0.64]),
        ],
        attributes: vec![("position", 3, positions), ("uv", 2, uvs)],
        indices,
        surface: (16, 8, checker.collect()),
    }
}
// [globe]
