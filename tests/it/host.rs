//! A host that uses only the reflection: it reads the emitted files and the JSON, and knows nothing else about the
//! program. Its picture is compared with the reference, with every flag of `glisten compile`.
//!
//! Needs a Vulkan software adapter.

use crate::drawing;
use crate::support::root;
use glisten::scene::DiskFiles;
use glisten_emit::Reflection;
use glisten_emit::reflection::{Attribute, Binding, Sampler, Uniform};
use glisten_front::{Compiler, Options};
use glisten_reference::Precision;
use glisten_scene::compare::{Criterion, Verdict};
use glisten_scene::picture::Picture;
use glisten_verify::scene;
use std::path::Path;
use std::process::Command;
use wgpu::util::DeviceExt;

const SIDE: u32 = 64;
const VERTICES: usize = 9;

/// The application's data by GLSL names, as its author would have passed it to OpenGL.
struct App {
    attributes: Vec<(&'static str, usize, Vec<f64>)>,
    uniforms: Vec<(&'static str, Vec<f64>)>,
    textures: Vec<(&'static str, [u32; 3], Vec<f64>)>,
}

fn app() -> App {
    // Three triangles: one next to the others, one in front of them, and one that faces away.
    let place = [
        [-0.91, -0.87, -0.5],
        [0.77, -0.93, -0.25],
        [-0.13, 0.59, 0.25],
        [-0.71, 0.97, 0.5],
        [-0.83, -0.41, -0.75],
        [0.69, 0.37, 0.125],
        [0.15, 0.91, 0.0],
        [0.93, 0.17, 0.375],
        [0.31, -0.79, -0.125],
    ];
    let numbers = |count: usize, scale: f64| (0..count).map(|k| (k * 37 % 11) as f64 * scale).collect::<Vec<f64>>();
    App {
        attributes: vec![
            ("place", 3, place.concat()),
            ("frame", 9, numbers(9 * VERTICES, 0.125)),
            ("tint", 3, numbers(3 * VERTICES, 0.0625)),
            ("cell", 2, (0..2 * VERTICES).map(|k| (k % 3) as f64).collect()),
        ],
        uniforms: vec![
            ("projection", vec![1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.75, 0.125, 0.0625, 0., 0.25, 1.25]),
            ("Light[0].direction", vec![0.0, 0.5, 0.75]),
            ("Light[0].power", vec![0.5]),
            ("Light[0].colors", vec![1.0, 0.0, 0.0, 0.25, 0.5, 0.75]),
            ("Light[0].mixing", vec![0.0; 6]),
            ("Light[0].on", vec![1.0]),
            ("Light[1].direction", vec![1.0, 0.25, -0.5]),
            ("Light[1].power", vec![0.25]),
            ("Light[1].colors", vec![0.0, 1.0, 0.5, 0.0, 0.0, 0.0]),
            ("Light[1].mixing", vec![0.125, 0.5, 0.25, -0.25, 0.0625, 0.375]),
            ("Light[1].on", vec![1.0]),
        ],
        textures: vec![
            ("image", [4, 2, 1], numbers(4 * 8, 0.125)),
            ("ramp", [8, 1, 1], numbers(4 * 8, 0.0625)),
            ("shadow", [4, 4, 1], (0..16).map(|k| (k * 7 % 16) as f64 / 16.0).collect()),
            ("table", [10, 1, 1], (0..40).map(|k| (k * 5 % 17) as f64).collect()),
            ("sky", [1, 1, 6], numbers(4 * 6, 0.125)),
        ],
    }
}

/// The choices that a host has.
#[derive(Clone, Copy)]
struct Draw {
    points: bool,
    /// Whether the code reads values that depend on the window's origin.
    window: bool,
    clip_distances: u32,
}

/// The reference's picture of the application.
fn reference(app: &App, draw: Draw) -> Picture {
    let folder = root().join("fixtures/lower");
    let mut text = format!(
        "framebuffer = {{ width = {SIDE}, height = {SIDE}, clear = [0, 0, 0, 0] }}\n[[draw]]\nvertex = '{0}/host.vert'\n\
         fragment = '{0}/host.frag'\nprimitive = \"{1}\"\ndepth_test = true\nclip_distances = {2}\n\
         program_point_size = true\n[draw.attributes]\n",
        folder.display(),
        if draw.points { "points" } else { "triangles" },
        draw.clip_distances,
    );
    let list = |name: &str, values: &[f64]| match name {
        // Integers are written without a point.
        "cell" | "table" => format!("{:?}", values.iter().map(|value| *value as i32).collect::<Vec<i32>>()),
        _ => format!("{values:?}"),
    };
    for (name, size, values) in &app.attributes {
        text += &format!("{name} = {{ size = {size}, values = {} }}\n", list(name, values));
    }
    text += "[draw.uniforms]\n";
    for (name, values) in &app.uniforms {
        match values.as_slice() {
            [one] => text += &format!("\"{name}\" = {one:?}\n"),
            values => text += &format!("\"{name}\" = {values:?}\n"),
        }
    }
    text += "[draw.textures]\n";
    for (name, [width, height, depth], values) in &app.textures {
        let depth = if *depth > 1 && *name != "sky" { format!(", depth = {depth}") } else { String::new() };
        let values = list(name, values);
        text += &format!("{name} = {{ width = {width}, height = {height}{depth}, values = {values} }}\n");
    }
    let place = tempfile::tempdir().expect("a temporary folder");
    let path = place.path().join("host.toml");
    std::fs::write(&path, &text).expect("written");
    let defines = if draw.window { vec![("WINDOW".to_owned(), String::new())] } else { Vec::new() };
    let compiler = Compiler::new(Options { defines, ..Options::default() });
    let loaded = scene::load(&path.to_string_lossy(), &DiskFiles, &compiler);
    drawing::reference(&drawing::loaded("host.toml", loaded), Precision::Envelope)
}

/// Runs `glisten compile`; returns the exit code and, if it is 0, the reflection.
fn compile(into: &Path, flags: &[&str]) -> (Option<i32>, Option<Reflection>) {
    let folder = root().join("fixtures/lower");
    let run = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["compile", "-q", "-o"])
        .arg(into)
        .args(flags)
        .arg(folder.join("host.vert"))
        .arg(folder.join("host.frag"))
        .output()
        .expect("the program runs");
    let text = std::fs::read_to_string(into.join("host.json"));
    (run.status.code(), text.ok().map(|text| serde_json::from_str(&text).expect("the reflection is read back")))
}

struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// The columns and rows of `mat3x2`, `vec4`, `int`.
fn shape(ty: &str) -> (u32, u32) {
    let digits: Vec<u32> = ty.chars().filter_map(|c| c.to_digit(10)).collect();
    match (ty.starts_with("mat"), digits.as_slice()) {
        (true, [n]) => (*n, *n),
        (true, [columns, rows]) => (*columns, *rows),
        (false, [n]) => (1, *n),
        _ => (1, 1),
    }
}

/// The bytes of a number as a component of `ivec3`, `bool`, `mat2`.
fn component(ty: &str, value: f64) -> [u8; 4] {
    match ty.as_bytes() {
        [b'i', ..] => (value as i32).to_ne_bytes(),
        [b'u' | b'b', ..] => (value as u32).to_ne_bytes(),
        _ => (value as f32).to_ne_bytes(),
    }
}

fn write_uniform(buffer: &mut [u8], uniform: &Uniform, values: &[f64]) {
    let (columns, rows) = shape(&uniform.ty);
    let mut values = values.iter();
    for element in 0..uniform.array_size.unwrap_or(1) {
        let start = uniform.offset + element * uniform.array_stride.unwrap_or(0);
        for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
            let stride = uniform.matrix_stride.unwrap_or(0);
            let at = if uniform.row_major { row * stride + column * 4 } else { column * stride + row * 4 };
            let Some(value) = values.next() else { return };
            let at = (start + at) as usize;
            buffer[at..at + 4].copy_from_slice(&component(&uniform.ty, *value));
        }
    }
}

impl Host {
    fn new() -> Self {
        let descriptor = wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        let instance = wgpu::Instance::new(descriptor);
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let software = adapters.iter().find(|adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu);
        let adapter = software.expect("this test needs Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers");
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: wgpu::Features::PASSTHROUGH_SHADERS
                | wgpu::Features::CLIP_DISTANCES
                | wgpu::Features::FLOAT32_FILTERABLE,
            required_limits: adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        }))
        .expect("a device");
        Self { device, queue }
    }

    fn module(&self, file: &Path, entry: &str) -> wgpu::ShaderModule {
        if file.extension().is_some_and(|extension| extension == "wgsl") {
            let text = std::fs::read_to_string(file).expect("the emitted text");
            let source = wgpu::ShaderSource::Wgsl(text.into());
            return self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        }
        let bytes = std::fs::read(file).expect("the emitted words");
        let words: Vec<u32> = bytes.chunks(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        self.words(&words, entry)
    }

    #[expect(unsafe_code, reason = "the emitted words are to run as they are")]
    fn words(&self, words: &[u32], entry: &str) -> wgpu::ShaderModule {
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            entry_points: vec![wgpu::PassthroughShaderEntryPoint {
                name: entry.to_owned().into(),
                workgroup_size: (0, 0, 0),
            }]
            .into(),
            spirv: Some(words.into()),
            ..wgpu::ShaderModuleDescriptorPassthrough::default()
        };
        // SAFETY: the words are valid SPIR-V (`emit.rs` checks them with `spirv-val`), and the layout is that of the
        // reflection.
        unsafe { self.device.create_shader_module_passthrough(descriptor) }
    }

    /// The bytes of every uniform buffer.
    fn buffers(&self, reflection: &Reflection, app: &App) -> Vec<(Binding, wgpu::Buffer)> {
        let mut buffers: Vec<(Binding, Vec<u8>)> = Vec::new();
        if let Some(loose) = &reflection.loose_block {
            buffers.push((Binding { group: loose.group, binding: loose.binding }, vec![0; loose.size as usize]));
        }
        for block in &reflection.blocks {
            for element in 0..block.array_size.unwrap_or(1) {
                let slot = Binding { group: block.group, binding: block.binding + element };
                buffers.push((slot, vec![0; block.size as usize]));
            }
        }
        let place = |buffers: &mut Vec<(Binding, Vec<u8>)>, slot: Binding, write: &dyn Fn(&mut [u8])| {
            let (_, bytes) = buffers.iter_mut().find(|(known, _)| *known == slot).expect("the buffer is reflected");
            write(bytes);
        };
        for uniform in &reflection.uniforms {
            let initial = uniform.default.iter().flatten().map(|value| match value {
                serde_json::Value::Bool(value) => f64::from(u8::from(*value)),
                value => value.as_f64().expect("a number"),
            });
            let initial: Vec<f64> = initial.collect();
            let given = app.uniforms.iter().find(|(name, _)| *name == uniform.name).map(|(_, values)| values.clone());
            let mut values = given.unwrap_or(initial);
            if uniform.name == "projection" && reflection.conventions.clip_z == "minus-one-to-one" {
                // wgpu clips to [0, w]: the host's own matrix maps z to it.
                for column in values.chunks_mut(4) {
                    column[2] = 0.5 * column[2] + 0.5 * column[3];
                }
            }
            let slot = Binding { group: uniform.group, binding: uniform.binding };
            place(&mut buffers, slot, &|bytes| write_uniform(bytes, uniform, &values));
        }
        if let Some(height) = reflection.conventions.framebuffer_height {
            place(&mut buffers, Binding { group: height.group, binding: height.binding }, &|bytes| {
                bytes[height.offset as usize..][..4].copy_from_slice(&(SIDE as f32).to_ne_bytes());
            });
        }
        for sampler in &reflection.samplers {
            let Some(count) = sampler.texel_count else { continue };
            let (_, [width, ..], _) = app.textures.iter().find(|(name, ..)| *name == sampler.name).expect("given");
            place(&mut buffers, Binding { group: count.group, binding: count.binding }, &|bytes| {
                bytes[count.offset as usize..][..4].copy_from_slice(&(*width as i32).to_ne_bytes());
            });
        }
        let usage = wgpu::BufferUsages::UNIFORM;
        let make = |contents: &[u8]| {
            self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        buffers.iter().map(|(slot, bytes)| (*slot, make(bytes))).collect()
    }

    fn texture(&self, sampler: &Sampler, [width, height, layers]: [u32; 3], values: &[f64]) -> wgpu::TextureView {
        let (format, channels) = match sampler.sample_type.as_str() {
            "sint" => (wgpu::TextureFormat::Rgba32Sint, 4),
            "uint" => (wgpu::TextureFormat::Rgba32Uint, 4),
            "depth" => (wgpu::TextureFormat::Depth16Unorm, 1),
            _ => (wgpu::TextureFormat::Rgba32Float, 4),
        };
        let row = sampler.row_width.unwrap_or(width);
        let mut bytes: Vec<u8> = match format {
            wgpu::TextureFormat::Depth16Unorm => {
                values.iter().flat_map(|value| ((value * 65535.0).round() as u16).to_ne_bytes()).collect()
            }
            _ => {
                let letter = if sampler.sample_type == "sint" { "i" } else { "f" };
                values.iter().flat_map(|value| component(letter, *value)).collect()
            }
        };
        let pixel = if channels == 1 { 2 } else { 16 };
        bytes.resize((row * height * layers * pixel) as usize, 0);
        let texture = self.device.create_texture_with_data(
            &self.queue,
            &wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: row, height, depth_or_array_layers: layers },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            &bytes,
        );
        let dimension = Some(view_dimension(&sampler.view_dimension));
        texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..wgpu::TextureViewDescriptor::default() })
    }

    fn sampler(&self, kind: &str) -> wgpu::Sampler {
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            address_mode_w: wgpu::AddressMode::Repeat,
            compare: (kind == "comparison").then_some(wgpu::CompareFunction::LessEqual),
            ..wgpu::SamplerDescriptor::default()
        })
    }

    /// Draws with the files in `folder` whose names end in `extension`.
    fn draw(&self, folder: &Path, extension: &str, reflection: &Reflection, app: &App, draw: Draw) -> Picture {
        let device = &self.device;
        let buffers = self.buffers(reflection, app);
        let mut textures = Vec::new();
        for sampler in &reflection.samplers {
            let (_, size, values) = app.textures.iter().find(|(name, ..)| *name == sampler.name).expect("given");
            let view = self.texture(sampler, *size, values);
            let sampler_object = sampler.sampler_type.as_deref().map(|kind| self.sampler(kind));
            textures.push((sampler, view, sampler_object));
        }
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let layout_of = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: stages, ty, count: None };
        let mut layouts: Vec<(u32, wgpu::BindGroupLayoutEntry)> = Vec::new();
        let mut entries: Vec<(u32, wgpu::BindGroupEntry<'_>)> = Vec::new();
        for (slot, buffer) in &buffers {
            let ty = wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            };
            layouts.push((slot.group, layout_of(slot.binding, ty)));
            let resource = buffer.as_entire_binding();
            entries.push((slot.group, wgpu::BindGroupEntry { binding: slot.binding, resource }));
        }
        for (sampler, view, object) in &textures {
            let ty = wgpu::BindingType::Texture {
                sample_type: sample_type(&sampler.sample_type),
                view_dimension: view_dimension(&sampler.view_dimension),
                multisampled: sampler.multisampled,
            };
            layouts.push((sampler.texture.group, layout_of(sampler.texture.binding, ty)));
            let resource = wgpu::BindingResource::TextureView(view);
            entries.push((sampler.texture.group, wgpu::BindGroupEntry { binding: sampler.texture.binding, resource }));
            let (Some(object), Some(kind)) = (object, &sampler.sampler_type) else { continue };
            let ty = wgpu::BindingType::Sampler(match kind.as_str() {
                "comparison" => wgpu::SamplerBindingType::Comparison,
                _ => wgpu::SamplerBindingType::Filtering,
            });
            layouts.push((sampler.sampler.group, layout_of(sampler.sampler.binding, ty)));
            let resource = wgpu::BindingResource::Sampler(object);
            entries.push((sampler.sampler.group, wgpu::BindGroupEntry { binding: sampler.sampler.binding, resource }));
        }
        layouts.sort_by_key(|(group, entry)| (*group, entry.binding));
        let groups = layouts.iter().map(|(group, _)| group + 1).max().unwrap_or(0);
        let layouts: Vec<wgpu::BindGroupLayout> = (0..groups)
            .map(|group| {
                let of: Vec<_> = layouts.iter().filter(|(of, _)| *of == group).map(|(_, entry)| *entry).collect();
                device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &of })
            })
            .collect();
        let bound: Vec<wgpu::BindGroup> = (0..groups)
            .map(|group| {
                let of: Vec<_> = entries.iter().filter(|(of, _)| *of == group).map(|(_, e)| e.clone()).collect();
                let layout = &layouts[group as usize];
                device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &of })
            })
            .collect();
        let pipeline = self.pipeline(folder, extension, reflection, &layouts, draw);
        let vertices: Vec<wgpu::Buffer> = reflection
            .attributes
            .iter()
            .map(|attribute| {
                let (_, _, values) = app.attributes.iter().find(|(name, ..)| *name == attribute.name).expect("given");
                let bytes: Vec<u8> = values.iter().flat_map(|value| component(&attribute.ty, *value)).collect();
                let usage = wgpu::BufferUsages::VERTEX;
                let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents: &bytes, usage };
                device.create_buffer_init(&descriptor)
            })
            .collect();
        // OpenGL's last vertex provokes.
        let flat = reflection.varyings.iter().any(|varying| varying.interpolation == "flat");
        let turn = if flat && reflection.conventions.provoking_vertex == "first" && !draw.points { 2 } else { 0 };
        let order: Vec<u32> = (0..VERTICES as u32).map(|index| index / 3 * 3 + (index + turn) % 3).collect();
        let contents: Vec<u8> = order.iter().flat_map(|index| index.to_ne_bytes()).collect();
        let usage = wgpu::BufferUsages::INDEX;
        let indices =
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents: &contents, usage });
        let mut rows = self.run(&pipeline, &bound, &vertices, &indices);
        let lower_left = reflection.conventions.window_origin == "lower-left";
        if lower_left != upside_down(reflection, extension) {
            rows.reverse();
        }
        let pixels: Vec<[f64; 4]> = rows.concat();
        Picture {
            covered: pixels.iter().map(|pixel| pixel[3] != 0.0).collect(),
            ..Picture::of_colors(SIDE, SIDE, pixels)
        }
    }

    fn pipeline(
        &self,
        folder: &Path,
        extension: &str,
        reflection: &Reflection,
        layouts: &[wgpu::BindGroupLayout],
        draw: Draw,
    ) -> wgpu::RenderPipeline {
        let names = &reflection.entry_points;
        let (vertex_entry, fragment_entry) = (names.vertex.as_deref(), names.fragment.as_deref());
        let vertex = self.module(&folder.join(format!("host.vert.{extension}")), vertex_entry.expect("a vertex stage"));
        let fragment =
            self.module(&folder.join(format!("host.frag.{extension}")), fragment_entry.expect("a fragment stage"));
        let groups: Vec<_> = layouts.iter().map(Some).collect();
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let columns: Vec<Vec<wgpu::VertexAttribute>> = reflection.attributes.iter().map(columns).collect();
        let buffers: Vec<_> = columns
            .iter()
            .map(|columns| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: columns.iter().map(|column| column.format.size()).sum(),
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: columns,
                })
            })
            .collect();
        let inverted = (reflection.conventions.front_face == "inverted") != upside_down(reflection, extension);
        let targets: Vec<Option<wgpu::ColorTargetState>> =
            reflection.outputs.iter().map(|_| Some(wgpu::TextureFormat::Rgba32Float.into())).collect();
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &vertex,
                entry_point: vertex_entry,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: match draw.points {
                    true => wgpu::PrimitiveTopology::PointList,
                    false => wgpu::PrimitiveTopology::TriangleList,
                },
                front_face: if inverted { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &fragment,
                entry_point: fragment_entry,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The rows of the framebuffer, in memory order.
    fn run(
        &self,
        pipeline: &wgpu::RenderPipeline,
        groups: &[wgpu::BindGroup],
        vertices: &[wgpu::Buffer],
        indices: &wgpu::Buffer,
    ) -> Vec<Vec<[f64; 4]>> {
        let size = wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 };
        let texture = |format| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let (color, depth) = (texture(wgpu::TextureFormat::Rgba32Float), texture(wgpu::TextureFormat::Depth32Float));
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (color_view, depth_view) = (view(&color), view(&depth));
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color_view,
                depth_slice: None,
                resolve_target: None,
                ops,
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth_view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(pipeline);
        for (index, group) in (0..).zip(groups) {
            pass.set_bind_group(index, group, &[]);
        }
        for (index, buffer) in (0..).zip(vertices) {
            pass.set_vertex_buffer(index, buffer.slice(..));
        }
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..VERTICES as u32, 0, 0..1);
        drop(pass);
        let row = SIDE * 16;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * SIDE),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(SIDE) };
        let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(color.as_image_copy(), into, size);
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the draw ends");
        let bytes = buffer.slice(..).get_mapped_range().expect("mapped").to_vec();
        let number = |b: &[u8]| f64::from(f32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
        let pixel = |b: &[u8]| [number(&b[..4]), number(&b[4..8]), number(&b[8..12]), number(&b[12..])];
        bytes.chunks(row as usize).map(|row| row.chunks(16).map(pixel).collect()).collect()
    }
}

