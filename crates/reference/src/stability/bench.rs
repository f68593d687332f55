//! [`Bench`]: draws the picture again with some expressions exact, and measures by how much that helps.
//!
//! *In:* a scene and its two pictures. *Out:* an [`Outcome`] for each experiment. *Holds:* experiments draw only the bins of
//! the picture with the largest errors.

use super::Cause;
use super::errors::ErrorMap;
use super::kinds::CauseKind;
use super::record::{SIGNIFICAND, Tally};
use crate::domain::{ErrorPart, F64, Shadow};
use crate::exec::Form;
use crate::pipeline::{self, Chosen, Study};
use crate::{Positions, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{GlobalId, ScalarValue, Stage};
use glisten_front::source::Span;
use glisten_scene::picture::Picture;
use glisten_scene::{Format, Scene};
use std::collections::BTreeSet;

/// The number of bins that experiments draw at most.
const MOST_BINS: usize = 16;

/// The number of times that the inputs are moved by an ULP.
const JITTERS: u64 = 6;

/// The least uniform that may be a place far away.
const FAR: f32 = 16.0;

/// The side of a bin of the pipeline in pixels.
const BIN: usize = pipeline::BIN_SIDE;

/// The scene under test, its pictures, and the part of them that experiments draw.
pub(super) struct Bench<'a> {
    pub(super) scene: &'a Scene,
    /// The format that the scene asks for.
    pub(super) format: Format,
    pub(super) options: RenderOptions,
    pub(super) exact: &'a Picture,
    pub(super) errors: &'a ErrorMap,
    /// See [`bound_relative`](super::ExamineOptions::bound_relative).
    pub(super) relative: f64,
    bins: Vec<bool>,
}

/// The result of an experiment.
pub(super) struct Outcome {
    /// By how much the errors of pixels shrank at most; infinite if a pixel became finite.
    pub(super) harm: f64,
    /// The pixel where that is.
    pub(super) index: usize,
    /// By how much each pixel's error shrank.
    pub(super) gains: Vec<f64>,
}

impl Outcome {
    /// Whether a pixel becomes finite.
    pub(super) fn cures(&self, index: usize) -> bool {
        self.gains.get(index).is_some_and(|gain| gain.is_infinite())
    }

    /// The number of pixels that become finite.
    pub(super) fn cured(&self) -> u64 {
        self.gains.iter().filter(|gain| gain.is_infinite()).count() as u64
    }
}

/// The options for both pictures.
pub(super) fn drawing_options() -> RenderOptions {
    RenderOptions { positions: Positions::Own, ..RenderOptions::default() }
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        format: Format,
        exact: &'a Picture,
        (errors, relative): (&'a ErrorMap, f64),
    ) -> Self {
        let columns = (scene.framebuffer.width as usize).div_ceil(BIN);
        let rows = (scene.framebuffer.height as usize).div_ceil(BIN);
        let mut worst = vec![0.0_f64; columns * rows];
        for (index, error) in errors.errors.iter().enumerate() {
            let [x, y] = errors.place(index).map(|at| at as usize / BIN);
            if let Some(worst) = worst.get_mut(y * columns + x) {
                *worst = worst.max(*error);
            }
        }
        let mut order: Vec<usize> = (0..worst.len()).filter(|bin| worst[*bin] > 0.0).collect();
        order.sort_by(|a, b| worst[*b].total_cmp(&worst[*a]));
        let mut bins = vec![false; worst.len()];
        order.iter().take(MOST_BINS).for_each(|bin| bins[*bin] = true);
        Self { scene, format, options: drawing_options(), exact, errors, relative, bins }
    }

    fn holds(&self, index: usize) -> bool {
        let columns = (self.errors.width as usize).div_ceil(BIN);
        let [x, y] = self.errors.place(index).map(|at| at as usize / BIN);
        self.bins.get(y * columns + x).copied().unwrap_or(false)
    }

    /// The pixels of what is drawn that are not finite.
    pub(super) fn not_finite(&self) -> BTreeSet<usize> {
        let errors = self.errors.errors.iter().enumerate();
        errors.filter(|(index, error)| error.is_infinite() && self.holds(*index)).map(|(index, _)| index).collect()
    }

    /// Draws with a part of the error of some expressions left out.
    pub(super) fn without(&self, stage: Stage, spans: &[Span], part: ErrorPart) -> Result<Outcome, Vec<Diagnostic>> {
        self.drawn(Study { exactly: Some(Chosen { stage, spans, part }), ..Study::NONE })
    }

    fn drawn(&self, study: Study<'_, Shadow>) -> Result<Outcome, Vec<Diagnostic>> {
        let study = Study { bins: Some(&self.bins), form: Form::Unfused, ..study };
        let picture = pipeline::render_studied::<Shadow>(self.scene, &self.options, study)?;
        let left = ErrorMap::new(&picture, self.exact, self.format).beyond(self.exact, self.relative);
        let gain = |index: usize| -> f64 {
            let (before, after) = (self.errors.errors[index], left.errors.get(index).copied().unwrap_or(0.0));
            if !self.holds(index) || before <= after { 0.0 } else { before - after }
        };
        let gains: Vec<f64> = (0..self.errors.errors.len()).map(gain).collect();
        let worst = gains
            .iter()
            .copied()
            .enumerate()
            .fold((0, 0.0), |worst, (index, gain)| if gain > worst.1 { (index, gain) } else { worst });
        Ok(Outcome { harm: worst.1, index: worst.0, gains })
    }

    /// Draws with an exact varying.
    pub(super) fn with_exact_varying(&self, varying: GlobalId) -> Result<Outcome, Vec<Diagnostic>> {
        self.drawn(Study { exact_inputs: &[varying], ..Study::NONE })
    }

    /// The [`changes`] of the exact picture, drawn once.
    pub(super) fn jittered<'m>(&self, changes: &'m mut Changes, moves: Moves) -> Result<&'m [f64], Vec<Diagnostic>> {
        let known = &mut changes.0[moves as usize];
        if known.is_none() {
            *known = Some(self::changes(self.scene, (self.exact, self.format), Some(&self.bins), moves)?);
        }
        Ok(known.as_deref().unwrap_or(&[]))
    }
}

