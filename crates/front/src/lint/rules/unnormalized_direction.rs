//! `unnormalized-direction`: the difference of two places as a direction in a cosine, with a vector of length 1.
//!
//! If the function takes the length of the difference anywhere, it may divide by it, and the rule is silent. It is silent, too, if one side
//! is a constant or a number: `2.0 * t.xyz - 1.0` decodes a direction.

use super::super::range::is_unit;
use super::super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::{BinaryOp, ExprId, ExprKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        // A cosine is clamped; other products of vectors are distances to planes, and so on.
        let ExprKind::BuiltinCall(B::Max | B::Clamp, arguments) = place.kind(expr) else { continue };
        let [first, second, ..] = arguments.as_slice() else { continue };
        let cosine = [(*first, *second), (*second, *first)].into_iter().find_map(|(id, bound)| {
            match place.kind(place.meaning(id)) {
                _ if place.value(bound).is_none() => None,
                ExprKind::BuiltinCall(B::Dot, sides) => <[ExprId; 2]>::try_from(sides.as_slice()).ok(),
                _ => None,
            }
        });
        let Some([a, b]) = cosine else { continue };
        let unit = [a, b].map(|side| is_unit(place, side));
        let long = match unit {
            [true, false] => b,
            [false, true] => a,
            _ => continue,
        };
        let meaning = place.meaning(long);
        let is_difference = match place.kind(meaning) {
            ExprKind::Binary(BinaryOp::Sub, a, b) => [*a, *b].into_iter().all(|side| is_place(place, side)),
            _ => false,
        };
        if !is_difference || !place.is_vector(long) || is_measured(place, meaning) {
            continue;
        }
        let span = place.expr(long).span;
        let mut finding = findings.at(span, "this direction is as long as the distance, and a cosine takes it for 1");
        if meaning != long {
            finding = finding.label(place.expr(meaning).span, "a difference of two places");
        }
        let text = subject.texts.text(span).map(|text| format!("normalize({text})"));
        let fix = text.and_then(|text| subject.texts.replace(Applicability::Unsafe, span, text));
        findings.push(finding.help("normalize it").maybe_fix(fix));
    }
}

/// Whether one side of a difference can be a place: a vector that the program computes.
fn is_place(place: &Place<'_>, side: ExprId) -> bool {
    place.is_vector(side) && place.value(place.meaning(side)).is_none()
}

/// Whether the function takes the length of a vector, or its product with itself, anywhere.
fn is_measured(place: &Place<'_>, vector: ExprId) -> bool {
    place.exprs.iter().any(|&expr| match place.kind(expr) {
        ExprKind::BuiltinCall(B::Length | B::Distance | B::Dot | B::Normalize, arguments) => match arguments.as_slice()
        {
            [one] => place.same(place.meaning(*one), vector),
            [a, b] => {
                let same = |side: ExprId| place.same(place.meaning(side), vector);
                same(*a) && same(*b) || matches!(place.kind(expr), ExprKind::BuiltinCall(B::Distance, _))
            }
            _ => false,
        },
        _ => false,
    })
}