/// Whether the code is for normalized device coordinates whose y points down; in wgpu, y points up.
fn upside_down(reflection: &Reflection, extension: &str) -> bool {
    extension == "spv" && reflection.conventions.spirv_env == "vulkan"
}

fn columns(attribute: &Attribute) -> Vec<wgpu::VertexAttribute> {
    use wgpu::VertexFormat as F;
    let (_, rows) = shape(&attribute.ty);
    let format = match (attribute.ty.as_bytes()[0], rows) {
        (b'i', 2) => F::Sint32x2,
        (_, 2) => F::Float32x2,
        (_, 3) => F::Float32x3,
        other => panic!("no attribute of the program has the shape {other:?}"),
    };
    let column = |column: u32| wgpu::VertexAttribute {
        format,
        offset: u64::from(column) * format.size(),
        shader_location: attribute.location + column,
    };
    (0..attribute.columns).map(column).collect()
}

fn view_dimension(name: &str) -> wgpu::TextureViewDimension {
    match name {
        "2d" => wgpu::TextureViewDimension::D2,
        "2d-array" => wgpu::TextureViewDimension::D2Array,
        "3d" => wgpu::TextureViewDimension::D3,
        "cube" => wgpu::TextureViewDimension::Cube,
        other => panic!("WebGPU has no view dimension `{other}` for a GLSL 1.50 sampler"),
    }
}

