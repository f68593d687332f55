//! Measures the harm of expressions: the picture is drawn again with one of them exact.
//!
//! *In:* a scene, and the tallies of its expressions. *Out:* [`Cause`]s with their harm, worst first. *Holds:* pictures and
//! order do not depend on threads. Experiments draw only the bins of the picture with the largest errors.

use super::errors::ErrorMap;
use super::kinds::CauseKind;
use super::loops::Loops;
use super::record::{Act, Place, SIGNIFICAND, Tally};
use super::{CAUSE_BITS, Cause, ExamineOptions};
use crate::domain::{ErrorPart, F64, Shadow};
use crate::exec::{Form, Kind};
use crate::pipeline::{self, Chosen, Study};
use crate::{Positions, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{GlobalId, Stage, Storage};
use glisten_front::source::Span;
use glisten_scene::picture::Picture;
use glisten_scene::{Format, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// The number of expressions that are tried at most.
const MOST_CANDIDATES: usize = 64;

/// The number of bins that experiments draw at most.
const MOST_BINS: usize = 16;

/// The number of times that the inputs are moved by an ULP.
const JITTERS: u64 = 6;

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
    bins: Vec<bool>,
}

/// The result of an experiment.
struct Outcome {
    /// By how much the errors of pixels shrank at most; infinite if a pixel became finite.
    harm: f64,
    /// The pixel where that is.
    index: usize,
    /// By how much each pixel's error shrank.
    gains: Vec<f64>,
}

impl Outcome {
    /// The number of pixels that become finite.
    fn cured(&self) -> u64 {
        self.gains.iter().filter(|gain| gain.is_infinite()).count() as u64
    }
}

/// An expression that may be a cause.
#[derive(Clone, Copy)]
struct Candidate {
    stage: Stage,
    span: Span,
    kind: CauseKind,
    act: Act,
    tally: Tally,
    /// Whether a loop runs it.
    repeats: bool,
    /// Whether only its own rounding counts: see [`Loops`].
    own: bool,
}

/// The options for both pictures.
pub(super) fn drawing_options() -> RenderOptions {
    RenderOptions { positions: Positions::Own, ..RenderOptions::default() }
}

impl<'a> Bench<'a> {
    pub(super) fn new(scene: &'a Scene, format: Format, exact: &'a Picture, errors: &'a ErrorMap) -> Self {
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
        Self { scene, format, options: drawing_options(), exact, errors, bins }
    }

    fn holds(&self, index: usize) -> bool {
        let columns = (self.errors.width as usize).div_ceil(BIN);
        let [x, y] = self.errors.place(index).map(|at| at as usize / BIN);
        self.bins.get(y * columns + x).copied().unwrap_or(false)
    }

    /// Draws with a part of the error of some expressions left out.
    fn without(&self, stage: Stage, spans: &[Span], part: ErrorPart) -> Result<Outcome, Vec<Diagnostic>> {
        self.drawn(Study { exactly: Some(Chosen { stage, spans, part }), ..Study::NONE })
    }

    fn drawn(&self, study: Study<'_, Shadow>) -> Result<Outcome, Vec<Diagnostic>> {
        let study = Study { bins: Some(&self.bins), form: Form::Unfused, ..study };
        let picture = pipeline::render_studied::<Shadow>(self.scene, &self.options, study)?;
        let left = ErrorMap::new(&picture, self.exact, self.format);
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
    fn with_exact_varying(&self, varying: GlobalId) -> Result<Outcome, Vec<Diagnostic>> {
        self.drawn(Study { exact_inputs: &[varying], ..Study::NONE })
    }

    /// The changes of [`Self::jitter`], drawn once.
    fn jittered<'m>(&self, moved: &'m mut Option<Vec<f64>>) -> Result<&'m [f64], Vec<Diagnostic>> {
        if moved.is_none() {
            *moved = Some(self.jitter()?);
        }
        Ok(moved.as_deref().unwrap_or(&[]))
    }

    /// The exact picture's largest change at each pixel when the inputs move by an ULP.
    fn jitter(&self) -> Result<Vec<f64>, Vec<Diagnostic>> {
        let mut most = vec![0.0_f64; self.errors.errors.len()];
        for seed in 1..=JITTERS {
            let study = Study { jitter: Some(seed), bins: Some(&self.bins), ..Study::NONE };
            let picture = pipeline::render_studied::<F64>(self.scene, &self.options, study)?;
            let moved = ErrorMap::new(&picture, self.exact, self.format);
            most.iter_mut().zip(moved.errors).for_each(|(most, moved)| *most = most.max(moved));
        }
        Ok(most)
    }
}

