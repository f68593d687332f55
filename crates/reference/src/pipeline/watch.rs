//! [`Watch`]: attaches observers and corrections to machines.
//!
//! *In:* a [`Study`]. *Out:* machines for it, each for one piece of the drawing.

use crate::domain::{Domain, ErrorPart, Gpu, Profile};
use crate::exec::{Code, Exactly, Form, Guess, Machine, Observer, Order, Piece, Purpose};
use glisten_front::hir::{GlobalId, Stage};
use glisten_front::source::Span;
use glisten_scene::Draw;
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
    /// The pixels to draw, column and row, sorted; all if there are none.
    pub(crate) pixels: Option<&'a [[u32; 2]]>,
    /// Moves the inputs of both stages by an ULP of f32, each up or down by chance with this seed.
    pub(crate) jitter: Option<u64>,
    /// The varyings that the fragment stage gets exact.
    pub(crate) exact_inputs: &'a [GlobalId],
    /// Sees the values of varyings at a pixel.
    pub(crate) probe: Option<&'a Probe>,
    /// The purpose for which the stages are compiled.
    pub(crate) form: Form,
    /// The GPU that is simulated, in the domain of simulated GPUs.
    pub(crate) gpu: Option<Gpu>,
    /// Numbers in the place of what the language leaves undefined.
    pub(crate) guess: Option<&'a Arc<Guess>>,
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
        probe: None,
        form: Form::Fast,
        gpu: None,
        guess: None,
    };
}

/// The bits of the pixels to draw among those of a row, of which bit `i` is the `i`th pixel from `x` on.
pub(super) fn wanted_in_row(pixels: &[[u32; 2]], x: i64, y: i64, set: u64) -> u64 {
    let is_wanted = |bit: &u32| {
        let place = [x + i64::from(*bit), y].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        set >> bit & 1 == 1 && pixels.binary_search(&place).is_ok()
    };
    (0..u64::BITS).filter(is_wanted).fold(0, |wanted, bit| wanted | 1 << bit)
}

/// Whether a pixel to draw is in the quad with this upper left corner.
pub(super) fn wanted_in_quad(pixels: &[[u32; 2]], x: i64, y: i64) -> bool {
    (y..y + 2).any(|y| wanted_in_row(pixels, x, y, 0b11) != 0)
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

/// A number moved by an ULP of f32 (2^-23 of it), up or down by chance: the chance depends on the seed and the place.
pub(super) fn jittered(value: f64, seed: u64, place: [u64; 3]) -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for part in place {
        state = (state ^ part).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state ^= state >> 29;
    }
    let step = f64::from(f32::EPSILON);
    value * if state >> 40 & 1 == 0 { 1.0 + step } else { 1.0 - step }
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
