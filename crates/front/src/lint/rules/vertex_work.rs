//! `vertex-work`: the product of a matrix that is the same in the whole draw and an interpolated vector, which the vertex stage could
//! compute: interpolation keeps such products.

use super::super::Place;
use super::super::rate::{Rate, rate};
use super::super::{Findings, Subject};
use crate::hir::{BinaryOp, ExprId, ExprKind, Interpolation, Stage, Storage, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    if subject.program.stages.len() < 2 {
        return;
    }
    for (place, expr) in subject.exprs().filter(|(place, _)| place.shader.stage == Stage::Fragment) {
        let ExprKind::Binary(BinaryOp::MatMul, a, b) = place.kind(expr) else { continue };
        let (matrix, vector) = if place.is_vector(*b) { (*a, *b) } else { (*b, *a) };
        if rate(place, matrix) <= Rate::Draw && is_linear(place, vector) {
            let finding = findings.at(place.expr(expr).span, "this product can be interpolated instead");
            findings.push(finding.help("compute it in the vertex stage, and pass it as a varying of its own"));
        }
    }
}

/// Whether a vector is an interpolated one, or put together from one and constants.
fn is_linear(place: &Place<'_>, id: ExprId) -> bool {
    match place.kind(place.meaning(id)) {
        ExprKind::Var(VarRef::Global(global)) => {
            let global = place.shader.global(*global);
            global.storage == Storage::In && global.builtin.is_none() && global.interpolation == Interpolation::Smooth
        }
        ExprKind::Construct(_, parts) => match parts.as_slice() {
            [first, rest @ ..] => is_linear(place, *first) && rest.iter().all(|part| place.value(*part).is_some()),
            [] => false,
        },
        _ => false,
    }
}
