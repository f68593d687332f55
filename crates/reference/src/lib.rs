//! The CPU reference: executes the typed program by OpenGL 3.2's rules.
//!
//! *In:* a [`Scene`]. *Out:* a [`Picture`].
//!
//! *Holds:* the crate never sees naga IR, so that a mistake in the lowering shows as a difference. Coverage is
//! decided in f32 and integers, and is the same in every domain; values are computed in the domain.

mod counts;
pub mod domain;
pub mod exec;
mod expand;
mod interpolate;
mod pass_through;
mod pipeline;
mod population;
mod raster;
mod sample;
#[cfg(any(test, feature = "stability"))]
pub mod stability;
mod texture;
#[cfg(any(test, feature = "stability"))]
pub mod trace;
mod undefined;
mod work;

pub use counts::{Counts, counts};
pub use exec::Step;
pub use exec::UndefinedKind;
pub use expand::{expand, has_geometry_stage};
pub use population::{as_llvmpipe, populate, simulate};
pub use sample::Sample;
pub use undefined::{Undefined, UndefinedPlace, hides_undefined, undefined};
pub use work::{Work, envelope_work, work};

use domain::faults::{self, Fault, Faults, KnownFault};
use domain::{Envelope, F32, F64, Profile};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{Interpolation, Shader, Stage, StmtKind};
use glisten_front::source::Span;
use glisten_scene::picture::Picture;
use glisten_scene::{Draw, Framebuffer, Scene};

/// The precision of the reference's numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Precision {
    /// IEEE f64: the truth.
    #[default]
    F64,
    /// IEEE f32, with one rounding per operation: a strict GPU.
    F32,
    /// f64 with the interval of values that a conforming GPU may compute.
    Envelope,
}

/// Which pixels a line covers, and whether a point whose center is outside the window is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineRule {
    /// The diamond-exit rule (OpenGL 3.2 §3.5.1). Such a point is discarded (§2.19).
    #[default]
    OpenGl,
    /// A rectangle one pixel wide, as Vulkan draws strict lines. The part of such a point inside the window is drawn.
    Vulkan,
}

/// Whose vertex positions decide which pixels are covered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Positions {
    /// Those of f32 arithmetic, in every domain: pictures of different domains cover the same pixels.
    #[default]
    Shared,
    /// Those of the domain, with its clip distances and its sizes of points.
    Own,
}

/// Options for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// The number domain.
    pub precision: Precision,
    /// The rule for lines and points.
    pub lines: LineRule,
    /// Whether to mark pixels near edges ([`Picture::near_edge`]), which a comparison needs and which takes time.
    pub mark_edges: bool,
    /// The faults of a driver that envelopes excuse, in addition to what the specifications allow.
    pub faults: Faults,
    /// Whose positions decide coverage.
    pub positions: Positions,
    /// The freedom of the device where the specifications leave it open.
    pub profile: Profile,
    /// The part of the picture that is drawn, with the pixels around it. Elsewhere nothing is covered.
    pub sample: Sample,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            precision: Precision::F64,
            lines: LineRule::OpenGl,
            mark_edges: true,
            faults: Faults::NONE,
            positions: Positions::Shared,
            profile: Profile::default(),
            sample: Sample::ALL,
        }
    }
}

/// Draws a scene.
///
/// # Errors
/// What the reference does not support, for example an endless loop.
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<Picture, Vec<Diagnostic>> {
    match options.precision {
        Precision::F64 => pipeline::render::<F64>(scene, options),
        Precision::F32 => pipeline::render::<F32>(scene, options),
        Precision::Envelope => pipeline::render::<Envelope>(scene, options),
    }
}

/// How far beyond the values at the vertices the fragments of a draw may be interpolated, on any conforming target: a
/// varying between `low` and `high` at the vertices is between `low - f (high - low)` and `high + f (high - low)` at the
/// fragments, but for the rounding of the result. `None` if nothing bounds it.
pub fn interpolation_reach(draw: &Draw, framebuffer: Framebuffer) -> Option<f64> {
    pipeline::reach(draw, framebuffer, &RenderOptions { mark_edges: false, ..RenderOptions::default() })
}

/// Whether a function that runs has a loop.
fn has_loops(shader: &Shader) -> bool {
    shader.functions.iter().filter(|function| function.reachable).any(|function| {
        let mut found = false;
        shader.visit_statements(function.body.as_deref().unwrap_or_default(), &mut |statement| {
            found |= matches!(statement.kind, StmtKind::Loop { .. });
        });
        found
    })
}

/// The known faults of drivers that can show in a scene: the others need not be drawn.
pub fn faults_of(scene: &Scene) -> Vec<&'static KnownFault> {
    let is_linear = |draw: &Draw| {
        let varyings = draw.program.interface.interpolated();
        varyings.into_iter().any(|varying| varying.active && varying.interpolation == Interpolation::Noperspective)
    };
    let has_loop = |draw: &Draw| draw.program.stage(Stage::Fragment).is_some_and(has_loops);
    let applies = |known: &&KnownFault| match known.fault {
        Fault::ClippedNoperspective => scene.draws.iter().any(is_linear),
        Fault::CutLoops => scene.draws.iter().any(has_loop),
    };
    faults::KNOWN.iter().filter(applies).collect()
}

/// The contribution of an operation to the width of a pixel's envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// The expression; for a varying, its declaration.
    pub span: Span,
    /// The operation as GLSL writes it, or `interpolation`.
    pub operation: &'static str,
    /// The share by which the envelope would be narrower if this operation were exact, 0 to 1. What several
    /// operations share counts for each of them, so shares need not add up to 1.
    pub share: f64,
}

/// The origin of the envelope of a channel (0 to 3) of a pixel (column from the left, row from the top), the largest
/// contribution first. It draws the pixel as many times as the fragment stage has operations.
///
/// # Errors
/// The errors of [`render`], or a pixel outside the picture.
pub fn explain(
    scene: &Scene,
    options: &RenderOptions,
    pixel: [u32; 2],
    attachment: usize,
    channel: usize,
) -> Result<Vec<Contribution>, Vec<Diagnostic>> {
    pipeline::explain(scene, options, pixel, attachment, channel)
}
