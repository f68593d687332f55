//! The causes that are no matter of rounding: operations that GLSL leaves undefined for their operands.
//!
//! *In:* a scene, the pixels that count, and the causes that are known. *Out:* a [`Cause`] for each further place whose result a GPU may
//! choose, and that changes the picture. *Holds:* the operations and their operands are those of [`undefined`](crate::undefined()), by
//! which `verify` judges. What is not there at all (an index, a texel, a value that was never written) is no arithmetic, and left out.

use super::bench::{drawing_options, significant};
use super::errors::ErrorMap;
use super::{Cause, CauseKind};
use crate::exec::UndefinedKind;
use crate::undefined::{UndefinedPlace, undefined_among};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Scene;

/// The causes, those with the largest change first.
pub(super) fn causes(
    scene: &Scene,
    errors: &ErrorMap,
    bound: f64,
    known: &[Cause],
) -> Result<Vec<Cause>, Vec<Diagnostic>> {
    let Some(found) = undefined_among(scene, &drawing_options(), &errors.counted)? else { return Ok(Vec::new()) };
    let is_new = |place: &UndefinedPlace| known.iter().all(|cause| cause.span != place.span);
    let places = found.places.iter().filter(|place| place.change > bound && is_new(place));
    let mut causes: Vec<Cause> = places.filter_map(|place| cause(scene, place)).collect();
    causes.sort_by(|a, b| b.harm.unwrap_or(0.0).total_cmp(&a.harm.unwrap_or(0.0)));
    Ok(causes)
}

fn cause(scene: &Scene, place: &UndefinedPlace) -> Option<Cause> {
    let kind = match place.kind {
        UndefinedKind::Domain => CauseKind::Domain,
        UndefinedKind::Division => CauseKind::Division,
        UndefinedKind::Absent => return None,
    };
    Some(Cause {
        stage: stage(scene, place.span)?,
        span: place.span,
        kind,
        harm: Some(significant(place.change)),
        lost_bits: 0.0,
        first_lost_bits: 0.0,
        condition: 0.0,
        non_finite: 0,
        non_finite_in_exact: 0,
        disagreements: 0,
        at: place.example,
        ill_posed: false,
        equality: false,
        undefined: Some(place.what),
    })
}

/// The stage that has an expression there.
fn stage(scene: &Scene, span: Span) -> Option<Stage> {
    let mut stages = scene.draws.iter().flat_map(|draw| &draw.program.stages);
    stages.find(|shader| shader.expr_at(span).is_some()).map(|shader| shader.stage)
}
