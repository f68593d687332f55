//! [`Watch`]: attaches observers and corrections to machines.
//!
//! *In:* a [`Study`]. *Out:* machines for it, each for one piece of the drawing.

use crate::domain::{Domain, ErrorPart, Gpu, Profile};
use crate::exec::{Code, Exactly, Fate, Form, Guess, Invoked, Machine, Observer, Order, Piece, Purpose};
use glisten_front::hir::{GlobalId, Stage};
use glisten_front::source::Span;
use glisten_scene::Draw;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex};

/// Makes an observer for a piece of the drawing.
pub(crate) type MakeObserver<D> = dyn Fn() -> Box<dyn Observer<D>> + Sync;

/// Expressions of a stage whose f32 error is left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chosen<'a> {
    pub(crate) stage: Stage,
    pub(crate) spans: &'a [Span],
    pub(crate) part: ErrorPart,
}

/// The purposes of a drawing besides the picture.
#[derive(Clone, Copy)]
pub(crate) struct Study<'a, D: Domain> {
    /// Sees what is computed.
    pub(crate) observers: Option<&'a MakeObserver<D>>,
    /// The expressions whose f32 error is left out.
    pub(crate) exactly: Option<Chosen<'a>>,
    /// Whether to draw a bin, by its index; all if there is none.
    pub(crate) bins: Option<&'a [bool]>,
    /// The pixels to draw; all if there are none.
    pub(crate) pixels: Option<&'a PixelSet>,
    /// Moves the inputs of both stages by an ULP of f32, each up or down by chance with this seed: see [`jitter`](super::jitter).
    pub(crate) jitter: Option<u64>,
    /// The varyings that the fragment stage gets exact.
    pub(crate) exact_inputs: &'a [GlobalId],
    /// Counts the instructions of the fragment stage.
    pub(crate) executed: Option<&'a AtomicU64>,
    /// Sees the values of varyings at a pixel.
    pub(crate) probe: Option<&'a Probe>,
    /// The purpose for which the stages are compiled.
    pub(crate) form: Form,
    /// The GPU that is simulated, in the domain of simulated GPUs.
    pub(crate) gpu: Option<Gpu>,
    /// Numbers in the place of what the language leaves undefined.
    pub(crate) guess: Option<&'a Arc<Guess>>,
    /// The invocations that observers follow.
    pub(crate) followed: Option<Followed>,
}

impl<D: Domain> Study<'_, D> {
    /// The picture alone.
    pub(crate) const NONE: Self = Self {
        observers: None,
        exactly: None,
        bins: None,
        pixels: None,
        jitter: None,
        exact_inputs: &[],
        executed: None,
        probe: None,
        form: Form::Fast,
        gpu: None,
        guess: None,
        followed: None,
    };
}

/// Invocations that observers follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(not(any(test, feature = "stability")), expect(dead_code, reason = "only that feature follows any"))]
pub(crate) enum Followed {
    /// The fragments of a pixel: column and row.
    Pixel([u32; 2]),
    /// A vertex: its index and its instance.
    Vertex(u32, u32),
}

/// A set of pixels.
#[derive(Clone, Debug)]
pub(crate) struct PixelSet {
    /// The number of words of a row.
    stride: usize,
    /// A bit for each pixel, row after row, the first pixel lowest. A row ends with a word of no pixels.
    words: Vec<u64>,
}

impl PixelSet {
    /// The marked pixels of a picture of this width, row after row.
    pub(crate) fn of(marks: &[bool], width: u32) -> Self {
        let width = (width as usize).max(1);
        let stride = width.div_ceil(64) + 1;
        let row = |marks: &[bool]| {
            let word = |marks: &[bool]| marks.iter().rev().fold(0, |word, mark| word << 1 | u64::from(*mark));
            let mut words: Vec<u64> = marks.chunks(64).map(word).collect();
            words.resize(stride, 0);
            words
        };
        Self { stride, words: marks.chunks(width).flat_map(row).collect() }
    }

    /// PixelSet by column and row.
    #[cfg(any(test, feature = "stability"))]
    pub(crate) fn at(pixels: &[[u32; 2]]) -> Self {
        let most = |axis: usize| pixels.iter().map(|pixel| pixel[axis] as usize + 1).max().unwrap_or(0);
        let stride = most(0).div_ceil(64) + 1;
        let mut words = vec![0; stride * most(1)];
        for [x, y] in pixels.iter().map(|pixel| pixel.map(|at| at as usize)) {
            if let Some(word) = words.get_mut(y * stride + x / 64) {
                *word |= 1 << (x % 64);
            }
        }
        Self { stride, words }
    }

