//! Finds the operations of a program that lose precision in f32, and measures what they do to the picture.
//!
//! *In:* a [`Scene`]. *Out:* a [`Trace`]: for each expression the effect of its f32 arithmetic, worst first; or an
//! [`Examination`]: both pictures and the [`Cause`]s of their difference.
//!
//! ```text
//!  Scene ──► record      one drawing in the shadow domain: a tally for each expression
//!        ──► errors      the picture of f32 arithmetic against the exact one, pixel by pixel
//!        ──► experiment  for each suspect (loops, kinds): the picture again, with this expression exact
//! ```
//!
//! The scene is drawn in the [shadow domain](super::domain::ShadowFloat), f32 and exact arithmetic side by side. For each
//! operation three results are known: in f32 on f32 operands (a), exactly on the same operands (b), exactly on exact
//! operands (c). `a - b` is the error that the operation adds, `b - c` what it makes of its operands' errors, `a - c`
//! the total error. An operation is suspect if its result has lost bits that its operands still had: by its own
//! rounding (`pow` with a large exponent), or by turning a small relative error into a large one (`1.0 - cos(x)`). It is
//! a cause if the picture gets better when it is computed exactly.
//!
//! *Holds:* figures do not depend on threads. Helper invocations are not counted.
//!
//! *Not done here:* a GPU's own approximations of `sin` and so on, and its weights of linear filtering, are not modeled:
//! they round once.

mod bench;
mod birth;
mod births;
mod draw;
mod errors;
mod exact;
mod experiment;
mod fractions;
mod kinds;
mod loops;
mod origin;
mod record;
#[cfg(test)]
pub(crate) mod tests;
mod undefined;

pub use births::births;
pub use draw::{Arithmetic, draw};
pub use errors::ErrorMap;
pub use exact::{EXACT_BITS, ExactPixel, recompute};
pub use kinds::CauseKind;

use super::domain::{F64, Shadow, Stepwise};
use super::pipeline::{self, Probe, Study};
use super::{RenderOptions, exec};
use bench::{Bench, Moves, drawing_options};
use births::BirthCounter;
use experiment::causes;
use glisten_front::diagnostic::{Diagnostic, codes};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::source::Span;
use glisten_scene::picture::Picture;
use glisten_scene::{Format, Scene};
use record::{Collected, Place, Recorder, Tally};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// An expression is a cause if its result has lost this many bits more than its operands. Three operands with half an
/// ULP each and as many roundings stay below.
pub const CAUSE_BITS: f64 = 3.0;

/// The bound of the picture's error above which a program is not stable: a quarter of a step of 8-bit colors.
pub const BOUND: f64 = 1.0 / 1024.0;

/// The effect of f32 arithmetic in one expression, over all lanes that evaluated it; a vector counts once for each
/// component. Errors are over results that are finite on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpanError {
    /// The expression.
    pub span: Span,
    /// The stage of the expression.
    pub stage: Stage,
    /// How it loses precision, if it does.
    pub kind: CauseKind,
    /// The number of scalar results.
    pub evaluations: u64,
    /// The largest error that the operation itself added: the difference between its f32 result and the exact result
    /// on the same operands.
    pub added: f64,
    /// That error in ULP of the exact result; half an ULP is rounding.
    pub added_ulps: f64,
    /// The largest difference between f32 and exact arithmetic, including the operands' errors.
    pub error: f64,
    /// The mean of that difference.
    pub mean_error: f64,
    /// The largest number of bits, of 24, that a result has lost and its operands had not.
    pub lost_bits: f64,
    /// The mean of that number.
    pub mean_lost_bits: f64,
    /// The largest number of leading bits that a sum, difference or dot product canceled.
    pub canceled_bits: f64,
    /// The largest factor by which the operands' relative errors grew in the exact result: a lower estimate of the
    /// condition number; 0 if no operand had an error.
    pub condition: f64,
    /// The number of results that are infinite or NaN in f32 although all operands were finite.
    pub births: u64,
    /// The number of those that are also infinite or NaN in exact arithmetic: the model causes them, not f32.
    pub births_in_both: u64,
    /// The number of comparisons, conversions to integers and jumps (`floor`, `step`) on which the two sides disagree.
    pub disagreements: u64,
    /// The number of branches and selections that exact arithmetic would decide differently.
    pub decisions: u64,
}

