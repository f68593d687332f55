//! [`lost_before`]: where an argument lost its digits, if a function merely shows the loss.
//!
//! *In:* the causes that experiments found, and the tallies of all expressions. *Out:* one more cause, or none. *Holds:* what is
//! blamed rounds, and the picture gets better if that rounding is left out.

use super::bench::{Bench, Found, Outcome, significant};
use super::kinds::CauseKind;
use super::loops::Loops;
use super::record::{Act, Place, SIGNIFICAND, Tally};
use super::{Cause, ExamineOptions};
use crate::domain::ErrorPart;
use crate::exec::Kind;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{GlobalId, Stage, Storage};
use glisten_front::source::Span;
use glisten_scene::Scene;
use std::collections::BTreeMap;

/// The number of expressions that are tried as the origin of a loss that another one shows.
const MOST_ORIGINS: usize = 12;

/// Where the argument of a `floor`, `fract`, `int` or `sin` lost its digits: a product of a large counter, a far coordinate.
/// Such a function merely shows the loss. Of the expressions whose own rounding makes the error, it is the earliest that
/// rounds nearly as coarsely as the coarsest; its harm is that of all of them in its stage.
pub(super) fn lost_before(
    bench: &Bench<'_>,
    tallies: &BTreeMap<Place, Tally>,
    loops: &BTreeMap<Stage, Loops>,
    known: &[Cause],
    options: &mut ExamineOptions<'_>,
) -> Result<Option<Cause>, Vec<Diagnostic>> {
    let shows = known.iter().filter(|cause| {
        matches!(cause.kind, CauseKind::Conversion | CauseKind::Argument) && !cause.ill_posed && cause.harm.is_some()
    });
    let harm = |cause: &&Cause| cause.harm.unwrap_or(0.0);
    let Some(shown) = shows.max_by(|a, b| harm(a).total_cmp(&harm(b)).then(b.span.cmp(&a.span))) else {
        return Ok(None);
    };
    let least = options.least().max(0.25 * harm(&shown));
    let before = before(tallies, shown);
    let mut coarsest: Vec<Rounding> =
        before.iter().filter(|one| one.tally.added > 0.0 && !is_known(known, one)).copied().collect();
    coarsest.sort_by(|a, b| b.tally.added.total_cmp(&a.tally.added));
    coarsest.truncate(MOST_ORIGINS);
    let total = coarsest.len();
    let mut blamed: Vec<(Rounding, Outcome)> = Vec::new();
    for (done, one) in coarsest.iter().enumerate() {
        if !(options.progress)(done, total) {
            break;
        }
        let own = bench.without(one.stage, &carried(&before, &[*one], known), ErrorPart::Own)?;
        if own.harm.is_finite() && own.harm >= least {
            blamed.push((*one, own));
        }
    }
    let most = blamed.iter().map(|(_, own)| own.harm).fold(0.0, f64::max);
    blamed.retain(|(_, own)| own.harm >= 0.5 * most);
    // If several round, one of them alone may make no difference.
    let blamed = if blamed.is_empty() { coarsest } else { blamed.into_iter().map(|(one, _)| one).collect() };
    let added = blamed.iter().map(|one| one.tally.added).fold(0.0, f64::max);
    let blamed: Vec<Rounding> = blamed.into_iter().filter(|one| one.tally.added >= added / 8.0).collect();
    // The vertex stage is before the fragment stage, and an expression is before those of later lines.
    if let Some(first) = blamed.iter().min_by_key(|one| (one.stage, one.span)) {
        let spans: Vec<Rounding> = blamed.iter().filter(|one| one.stage == first.stage).copied().collect();
        let all = bench.without(first.stage, &carried(&before, &spans, known), ErrorPart::Own)?;
        if all.harm.is_finite() && all.harm >= least {
            let repeats = loops.get(&first.stage).is_some_and(|loops| loops.inside.contains(&first.span));
            let kind = if repeats { CauseKind::Accumulation } else { CauseKind::Rounding };
            let harm = Some(significant(all.harm));
            let found = Found { kind, cured: 0, harm, index: all.index, ill_posed: false, equality: false };
            return Ok(Some(as_origin(found.cause(bench, (first.stage, first.span), &first.tally))));
        }
    }
    let varying = coarse_varying(bench, tallies, options)?;
    Ok(varying.filter(|cause| harm(&cause) >= least && !known.iter().any(|it| it.span == cause.span)).map(as_origin))
}

/// A cause that comes before those that show it, if they do as much harm.
fn as_origin(cause: Cause) -> Cause {
    Cause { first_lost_bits: SIGNIFICAND, ..cause }
}

/// An expression that computes numbers.
#[derive(Clone, Copy)]
struct Rounding {
    stage: Stage,
    span: Span,
    tally: Tally,
}

fn is_known(known: &[Cause], one: &Rounding) -> bool {
    known.iter().any(|cause| cause.stage == one.stage && cause.span == one.span)
}

/// The expressions with an error that may be part of the argument of a cause: those of earlier stages, and those that are not
/// after it in the text. What jumps is none of them.
fn before(tallies: &BTreeMap<Place, Tally>, shown: &Cause) -> Vec<Rounding> {
    let mut all: Vec<Rounding> = Vec::new();
    for (&(stage, span, act), tally) in tallies {
        let computes = matches!(act, Act::Float(kind) if !kind.jumps() && !matches!(kind, Kind::Texture | Kind::Angle));
        let is_before = stage < shown.stage || stage == shown.stage && span.start <= shown.span.end;
        if tally.error > 0.0 && span.is_known() && computes && is_before {
            all.push(Rounding { stage, span, tally: *tally });
        }
    }
    all
}

/// The spans of expressions, with those that carry their results on: that round much less, or that are causes already. An exact
/// number that f32 does not have would be rounded by the next operation instead.
fn carried(before: &[Rounding], rounding: &[Rounding], known: &[Cause]) -> Vec<Span> {
    let least = rounding.iter().map(|one| one.tally.added).fold(f64::INFINITY, f64::min);
    let stage = rounding.first().map(|one| one.stage);
    let carries =
        before.iter().filter(|one| Some(one.stage) == stage && (one.tally.added < least / 8.0 || is_known(known, one)));
    let mut spans: Vec<Span> = rounding.iter().chain(carries).map(|one| one.span).collect();
    spans.sort_unstable();
    spans
}

/// If an exact varying makes the picture better, and no expression does: what the vertex stage writes is too large for f32 to
/// interpolate. The expression of the vertex stage that rounds most is to blame, or the varying itself if none rounds.
pub(super) fn coarse_varying(
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
