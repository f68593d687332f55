//! [`Population`]: pictures of simulated GPUs that conform.
//!
//! *In:* a [`Scene`], a seed, the GPUs of the population to draw with. *Out:* for each pixel and channel the least and the
//! largest value that one of them drew, and how many of them covered the pixel.
//!
//! *Holds:* each picture is one that the specifications allow. Unlike intervals, a picture keeps what belongs together:
//! the same operation on the same numbers has the same result, and both fragments of a derivative lie on one plane. The
//! range is what GPUs are likely to draw, not all that they may draw. The same seed gives the same population on every
//! machine and with any number of threads.

use crate::domain::{Gpu, Simulated};
use crate::pipeline::{self, Study};
use crate::{Precision, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use std::ops::Range;

/// The values of a channel of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// The least that is a number.
    pub low: f64,
    /// The largest that is a number.
    pub high: f64,
    /// Whether one of them is NaN.
    pub has_nan: bool,
}

impl Drawn {
    /// Of no picture.
    pub const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, has_nan: false };

    fn add(&mut self, value: f64) {
        if value.is_nan() {
            self.has_nan = true;
        } else {
            self.low = self.low.min(value);
            self.high = self.high.max(value);
        }
    }

    /// Adds what others drew.
    pub fn join(&mut self, other: &Self) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
        self.has_nan |= other.has_nan;
    }

    /// The distance of a value from what was drawn, in units of its spread or, if that is less, of `unit`; infinite for a
    /// NaN, or a number, where none was drawn.
    pub fn distance(&self, value: f64, unit: f64) -> f64 {
        if value.is_nan() {
            return if self.has_nan { 0.0 } else { f64::INFINITY };
        }
        if (self.low..=self.high).contains(&value) {
            return 0.0;
        }
        let spread = (self.high - self.low).max(unit);
        let away = (self.low - value).max(value - self.high);
        if away.is_finite() && spread > 0.0 { away / spread } else { f64::INFINITY }
    }
}

/// What a population drew.
#[derive(Clone, Debug)]
pub struct Population {
    /// The seed.
    pub seed: u64,
    /// The number of GPUs.
    pub members: u32,
    /// The values of each channel of each pixel of each attachment, top row first.
    pub attachments: Vec<Vec<[Drawn; 4]>>,
    /// For each pixel, the number of GPUs that covered it.
    pub covered_by: Vec<u32>,
}

impl Population {
    fn blank(seed: u64, scene: &Scene) -> Self {
        let framebuffer = scene.framebuffer;
        let count = framebuffer.width as usize * framebuffer.height as usize;
        let attachments = vec![vec![[Drawn::NONE; 4]; count]; framebuffer.attachments as usize];
        Self { seed, members: 0, attachments, covered_by: vec![0; count] }
    }

    fn add(&mut self, picture: &Picture) {
        self.members += 1;
        for (drawn, colors) in self.attachments.iter_mut().zip(&picture.attachments) {
            for (drawn, color) in drawn.iter_mut().zip(colors) {
                drawn.iter_mut().zip(color).for_each(|(drawn, value)| drawn.add(*value));
            }
        }
        for (count, covered) in self.covered_by.iter_mut().zip(&picture.covered) {
            *count += u32::from(*covered);
        }
    }

    /// Adds the pictures of further GPUs, drawn of the same scene.
    pub fn join(&mut self, other: &Self) {
        self.members += other.members;
        for (ours, theirs) in self.attachments.iter_mut().zip(&other.attachments) {
            for (ours, theirs) in ours.iter_mut().zip(theirs) {
                ours.iter_mut().zip(theirs).for_each(|(ours, theirs)| ours.join(theirs));
            }
        }
        self.covered_by.iter_mut().zip(&other.covered_by).for_each(|(ours, theirs)| *ours += theirs);
    }
}

/// Draws a scene with these GPUs of the population of a seed. If there are `pixels` (column and row, sorted), only these
/// are drawn; the others are as cleared.
///
/// # Errors
/// As [`render`](crate::render).
pub fn population(
    scene: &Scene,
    options: &RenderOptions,
    (seed, members): (u64, Range<u32>),
    pixels: Option<&[[u32; 2]]>,
) -> Result<Population, Vec<Diagnostic>> {
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..*options };
    let mut population = Population::blank(seed, scene);
    for number in members {
        population.add(&member(scene, &options, Gpu::of(seed, number), pixels)?);
    }
    Ok(population)
}

/// The picture of one GPU.
fn member(
    scene: &Scene,
    options: &RenderOptions,
    gpu: Gpu,
    pixels: Option<&[[u32; 2]]>,
) -> Result<Picture, Vec<Diagnostic>> {
    gpu.enter();
    let drawn = pipeline::render_studied::<Simulated>(scene, options, Study { gpu: Some(gpu), pixels, ..Study::NONE });
    Gpu::STRICT.enter();
    drawn
}

/// The picture of the GPU with this number in the population of a seed.
///
/// # Errors
/// As [`render`](crate::render).
pub fn simulate(
    scene: &Scene,
    options: &RenderOptions,
    (seed, number): (u64, u32),
) -> Result<Picture, Vec<Diagnostic>> {
    member(
        scene,
        &RenderOptions { precision: Precision::F32, mark_edges: false, ..*options },
        Gpu::of(seed, number),
        None,
    )
}