/// The stability of a program, as a drawing shows it.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Every expression that was evaluated: causes first, then by their loss.
    pub spans: Vec<SpanError>,
    /// The largest difference between f32 and exact arithmetic in the outputs of the fragment stages.
    pub output_error: f64,
    /// The picture, in f32.
    pub picture: Picture,
}

/// An expression that harms the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cause {
    /// The stage of the expression.
    pub stage: Stage,
    /// The expression.
    pub span: Span,
    /// How it loses precision.
    pub kind: CauseKind,
    /// By how much the error of a pixel shrinks at most if this expression alone is exact, in units of the picture;
    /// `None` if that is not finite.
    pub harm: Option<f64>,
    /// The largest number of bits, of 24, that a result has lost and its operands had not.
    pub lost_bits: f64,
    /// The largest such number where no operand had lost anything before: if it is 0, the loss began earlier.
    pub first_lost_bits: f64,
    /// The largest factor by which the operands' relative errors grew.
    pub condition: f64,
    /// The number of results that are not finite although the operands are.
    pub non_finite: u64,
    /// The number of those that are not finite in exact arithmetic either.
    pub non_finite_in_exact: u64,
    /// The number of decisions that f32 takes the other way.
    pub disagreements: u64,
    /// The pixel with the largest harm: column and row.
    pub at: [u32; 2],
    /// Whether the exact result jumps there by itself, so that no rewriting helps.
    pub ill_posed: bool,
    /// Whether it compares for equality.
    pub equality: bool,
    /// The undefined thing in words, if GLSL leaves the result undefined and f32 loses nothing: [`harm`](Self::harm) is then the largest
    /// change of a channel that other results make.
    pub undefined: Option<&'static str>,
}

/// How to examine a scene.
pub struct ExamineOptions<'a> {
    /// The error of the picture that is accepted.
    pub bound: f64,
    /// An error of this share of a pixel's largest channel is accepted, too: f32 has no more digits for large values. 0
    /// accepts none.
    pub bound_relative: f64,
    /// Whether causes below the bound are told, too.
    pub all: bool,
    /// Whether the figures of every expression are wanted, even if nothing hurts.
    pub figures: bool,
    /// Called before each experiment with the number of those done and of all; `false` ends the experiments.
    pub progress: &'a mut dyn FnMut(usize, usize) -> bool,
}

/// The verdict over a program with its inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stability {
    /// The error of the picture is within the bound.
    Stable,
    /// It is above the bound.
    Degraded,
    /// A number that is not finite, a decision that f32 takes the other way, or a result that GLSL leaves undefined changes a pixel by
    /// more than the bound.
    Broken,
}

/// The effect of f32 arithmetic on the picture of a scene, and its causes.
#[derive(Clone, Debug)]
pub struct Examination {
    /// The picture of f32 arithmetic, before it is rounded to the framebuffer's format.
    pub single: Picture,
    /// The picture of exact arithmetic.
    pub exact: Picture,
    /// The framebuffer's format.
    pub format: Format,
    /// The difference, pixel by pixel, where it is more than [`ExamineOptions::bound_relative`] accepts.
    pub errors: ErrorMap,
    /// The difference, pixel by pixel, all of it.
    pub all_errors: ErrorMap,
    /// The number of results in all invocations that are not finite in f32 although their operands are.
    pub non_finite: u64,
    /// The causes, worst first.
    pub causes: Vec<Cause>,
    /// Every expression that was evaluated: causes first, then by their loss; empty if nothing hurts and
    /// [`ExamineOptions::figures`] is not set.
    pub spans: Vec<SpanError>,
    /// The verdict.
    pub verdict: Stability,
}

impl ExamineOptions<'_> {
    /// The least harm that is told.
    fn least(&self) -> f64 {
        if self.all { self.bound * 1e-3 } else { self.bound }
    }
}

impl Stability {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Degraded => "degraded",
            Self::Broken => "broken",
        }
    }
}

impl Examination {
    /// The attachment in which a pixel has its largest error; the first of those that are equal.
    pub fn attachment_at(&self, pixel: usize) -> usize {
        let attachments = self.single.attachments.iter().zip(&self.exact.attachments);
        let errors = attachments.map(|(single, exact)| match (single.get(pixel), exact.get(pixel)) {
            (Some(single), Some(exact)) => errors::pixel_error(single, exact, self.format),
            _ => 0.0,
        });
        errors.enumerate().fold((0, 0.0), |worst, (at, error)| if error > worst.1 { (at, error) } else { worst }).0
    }

