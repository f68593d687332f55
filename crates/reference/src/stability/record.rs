//! Records the errors of each span while a scene is drawn in the shadow domain.
//!
//! *In:* the executor's events. *Out:* a [`Tally`] for each span and kind of operation. *Holds:* tallies of the same
//! events are the same, whatever threads they ran on: each piece of the drawing has its own recorder, and the recorders
//! are joined in order.

use super::CAUSE_BITS;
use super::birth::{Birth, is_vanished};
use crate::domain::{Shadow, ShadowFloat, rounded};
use crate::exec::{Event, Kind, Observer, Order, Values, What};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The number of bits of an f32's significand, which is the largest possible loss.
pub(super) const SIGNIFICAND: f64 = 24.0;

/// Operands whose error is at most this many ULP have lost nothing yet.
pub(super) const SOUND_ULPS: f64 = 8.0;

/// The relative error up to which a result has lost less than [`CAUSE_BITS`]: 8 ULP at the end of a binade.
const SOUND: f64 = 1.0 / (1u64 << 21) as f64;

/// The square of a number above this is above the largest f32.
const LARGEST_SQUARED: f64 = 1.8e19;

/// The square of a number below this is below the smallest normal f32.
const SMALLEST_SQUARED: f64 = 1.1e-19;

/// The smallest normal f32.
const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

/// The act of a span: an operation on floats, or an answer about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Act {
    /// Floats from floats.
    Float(Kind),
    /// A comparison.
    Compare {
        /// `==`, `!=`
        equality: bool,
    },
    /// `int(x)`, `uint(x)`
    ToInt,
}

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
    /// The largest loss where no operand had lost anything: here, and not earlier.
    pub(super) first_lost_bits: f64,
    /// The largest loss where nothing was below the range of f32.
    pub(super) lost_bits_in_range: f64,
    pub(super) canceled_bits: f64,
    pub(super) condition: f64,
    /// The size of the largest operand.
    pub(super) largest_operand: f64,
    /// Results that are not finite although the operands are, by their origin.
    pub(super) births: [u64; Birth::ALL.len()],
    pub(super) births_in_both: u64,
    /// Results of whole vectors that are wrong because squares of their components overflow on the way.
    pub(super) overflows: u64,
    /// Results that are 0 only because f32 has no smaller number.
    pub(super) underflows: u64,
    pub(super) disagreements: u64,
    /// Disagreements on operands that have lost nothing: the exact operands are at the edge themselves.
    pub(super) at_edge: u64,
    pub(super) decisions: u64,
}

impl Tally {
    /// All results that are not finite although the operands are.
    pub(super) fn non_finite(&self) -> u64 {
        self.births.iter().sum()
    }

    pub(super) fn join(&mut self, other: &Self) {
        self.evaluations += other.evaluations;
        self.finite += other.finite;
        self.added = self.added.max(other.added);
        self.added_ulps = self.added_ulps.max(other.added_ulps);
        self.error = self.error.max(other.error);
        self.error_sum += other.error_sum;
        self.lost_bits = self.lost_bits.max(other.lost_bits);
        self.lost_bits_sum += other.lost_bits_sum;
        self.first_lost_bits = self.first_lost_bits.max(other.first_lost_bits);
        self.lost_bits_in_range = self.lost_bits_in_range.max(other.lost_bits_in_range);
        self.canceled_bits = self.canceled_bits.max(other.canceled_bits);
        self.condition = self.condition.max(other.condition);
        self.largest_operand = self.largest_operand.max(other.largest_operand);
        self.births.iter_mut().zip(other.births).for_each(|(mine, more)| *mine += more);
        self.births_in_both += other.births_in_both;
        self.overflows += other.overflows;
        self.underflows += other.underflows;
        self.disagreements += other.disagreements;
        self.at_edge += other.at_edge;
        self.decisions += other.decisions;
    }

    /// Records `count` equal results that are as good as f32 has them; `false` if this one needs [`Self::note`].
    #[inline(always)]
    fn note_sound(&mut self, result: ShadowFloat, count: u64) -> bool {
        let error = (result.single - result.wide).abs();
        // A comparison with a NaN is false.
        if error <= SOUND * result.single.abs() && error.is_finite() {
            self.evaluations += count;
            self.finite += count;
            self.error = self.error.max(error);
            self.error_sum += error * count as f64;
            self.added = self.added.max((result.single - result.exact).abs());
            return true;
        }
        false
    }

