//! Where a pixel's envelope becomes wide, when no operation alone is the reason.
//!
//! *In:* what a machine computes for the fragments of a pixel. *Out:* the first expression that is wide although its operands
//! are narrow, or the first decision that is open. *Holds:* it is asked only where exact operations, one at a time, do not
//! narrow the envelope: several that each suffice, undefined results, and loops or branches that may go any way.

use crate::Contribution;
use crate::domain::{Domain, Integer, Number};
use crate::exec::{Event, Observer, Operation, Order, What};
use glisten_front::source::Span;
use std::sync::{Arc, Mutex, PoisonError};

/// The operation's name for a decision.
const DECISION: &str = "an open decision";

/// The operation's name for an expression that is none of the operations of the stage.
const EXPRESSION: &str = "an expression";

/// A number is wide from this share of its magnitude, or of 1, on.
const WIDE: f64 = 1.0 / 255.0;

/// The places that were found.
#[derive(Clone, Copy, Debug, Default)]
struct Places {
    widened: Option<Span>,
    decision: Option<Span>,
}

/// Looks for the places while a machine runs.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin {
    places: Arc<Mutex<Places>>,
}

impl Origin {
    /// The places as contributions to the whole width.
    pub(super) fn contributions(&self, operations: &[Operation]) -> Vec<Contribution> {
        let places = *self.places.lock().unwrap_or_else(PoisonError::into_inner);
        let name = |span: Span| {
            let known = operations.iter().find(|operation| operation.span == span);
            known.map_or(EXPRESSION, |operation| operation.name)
        };
        let widened = places.widened.map(|span| (span, name(span)));
        let decision = places.decision.map(|span| (span, DECISION));
        let found = widened.into_iter().chain(decision);
        found.map(|(span, operation)| Contribution { span, operation, share: 1.0 }).collect()
    }
}

impl<D: Domain> Observer<D> for Origin {
    fn see(&mut self, event: &Event<'_, D>) {
        let mut places = self.places.lock().unwrap_or_else(PoisonError::into_inner);
        match &event.what {
            What::Floats { operands, results, .. } if places.widened.is_none() => {
                let is_narrow = |number: D::Float| number.interval().width() <= WIDE * number.value().abs().max(1.0);
                let begins = |lane: usize| {
                    results.iter().any(|result| !is_narrow(result.at(lane)))
                        && operands.iter().all(|operand| is_narrow(operand.at(lane)))
                };
                if event.lanes.lanes().any(begins) {
                    places.widened = Some(event.span);
                }
            }
            What::Choice(condition) if places.decision.is_none() => {
                if event.lanes.lanes().any(|lane| !condition.at(lane).is_decided()) {
                    places.decision = Some(event.span);
                }
            }
            What::Floats { .. } | What::Choice(_) | What::Answer { .. } | What::Output(_) => {}
        }
    }

    fn finish(self: Box<Self>, _: Order) {}
}
