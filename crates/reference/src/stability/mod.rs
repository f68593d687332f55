//! Which operations of a program lose precision in f32: root causes, not every line behind them.
//!
//! *In:* a [`Scene`]. *Out:* a [`Trace`]: for each expression what its f32 arithmetic does to the truth, worst first.
//!
//! The scene is drawn in the [shadow domain](super::domain::ShadowFloat), f32 and f64 side by side. Of each operation
//! three results are known: in f32 on f32 operands (a), in f64 on the same operands (b), in f64 on f64 operands (c).
//! `a - b` is what the operation adds, `b - c` what it makes of the errors that its operands bring, `a - c` the error by
//! now. An operation is a cause if its result has lost bits that its operands still had: by its own rounding (`pow` of a
//! large exponent), or by turning a small relative error into a large one (`1.0 - cos(x)`).
//!
//! *Holds:* both sides run the path of f64. The figures do not depend on threads. Helper invocations are not counted.
//!
//! *Not done here:* denormals are not flushed; a GPU's own formulas for `sin` and its like, and its weights of linear
//! filtering, are not modeled: they round once.

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

/// How many bits more than its operands a result must have lost for its expression to be called a cause: three operands
/// with half an ULP each and as many roundings stay below.
pub const CAUSE_BITS: f64 = 3.0;

/// What f32 arithmetic did in one expression, in all lanes that evaluated it; a vector counts once for each component.
/// Errors are over results that are finite on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpanError {
    /// The expression.
    pub span: Span,
    /// Whose it is.
    pub stage: Stage,
    /// Scalar results.
    pub evaluations: u64,
    /// The largest error that the operation itself added: the distance of its f32 result from the exact result on the
    /// same operands.
    pub added: f64,
    /// The same in ULP of the exact result; half a ULP is rounding.
    pub added_ulps: f64,
    /// The largest distance of f32 from f64 by now, the operands' errors included.
    pub error: f64,
    /// Its mean.
    pub mean_error: f64,
    /// The most bits, of 24, that a result has lost and its operands had not.
    pub lost_bits: f64,
    /// Their mean.
    pub mean_lost_bits: f64,
    /// The most leading bits that a sum, difference or dot product canceled.
    pub cancelled_bits: f64,
    /// The largest factor by which operands' relative errors grew in the exact result: an estimate of the condition
    /// number from below; 0 where no operand brought an error.
    pub condition: f64,
    /// Results that are infinite or NaN in f32 though all operands were finite.
    pub births: u64,
    /// Those of them that are infinite or NaN in f64, too: the model's own, not f32's.
    pub births_in_both: u64,
    /// Comparisons, conversions to integers and jumps (`floor`, `step`) on which f32 and f64 disagree.
    pub disagreements: u64,
    /// Branches and selections that f32 alone would take the other way.
    pub choices: u64,
}

/// What a drawing tells of a program's stability.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Every expression that was evaluated: causes first, then by what they lose.
    pub spans: Vec<SpanError>,
    /// The largest distance of f32 from f64 in what the fragment stages put out.
    pub output_error: f64,
    /// The picture, in f64.
    pub picture: Picture,
}

/// Draws a scene in f32 and f64 side by side. The options' precision is of no account.
///
/// Costs many times what the same picture costs in f64: it looks at every result in every lane.
///
/// # Errors
/// Those of [`cpu::render`](super::render).
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
    // Stable: equals stay in the order of the text.
    spans.sort_by(|a, b| {
        let key = |span: &SpanError| (span.is_cause(), span.births > 0);
        let bits = b.mean_lost_bits.total_cmp(&a.mean_lost_bits);
        key(b).cmp(&key(a)).then(bits).then(b.added.total_cmp(&a.added))
    });
    Ok(Trace { spans, output_error, picture })
}

impl SpanError {
    fn new(stage: u8, span: Span, tally: &Tally) -> Self {
        let mean = |sum: f64| if tally.finite == 0 { 0.0 } else { sum / tally.finite as f64 };
        Self {
            span,
            stage: if stage == 0 { Stage::Vertex } else { Stage::Fragment },
            evaluations: tally.evaluations,
            added: tally.added,
            added_ulps: tally.added_ulps,
            error: tally.error,
            mean_error: mean(tally.error_sum),
            lost_bits: tally.lost_bits,
            mean_lost_bits: mean(tally.lost_bits_sum),
            cancelled_bits: tally.cancelled_bits,
            condition: tally.condition,
            births: tally.births,
            births_in_both: tally.births_in_both,
            disagreements: tally.disagreements,
            choices: tally.choices,
        }
    }

    /// Whether precision is lost here, rather than before: bits that the operands had, a number that is none, or an
    /// answer on which f32 and f64 disagree.
    pub fn is_cause(&self) -> bool {
        self.lost_bits >= CAUSE_BITS || self.births > 0 || self.disagreements > 0
    }

    /// It as a finding that any writer can show.
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
            () if self.cancelled_bits >= CAUSE_BITS => {
                format!(
                    "up to {:.0} leading bits cancel; {:.1} bits lost on average",
                    self.cancelled_bits, self.mean_lost_bits
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
