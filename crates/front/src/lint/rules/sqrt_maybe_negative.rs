//! `sqrt-maybe-negative`: a root of a number that is negative for some input.

use super::super::domain::{Fault, calls};
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;

const FAULT: Fault = Fault {
    is_in: |range| range.low < 0.0 && range.reaches_low,
    message: "this root is of a number that can be negative, which gives NaN",
    guard: ["max(", ", 0.0)"],
};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    calls(subject, &FAULT, findings, |function| matches!(function, B::Sqrt | B::Inversesqrt));
}
