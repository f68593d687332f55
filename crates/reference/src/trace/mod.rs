//! Follows single invocations: the value of every expression, in the order in which they are computed.
//!
//! *In:* a scene, and a pixel or a vertex. *Out:* a [`Trace`]: for each invocation its [`Entry`]s, with the value in f32,
//! in exact arithmetic, and the interval of a conforming GPU's values.
//!
//! ```text
//!  Scene ──► follow    one drawing of the pixel in the shadow domain (f32 and f64), one with envelopes
//!        ──► record    the notes of the followed lanes
//!        ──► join      the intervals of the second to the values of the first, as far as both went the same way
//! ```
//!
//! *Holds:* following changes no value. Conditions are decided in f32. The colors of the pixel are those before they are
//! rounded to the framebuffer's format; where draws blend, they are as stored, since the later draw reads what is stored. *Not done here:* geometry stages run, but their invocations are not followed.

mod join;
mod record;
#[cfg(test)]
mod tests;

pub use crate::exec::{Fate, Invoked, NoteKind};

use crate::domain::{Domain, Envelope, Shadow};
use crate::exec::{Form, Observer};
use crate::pipeline::{self, BIN_SIDE, Followed, PixelSet, Study, vertices_of};
use crate::{RenderOptions, domain::Number};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_CANNOT_DRAW;
use glisten_front::hir::{Stage, TypeId};
use glisten_front::source::Span;
use glisten_scene::picture::{Interval, Picture};
use glisten_scene::{Format, Framebuffer, Scene};
use record::{Recorder, Recordings};
use std::sync::Arc;

/// The number of entries of an invocation that are kept.
pub const MOST_ENTRIES: usize = 1 << 16;

/// Invocations to follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All fragments of a pixel: its column from the left and its row from the top.
    Pixel([u32; 2]),
    /// A vertex of a draw.
    Vertex {
        /// The number of the draw.
        draw: usize,
        /// The index of the vertex.
        vertex: u32,
        /// The instance.
        instance: u32,
    },
}

/// The values that followed invocations computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The invocations in the order in which they are drawn.
    pub invocations: Vec<Invocation>,
    /// The color of the pixel in each attachment; none of a vertex.
    pub colors: Vec<[Component; 4]>,
}

/// An invocation of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Invocation {
    /// The number of the draw.
    pub draw: usize,
    /// The instance.
    pub instance: u32,
    /// The stage.
    pub stage: Stage,
    /// The vertex, or the primitive of the fragment.
    pub invoked: Invoked,
    /// The vertices of the primitive, in their order in the draw; empty if a geometry stage made it.
    pub vertices: Vec<u32>,
    /// Its end.
    pub fate: Fate,
    /// The values, in the order in which they were computed.
    pub entries: Vec<Entry>,
    /// How many more there were than [`MOST_ENTRIES`].
    pub left_out: usize,
}

/// A value of the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The kind of place.
    pub kind: NoteKind,
    /// The expression, the statement or the declaration.
    pub span: Span,
    /// The name of the variable or function; empty for an expression.
    pub name: String,
    /// The type of the value; `void` if there is none.
    pub ty: TypeId,
    /// The number of calls around it.
    pub depth: usize,
    /// The scalars in flat order.
    pub scalars: Vec<Component>,
}

/// A scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Component {
    /// A `float`.
    Float {
        /// In f32.
        single: f64,
        /// In exact arithmetic.
        exact: f64,
        /// The values of a conforming GPU; none if it may go another way before.
        interval: Option<Interval>,
    },
    /// An `int`.
    Int(i32),
    /// A `uint`.
    Uint(u32),
    /// A `bool`.
    Bool(bool),
    /// The number of a sampler's slot.
    Sampler(u32),
}

/// Follows the invocations at a place.
///
/// # Errors
/// The errors of [`render`](crate::render), and a place outside of the picture or of the draw.
pub fn trace(scene: &Scene, place: Place) -> Result<Trace, Vec<Diagnostic>> {
    let scene = &alone(scene, place)?;
    let (mut invocations, picture) = follow::<Shadow>(scene, place, Form::Noted)?;
    let (tight, intervals) = follow::<Envelope>(scene, place, Form::NotedTight)?;
    join::join(&mut invocations, &tight);
    for invocation in &mut invocations {
        if let Place::Vertex { draw, .. } = place {
            invocation.draw = draw;
        }
        if let (Invoked::Fragment { primitive, .. }, Some(draw)) =
            (invocation.invoked, scene.draws.get(invocation.draw))
        {
            invocation.vertices = vertices_of(draw, primitive);
        }
    }
    let colors = match place {
        Place::Pixel(pixel) => colors(&picture, &intervals, pixel),
        Place::Vertex { .. } => Vec::new(),
    };
    Ok(Trace { invocations, colors })
}