fn sample_type(name: &str) -> wgpu::TextureSampleType {
    match name {
        "float" => wgpu::TextureSampleType::Float { filterable: true },
        "unfilterable-float" => wgpu::TextureSampleType::Float { filterable: false },
        "depth" => wgpu::TextureSampleType::Depth,
        "sint" => wgpu::TextureSampleType::Sint,
        "uint" => wgpu::TextureSampleType::Uint,
        other => panic!("WebGPU has no sample type `{other}`"),
    }
}

/// The flags, the form of the code, and whether to draw points or triangles.
fn runs() -> Vec<(Vec<&'static str>, &'static str, Draw)> {
    let mut runs = Vec::new();
    for (index, (clip_z, origin)) in [
        ("zero-to-one", "upper-left"),
        ("zero-to-one", "lower-left"),
        ("minus-one-to-one", "upper-left"),
        ("minus-one-to-one", "lower-left"),
    ]
    .into_iter()
    .enumerate()
    {
        for (env, extension) in [("webgpu", "wgsl"), ("webgpu", "spv"), ("vulkan", "spv")] {
            // In a plain Vulkan host, the rows of the window are upright where wgpu's are upside down, so this host
            // cannot provide a window.
            let window = env == "webgpu";
            let (distances, clip_distances) = [("2", 2), ("1", 1), ("0", 0), ("2", 2)][index];
            let mut flags = vec!["--target", if extension == "wgsl" { "wgsl" } else { "spirv" }];
            flags.extend(["--clip-z", clip_z, "--window-origin", origin, "--spirv-env", env]);
            if index > 0 {
                flags.extend(["--clip-distances", distances]);
            }
            if window {
                flags.extend(["-D", "WINDOW"]);
            }
            runs.push((flags, extension, Draw { points: false, window, clip_distances }));
        }
    }
    let points = Draw { points: true, window: true, clip_distances: 2 };
    runs.push((vec!["--target", "spirv", "--program-point-size", "-D", "WINDOW"], "spv", points));
    runs
}

#[test]
fn a_host_that_knows_the_reflection_alone_draws_the_picture() {
    let host = Host::new();
    let app = app();
    let mut wrong = Vec::new();
    for (flags, extension, draw) in runs() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (code, reflection) = compile(folder.path(), &flags);
        assert_eq!(code, Some(0), "{flags:?}");
        let reflection = reflection.expect("the reflection is written");
        assert_eq!(reflection.conventions.clip_distances, draw.clip_distances, "{flags:?}");
        assert_eq!(reflection.conventions.point_size, draw.points, "{flags:?}");
        let picture = host.draw(folder.path(), extension, &reflection, &app, draw);
        let reference = reference(&app, draw);
        let covered = reference.covered.iter().filter(|covered| **covered).count();
        assert!(covered > if draw.points { 60 } else { 900 }, "{covered} pixels are covered");
        let verdict = Verdict::new(&picture, &reference, Criterion::Envelope);
        if verdict.fails() {
            wrong.push(format!("{flags:?} as {extension}: {verdict:#?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn points_with_a_size_are_refused_where_the_target_has_none() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (code, reflection) = compile(folder.path(), &["--target", "wgsl", "--program-point-size"]);
    assert_eq!((code, reflection), (Some(1), None));
}
