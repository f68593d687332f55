//! Results that are not finite although their operands are, while a scene is drawn in f32.
//!
//! *In:* the executor's events. *Out:* their number; or the places of each draw where there are some. *Holds:* they are the births that the
//! [`record`](super::record) of a trace has, at a fraction of its cost.

use crate::RenderOptions;
use crate::domain::{Number, Stepwise};
use crate::exec::{Event, Observer, Order, What};
use crate::pipeline;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::Span;
use glisten_scene::Scene;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The number of scalar results of an event that are born so.
fn born(event: &Event<'_, Stepwise>) -> u64 {
    let What::Floats { operands, results, .. } = &event.what else { return 0 };
    let mut births = 0;
    for values in *results {
        for lane in event.lanes.lanes() {
            let is_born = !values.at(lane).value().is_finite()
                && operands.iter().all(|operand| operand.at(lane).value().is_finite());
            births += u64::from(is_born);
        }
    }
    births
}

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
        self.births += born(event);
    }

    fn finish(self: Box<Self>, _: Order) {
        self.total.fetch_add(self.births, Ordering::Relaxed);
    }
}

/// Where numbers are born that are not finite, by the draws of a scene.
type ByDraw = BTreeSet<(usize, Span)>;

/// Notes the places of one piece of the drawing.
#[derive(Debug)]
struct BirthPlaces {
    places: BTreeSet<Span>,
    all: Arc<Mutex<ByDraw>>,
}

impl Observer<Stepwise> for BirthPlaces {
    fn see(&mut self, event: &Event<'_, Stepwise>) {
        if event.span.is_known() && !self.places.contains(&event.span) && born(event) > 0 {
            self.places.insert(event.span);
        }
    }

    fn finish(self: Box<Self>, order: Order) {
        if !self.places.is_empty() {
            let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
            all.extend(self.places.iter().map(|span| (order.draw, *span)));
        }
    }
}

/// Draws a scene in f32, and tells the expressions whose results are infinite or NaN although all operands are finite, each with the
/// number of its draw.
///
/// # Errors
/// The errors of [`render`](crate::render).
pub fn births(scene: &Scene, options: &RenderOptions) -> Result<BTreeSet<(usize, Span)>, Vec<Diagnostic>> {
    let all = Arc::new(Mutex::new(ByDraw::new()));
    let shared = Arc::clone(&all);
    let make = move || -> Box<dyn Observer<Stepwise>> {
        Box::new(BirthPlaces { places: BTreeSet::new(), all: Arc::clone(&shared) })
    };
    pipeline::render_watched::<Stepwise>(scene, options, Some(&make))?;
    let found = std::mem::take(&mut *all.lock().unwrap_or_else(PoisonError::into_inner));
    Ok(found)
}
