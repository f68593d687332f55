//! Joins the intervals of one recording to the values of another.
//!
//! *In:* the same invocations, recorded in two domains. *Out:* the first ones, with the intervals of the second. *Holds:*
//! where the two take different ways, what follows has no interval.

use super::{Component, Entry, Invocation};

/// Joins the intervals of `tight` to `invocations`.
pub(super) fn join(invocations: &mut [Invocation], tight: &[Invocation]) {
    let key = |one: &Invocation| (one.draw, one.instance, one.stage, one.invoked);
    let mut rest = tight.iter();
    for invocation in invocations {
        // A primitive that is cut has several parts, in the same order.
        let Some(other) = rest.find(|other| key(other) == key(invocation)) else { return };
        let pairs = invocation.entries.iter_mut().zip(&other.entries);
        for (entry, other) in pairs.take_while(|(entry, other)| is_same(entry, other)) {
            for (scalar, other) in entry.scalars.iter_mut().zip(&other.scalars) {
                if let (Component::Float { interval, .. }, Component::Float { interval: found, .. }) = (scalar, other) {
                    *interval = *found;
                }
            }
        }
    }
}

/// Whether two entries are of the same place.
fn is_same(entry: &Entry, other: &Entry) -> bool {
    (entry.kind, entry.span, entry.depth) == (other.kind, other.span, other.depth)
}
