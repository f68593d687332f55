//! `log-of-zero`: a logarithm of a number that is zero or less for some input.

use super::super::domain::{Fault, calls};
use super::super::{Findings, Subject};
use crate::builtin::BuiltinFunction as B;

const FAULT: Fault = Fault {
    is_in: |range| range.low <= 0.0 && range.reaches_low && range.low > f64::NEG_INFINITY,
    message: "this logarithm is of a number that can be zero or less",
    guard: ["max(", ", 1e-6)"],
};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    calls(subject, &FAULT, findings, |function| matches!(function, B::Log | B::Log2));
}
