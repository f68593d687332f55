//! `uniform-work`: a costly call in the fragment stage whose arguments are the same in the whole draw.

use super::super::rate::{Rate, is_costly, rate};
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::hir::{ExprId, ExprKind, Stage};
use rustc_hash::FxHashSet;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let mut inside: FxHashSet<ExprId> = FxHashSet::default();
    for place in subject.places.iter().filter(|place| place.shader.stage == Stage::Fragment) {
        inside.clear();
        for &expr in &place.exprs {
            let ExprKind::BuiltinCall(function, _) = place.kind(expr) else { continue };
            if inside.contains(&expr) || !is_wanted(*function) || rate(place, expr) != Rate::Draw {
                continue;
            }
            place.shader.visit_expr(expr, &mut |inner| {
                inside.insert(inner);
            });
            let message = format!("`{}` gives the same for all fragments of a draw", function.name());
            let help = "let the host compute it, or the vertex stage in a flat output";
            findings.push(findings.at(place.expr(expr).span, message).help(help));
        }
    }
}

/// Costly functions without those of angles, which shaders take of the time, and without inverses, which have a rule of their own.
fn is_wanted(function: B) -> bool {
    is_costly(function)
        && !matches!(function, B::Inverse | B::Sin | B::Cos | B::Tan | B::Asin | B::Acos | B::Atan | B::Exp | B::Exp2)
}
