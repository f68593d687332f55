//! Counts results that are not finite although their operands are, while a scene is drawn in f32.
//!
//! *In:* the executor's events. *Out:* a number. *Holds:* it is the sum of the births that the [`record`](super::record) of a trace
//! has, at a fraction of its cost.

use crate::domain::{Number, Stepwise};
use crate::exec::{Event, Observer, Order, What};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts for one piece of the drawing.
#[derive(Debug)]
pub(super) struct BirthCounter {
    births: u64,
    total: Arc<AtomicU64>,
}

impl BirthCounter {
    pub(super) fn new(total: &Arc<AtomicU64>) -> Self {
        Self { births: 0, total: Arc::clone(total) }
    }
}

impl Observer<Stepwise> for BirthCounter {
    fn see(&mut self, event: &Event<'_, Stepwise>) {
        let What::Floats { operands, results, .. } = &event.what else { return };
        for values in *results {
            for lane in event.lanes.lanes() {
                let is_born = !values.at(lane).value().is_finite()
                    && operands.iter().all(|operand| operand.at(lane).value().is_finite());
                self.births += u64::from(is_born);
            }
        }
    }

    fn finish(self: Box<Self>, _: Order) {
        self.total.fetch_add(self.births, Ordering::Relaxed);
    }
}
