//! Finds the operations of a program that lose precision in f32: the root causes, not every expression after them.
//!
//! *In:* a [`Scene`]. *Out:* a [`Trace`]: for each expression the effect of its f32 arithmetic, worst first.
//!
//! The scene is drawn in the [shadow domain](super::domain::ShadowFloat), f32 and f64 side by side. For each
//! operation three results are known: in f32 on f32 operands (a), in f64 on the same operands (b), in f64 on f64
//! operands (c). `a - b` is the error that the operation adds, `b - c` what it makes of its operands' errors, `a - c`
//! the total error. An operation is a cause if its result has lost bits that its operands still had: by its own
//! rounding (`pow` with a large exponent), or by turning a small relative error into a large one (`1.0 - cos(x)`).
//!
//! *Holds:* both sides take the path of f64. The figures do not depend on threads. Helper invocations are not
//! counted.
//!
//! *Not done here:* subnormal numbers are not flushed. A GPU's own formulas for `sin` and so on, and its weights of
//! linear filtering, are not modeled: they round once.

mod record;
#[cfg(test)]
mod tests;

use super::domain::Shadow;
use super::pipeline;
use super::{RenderOptions, exec};
use glisten_front::diagnostic::{Diagnostic, codes};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use record::{Collected, Recorder, Tally};
use std::sync::Arc;

/// An expression is a cause if its result has lost this many bits more than its operands. Three operands with half an
/// ULP each and as many roundings stay below.
pub const CAUSE_BITS: f64 = 3.0;

/// The effect of f32 arithmetic in one expression, over all lanes that evaluated it; a vector counts once for each
/// component. Errors are over results that are finite on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpanError {
    /// The expression.
    pub span: Span,
    /// The stage of the expression.
    pub stage: Stage,
    /// The number of scalar results.
    pub evaluations: u64,
    /// The largest error that the operation itself added: the difference between its f32 result and the exact result
    /// on the same operands.
    pub added: f64,
    /// That error in ULP of the exact result; half an ULP is rounding.
    pub added_ulps: f64,
    /// The largest difference between f32 and f64, including the operands' errors.
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
    /// The number of those that are also infinite or NaN in f64: the model causes them, not f32.
    pub births_in_both: u64,
    /// The number of comparisons, conversions to integers and jumps (`floor`, `step`) on which f32 and f64 disagree.
    pub disagreements: u64,
    /// The number of branches and selections that f32 alone would decide differently.
    pub decisions: u64,
}

/// The stability of a program, as a drawing shows it.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Every expression that was evaluated: causes first, then by their loss.
    pub spans: Vec<SpanError>,
    /// The largest difference between f32 and f64 in the outputs of the fragment stages.
    pub output_error: f64,
    /// The picture, in f64.
    pub picture: Picture,
}

/// Draws a scene in f32 and f64 side by side. The precision in the options is ignored.
///
/// It takes many times as long as the same picture in f64, because it examines every result in every lane.
///
/// # Errors
/// The errors of [`cpu::render`](super::render).
pub fn trace(scene: &Scene, options: &RenderOptions) -> Result<Trace, Vec<Diagnostic>> {
    let collected = Arc::new(Collected::default());
    let shared = Arc::clone(&collected);
    let make = move || -> Box<dyn exec::Observer<Shadow>> { Box::new(Recorder::new(&shared)) };
    let picture = pipeline::render_watched::<Shadow>(scene, options, Some(&make))?;
    let (tallies, output_error) = collected.joined();
    let mut spans: Vec<SpanError> = (tallies.into_iter())
        .filter(|((_, span), _)| span.is_known())
        .map(|((stage, span), tally)| SpanError::new(stage, span, &tally))
        .collect();
    // The sort is stable: equal entries stay in source order.
    spans.sort_by(|a, b| {
        let key = |span: &SpanError| (span.is_cause(), span.births > 0);
        let bits = b.mean_lost_bits.total_cmp(&a.mean_lost_bits);
        key(b).cmp(&key(a)).then(bits).then(b.added.total_cmp(&a.added))
    });
    Ok(Trace { spans, output_error, picture })
}

impl SpanError {
    fn new(stage: Stage, span: Span, tally: &Tally) -> Self {
        let mean = |sum: f64| if tally.finite == 0 { 0.0 } else { sum / tally.finite as f64 };
        Self {
            span,
            stage,
            evaluations: tally.evaluations,
            added: tally.added,
            added_ulps: tally.added_ulps,
            error: tally.error,
            mean_error: mean(tally.error_sum),
            lost_bits: tally.lost_bits,
            mean_lost_bits: mean(tally.lost_bits_sum),
            canceled_bits: tally.canceled_bits,
            condition: tally.condition,
            births: tally.births,
            births_in_both: tally.births_in_both,
            disagreements: tally.disagreements,
            decisions: tally.decisions,
        }
    }

    /// Whether precision is lost here rather than earlier: bits that the operands had, a result that is not a number,
    /// or a decision on which f32 and f64 disagree.
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
            (0, 1..) => "f32 and f64 disagree on this".to_owned(),
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