/// The inputs that are moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moves {
    /// Those that differ between vertices and between fragments.
    Inputs,
    /// Those and the uniforms.
    InputsAndUniforms,
}

/// The changes that were drawn already, by what was moved.
#[derive(Default)]
pub(super) struct Changes([Option<Vec<f64>>; 2]);

/// The results of the experiments with an expression.
pub(super) struct Found {
    pub(super) kind: CauseKind,
    /// The number of pixels that become finite.
    pub(super) cured: u64,
    pub(super) harm: Option<f64>,
    pub(super) index: usize,
    pub(super) ill_posed: bool,
    pub(super) equality: bool,
}

impl Found {
    pub(super) fn cause(self, bench: &Bench<'_>, (stage, span): (Stage, Span), tally: &Tally) -> Cause {
        let Self { kind, cured, harm, index, ill_posed, equality } = self;
        Cause {
            stage,
            span,
            kind,
            harm,
            lost_bits: tally.lost_bits,
            first_lost_bits: if kind == CauseKind::Accumulation { SIGNIFICAND } else { tally.first_lost_bits },
            condition: tally.condition,
            non_finite: tally.non_finite().max(cured),
            non_finite_in_exact: tally.births_in_both,
            disagreements: tally.disagreements,
            at: bench.errors.place(index),
            ill_posed,
            equality,
            undefined: None,
        }
    }
}

/// Three significant digits, so that figures that differ by noise alone are equal.
pub(super) fn significant(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// The exact picture's largest change at each pixel when the inputs move by an ULP, in some bins or in all.
pub(super) fn changes(
    scene: &Scene,
    (exact, format): (&Picture, Format),
    bins: Option<&[bool]>,
    moves: Moves,
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let mut most = vec![0.0_f64; exact.covered.len()];
    for seed in 1..=JITTERS {
        let study = Study { jitter: Some(seed), bins, ..Study::NONE };
        let moved = (moves == Moves::InputsAndUniforms).then(|| with_moved_uniforms(scene, seed));
        let picture = pipeline::render_studied::<F64>(moved.as_ref().unwrap_or(scene), &drawing_options(), study)?;
        let moved = ErrorMap::new(&picture, exact, format);
        most.iter_mut().zip(moved.errors).for_each(|(most, moved)| *most = most.max(moved));
    }
    Ok(most)
}

/// The scene with its float uniforms moved to the next f32, up or down by chance. Whole numbers are taken for exact, as many count something;
/// and numbers from [`FAR`] on, as a host can keep a far place apart.
fn with_moved_uniforms(scene: &Scene, seed: u64) -> Scene {
    let mut moved = scene.clone();
    for draw in &mut moved.draws {
        for (root, values) in (0..).zip(&mut draw.uniforms) {
            for (flat, value) in (0..).zip(values) {
                if let ScalarValue::Float(number) = value
                    && number.fract() != 0.0
                    && number.abs() < FAR
                {
                    let is_up = pipeline::jittered(1.0, 1.0, seed, [u64::MAX, root, flat]) > 1.0;
                    *number = if is_up { number.next_up() } else { number.next_down() };
                }
            }
        }
    }
    moved
}
