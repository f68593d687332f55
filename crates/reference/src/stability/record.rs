//! Records the errors of each span while a scene is drawn in the shadow domain.
//!
//! *In:* the executor's events. *Out:* a [`Tally`] for each span. *Holds:* tallies of the same events are the same,
//! whatever threads they ran on: each piece of the drawing has its own recorder, and the recorders are joined in
//! order.

use crate::domain::{Shadow, ShadowFloat};
use crate::exec::{Event, Kind, Observer, Order, Values, What};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::compare::ulp_f32;
use smallvec::SmallVec;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The number of bits of an f32's significand, which is the largest possible loss.
pub(super) const SIGNIFICAND: f64 = 24.0;

/// The figures of one span. Sums are over evaluations: one scalar result in one lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) evaluations: u64,
    pub(super) finite: u64,
    pub(super) added: f64,
    pub(super) added_ulps: f64,
    pub(super) error: f64,
    pub(super) error_sum: f64,
    pub(super) lost_bits: f64,
    pub(super) lost_bits_sum: f64,
    pub(super) canceled_bits: f64,
    pub(super) condition: f64,
    pub(super) births: u64,
    pub(super) births_in_both: u64,
    pub(super) disagreements: u64,
    pub(super) decisions: u64,
}

impl Tally {
    pub(super) fn join(&mut self, other: &Self) {
        self.evaluations += other.evaluations;
        self.finite += other.finite;
        self.added = self.added.max(other.added);
        self.added_ulps = self.added_ulps.max(other.added_ulps);
        self.error = self.error.max(other.error);
        self.error_sum += other.error_sum;
        self.lost_bits = self.lost_bits.max(other.lost_bits);
        self.lost_bits_sum += other.lost_bits_sum;
        self.canceled_bits = self.canceled_bits.max(other.canceled_bits);
        self.condition = self.condition.max(other.condition);
        self.births += other.births;
        self.births_in_both += other.births_in_both;
        self.disagreements += other.disagreements;
        self.decisions += other.decisions;
    }

    /// Records one scalar result of operands in one lane.
    fn note(&mut self, kind: Kind, operands: &[ShadowFloat], result: ShadowFloat) {
        self.evaluations += 1;
        let finite = |number: &ShadowFloat| number.single.is_finite();
        if !finite(&result) && operands.iter().all(finite) {
            self.births += 1;
            self.births_in_both += u64::from(!result.wide.is_finite());
            self.lost_bits = if result.wide.is_finite() { SIGNIFICAND } else { self.lost_bits };
        }
        if !finite(&result) || !result.wide.is_finite() || !result.exact.is_finite() {
            return;
        }
        self.finite += 1;
        self.added = self.added.max(result.added());
        self.added_ulps = self.added_ulps.max(result.added() / ulp_f32(result.exact));
        self.error = self.error.max(result.error());
        self.error_sum += result.error();
        let brought = operands.iter().copied().map(error_ulps).fold(0.0, f64::max);
        // Within an ULP nothing is lost. The loss is a ratio, because the number of ULP of an error jumps at powers
        // of two.
        let lost = (error_ulps(result).max(1.0) / brought.max(1.0)).log2().clamp(0.0, SIGNIFICAND);
        self.lost_bits = self.lost_bits.max(lost);
        self.lost_bits_sum += lost;
        self.canceled_bits = self.canceled_bits.max(canceled(kind, operands, result));
        self.condition = self.condition.max(condition(operands, result));
        if kind == Kind::Jump && result.error() >= 0.5 {
            self.disagreements += 1;
        }
    }
}

/// The difference between f32 and f64 in ULP of the larger: 2^24 if no digit is right.
fn error_ulps(number: ShadowFloat) -> f64 {
    let size = f64::from(number.single).abs().max(number.wide.abs());
    if number.error() == 0.0 || !size.is_finite() { 0.0 } else { number.error() / ulp_f32(size) }
}