    /// Whether every pixel that counts is finite in exact arithmetic.
    pub fn is_finite_in_exact(&self) -> bool {
        let is_finite = |at: usize| {
            let pixels = self.exact.attachments.iter().filter_map(|pixels| pixels.get(at));
            pixels.flatten().all(|channel| channel.is_finite())
        };
        self.all_errors.counted.iter().enumerate().all(|(at, counted)| !counted || is_finite(at))
    }
}

/// Draws a scene in f32 and exact arithmetic side by side. The precision in the options is ignored.
///
/// It takes many times as long as the same picture in f64, because it examines every result in every lane.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn trace(scene: &Scene, options: &RenderOptions) -> Result<Trace, Vec<Diagnostic>> {
    let (picture, tallies, output_error) = recorded(scene, options)?;
    Ok(Trace { spans: spans(&tallies), output_error, picture })
}

fn recorded(scene: &Scene, options: &RenderOptions) -> Result<(Picture, BTreeMap<Place, Tally>, f64), Vec<Diagnostic>> {
    let collected = Arc::new(Collected::default());
    let shared = Arc::clone(&collected);
    let make = move || -> Box<dyn exec::Observer<Shadow>> { Box::new(Recorder::new(&shared)) };
    let picture = pipeline::render_watched::<Shadow>(scene, options, Some(&make))?;
    let (tallies, output_error) = collected.joined();
    Ok((picture, tallies, output_error))
}

fn spans(tallies: &BTreeMap<Place, Tally>) -> Vec<SpanError> {
    let mut by_span: BTreeMap<(Stage, Span), SpanError> = BTreeMap::new();
    for (&(stage, span, act), tally) in tallies.iter().filter(|((_, span, _), _)| span.is_known()) {
        let found = SpanError::new(stage, span, CauseKind::of(act, tally), tally);
        let known = by_span.entry((stage, span));
        known.and_modify(|known| known.join(&found)).or_insert(found);
    }
    let mut spans: Vec<SpanError> = by_span.into_values().collect();
    // The sort is stable: equal entries stay in source order.
    spans.sort_by(|a, b| {
        let key = |span: &SpanError| (span.is_cause(), span.births > 0);
        let bits = b.mean_lost_bits.total_cmp(&a.mean_lost_bits);
        key(b).cmp(&key(a)).then(bits).then(b.added.total_cmp(&a.added))
    });
    spans
}

/// Draws a scene in f32 and in exact arithmetic, finds what differs, and which expressions are to blame.
///
/// Pictures are compared before they are rounded to the framebuffer's format. Vertex positions belong to the
/// comparison: an error of a position that moves an edge by more than 1/128 pixel shows.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn examine(scene: &Scene, options: &mut ExamineOptions<'_>) -> Result<Examination, Vec<Diagnostic>> {
    let format = scene.framebuffer.format;
    let given = scene;
    let scene = &Scene { framebuffer: errors::unrounded(scene.framebuffer), ..scene.clone() };
    let drawing = drawing_options();
    let exact = pipeline::render::<F64>(scene, &drawing)?;
    let births = Arc::new(AtomicU64::new(0));
    let shared = Arc::clone(&births);
    let make = move || -> Box<dyn exec::Observer<Stepwise>> { Box::new(BirthCounter::new(&shared)) };
    let single = pipeline::render_watched::<Stepwise>(scene, &drawing, Some(&make))?;
    let all_errors = ErrorMap::new(&single, &exact, format);
    let errors = all_errors.clone().beyond(&exact, options.bound_relative);
    let non_finite = births.load(Ordering::Relaxed);
    let worst = errors.worst().map_or(0.0, |(_, error)| error);
    let hurts = worst > options.least() || errors.not_finite() > 0;
    let tallies = if hurts || options.figures { recorded(scene, &drawing)?.1 } else { BTreeMap::new() };
    let mut causes = if hurts {
        causes(&Bench::new(scene, format, &exact, (&errors, options.bound_relative)), &tallies, options)?
    } else {
        Vec::new()
    };
    // Those whose harm is not finite come first.
    let chosen = undefined::causes(given, &errors, options.bound, &causes)?;
    let first = causes.iter().position(|cause| cause.harm.is_some()).unwrap_or(causes.len());
    causes.splice(first..first, chosen);
    let breaks = |cause: &Cause| {
        let decides = cause.disagreements > 0 && cause.kind.is_decision();
        (decides || cause.non_finite > 0 || cause.undefined.is_some())
            && cause.harm.is_none_or(|harm| harm > options.bound)
    };
    let verdict = match () {
        () if errors.not_finite() > 0 || causes.iter().any(breaks) => Stability::Broken,
        () if worst > options.bound => Stability::Degraded,
        () => Stability::Stable,
    };
    let spans = spans(&tallies);
    Ok(Examination { single, exact, format, errors, all_errors, non_finite, causes, spans, verdict })
}

