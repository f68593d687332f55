//! Arguments outside of the domain of a function for some input.
//!
//! The bound must be known, and known to be reached ([`super::range`]). Arguments of which a condition in the function names a
//! variable are left out, since the condition may be a guard.

use super::interval::Range;
use super::range::range;
use super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction;
use crate::diagnostic::Applicability;
use crate::hir::{ExprId, ExprKind};

/// A bound that only rounding takes below zero.
const BY_ROUNDING: f64 = 1e-5;

/// A fault that an argument may have.
pub(super) struct Fault {
    /// Whether a range contains it.
    pub(super) is_in: fn(Range) -> bool,
    pub(super) message: &'static str,
    /// The text around the argument that rules it out.
    pub(super) guard: [&'static str; 2],
}

/// Reports the first arguments of calls that have a fault.
pub(super) fn calls(
    subject: &Subject<'_>,
    fault: &Fault,
    findings: &mut Findings<'_>,
    wanted: fn(BuiltinFunction) -> bool,
) {
    for (place, expr) in subject.exprs() {
        let ExprKind::BuiltinCall(function, arguments) = place.kind(expr) else { continue };
        if let Some(&argument) = arguments.first().filter(|_| wanted(*function)) {
            examine(subject, place, argument, fault, findings);
        }
    }
}

/// Reports an argument that has a fault.
pub(super) fn examine(
    subject: &Subject<'_>,
    place: &Place<'_>,
    argument: ExprId,
    fault: &Fault,
    findings: &mut Findings<'_>,
) {
    let span = place.expr(argument).span;
    // A constant has rules of its own.
    if !(fault.is_in)(range(place, argument)) || place.value(argument).is_some() || place.is_guarded(argument) {
        return;
    }
    let found = range(place, argument);
    let mut finding = findings.at(span, fault.message);
    if found.low > -BY_ROUNDING && found.low < 0.0 {
        finding = finding.note("it is negative by rounding alone, where a product of directions passes 1");
    }
    let meaning = place.meaning(argument);
    if meaning != argument {
        finding = finding.label(place.expr(meaning).span, "the value is from here");
    }
    let [before, after] = fault.guard;
    let fix = subject
        .texts
        .text(span)
        .and_then(|text| subject.texts.replace(Applicability::Unsafe, span, format!("{before}{text}{after}")));
    findings.push(finding.help(format!("write `{before}...{after}` around it")).maybe_fix(fix));
}
