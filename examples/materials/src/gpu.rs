//! Pipelines of programs and frames by them.
//!
//! *In:* modules and reflections. *Out:* pixels. *Holds:* where a uniform is the reflection says; a program without uniforms has
//! no buffer.

use crate::materials::{DYNAMIC, Material, zero};
use glisten::emit::{Conventions, Emitted, Reflection, Target, emit, reflect};
use glisten::specialize::{ScalarValue, Variant};
use glisten::{Program, Stage};
use std::error::Error;

/// Pixels each way.
const SIZE: u32 = 512;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

pub(crate) struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    target: wgpu::Texture,
}

/// A pipeline, with what its uniforms are.
pub(crate) struct Pipeline {
    pipeline: wgpu::RenderPipeline,
    reflection: Reflection,
    /// The buffer of the loose uniforms and its group.
    uniforms: Option<(wgpu::Buffer, u32, wgpu::BindGroup)>,
}

impl Gpu {
    pub(crate) async fn new() -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: COLOR,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        Ok(Self { device, queue, target })
    }

    /// The pipeline of a whole program.
    pub(crate) fn pipeline_of_program(&self, program: &Program) -> Result<Pipeline, Box<dyn Error>> {
        let conventions = Conventions::default();
        let module = |stage| emit(program, stage, Target::Wgsl, &conventions);
        self.pipeline([module(Stage::Vertex), module(Stage::Fragment)], reflect(program, &conventions))
    }

    /// The pipeline of a residual.
    pub(crate) fn pipeline_of_variant(&self, variant: &Variant) -> Result<Pipeline, Box<dyn Error>> {
        let conventions = Conventions::default();
        let module = |stage| variant.module(stage, Target::Wgsl, &conventions);
        self.pipeline([module(Stage::Vertex), module(Stage::Fragment)], variant.reflection(&conventions))
    }

    fn pipeline(
        &self,
        modules: [Result<Emitted, Vec<glisten::Diagnostic>>; 2],
        reflection: Reflection,
    ) -> Result<Pipeline, Box<dyn Error>> {
        let [vertex, fragment] = modules.map(|module| match module {
            Ok(Emitted::Text(text)) => Ok(self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(text.into()),
            })),
            Ok(_) => Err("WGSL is text".to_owned()),
            Err(found) => Err(found.into_iter().map(|one| one.message).collect::<Vec<_>>().join("; ")),
        });
        let (vertex, fragment) = (vertex?, fragment?);
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &vertex,
                entry_point: reflection.entry_points.vertex.as_deref(),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &fragment,
                entry_point: reflection.entry_points.fragment.as_deref(),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(COLOR.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniforms = reflection.loose_block.as_ref().map(|block| {
            let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(block.size),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(block.group),
                entries: &[wgpu::BindGroupEntry { binding: block.binding, resource: buffer.as_entire_binding() }],
            });
            (buffer, block.group, group)
        });
        Ok(Pipeline { pipeline, reflection, uniforms })
    }

    /// Draws a frame and waits for it.
    pub(crate) fn draw(&self, pipeline: &Pipeline, material: &Material, time: f32) -> Result<(), Box<dyn Error>> {
        if let Some((buffer, _, _)) = &pipeline.uniforms {
            self.queue.write_buffer(buffer, 0, &bytes(&pipeline.reflection, buffer.size(), material, time));
        }
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let view = self.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&pipeline.pipeline);
        if let Some((_, index, group)) = &pipeline.uniforms {
            pass.set_bind_group(*index, group, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(())
    }

    /// The pixels of the last frame.
    pub(crate) fn read(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        // A row is a multiple of the 256 bytes that copies want.
        let row = 4 * SIZE;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * SIZE),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            self.target.size(),
        );
        self.queue.submit([encoder.finish()]);
        let slice = buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(slice.get_mapped_range()?.to_vec())
    }
}

/// The contents of the buffer of the loose uniforms.
fn bytes(reflection: &Reflection, size: u64, material: &Material, time: f32) -> Vec<u8> {
    let mut bytes = vec![0; size as usize];
    for uniform in reflection.uniforms.iter().filter(|uniform| uniform.block.is_none()) {
        let (scalar, components) = shape(&uniform.ty);
        let elements = uniform.array_size.unwrap_or(1) as usize;
        let values = if uniform.name == DYNAMIC {
            vec![ScalarValue::Float(time)]
        } else {
            material.scalars(&uniform.name, components * elements, zero(scalar))
        };
        for (index, value) in values.iter().enumerate() {
            let stride = uniform.array_stride.unwrap_or(0) as usize;
            let place = uniform.offset as usize + index / components * stride + index % components * 4;
            let word = match *value {
                ScalarValue::Float(value) => value.to_le_bytes(),
                ScalarValue::Int(value) => value.to_le_bytes(),
                ScalarValue::Uint(value) => value.to_le_bytes(),
                ScalarValue::Bool(value) => u32::from(value).to_le_bytes(),
            };
            if let Some(slot) = bytes.get_mut(place..place + 4) {
                slot.copy_from_slice(&word);
            }
        }
    }
    bytes
}

/// The scalar type of a scalar or vector, and how many components it has.
fn shape(ty: &str) -> (&str, usize) {
    match ty {
        "vec2" => ("float", 2),
        "vec3" => ("float", 3),
        "vec4" => ("float", 4),
        scalar => (scalar, 1),
    }
}