/// Both pictures of a scene, and their difference.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The picture of f32 arithmetic, before it is rounded to the framebuffer's format.
    pub single: Picture,
    /// The picture of exact arithmetic.
    pub exact: Picture,
    /// The difference, pixel by pixel.
    pub errors: ErrorMap,
}

/// The pictures in f32 and in exact arithmetic alone, without causes: several times as fast as [`examine`].
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn pictures_of(scene: &Scene) -> Result<Pair, Vec<Diagnostic>> {
    let format = scene.framebuffer.format;
    let scene = &Scene { framebuffer: errors::unrounded(scene.framebuffer), ..scene.clone() };
    let drawing = drawing_options();
    let exact = pipeline::render::<F64>(scene, &drawing)?;
    let single = pipeline::render::<Stepwise>(scene, &drawing)?;
    let errors = ErrorMap::new(&single, &exact, format);
    Ok(Pair { single, exact, errors })
}

/// The largest change of each pixel of the exact picture when all inputs of its fragment move by an ULP of f32.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn changes_of(scene: &Scene) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let format = scene.framebuffer.format;
    let scene = &Scene { framebuffer: errors::unrounded(scene.framebuffer), ..scene.clone() };
    let exact = pipeline::render::<F64>(scene, &drawing_options())?;
    bench::changes(scene, (&exact, format), None, Moves::Inputs)
}

/// The difference of [`pictures_of`].
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn errors_of(scene: &Scene) -> Result<ErrorMap, Vec<Diagnostic>> {
    pictures_of(scene).map(|pair| pair.errors)
}

/// The errors of a scene that should look like another one.
#[derive(Clone, Debug)]
pub struct Against {
    /// The difference of its picture in f32 from the exact picture of the other. Where that is not finite, its own exact picture takes the
    /// place of it.
    pub errors: ErrorMap,
    /// The difference of the exact pictures, where that of the other is finite.
    pub exact: ErrorMap,
}

/// Compares a scene with the exact picture of another one that should look the same.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn errors_against(scene: &Scene, wanted: &Picture) -> Result<Against, Vec<Diagnostic>> {
    let format = scene.framebuffer.format;
    let own = pictures_of(scene)?;
    let mut wanted = wanted.clone();
    for (wanted, own) in wanted.attachments.iter_mut().zip(&own.exact.attachments) {
        for (wanted, own) in wanted.iter_mut().flatten().zip(own.iter().flatten()) {
            if !wanted.is_finite() {
                *wanted = *own;
            }
        }
    }
    let [errors, exact] = [&own.single, &own.exact].map(|picture| ErrorMap::new(picture, &wanted, format));
    Ok(Against { errors, exact })
}

/// The values of the fragment stage's varyings at a pixel, in exact arithmetic: names with their components. Empty where
/// nothing was drawn.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn inputs_at(scene: &Scene, pixel: [u32; 2]) -> Result<Vec<(String, Vec<f64>)>, Vec<Diagnostic>> {
    let mut found = Vec::new();
    for draw in &scene.draws {
        let probe = Probe { pixel, found: Mutex::new(Vec::new()) };
        let study = Study { probe: Some(&probe), ..Study::NONE };
        let alone = Scene { draws: vec![draw.clone()], ..scene.clone() };
        pipeline::render_studied::<F64>(&alone, &drawing_options(), study)?;
        let values = probe.found.into_inner().unwrap_or_else(PoisonError::into_inner);
        if !values.is_empty() {
            found = named(&draw.program, &values);
        }
    }
    Ok(found)
}