/// The draws that matter for a place, in a framebuffer that rounds nothing unless a draw reads it (GL 3.2 §4.1.7).
fn alone(scene: &Scene, place: Place) -> Result<Scene, Vec<Diagnostic>> {
    let refuse = |message: String| vec![Diagnostic::new(&SCENE_CANNOT_DRAW, Span::default(), message)];
    let Framebuffer { width, height, format, .. } = scene.framebuffer;
    let format = match format {
        Format::Rgba32Sint | Format::Rgba32Uint => format,
        _ if scene.draws.iter().any(|draw| draw.state.blend.is_some()) => format,
        _ => Format::Rgba32Float,
    };
    let framebuffer = Framebuffer { format, ..scene.framebuffer };
    match place {
        Place::Pixel([x, y]) if x < width && y < height => Ok(Scene { framebuffer, ..scene.clone() }),
        Place::Pixel(_) => Err(refuse(format!("there is no such pixel: the picture has {width} by {height}"))),
        Place::Vertex { draw: number, vertex, instance } => {
            let draws = scene.draws.len();
            let Some(draw) = scene.draws.get(number) else {
                return Err(refuse(format!("there is no draw {number}: the scene has {draws}")));
            };
            let is_drawn = match &draw.indices {
                Some(indices) => indices.iter().take(draw.vertex_count as usize).any(|index| *index == vertex),
                None => vertex < draw.vertex_count,
            };
            if !is_drawn || instance >= draw.instances {
                let most = draw.indices.as_ref().and_then(|indices| indices.iter().max().copied());
                let most = most.unwrap_or(draw.vertex_count.saturating_sub(1));
                let message = format!(
                    "draw {number} has no such vertex: its last vertex is {most}, its last instance {}",
                    draw.instances.saturating_sub(1)
                );
                return Err(refuse(message));
            }
            Ok(Scene { framebuffer, draws: vec![draw.clone()], ..scene.clone() })
        }
    }
}

fn follow<D: Domain>(scene: &Scene, place: Place, form: Form) -> Result<(Vec<Invocation>, Picture), Vec<Diagnostic>> {
    let recordings = Arc::new(Recordings::default());
    let shared = Arc::clone(&recordings);
    let make = move || -> Box<dyn Observer<D>> { Box::new(Recorder::new(&shared)) };
    let columns = (scene.framebuffer.width as usize).div_ceil(BIN_SIDE);
    let (followed, bin) = match place {
        Place::Pixel([x, y]) => {
            (Followed::Pixel([x, y]), Some(y as usize / BIN_SIDE * columns + x as usize / BIN_SIDE))
        }
        Place::Vertex { vertex, instance, .. } => (Followed::Vertex(vertex, instance), None),
    };
    let mut bins = vec![false; bin.map_or(0, |bin| bin + 1)];
    if let Some(last) = bins.last_mut() {
        *last = true;
    }
    let pixels = match place {
        Place::Pixel(pixel) => PixelSet::at(&[pixel]),
        Place::Vertex { .. } => PixelSet::at(&[]),
    };
    let study = Study {
        observers: Some(&make),
        bins: Some(&bins),
        pixels: Some(&pixels),
        followed: Some(followed),
        form,
        ..Study::NONE
    };
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    let picture = pipeline::render_studied::<D>(scene, &options, study)?;
    Ok((recordings.in_order(), picture))
}

/// The color of a pixel in each attachment.
fn colors(picture: &Picture, intervals: &Picture, [x, y]: [u32; 2]) -> Vec<[Component; 4]> {
    let index = y as usize * picture.width as usize + x as usize;
    let of = |number: usize| -> Option<[Component; 4]> {
        let single = picture.attachments.get(number)?.get(index)?;
        let exact = intervals.attachments.get(number)?.get(index)?;
        let held = intervals.intervals.as_ref().and_then(|all| all.get(number)?.get(index));
        Some(std::array::from_fn(|channel| Component::Float {
            single: single[channel],
            exact: exact[channel],
            interval: held.map(|held| held[channel]),
        }))
    };
    (0..picture.attachments.len()).filter_map(of).collect()
}

/// A number of any domain.
fn component<N: Number>(number: N) -> Component {
    let interval = N::HAS_INTERVALS.then(|| number.interval());
    Component::Float { single: number.value(), exact: number.second(), interval }
}
