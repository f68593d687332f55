//! One frame: attachments, the passes that draw a prepared scene, and the read-back to a [`Picture`].
//!
//! *Holds:* values are those that the format stores, without clamping or conversion except to `f64`. Coverage is the
//! stencil that each written fragment sets (see `states::depth_stencil`), never inferred from colors. The device does
//! not report edges: `near_edge` and `undecided` are all `false` here.

use super::prepare::Prepared;
use super::{Error, Gpu, Rendered, Via};
use glisten_plan::pixels::picture;
use glisten_plan::states::{color_format, pixel_size};
use glisten_scene::picture::Picture;
use glisten_scene::{Framebuffer, Scene};
use std::time::Instant;

/// The attachments of a frame.
pub(super) struct Attachments {
    colors: Vec<(wgpu::Texture, wgpu::TextureView)>,
    depth: (wgpu::Texture, wgpu::TextureView),
}

impl Gpu {
    /// Draws a scene once.
    ///
    /// # Errors
    /// The errors of [`Gpu::prepare`], and [`Error::Timeout`] or [`Error::Lost`].
    pub fn render(&self, scene: &Scene, via: Via) -> Result<Rendered, Error> {
        let prepared = self.prepare(scene, via)?;
        self.draw(&prepared)
    }

    /// Draws a prepared scene once.
    ///
    /// # Errors
    /// [`Error::Refused`], [`Error::Timeout`] or [`Error::Lost`].
    pub fn draw(&self, prepared: &Prepared) -> Result<Rendered, Error> {
        self.guarded(|| {
            let attachments = self.attachments(&prepared.framebuffer);
            let stopwatch = self.stopwatch();
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.encode_pass(&mut encoder, prepared, &attachments, stopwatch.as_ref().map(|watch| watch.writes(0, 1)));
            if let Some(watch) = &stopwatch {
                watch.resolve(&mut encoder);
            }
            let readers = self.read_back(&mut encoder, &prepared.framebuffer, &attachments);
            let start = Instant::now();
            self.queue.submit([encoder.finish()]);
            self.wait()?;
            let wall = start.elapsed().as_secs_f64() * 1e3;
            let milliseconds = match &stopwatch {
                Some(watch) => watch.milliseconds(self)?,
                None => wall,
            };
            let picture = self.picture(&prepared.framebuffer, &readers)?;
            Ok(Rendered { picture, milliseconds })
        })
    }

    pub(super) fn attachments(&self, framebuffer: &Framebuffer) -> Attachments {
        let texture = |format| {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: extent(framebuffer),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            (texture, view)
        };
        Attachments {
            colors: (0..framebuffer.attachments).map(|_| texture(color_format(framebuffer.format))).collect(),
            depth: texture(wgpu::TextureFormat::Depth32FloatStencil8),
        }
    }

    /// Encodes a pass that clears all attachments and draws the scene.
    pub(super) fn encode_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        attachments: &Attachments,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        self.with_pass(encoder, prepared, attachments, timestamp_writes, |pass| record(pass, prepared));
    }

    /// Encodes the same pass under a query that counts.
    pub(super) fn encode_counted_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        attachments: &Attachments,
        queries: &wgpu::QuerySet,
    ) {
        self.with_pass(encoder, prepared, attachments, None, |pass| {
            pass.begin_pipeline_statistics_query(queries, 0);
            record(pass, prepared);
            pass.end_pipeline_statistics_query();
        });
    }

    fn with_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        attachments: &Attachments,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
        body: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let [r, g, b, a] = prepared.framebuffer.clear;
        let ops =
            wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }), store: wgpu::StoreOp::Store };
        let colors: Vec<_> = attachments
            .colors
            .iter()
            .map(|(_, view)| {
                Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
            })
            .collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &attachments.depth.1,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        body(&mut pass);
    }

    /// Copies every attachment and the stencil to buffers that the host can read.
    fn read_back(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        framebuffer: &Framebuffer,
        attachments: &Attachments,
    ) -> Vec<Reader> {
        let mut readers = Vec::new();
        let colors = attachments
            .colors
            .iter()
            .map(|(texture, _)| (texture, wgpu::TextureAspect::All, pixel_size(framebuffer.format)));
        let stencil = std::iter::once((&attachments.depth.0, wgpu::TextureAspect::StencilOnly, 1));
        for (texture, aspect, pixel) in colors.chain(stencil) {
            let row = (framebuffer.width * pixel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
            let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(row) * u64::from(framebuffer.height),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { aspect, ..texture.as_image_copy() },
                wgpu::TexelCopyBufferInfo {
                    buffer: &buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row),
                        rows_per_image: Some(framebuffer.height),
                    },
                },
                extent(framebuffer),
            );
            readers.push(Reader { buffer, row: row as usize, used: (framebuffer.width * pixel) as usize });
        }
        readers
    }

    /// The bytes of a buffer that was copied to.
    pub(super) fn bytes(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, Error> {
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let bytes = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|error| Error::Lost(format!("reading back failed: {error}")))?
            .to_vec();
        buffer.unmap();
        Ok(bytes)
    }

    fn picture(&self, framebuffer: &Framebuffer, readers: &[Reader]) -> Result<Picture, Error> {
        let mut planes = Vec::new();
        for reader in readers {
            let bytes = self.bytes(&reader.buffer)?;
            planes
                .push(bytes.chunks(reader.row).flat_map(|row| row[..reader.used].iter().copied()).collect::<Vec<u8>>());
        }
        Ok(picture(framebuffer, planes))
    }
}

/// A buffer with the rows of a picture.
struct Reader {
    buffer: wgpu::Buffer,
    /// The stride of a row in bytes.
    row: usize,
    /// The number of used bytes in a row.
    used: usize,
}

fn extent(framebuffer: &Framebuffer) -> wgpu::Extent3d {
    wgpu::Extent3d { width: framebuffer.width, height: framebuffer.height, depth_or_array_layers: 1 }
}

/// Records all draws of a scene.
fn record(pass: &mut wgpu::RenderPass<'_>, prepared: &Prepared) {
    pass.set_stencil_reference(1);
    for draw in &prepared.draws {
        pass.set_pipeline(&draw.pipeline);
        if let Some(constant) = draw.constant {
            pass.set_blend_constant(constant);
        }
        for (index, group) in (0..).zip(&draw.groups) {
            pass.set_bind_group(index, group, &[]);
        }
        for (index, buffer) in (0..).zip(&draw.vertex_buffers) {
            pass.set_vertex_buffer(index, buffer.slice(..));
        }
        match &draw.indices {
            Some(indices) => {
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..draw.count, 0, 0..draw.instances);
            }
            None => pass.draw(0..draw.count, 0..draw.instances),
        }
    }
}
