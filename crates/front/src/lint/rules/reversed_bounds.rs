//! `reversed-bounds`: `smoothstep` whose lower edge is not below the upper one, and `clamp` whose least value is above the largest.
//! Only bounds that are constants count, and edges that are one expression; integers are left out.

use super::super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::{ExprId, ExprKind};
use std::cmp::Ordering;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(function @ (B::Smoothstep | B::Clamp), arguments) = place.kind(expr) else {
            continue;
        };
        let &[first, second, third] = arguments.as_slice() else { continue };
        let is_step = *function == B::Smoothstep;
        let (low, high, value) = if is_step { (first, second, third) } else { (second, third, first) };
        let orders = orders(place, low, high);
        let is_fault = |order: &Ordering| *order == Ordering::Greater || is_step && *order == Ordering::Equal;
        if !orders.iter().any(is_fault) {
            continue;
        }
        let message = match is_step {
            true => "the lower edge of this `smoothstep` is not below the upper one",
            false => "the least value of this `clamp` is above the largest",
        };
        let finding = findings.at(place.expr(expr).span, message).here("the result is undefined");
        let texts = [low, high, value].map(|id| subject.texts.text(place.expr(id).span));
        let all = |order| orders.iter().all(|one| *one == order);
        let text = match texts {
            [Some(low), Some(high), Some(x)] if is_step && all(Ordering::Greater) => {
                Some(format!("(1.0 - smoothstep({high}, {low}, {x}))"))
            }
            [Some(low), _, Some(x)] if is_step && all(Ordering::Equal) => Some(format!("step({low}, {x})")),
            [Some(low), Some(high), Some(x)] if !is_step && all(Ordering::Greater) => {
                Some(format!("clamp({x}, {high}, {low})"))
            }
            _ => None,
        };
        findings.push(subject.texts.advised(finding, Applicability::Unsafe, text));
    }
}

/// How the components of two bounds compare; none if that is not known.
fn orders(place: &Place<'_>, low: ExprId, high: ExprId) -> Vec<Ordering> {
    if place.is_float(low) && place.same(low, high) {
        return vec![Ordering::Equal];
    }
    let (Some(low), Some(high)) = (place.numbers(low), place.numbers(high)) else { return Vec::new() };
    low.iter().zip(&high).filter_map(|(low, high)| low.partial_cmp(high)).collect()
}
