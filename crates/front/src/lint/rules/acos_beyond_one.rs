//! `acos-beyond-one`: `acos` and `asin` of a cosine that rounding takes beyond 1.

use super::super::domain::{Fault, calls};
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;

const FAULT: Fault = Fault {
    is_in: |range| range.low < -1.0 && range.reaches_low || range.high > 1.0 && range.reaches_high,
    message: "this can be beyond 1 by rounding, which gives NaN",
    guard: ["clamp(", ", -1.0, 1.0)"],
};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    calls(subject, &FAULT, findings, |function| matches!(function, B::Acos | B::Asin));
}
