//! `matrix-inverse`: an inverse that is computed for each fragment, or for each vertex though it is the same in the whole draw.

use super::super::rate::{Rate, rate};
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::hir::{ExprKind, Stage};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(B::Inverse, _) = place.kind(expr) else { continue };
        let of_draw = rate(place, expr) == Rate::Draw;
        let message = match place.shader.stage {
            Stage::Fragment if of_draw => "each fragment inverts a matrix that is the same in the whole draw",
            Stage::Fragment => "each fragment inverts a matrix",
            _ if of_draw => "each vertex inverts a matrix that is the same in the whole draw",
            _ => continue,
        };
        findings.push(findings.at(place.expr(expr).span, message).help("let the host compute it"));
    }
}