/// By how many bits the result of a sum is smaller than its largest term, all computed in f32.
fn canceled(kind: Kind, operands: &[ShadowFloat], result: ShadowFloat) -> f64 {
    let terms: SmallVec<[f64; 4]> = match kind {
        Kind::Sum => operands.iter().map(|operand| f64::from(operand.single)).collect(),
        Kind::Dot => {
            let (a, b) = operands.split_at(operands.len() / 2);
            a.iter().zip(b).map(|(a, b)| f64::from(a.single) * f64::from(b.single)).collect()
        }
        Kind::Jump | Kind::Derivative | Kind::Texture | Kind::Other => return 0.0,
    };
    let largest = terms.iter().map(|term| term.abs()).fold(0.0, f64::max);
    let left = f64::from(result.single).abs();
    if largest == 0.0 || left >= largest {
        return 0.0;
    }
    (largest.log2() - left.log2()).min(SIGNIFICAND)
}

/// The relative error that the operands' errors cause in the exact result, as a multiple of the largest of them; 0 if
/// they have none.
fn condition(operands: &[ShadowFloat], result: ShadowFloat) -> f64 {
    let relative = |difference: f64, value: f64| if value == 0.0 { 0.0 } else { (difference / value).abs() };
    let brought = operands.iter().map(|operand| relative(operand.error(), operand.wide)).fold(0.0, f64::max);
    let made = relative(result.exact - result.wide, result.wide);
    if brought == 0.0 || !brought.is_finite() { 0.0 } else { made / brought }
}

/// All tallies, joined in order.
#[derive(Debug, Default)]
pub(super) struct Collected {
    parts: Mutex<Vec<(Order, Recorder)>>,
}

/// Whether a tally belongs to a vertex or a fragment stage, and its span.
pub(super) type StageSpan = (Stage, Span);

impl Collected {
    /// The tallies of each stage and span, and the largest error of a fragment stage's output.
    pub(super) fn joined(&self) -> (BTreeMap<StageSpan, Tally>, f64) {
        let mut parts = std::mem::take(&mut *self.parts.lock().unwrap_or_else(PoisonError::into_inner));
        parts.sort_by_key(|(order, _)| *order);
        let mut all: BTreeMap<StageSpan, Tally> = BTreeMap::new();
        let mut output = 0.0_f64;
        for (order, recorder) in &parts {
            // Values that are the same for all invocations count with their stage: 0 with 2, 1 with 3.
            let stage = order.piece.stage();
            for (span, tally) in &recorder.tallies {
                all.entry((stage, *span)).or_default().join(tally);
            }
            if stage == Stage::Fragment {
                output = output.max(recorder.output);
            }
        }
        (all, output)
    }
}

/// The tallies of one piece of the drawing.
#[derive(Debug, Default)]
pub(super) struct Recorder {
    tallies: BTreeMap<Span, Tally>,
    output: f64,
    shared: Option<Arc<Collected>>,
}

impl Recorder {
    pub(super) fn new(shared: &Arc<Collected>) -> Self {
        Self { shared: Some(Arc::clone(shared)), ..Self::default() }
    }
}

impl Observer<Shadow> for Recorder {
    fn see(&mut self, event: &Event<'_, Shadow>) {
        if event.lanes.is_empty() {
            return;
        }
        let undecided = |values: &Values<'_, crate::domain::ShadowInt>| {
            event.lanes.lanes().filter(|lane| values.at(*lane).bits != values.at(*lane).single).count() as u64
        };
        match &event.what {
            What::Floats { kind, operands, results } => {
                let tally = self.tallies.entry(event.span).or_default();
                for lane in event.lanes.lanes() {
                    let operands: SmallVec<[ShadowFloat; 8]> = operands.iter().map(|values| values.at(lane)).collect();
                    results.iter().for_each(|values| tally.note(*kind, &operands, values.at(lane)));
                }
            }
            What::Answer(values) => {
                let tally = self.tallies.entry(event.span).or_default();
                tally.evaluations += u64::from(event.lanes.0.count_ones());
                tally.disagreements += undecided(values);
            }
            What::Choice(values) => {
                let decisions = undecided(values);
                if decisions > 0 {
                    self.tallies.entry(event.span).or_default().decisions += decisions;
                }
            }
            What::Output(values) => {
                let errors = event.lanes.lanes().map(|lane| values.at(lane).error());
                self.output = errors.filter(|error| error.is_finite()).fold(self.output, f64::max);
            }
        }
    }

    fn finish(mut self: Box<Self>, order: Order) {
        if let Some(shared) = self.shared.take() {
            shared.parts.lock().unwrap_or_else(PoisonError::into_inner).push((order, *self));
        }
    }
}
