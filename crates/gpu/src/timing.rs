//! Measures how long a draw takes on the device.
//!
//! *Holds:* a figure is the mean over enough whole frames (each clears, so that a depth test does the same work) that
//! the measurement lasts at least [`Gpu::STRETCH`]. The first frame, which includes compiling the pipelines, is never
//! part of it. The caller measures candidates for a comparison in turns.

use super::frame::Attachments;
use super::{Error, Gpu, Prepared, Via};
use glisten_scene::Scene;
use std::time::{Duration, Instant};

/// A pair of timestamps.
pub(super) struct Stopwatch {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
}

/// The size of two 64-bit timestamps.
const STAMPS: u64 = 16;

impl Stopwatch {
    /// The queries that record the beginning and the end of a pass.
    pub(super) fn writes(&self, beginning: u32, end: u32) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(beginning),
            end_of_pass_write_index: Some(end),
        }
    }

    /// Copies the timestamps to where the host can read them.
    pub(super) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, STAMPS);
    }

    /// The time from the first timestamp to the second.
    pub(super) fn milliseconds(&self, gpu: &Gpu) -> Result<f64, Error> {
        let bytes = gpu.bytes(&self.readable)?;
        let stamps: Vec<u64> = bytes
            .chunks_exact(8)
            .map(|stamp| u64::from_ne_bytes(stamp.try_into().expect("chunks_exact gives 8 bytes")))
            .collect();
        let ticks = match stamps[..] {
            [begin, end] => end.saturating_sub(begin),
            _ => 0,
        };
        Ok(ticks as f64 * f64::from(gpu.queue.get_timestamp_period()) / 1e6)
    }
}

impl Gpu {
    /// The shortest measurement. Shorter ones vary by a factor of two on a software driver.
    pub const STRETCH: Duration = Duration::from_millis(30);
    /// How often a measurement is tried to find the number of its frames.
    const TRIALS: u32 = 3;
    /// The largest number of frames in a measurement.
    const MOST_FRAMES: u32 = 4096;

    pub(super) fn stopwatch(&self) -> Option<Stopwatch> {
        if !self.features.contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |usage| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: STAMPS,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Stopwatch {
            queries: self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
        })
    }

    /// The time of a frame of the scene in milliseconds, measured `repeats` times with warm pipelines.
    ///
    /// # Errors
    /// The errors of [`Gpu::render`].
    pub fn time(&self, scene: &Scene, via: Via, repeats: u32) -> Result<Vec<f64>, Error> {
        let prepared = self.prepare(scene, via)?;
        let frames = self.frames_for_a_stretch(&prepared)?;
        (0..repeats).map(|_| self.measure(&prepared, frames)).collect()
    }

    /// The number of frames in a measurement; warms up the pipelines.
    ///
    /// # Errors
    /// The errors of [`Gpu::draw`].
    pub fn frames_for_a_stretch(&self, prepared: &Prepared) -> Result<u32, Error> {
        self.measure(prepared, 1)?;
        let goal = Self::STRETCH.as_secs_f64() * 1e3;
        let mut frames = 2;
        // A busy machine makes a short measurement far too long, never too short: the least of several counts.
        loop {
            let mut one = f64::INFINITY;
            for _ in 0..Self::TRIALS {
                one = one.min(self.measure(prepared, frames)?.max(1e-4));
            }
            let wanted = (goal / one).ceil().min(f64::from(Self::MOST_FRAMES)) as u32;
            if f64::from(frames) >= 0.8 * f64::from(wanted) {
                return Ok(wanted.max(1));
            }
            frames = wanted.min(frames * 16).max(1);
        }
    }

    /// The time of a frame in milliseconds: the mean over `frames` frames drawn in one go.
    ///
    /// # Errors
    /// The errors of [`Gpu::draw`].
    pub fn measure(&self, prepared: &Prepared, frames: u32) -> Result<f64, Error> {
        let frames = frames.max(1);
        self.guarded(|| {
            let attachments: Attachments = self.attachments(&prepared.framebuffer);
            let stopwatch = self.stopwatch();
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            for frame in 0..frames {
                let writes = stopwatch.as_ref().and_then(|watch| edges(watch, frame, frames));
                self.encode_pass(&mut encoder, prepared, &attachments, writes);
            }
            if let Some(watch) = &stopwatch {
                watch.resolve(&mut encoder);
            }
            let start = Instant::now();
            self.queue.submit([encoder.finish()]);
            self.wait()?;
            let wall = start.elapsed().as_secs_f64() * 1e3;
            let whole = match &stopwatch {
                Some(watch) => watch.milliseconds(self)?,
                None => wall,
            };
            Ok(whole / f64::from(frames))
        })
    }

    /// How often the fragment stage runs in a frame, without helper invocations if the driver omits them; `None` if
    /// the adapter does not count.
    ///
    /// # Errors
    /// The errors of [`Gpu::draw`].
    pub fn fragments_shaded(&self, prepared: &Prepared) -> Result<Option<u64>, Error> {
        if !self.features.contains(wgpu::Features::PIPELINE_STATISTICS_QUERY) {
            return Ok(None);
        }
        self.guarded(|| {
            let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::PipelineStatistics(wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS),
                count: 1,
            });
            let size = 8;
            let buffer = |usage| {
                self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size,
                    usage,
                    mapped_at_creation: false,
                })
            };
            let resolved = buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
            let readable = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
            let attachments = self.attachments(&prepared.framebuffer);
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.encode_counted_pass(&mut encoder, prepared, &attachments, &queries);
            encoder.resolve_query_set(&queries, 0..1, &resolved, 0);
            encoder.copy_buffer_to_buffer(&resolved, 0, &readable, 0, size);
            self.queue.submit([encoder.finish()]);
            self.wait()?;
            let bytes = self.bytes(&readable)?;
            Ok(bytes.first_chunk::<8>().map(|bytes| u64::from_ne_bytes(*bytes)))
        })
    }
}

/// The timestamps of a frame: the first frame records the beginning and the last the end; a single frame records
/// both.
fn edges(watch: &Stopwatch, frame: u32, frames: u32) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
    let (first, last) = (frame == 0, frame + 1 == frames);
    (first || last).then(|| wgpu::RenderPassTimestampWrites {
        beginning_of_pass_write_index: first.then_some(0),
        end_of_pass_write_index: last.then_some(1),
        ..watch.writes(0, 1)
    })
}
