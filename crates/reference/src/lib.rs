//! The CPU reference: executes the typed program by OpenGL 3.2's rules.
//!
//! *In:* a [`Scene`]. *Out:* a [`Picture`].
//!
//! *Holds:* never sees naga IR, so that a mistake in lowering shows as a difference. Which pixels a primitive covers is
//! decided in f32 and integers, alike in every number domain; what they hold is computed in the domain.

pub mod domain;
pub mod exec;
mod interpolate;
mod pipeline;
mod raster;
pub mod stability;
mod texture;
mod work;

pub use work::{Work, work};

use domain::faults::Faults;
use domain::{Envelope, F32, F64};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::Span;
use glisten_scene::compare::Picture;
use glisten_scene::scene::Scene;

/// What numbers the reference computes with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Precision {
    /// IEEE f64: the truth.
    #[default]
    F64,
    /// IEEE f32, one rounding an operation: a strict GPU.
    F32,
    /// f64 with the interval of what a conforming GPU may have in its place.
    Envelope,
}

/// Which pixels a line covers, and what becomes of a point whose center lies outside the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineRule {
    /// The diamond-exit rule (OpenGL 3.2 §3.5.1); such a point is discarded (§2.19).
    #[default]
    OpenGl,
    /// A rectangle one pixel wide, as Vulkan draws strict lines; of such a point what reaches into the window is drawn.
    Vulkan,
}

/// How to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// The number domain.
    pub precision: Precision,
    /// The rule for lines.
    pub lines: LineRule,
    /// Whether pixels near edges are marked ([`Picture::near_edge`]): wanted for a comparison, and it takes time.
    pub mark_edges: bool,
    /// Faults of a driver that envelopes admit beside what the specifications do.
    pub faults: Faults,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self { precision: Precision::F64, lines: LineRule::OpenGl, mark_edges: true, faults: Faults::NONE }
    }
}

/// Draws a scene.
///
/// # Errors
/// What the reference cannot draw: a geometry stage, a multisample sampler, a loop without end.
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<Picture, Vec<Diagnostic>> {
    match options.precision {
        Precision::F64 => pipeline::render::<F64>(scene, options),
        Precision::F32 => pipeline::render::<F32>(scene, options),
        Precision::Envelope => pipeline::render::<Envelope>(scene, options),
    }
}

/// What an operation adds to the width of a pixel's envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// The expression; of a varying its declaration.
    pub span: Span,
    /// How GLSL writes the operation, or `interpolation`.
    pub operation: &'static str,
    /// By how much of its width the envelope is narrower without the freedom that the rule of this operation gives, 0 to 1.
    /// What several operations share counts under each of them, so shares need not add up to 1.
    pub share: f64,
}

/// What the envelope of a channel (0 to 3) of a pixel (column from the left, row from the top) comes from, the largest
/// contribution first. Costs as many drawings of the pixel as the fragment stage has operations.
///
/// # Errors
/// As [`render`], and a pixel that there is not.
pub fn explain(
    scene: &Scene,
    options: &RenderOptions,
    pixel: [u32; 2],
    attachment: usize,
    channel: usize,
) -> Result<Vec<Contribution>, Vec<Diagnostic>> {
    pipeline::explain(scene, options, pixel, attachment, channel)
}
