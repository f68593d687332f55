//! `loop-invariant-lookup`: a texture that is read at the same place in each iteration of a loop.

use super::super::loop_invariant::find;
use super::super::rate::is_lookup;
use super::super::{Findings, Subject};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    find(subject, is_lookup, findings);
}