fn named(program: &Program, values: &[(glisten_front::hir::GlobalId, u32, f64)]) -> Vec<(String, Vec<f64>)> {
    let globals = program.stage(Stage::Fragment).map_or(&[][..], |shader| &shader.globals);
    let mut by_name: Vec<(String, Vec<f64>)> = Vec::new();
    for (id, _, value) in values {
        let Some(global) = globals.get(id.index()) else { continue };
        match by_name.last_mut() {
            Some((name, components)) if *name == global.name => components.push(*value),
            _ => by_name.push((global.name.clone(), vec![*value])),
        }
    }
    by_name
}

impl SpanError {
    fn new(stage: Stage, span: Span, kind: CauseKind, tally: &Tally) -> Self {
        let mean = |sum: f64| if tally.finite == 0 { 0.0 } else { sum / tally.finite as f64 };
        Self {
            span,
            stage,
            kind,
            evaluations: tally.evaluations,
            added: tally.added,
            added_ulps: tally.added_ulps,
            error: tally.error,
            mean_error: mean(tally.error_sum),
            lost_bits: tally.lost_bits,
            mean_lost_bits: mean(tally.lost_bits_sum),
            canceled_bits: tally.canceled_bits,
            condition: tally.condition,
            births: tally.non_finite(),
            births_in_both: tally.births_in_both,
            disagreements: tally.disagreements,
            decisions: tally.decisions,
        }
    }

    /// Another operation of the same expression: counts of evaluations are those of the first.
    fn join(&mut self, other: &Self) {
        if other.lost_bits > self.lost_bits || other.births > self.births {
            self.kind = other.kind;
        }
        self.evaluations = self.evaluations.max(other.evaluations);
        for (mine, more) in [
            (&mut self.added, other.added),
            (&mut self.added_ulps, other.added_ulps),
            (&mut self.error, other.error),
            (&mut self.mean_error, other.mean_error),
            (&mut self.lost_bits, other.lost_bits),
            (&mut self.mean_lost_bits, other.mean_lost_bits),
            (&mut self.canceled_bits, other.canceled_bits),
            (&mut self.condition, other.condition),
        ] {
            *mine = mine.max(more);
        }
        self.births += other.births;
        self.births_in_both += other.births_in_both;
        self.disagreements += other.disagreements;
        self.decisions += other.decisions;
    }

    /// Whether precision is lost here rather than earlier: bits that the operands had, a result that is not a number,
    /// or a decision on which the two sides disagree.
    pub fn is_cause(&self) -> bool {
        self.lost_bits >= CAUSE_BITS || self.births > 0 || self.disagreements > 0
    }

    /// The error as a diagnostic that any writer can show.
    pub fn diagnostic(&self) -> Diagnostic {
        let message = match (self.births, self.disagreements) {
            (1.., _) if self.births == self.births_in_both => {
                "this is not finite in exact arithmetic either".to_owned()
            }
            (1.., _) => "this is finite, and in f32 it is not".to_owned(),
            (0, 1..) => "f32 and exact arithmetic disagree on this".to_owned(),
            (0, 0) => format!("this loses up to {:.1} of 24 bits in f32", self.lost_bits),
        };
        let label = match () {
            () if self.births > 0 => format!("{} of {} results", self.births, self.evaluations),
            () if self.disagreements > 0 => format!("{} of {} results", self.disagreements, self.evaluations),
            () if self.canceled_bits >= CAUSE_BITS => {
                format!(
                    "up to {:.0} leading bits cancel; {:.1} bits lost on average",
                    self.canceled_bits, self.mean_lost_bits
                )
            }
            () => format!("{:.1} bits lost on average", self.mean_lost_bits),
        };
        let mut figures = format!(
            "it adds up to {:.1e} ({:.1} ulp); the error by then is up to {:.1e}, {:.1e} on average",
            self.added, self.added_ulps, self.error, self.mean_error
        );
        if self.condition > 1.0 {
            figures.push_str(&format!("; errors of operands grow up to {:.0} times", self.condition));
        }
        Diagnostic::new(&codes::scenes::PRECISION_LOST, self.span, message).here(label).note(figures)
    }
}
