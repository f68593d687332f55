//! Measures the harm of expressions: the picture is drawn again with one of them exact.
//!
//! *In:* a scene, and the tallies of its expressions. *Out:* [`Cause`]s with their harm, worst first. *Holds:* pictures and
//! order do not depend on threads.

use super::bench::{Bench, Changes, Found, Moves, Outcome, significant};
use super::fractions::fractions;
use super::kinds::CauseKind;
use super::loops::Loops;
use super::origin::{coarse_varying, lost_before};
use super::record::{Act, Place, Tally};
use super::{CAUSE_BITS, Cause, ExamineOptions};
use crate::domain::ErrorPart;
use crate::exec::Kind;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Scene;
use std::collections::{BTreeMap, BTreeSet};

/// The number of expressions that are tried at most.
const MOST_CANDIDATES: usize = 64;

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
    /// Whether a loop stores its result in a variable that it reads.
    feeds: bool,
    /// Whether only its own rounding counts: see [`Loops`].
    own: bool,
}

/// The causes of the picture's error, worst first.
pub(super) fn causes(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    options: &mut ExamineOptions<'_>,
) -> Result<Vec<Cause>, Vec<Diagnostic>> {
    let loops = loops(bench.scene);
    let candidates = candidates(tallies, &loops, &fractions(bench.scene));
    let total = candidates.len();
    let mut tried: Vec<(Cause, Gains)> = Vec::new();
    let mut jitter = Changes::default();
    let mut open = bench.not_finite();
    for (done, candidate) in candidates.iter().enumerate() {
        if !(options.progress)(done, total) {
            break;
        }
        tried.extend(try_candidate(bench, candidate, options, (&mut jitter, &mut open))?);
    }
    let mut found = without_bearers(&tried, options.least());
    found.extend(joint(bench, &candidates, &found, &open, options)?);
    found.extend(lost_before(bench, tallies, &loops, &found, options)?);
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
fn candidates(
    tallies: &BTreeMap<Place, Tally>,
    loops: &BTreeMap<Stage, Loops>,
    fractions: &BTreeSet<(Stage, Span)>,
) -> Vec<Candidate> {
    let mut by_span: BTreeMap<(Stage, Span), Candidate> = BTreeMap::new();
    for (&(stage, span, act), tally) in tallies {
        let is_cause = tally.lost_bits >= CAUSE_BITS || tally.non_finite() > 0 || tally.disagreements > 0;
        let accumulates = loops.get(&stage).is_some_and(|loops| loops.accumulate.contains(&span));
        let adds = accumulates && tally.added > 0.0;
        if !span.is_known() || !(is_cause || adds) || is_far_lookup(act, tally) {
            continue;
        }
        let kind = match if is_cause { CauseKind::of(act, tally) } else { CauseKind::Accumulation } {
            CauseKind::Cancellation if fractions.contains(&(stage, span)) => CauseKind::Conversion,
            kind => kind,
        };
        let repeats = loops.get(&stage).is_some_and(|loops| loops.inside.contains(&span));
        let candidate =
            Candidate { stage, span, kind, act, tally: *tally, repeats, feeds: accumulates, own: !is_cause };
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
    (jitter, open): (&mut Changes, &mut BTreeSet<usize>),
) -> Result<Option<(Cause, Gains)>, Vec<Diagnostic>> {
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
    if kind == CauseKind::Underflow && tally.non_finite() == 0 && !is_of_vector(candidate.act) {
        // Whether it harms that numbers vanish, and not what the operands bring elsewhere.
        let vanished = bench.without(stage, &spans, ErrorPart::Vanished)?;
        if vanished.harm < 0.5 * outcome.harm {
            if tally.lost_bits_in_range < CAUSE_BITS && tally.disagreements == 0 {
                return Ok(None);
            }
            kind = CauseKind::of(candidate.act, &Tally { underflows: 0, ..*tally });
        }
    }
    open.retain(|index| !outcome.cures(*index));
    if candidate.own || kind == CauseKind::Cancellation {
        // Whether it is the rounding of many iterations, and not what the terms bring.
        let own = bench.without(stage, &spans, ErrorPart::Own)?;
        if candidate.own && own.harm < 0.5 * outcome.harm {
            return Ok(None);
        }
    }
    let mut ill_posed = is_at_edge(candidate);
    if !ill_posed && outcome.harm.is_finite() && (kind.is_decision() || candidate.repeats) {
        ill_posed = is_ill_posed(&outcome, bench.jittered(jitter, moves(kind, candidate.feeds))?, least);
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
    let gains = outcome.gains.into_iter().enumerate().filter(|(_, gain)| *gain >= 0.5 * least).collect();
    Ok(Some((found.cause(bench, (stage, span), tally), gains)))
}

/// Whether an operation squares the components of a vector: what vanishes there is no result.
fn is_of_vector(act: Act) -> bool {
    matches!(act, Act::Float(Kind::Normalize | Kind::Vector))
}

/// By how much the errors of pixels shrink, by their indices; those that shrink by too little to count are left out.
type Gains = BTreeMap<usize, f64>;

/// The causes without the sums that merely bear a loss: they cancel nothing where their operands have digits, and at each pixel that they
/// harm, a function that loses its argument's digits, or a difference that loses its own, does at least half as much.
fn without_bearers(tried: &[(Cause, Gains)], least: f64) -> Vec<Cause> {
    let loses = |cause: &Cause| {
        cause.kind != CauseKind::Accumulation && cause.first_lost_bits >= CAUSE_BITS && cause.harm.is_some()
    };
    let bears = |cause: &Cause, gains: &Gains| {
        let covers = |others: &Gains| {
            let mut harmed = gains.iter().filter(|(_, gain)| **gain >= least);
            harmed.all(|(index, gain)| others.get(index).is_some_and(|other| *other >= 0.5 * gain))
        };
        let is_sum = cause.kind == CauseKind::Cancellation && cause.first_lost_bits < CAUSE_BITS;
        is_sum && cause.harm.is_some() && tried.iter().any(|(other, others)| loses(other) && covers(others))
    };
    tried.iter().filter(|(cause, gains)| !bears(cause, gains)).map(|(cause, _)| *cause).collect()
}

/// The causes of pixels that no expression alone makes finite, since several of them break each: those without which the others do
/// not make as many finite.
fn joint(
    bench: &Bench<'_>,
    candidates: &[Candidate],
    known: &[Cause],
    open: &BTreeSet<usize>,
    options: &mut ExamineOptions<'_>,
) -> Result<Vec<Cause>, Vec<Diagnostic>> {
    for stage in [Stage::Fragment, Stage::Vertex] {
        let mut born: Vec<&Candidate> =
            candidates.iter().filter(|one| one.stage == stage && one.tally.non_finite() > 0).collect();
        born.sort_by_key(|candidate| candidate.span);
        let spans: Vec<Span> = born.iter().map(|candidate| candidate.span).collect();
        if open.is_empty() || born.len() < 2 {
            continue;
        }
        for part in [ErrorPart::All, ErrorPart::Limited] {
            let all = bench.without(stage, &spans, part)?;
            let cured: Vec<usize> = open.iter().copied().filter(|index| all.cures(*index)).collect();
            let Some(&first) = cured.first() else { continue };
            let mut found = Vec::new();
            for (done, candidate) in born.iter().enumerate() {
                let is_known = known.iter().any(|cause| cause.stage == stage && cause.span == candidate.span);
                if is_known || !(options.progress)(done, born.len()) {
                    continue;
                }
                let others: Vec<Span> = spans.iter().copied().filter(|span| *span != candidate.span).collect();
                let rest = bench.without(stage, &others, part)?;
                let own: Vec<usize> = cured.iter().copied().filter(|index| !rest.cures(*index)).collect();
                found.extend(own.first().map(|index| broken_by(bench, candidate, own.len(), *index)));
            }
            if found.is_empty() {
                found.extend(born.first().map(|candidate| broken_by(bench, candidate, cured.len(), first)));
            }
            return Ok(found);
        }
    }
    Ok(Vec::new())
}

/// The cause of pixels that are not finite.
fn broken_by(bench: &Bench<'_>, candidate: &Candidate, cured: usize, index: usize) -> Cause {
    let Candidate { stage, span, kind, tally, .. } = candidate;
    let of = Found { kind: *kind, cured: cured as u64, harm: None, index, ill_posed: false, equality: false };
    of.cause(bench, (*stage, *span), tally)
}

/// Whether a comparison disagrees on numbers that are as good as f32 has them: the exact ones are at the threshold. A test for
/// equality is not: a tolerance helps.
fn is_at_edge(candidate: &Candidate) -> bool {
    let compares = matches!(candidate.act, Act::Compare { equality: false } | Act::Float(Kind::Step));
    let Tally { disagreements, at_edge, .. } = candidate.tally;
    compares && disagreements > 0 && at_edge == disagreements
}

/// The inputs whose last digits may decide: what feeds itself in a loop may magnify those of uniforms. Elsewhere they are the digits of a
/// place or a time that a host can keep small, as those of what merely shows a loss.
fn moves(kind: CauseKind, feeds: bool) -> Moves {
    let shows = matches!(kind, CauseKind::Conversion | CauseKind::Argument);
    if feeds && !shows { Moves::InputsAndUniforms } else { Moves::Inputs }
}

/// Whether the exact picture changes as much when its inputs move by an ULP, at most of the pixels that the expression
/// harms.
fn is_ill_posed(outcome: &Outcome, moved: &[f64], least: f64) -> bool {
    let harmed: Vec<(f64, f64)> =
        outcome.gains.iter().copied().zip(moved.iter().copied()).filter(|(gain, _)| *gain >= least).collect();
    let jumping = harmed.iter().filter(|(gain, moved)| *moved >= 0.5 * gain).count();
    !harmed.is_empty() && 2 * jumping >= harmed.len()
}

/// If no expression loses bits, many lose a little, or a number is too coarse for what follows: the expressions whose own
/// rounding harms most.
fn roundings(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    loops: &BTreeMap<Stage, Loops>,
    known: &[Cause],
    options: &mut ExamineOptions<'_>,
    jitter: &mut Changes,
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
        let feeds = loops.get(&stage).is_some_and(|loops| loops.accumulate.contains(&span));
        let ill_posed = repeats && is_ill_posed(&own, bench.jittered(jitter, moves(kind, feeds))?, options.least());
        let of =
            Found { kind, cured: 0, harm: Some(significant(own.harm)), index: own.index, ill_posed, equality: false };
        found.push(of.cause(bench, (stage, span), &tally));
    }
    if found.is_empty() {
        found.extend(coarse_varying(bench, tallies, options)?);
    }
    Ok(found)
}
