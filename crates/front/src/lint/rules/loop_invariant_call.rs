//! `loop-invariant-call`: a costly call in a loop that gives the same in each iteration.

use super::super::loop_invariant::find;
use super::super::rate::is_costly;
use super::super::{Findings, Subject};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    find(subject, is_costly, findings);
}
