//! Pictures of simulated GPUs that conform.
//!
//! *In:* a [`Scene`], a seed, the numbers of GPUs. *Out:* their [`Population`]: for each pixel and channel the range of what
//! they drew, and how many of them covered the pixel.
//!
//! *Holds:* each picture is one that the specifications allow. Unlike intervals, a picture keeps what belongs together:
//! the same operation on the same numbers has the same result, and both fragments of a derivative lie on one plane. The
//! range is what GPUs are likely to draw, not all that they may draw. The same seed gives the same population on every
//! machine and with any number of threads.

use crate::domain::{Gpu, Simulated};
use crate::pipeline::{self, PixelSet, Study};
use crate::{Positions, Precision, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_scene::Scene;
use glisten_scene::compare::Population;
use glisten_scene::picture::Picture;
use std::ops::Range;

/// Adds the pictures of the GPUs with these numbers to a population: of the places that it names, if it is restricted.
///
/// # Errors
/// As [`render`](crate::render).
pub fn populate(
    population: &mut Population,
    scene: &Scene,
    options: &RenderOptions,
    members: Range<u32>,
) -> Result<(), Vec<Diagnostic>> {
    for number in members {
        let places = population.places().map(|places| PixelSet::of(places, population.width));
        population.add(&drawn(scene, options, (population.seed, number), places.as_ref())?);
    }
    Ok(())
}

/// The picture of the GPU with this number in the population of a seed.
///
/// # Errors
/// As [`render`](crate::render).
pub fn simulate(scene: &Scene, options: &RenderOptions, member: (u64, u32)) -> Result<Picture, Vec<Diagnostic>> {
    drawn(scene, options, member, None)
}

/// The picture that llvmpipe draws, as far as its arithmetic is known, or some of its pixels. `number` is one of the possibilities
/// that are left, less than [`Gpu::LLVMPIPES`].
///
/// # Errors
/// As [`render`](crate::render).
pub fn as_llvmpipe(
    scene: &Scene,
    options: &RenderOptions,
    number: u32,
    places: Option<&[bool]>,
) -> Result<Picture, Vec<Diagnostic>> {
    let pixels = places.map(|places| PixelSet::of(places, scene.framebuffer.width));
    drawn_by(Gpu::llvmpipe(number), scene, options, pixels.as_ref())
}

/// The picture of a GPU, or some of its pixels.
fn drawn(
    scene: &Scene,
    options: &RenderOptions,
    (seed, number): (u64, u32),
    pixels: Option<&PixelSet>,
) -> Result<Picture, Vec<Diagnostic>> {
    drawn_by(Gpu::of(seed, number), scene, options, pixels)
}

fn drawn_by(
    gpu: Gpu,
    scene: &Scene,
    options: &RenderOptions,
    pixels: Option<&PixelSet>,
) -> Result<Picture, Vec<Diagnostic>> {
    let own = RenderOptions { positions: Positions::Own, ..*options };
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..own };
    let gpu = gpu.on(&options.profile);
    gpu.enter();
    let drawn = pipeline::render_studied::<Simulated>(scene, &options, Study { gpu: Some(gpu), pixels, ..Study::NONE });
    Gpu::STRICT.enter();
    drawn
}