    /// Records one scalar result of operands in one lane.
    fn note(&mut self, kind: Kind, operands: &[ShadowFloat], result: ShadowFloat) {
        self.evaluations += 1;
        self.largest_operand = operands.iter().map(|operand| operand.single.abs()).fold(self.largest_operand, f64::max);
        let finite = |number: &ShadowFloat| number.single.is_finite();
        if !finite(&result) && operands.iter().all(finite) {
            self.births[Birth::of(kind, operands, result) as usize] += 1;
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
        // Within an ULP nothing is lost. The loss is a ratio, because the number of ULP of an error jumps at powers
        // of two.
        let brought = match kind {
            // The integer that is converted brings what its exact conversion has lost.
            Kind::Conversion => error_ulps(ShadowFloat { single: result.exact, ..result }).max(worst_ulps(operands)),
            _ => worst_ulps(operands),
        };
        let lost = log2(error_ulps(result).max(1.0) / brought.max(1.0)).clamp(0.0, SIGNIFICAND);
        if brought <= SOUND_ULPS {
            self.first_lost_bits = self.first_lost_bits.max(lost);
        }
        self.lost_bits = self.lost_bits.max(lost);
        self.lost_bits_sum += lost;
        self.canceled_bits = self.canceled_bits.max(canceled(kind, operands, result));
        self.condition = self.condition.max(condition(operands, result));
        let is_sum = matches!(kind, Kind::Sum | Kind::Dot | Kind::Pairs);
        let known = self.underflows;
        self.underflows +=
            u64::from(!is_sum && result.single == 0.0 && rounded(result.exact) == 0.0 && result.exact != 0.0);
        self.underflows += u64::from(kind == Kind::Dot && lost >= CAUSE_BITS && vanishes(operands));
        // A root or a quotient shows digits that left the range before.
        self.underflows += u64::from(!is_sum && lost >= CAUSE_BITS && operands.iter().any(is_vanished));
        if matches!(kind, Kind::Normalize | Kind::Vector) && lost >= CAUSE_BITS {
            let largest = operands.iter().map(|operand| operand.single.abs()).fold(0.0, f64::max);
            self.overflows += u64::from(largest > LARGEST_SQUARED);
            self.underflows += u64::from(largest < SMALLEST_SQUARED);
        }
        if self.underflows == known {
            self.lost_bits_in_range = self.lost_bits_in_range.max(lost);
        }
        if kind.jumps() && result.error() >= 0.5 * step_size(kind, operands) {
            self.note_disagreement(operands);
        }
    }

    fn note_disagreement(&mut self, operands: &[ShadowFloat]) {
        self.disagreements += 1;
        self.at_edge += u64::from(worst_ulps(operands) <= SOUND_ULPS);
    }
}

/// Whether the products of a dot product are too small for f32, so that their sum is, without any cancellation.
fn vanishes(operands: &[ShadowFloat]) -> bool {
    let (a, b) = operands.split_at(operands.len() / 2);
    let sizes = a.iter().zip(b).map(|(a, b)| (a.single * b.single).abs());
    (f64::MIN_POSITIVE..SMALLEST).contains(&sizes.fold(0.0, f64::max))
}

/// By how much a discontinuous function jumps: 1, or the divisor of `mod`.
fn step_size(kind: Kind, operands: &[ShadowFloat]) -> f64 {
    match (kind, operands) {
        (Kind::Whole, [_, divisor]) => divisor.wide.abs(),
        _ => 1.0,
    }
}

/// The largest error of operands, in ULP.
fn worst_ulps(operands: &[ShadowFloat]) -> f64 {
    operands.iter().copied().map(error_ulps).fold(0.0, f64::max)
}

/// The difference between f32 and exact arithmetic in ULP of the larger: 2^24 if no digit is right.
fn error_ulps(number: ShadowFloat) -> f64 {
    let size = number.single.abs().max(number.wide.abs());
    match (number.single.is_finite(), size.is_finite()) {
        _ if number.single == number.wide => 0.0,
        (false, _) => SIGNIFICAND.exp2(),
        (true, false) => 0.0,
        (true, true) => number.error() / ulp_f32(size),
    }
}

/// By how many bits the result of a sum is smaller than its largest term, all computed in f32.
fn canceled(kind: Kind, operands: &[ShadowFloat], result: ShadowFloat) -> f64 {
    let product = |a: &ShadowFloat, b: &ShadowFloat| a.single * b.single;
    let terms: SmallVec<[f64; 4]> = match kind {
        Kind::Sum => operands.iter().map(|operand| operand.single).collect(),
        Kind::Dot => {
            let (a, b) = operands.split_at(operands.len() / 2);
            a.iter().zip(b).map(|(a, b)| product(a, b)).collect()
        }
        Kind::Pairs => operands.chunks(2).map(|pair| pair.iter().map(|factor| factor.single).product()).collect(),
        _ => return 0.0,
    };
    let largest = terms.iter().map(|term| term.abs()).fold(0.0, f64::max);
    let left = result.single.abs();
    if largest == 0.0 || left >= largest {
        return 0.0;
    }
    if left == 0.0 { SIGNIFICAND } else { log2(largest / left).min(SIGNIFICAND) }
}

/// The binary logarithm of a positive normal number, at most 0.09 too small: a straight line between powers of two. It is
/// called for every result that has lost something.
fn log2(value: f64) -> f64 {
    let bits = value.to_bits();
    let exponent = (bits >> 52) as f64 - 1023.0;
    exponent + (bits & ((1 << 52) - 1)) as f64 / (1u64 << 52) as f64
}

/// The distance of f32 numbers of this size: [`ulp_f32`](glisten_scene::compare::ulp_f32), by the bits alone.
fn ulp_f32(value: f64) -> f64 {
    let exponent = (value.to_bits() >> 52 & 0x7ff).clamp(1023 - 126, 1023 + 127);
    f64::from_bits((exponent - 23) << 52)
}

/// The relative error that the operands' errors cause in the exact result, as a multiple of the largest of them; 0 if
/// they have none.
fn condition(operands: &[ShadowFloat], result: ShadowFloat) -> f64 {
    let relative = |difference: f64, value: f64| if value == 0.0 { 0.0 } else { (difference / value).abs() };
    let brought = operands.iter().map(|operand| relative(operand.error(), operand.wide)).fold(0.0, f64::max);
    let made = relative(result.exact - result.wide, result.wide);
    if brought == 0.0 || !brought.is_finite() || !made.is_finite() { 0.0 } else { made / brought }
}

/// All tallies, joined in order.
#[derive(Debug, Default)]
pub(super) struct Collected {
    parts: Mutex<Vec<(Order, Recorder)>>,
}

/// A stage, a span of it, and what it does.
pub(super) type Place = (Stage, Span, Act);

impl Collected {
    /// The tallies of each place, and the largest error of a fragment stage's output.
    pub(super) fn joined(&self) -> (BTreeMap<Place, Tally>, f64) {
        let mut parts = std::mem::take(&mut *self.parts.lock().unwrap_or_else(PoisonError::into_inner));
        parts.sort_by_key(|(order, _)| *order);
        let mut all: BTreeMap<Place, Tally> = BTreeMap::new();
        let mut output = 0.0_f64;
        for (order, recorder) in &parts {
            // Values that are the same for all invocations count with their stage: 0 with 2, 1 with 3.
            let stage = order.piece.stage();
            let tallies: BTreeMap<_, _> = recorder.tallies.iter().collect();
            for ((span, act), tally) in tallies {
                all.entry((stage, *span, *act)).or_default().join(tally);
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
    tallies: FxHashMap<(Span, Act), Tally>,
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
        let is_undecided = |values: &Values<'_, crate::domain::ShadowInt>, lane: usize| {
            let value = values.at(lane);
            value.bits != value.wide
        };
        let picked = |operands: &[Values<'_, ShadowFloat>], lane: usize| -> SmallVec<[ShadowFloat; 8]> {
            operands.iter().map(|values| values.at(lane)).collect()
        };
        match &event.what {
            What::Floats { kind, operands, results } => {
                let tally = self.tallies.entry((event.span, Act::Float(*kind))).or_default();
                let jumps = kind.jumps();
                let n_lanes = u64::from(event.lanes.0.count_ones());
                for values in *results {
                    if let Values::One(result) = values
                        && !jumps
                        && tally.note_sound(*result, n_lanes)
                    {
                        continue;
                    }
                    for lane in event.lanes.lanes() {
                        let result = values.at(lane);
                        if jumps || !tally.note_sound(result, 1) {
                            tally.note(*kind, &picked(operands, lane), result);
                        }
                    }
                }
            }
            What::Answer { converts, equality, operands, answer } => {
                let act = if *converts { Act::ToInt } else { Act::Compare { equality: *equality } };
                let tally = self.tallies.entry((event.span, act)).or_default();
                tally.evaluations += u64::from(event.lanes.0.count_ones());
                for lane in event.lanes.lanes().filter(|lane| is_undecided(answer, *lane)) {
                    tally.note_disagreement(&picked(operands, lane));
                }
            }
            What::Choice(values) => {
                let decisions = event.lanes.lanes().filter(|lane| is_undecided(values, *lane)).count() as u64;
                if decisions > 0 {
                    let act = Act::Compare { equality: false };
                    self.tallies.entry((event.span, act)).or_default().decisions += decisions;
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

#[cfg(test)]
mod tests {
    use super::{log2, ulp_f32};

    #[test]
    fn the_quick_functions_are_near_enough() {
        for value in [1.0, 1.5, 0.1, 3.7e-5, 123_456.0, 1e30, 2f64.powi(-126), 2f64.powi(127)] {
            assert_eq!(ulp_f32(value), glisten_scene::compare::ulp_f32(value), "{value}");
            assert!((0.0..0.09).contains(&(value.log2() - log2(value))), "{value}");
        }
    }
}
