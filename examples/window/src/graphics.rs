//! [`Graphics`]: a surface, a pipeline, and the buffers of one sphere.
//!
//! *In:* a window; the time in seconds. *Out:* frames.

use super::mesh;
use super::shaders::lit;
use glam::camera::rh::proj::opengl::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat3, Mat4, Vec3};
use std::error::Error;
use std::sync::Arc;
use wgpu::CurrentSurfaceTexture as Frame;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use winit::dpi::PhysicalSize;
use winit::window::Window;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Radians a second.
const SPEED: f32 = 0.5;

pub(crate) struct Graphics {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    uniforms: wgpu::Buffer,
    vertices: wgpu::Buffer,
    count: u32,
    depth: wgpu::TextureView,
}

impl Graphics {
    pub(crate) async fn new(window: Arc<Window>) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(Arc::clone(&window))?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = instance.request_adapter(&options).await?;
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
        let PhysicalSize { width, height } = window.inner_size();
        let mut configuration = surface
            .get_default_config(&adapter, width.max(1), height.max(1))
            .ok_or("the adapter cannot show pictures")?;
        // The shaders' colors are shown as they are.
        configuration.format = configuration.format.remove_srgb_suffix();
        surface.configure(&device, &configuration);
        let mesh = mesh::sphere(128, 64);
        let buffer =
            |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        let uniforms = buffer(
            bytemuck::bytes_of(&lit::Uniforms::new()),
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let mut light = lit::Light::new();
        light.set_toward(Vec3::new(0.6, 0.64, 0.48)).set_shininess(40.0).set_color([1.0, 0.95, 0.9]);
        let light = buffer(bytemuck::bytes_of(&light), wgpu::BufferUsages::UNIFORM);
        let resources = lit::BindGroup0 { uniforms: &uniforms, light: &light };
        let group = lit::bind_group_0(&device, &lit::bind_group_0_layout(&device), &resources);
        let pipeline = lit::pipeline(&device, [Some(configuration.format.into())], state());
        Ok(Self {
            vertices: buffer(bytemuck::cast_slice(&mesh), wgpu::BufferUsages::VERTEX),
            count: mesh.len() as u32,
            depth: depth(&device, &configuration),
            window,
            surface,
            configuration,
            device,
            queue,
            pipeline,
            group,
            uniforms,
        })
    }

    /// Takes over another size of the window. A minimized one has none.
    pub(crate) fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 {
            (self.configuration.width, self.configuration.height) = (size.width, size.height);
            self.surface.configure(&self.device, &self.configuration);
            self.depth = depth(&self.device, &self.configuration);
        }
        self.ask_for_next();
    }

    pub(crate) fn ask_for_next(&self) {
        self.window.request_redraw();
    }

    /// Draws a frame. A frame that the window does not take is skipped.
    pub(crate) fn draw(&mut self, seconds: f32) -> Result<(), Box<dyn Error>> {
        let frame = match self.surface.get_current_texture() {
            Frame::Success(frame) | Frame::Suboptimal(frame) => frame,
            Frame::Outdated | Frame::Lost => {
                self.surface.configure(&self.device, &self.configuration);
                return Ok(());
            }
            Frame::Timeout | Frame::Occluded => return Ok(()),
            Frame::Validation => return Err("the surface is not valid".into()),
        };
        self.queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&self.uniforms_at(seconds)));
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.sphere(&mut encoder, &view);
        self.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        self.queue.present(frame);
        Ok(())
    }

    fn uniforms_at(&self, seconds: f32) -> lit::Uniforms {
        let aspect = self.configuration.width as f32 / self.configuration.height as f32;
        let turn = Mat4::from_rotation_y(SPEED * seconds);
        let model_view = look_at_mat4(Vec3::new(0.0, 1.0, 3.0), Vec3::ZERO, Vec3::Y) * turn;
        // The program expects OpenGL's clip space; glisten's code converts it.
        let projection = perspective(40f32.to_radians(), aspect, 1.0, 10.0);
        let mut uniforms = lit::Uniforms::new();
        uniforms.set_model_view_projection(projection * model_view).set_model_view(model_view);
        uniforms.set_normal_matrix(Mat3::from_mat4(model_view));
        uniforms
    }

    fn sphere(&self, encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView) {
        let clear = wgpu::Color { r: 0.02, g: 0.02, b: 0.04, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

/// The state of the pipeline that no shader decides.
fn state() -> lit::PipelineState {
    lit::PipelineState {
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..wgpu::PrimitiveState::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        ..lit::PipelineState::default()
    }
}

/// A depth buffer of the surface's size.
fn depth(device: &wgpu::Device, configuration: &wgpu::SurfaceConfiguration) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: configuration.width, height: configuration.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