/// The causes of the picture's error, worst first.
pub(super) fn causes(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    options: &mut ExamineOptions<'_>,
) -> Result<Vec<Cause>, Vec<Diagnostic>> {
    let loops = loops(bench.scene);
    let candidates = candidates(tallies, &loops);
    let total = candidates.len();
    let mut found = Vec::new();
    let mut jitter: Option<Vec<f64>> = None;
    for (done, candidate) in candidates.into_iter().enumerate() {
        if !(options.progress)(done, total) {
            break;
        }
        if let Some(cause) = try_candidate(bench, &candidate, options, &mut jitter)? {
            found.push(cause);
        }
    }
    let explained = found.iter().filter_map(|cause| cause.harm).fold(0.0, f64::max);
    let worst = bench.errors.worst().map_or(0.0, |(_, error)| error);
    if worst > options.bound && explained < 0.5 * worst && !found.iter().any(|cause| cause.harm.is_none()) {
        found.extend(roundings(bench, tallies, &loops, &found, options, &mut jitter)?);
    }
    found.sort_by(|a, b| {
        let harm = |cause: &Cause| cause.harm.unwrap_or(f64::INFINITY);
        let first = b.first_lost_bits.total_cmp(&a.first_lost_bits);
        let bits = first.then(b.lost_bits.total_cmp(&a.lost_bits));
        harm(b).total_cmp(&harm(a)).then(bits).then(a.span.cmp(&b.span))
    });
    Ok(found)
}

fn loops(scene: &Scene) -> BTreeMap<Stage, Loops> {
    let mut all: BTreeMap<Stage, Loops> = BTreeMap::new();
    for draw in &scene.draws {
        for stage in [Stage::Vertex, Stage::Fragment] {
            let Some(shader) = draw.program.stage(stage) else { continue };
            let more = Loops::of(shader);
            let known = all.entry(stage).or_default();
            known.inside.extend(more.inside);
            known.accumulate.extend(more.accumulate);
        }
    }
    all
}

/// The expressions to try: those that lose bits, give birth to what is not finite, decide differently, or accumulate.
fn candidates(tallies: &BTreeMap<Place, Tally>, loops: &BTreeMap<Stage, Loops>) -> Vec<Candidate> {
    let mut by_span: BTreeMap<(Stage, Span), Candidate> = BTreeMap::new();
    for (&(stage, span, act), tally) in tallies {
        let is_cause = tally.lost_bits >= CAUSE_BITS || tally.non_finite() > 0 || tally.disagreements > 0;
        let accumulates = loops.get(&stage).is_some_and(|loops| loops.accumulate.contains(&span));
        let adds = accumulates && tally.added > 0.0;
        if !span.is_known() || !(is_cause || adds) || is_far_lookup(act, tally) {
            continue;
        }
        let kind = if is_cause { CauseKind::of(act, tally) } else { CauseKind::Accumulation };
        let repeats = loops.get(&stage).is_some_and(|loops| loops.inside.contains(&span));
        let candidate = Candidate { stage, span, kind, act, tally: *tally, repeats, own: !is_cause };
        let known = by_span.entry((stage, span));
        known
            .and_modify(|known| {
                if rank(&candidate) > rank(known) {
                    *known = candidate;
                }
            })
            .or_insert(candidate);
    }
    let mut list: Vec<Candidate> = by_span.into_values().collect();
    // The sort is stable: equal ones stay in source order.
    list.sort_by_key(|candidate| std::cmp::Reverse(rank(candidate)));
    list.truncate(MOST_CANDIDATES);
    list
}