    /// The bits of the set among those of a row, of which bit `i` is the `i`th pixel from `x` on.
    pub(super) fn in_row(&self, x: i64, y: i64, set: u64) -> u64 {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return 0 };
        if x / 64 + 1 >= self.stride {
            return 0;
        }
        let word = |index: usize| self.words.get(y * self.stride + index).copied().unwrap_or(0);
        let (low, high, shift) = (word(x / 64), word(x / 64 + 1), x % 64);
        let found = if shift == 0 { low } else { low >> shift | high << (64 - shift) };
        set & found
    }

    /// Whether a pixel of the set is in the quad with this upper left corner.
    pub(super) fn in_quad(&self, x: i64, y: i64) -> bool {
        (y..y + 2).any(|y| self.in_row(x, y, 0b11) != 0)
    }
}

/// Collects the float varyings of the last fragment that reached a pixel.
#[derive(Debug)]
pub(crate) struct Probe {
    pub(crate) pixel: [u32; 2],
    pub(crate) found: Mutex<Vec<(GlobalId, u32, f64)>>,
}

/// A study, and the place in the drawing.
#[derive(Clone, Copy)]
pub(super) struct Watch<'a, D: Domain> {
    pub(super) study: Study<'a, D>,
    pub(super) draw: usize,
    pub(super) instance: u32,
    /// The surface of the draw, if another draw has the same.
    pub(super) surface: u64,
}

impl<D: Domain> Watch<'_, D> {
    /// Lets this thread compute for the study. Each piece of work that a thread takes begins with it.
    pub(super) fn enter(&self) {
        if let Some(gpu) = self.study.gpu {
            D::enter(gpu);
        }
    }

    /// A machine for a stage of the draw.
    pub(super) fn machine(&self, stage: Stage, code: &Code, draw: &Draw, profile: Profile) -> Machine<D> {
        self.enter();
        let purpose = match self.study.exactly.filter(|chosen| chosen.stage == stage) {
            Some(Chosen { spans, part, .. }) => {
                let exactly = Exactly::new(code, part, |span| spans.binary_search(&span).is_ok());
                Purpose::Corrected(Arc::new(exactly))
            }
            None => self.study.guess.map_or(Purpose::Results, |guess| Purpose::Guessing(Arc::clone(guess))),
        };
        Machine::with(purpose, profile, code, &draw.uniforms, &draw.textures)
    }

    /// Announces the vertices that observers follow.
    pub(super) fn announce(&self, machine: &mut Machine<D>, lanes: &[(u32, u32)]) {
        let Some(Followed::Vertex(vertex, instance)) = self.study.followed else { return };
        if let Some(lane) = lanes.iter().position(|lane| *lane == (vertex, instance)) {
            machine.announce(lane, &Invoked::Vertex { vertex, instance });
        }
    }

    /// Ends the vertices that observers follow.
    pub(super) fn conclude(&self, machine: &mut Machine<D>, lanes: &[(u32, u32)]) {
        let Some(Followed::Vertex(vertex, instance)) = self.study.followed else { return };
        if let Some(lane) = lanes.iter().position(|lane| *lane == (vertex, instance)) {
            machine.conclude(lane, Fate::Done);
        }
    }

    /// Whether a bin is drawn.
    pub(super) fn wants(&self, bin: usize) -> bool {
        self.study.bins.is_none_or(|bins| bins.get(bin).copied().unwrap_or(false))
    }

    /// Shows once what the stage computes for all invocations.
    pub(super) fn common(&self, code: &Code, draw: &Draw, piece: Piece) {
        if let Some(make) = self.study.observers {
            let purpose = Purpose::Watching(make());
            let mut machine = Machine::with(purpose, Profile::default(), code, &draw.uniforms, &draw.textures);
            machine.end_watch(self.order(piece, 0));
        }
    }

    pub(super) fn begin(&self, machine: &mut Machine<D>) {
        self.enter();
        if let Some(make) = self.study.observers {
            machine.watch(make());
        }
    }

    pub(super) fn end(&self, machine: &mut Machine<D>, piece: Piece, part: usize) {
        machine.end_watch(self.order(piece, part));
    }

    fn order(&self, piece: Piece, part: usize) -> Order {
        Order { draw: self.draw, instance: self.instance, piece, part }
    }
}