/// Whether a lookup merely shows what its coordinates have lost before: they are so large that f32 has few digits for the
/// place in the texture.
fn is_far_lookup(act: Act, tally: &Tally) -> bool {
    const FAR: f64 = 8.0;
    act == Act::Float(Kind::Texture) && tally.largest_operand >= FAR
}

/// The order in which candidates are tried: the largest first.
fn rank(candidate: &Candidate) -> (bool, bool, u64) {
    let tally = &candidate.tally;
    (tally.non_finite() > 0, tally.disagreements > 0, (tally.lost_bits * 1e6) as u64)
}

fn try_candidate(
    bench: &Bench<'_>,
    candidate: &Candidate,
    options: &ExamineOptions<'_>,
    jitter: &mut Option<Vec<f64>>,
) -> Result<Option<Cause>, Vec<Diagnostic>> {
    let Candidate { stage, span, .. } = *candidate;
    let tally = &candidate.tally;
    let spans = [span];
    let least = options.least();
    let mut kind = candidate.kind;
    let mut outcome = bench.without(stage, &spans, ErrorPart::All)?;
    if outcome.harm < least && tally.non_finite() > 0 {
        // The exact result may be too large for the next operation.
        outcome = bench.without(stage, &spans, ErrorPart::Limited)?;
    }
    if outcome.harm < least {
        return Ok(None);
    }
    if candidate.own || kind == CauseKind::Cancellation {
        // Whether it is the rounding of many iterations, and not what the terms bring.
        let own = bench.without(stage, &spans, ErrorPart::Own)?;
        if candidate.own && own.harm < 0.5 * outcome.harm {
            return Ok(None);
        }
    }
    let mut ill_posed = is_at_edge(candidate);
    if !ill_posed && outcome.harm.is_finite() && (kind.is_decision() || candidate.repeats) {
        ill_posed = is_ill_posed(&outcome, bench.jittered(jitter)?, least);
    }
    let is_lookup = candidate.act == Act::Float(Kind::Texture);
    if ill_posed && kind == CauseKind::Conversion && !is_lookup {
        kind = CauseKind::Comparison;
    }
    let index = outcome.index;
    let harm = outcome.harm.is_finite().then(|| significant(outcome.harm));
    let equality = candidate.act == Act::Compare { equality: true };
    let cured = outcome.cured();
    let found = Found { kind, cured, harm, index, ill_posed, equality };
    Ok(Some(found.cause(bench, (stage, span), tally)))
}

/// The results of the experiments with an expression.
struct Found {
    kind: CauseKind,
    /// The number of pixels that become finite.
    cured: u64,
    harm: Option<f64>,
    index: usize,
    ill_posed: bool,
    equality: bool,
}

impl Found {
    fn cause(self, bench: &Bench<'_>, (stage, span): (Stage, Span), tally: &Tally) -> Cause {
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
        }
    }
}

/// Whether a comparison disagrees on numbers that are as good as f32 has them: the exact ones are at the threshold. A test for
/// equality is not: a tolerance helps.
fn is_at_edge(candidate: &Candidate) -> bool {
    let compares = matches!(candidate.act, Act::Compare { equality: false } | Act::Float(Kind::Step));
    let Tally { disagreements, at_edge, .. } = candidate.tally;
    compares && disagreements > 0 && at_edge == disagreements
}

/// Whether the exact picture changes as much when its inputs move by an ULP, at most of the pixels that the expression
/// harms.
fn is_ill_posed(outcome: &Outcome, moved: &[f64], least: f64) -> bool {
    let harmed: Vec<(f64, f64)> =
        outcome.gains.iter().copied().zip(moved.iter().copied()).filter(|(gain, _)| *gain >= least).collect();
    let jumping = harmed.iter().filter(|(gain, moved)| *moved >= 0.5 * gain).count();
    !harmed.is_empty() && 2 * jumping >= harmed.len()
}

/// Three significant digits, so that figures that differ by noise alone are equal.
fn significant(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// If no expression loses bits, many lose a little, or a number is too coarse for what follows: the expressions whose own
/// rounding harms most.
fn roundings(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    loops: &BTreeMap<Stage, Loops>,
    known: &[Cause],
    options: &mut ExamineOptions<'_>,
    jitter: &mut Option<Vec<f64>>,
) -> Result<Vec<Cause>, Vec<Diagnostic>> {
    let is_known = |stage: Stage, span: Span| known.iter().any(|cause| cause.stage == stage && cause.span == span);
    let mut adding: Vec<(Stage, Span, Tally)> = Vec::new();
    for (&(stage, span, _), tally) in tallies {
        if tally.added > 0.0 && span.is_known() && !is_known(stage, span) {
            adding.push((stage, span, *tally));
        }
    }
    adding.sort_by(|a, b| b.2.error.total_cmp(&a.2.error));
    let mut tried = BTreeSet::new();
    adding.retain(|(stage, span, _)| tried.insert((*stage, *span)));
    adding.truncate(MOST_CANDIDATES);
    let mut found = Vec::new();
    let total = adding.len();
    for (done, (stage, span, tally)) in adding.into_iter().enumerate() {
        if !(options.progress)(done, total) {
            break;
        }
        let own = bench.without(stage, &[span], ErrorPart::Own)?;
        if own.harm < options.least() || !own.harm.is_finite() {
            continue;
        }
        let repeats = loops.get(&stage).is_some_and(|loops| loops.inside.contains(&span));
        let kind = if repeats { CauseKind::Accumulation } else { CauseKind::Rounding };
        let ill_posed = repeats && is_ill_posed(&own, bench.jittered(jitter)?, options.least());
        let of =
            Found { kind, cured: 0, harm: Some(significant(own.harm)), index: own.index, ill_posed, equality: false };
        found.push(of.cause(bench, (stage, span), &tally));
    }
    if found.is_empty() {
        found.extend(coarse_varying(bench, tallies, options)?);
    }
    Ok(found)
}

/// If an exact varying makes the picture better, and no expression does: what the vertex stage writes is too large for f32 to
/// interpolate. The expression of the vertex stage that rounds most is to blame, or the varying itself if none rounds.
fn coarse_varying(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    options: &ExamineOptions<'_>,
) -> Result<Option<Cause>, Vec<Diagnostic>> {
    let mut worst: Option<(Outcome, Span)> = None;
    for (id, span) in varyings(bench.scene) {
        let outcome = bench.with_exact_varying(id)?;
        if outcome.harm.is_finite() && worst.as_ref().is_none_or(|(known, _)| outcome.harm > known.harm) {
            worst = Some((outcome, span));
        }
    }
    let Some((outcome, declared)) = worst.filter(|(outcome, _)| outcome.harm >= options.least()) else {
        return Ok(None);
    };
    let of_vertices = tallies.iter().filter(|((stage, span, _), _)| *stage == Stage::Vertex && span.is_known());
    let coarsest = of_vertices.max_by(|(_, a), (_, b)| a.added.total_cmp(&b.added));
    let harm = Some(significant(outcome.harm));
    let found =
        Found { kind: CauseKind::Rounding, cured: 0, harm, index: outcome.index, ill_posed: false, equality: false };
    Ok(Some(match coarsest.filter(|(_, tally)| tally.added > 0.0) {
        Some((&(stage, span, _), tally)) => found.cause(bench, (stage, span), tally),
        None => found.cause(bench, (Stage::Fragment, declared), &Tally::default()),
    }))
}

/// The varyings that fragment stages read, with their declarations.
fn varyings(scene: &Scene) -> Vec<(GlobalId, Span)> {
    let mut all = Vec::new();
    for shader in scene.draws.iter().filter_map(|draw| draw.program.stage(Stage::Fragment)) {
        for (index, global) in shader.globals.iter().enumerate() {
            if global.storage == Storage::In && global.span.is_known() {
                all.push((GlobalId::new(index), global.span));
            }
        }
    }
    all
}
