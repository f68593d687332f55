//! [`work`]: how many operations a picture takes.
//!
//! *In:* a scene. *Out:* for each draw, the operations that its stages execute, counted while the reference draws in f32.
//!
//! *Holds:* the counts are the same on every machine and with any number of threads. An operation is one scalar result
//! in one invocation: of arithmetic on floats, of a built-in function, of a comparison, or of a lookup. Copies, masks,
//! arithmetic on integers and helper invocations do not count.

use crate::RenderOptions;
use crate::domain::{Envelope, F32};
use crate::exec::{Event, Form, Kind, Observer, Order, What};
use crate::pipeline::{self, Study};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_scene::Scene;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, PoisonError};

/// The operations that a draw executes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Operations of the vertex stage, and of the geometry stage.
    pub vertex_operations: u64,
    /// Operations of the fragment stage.
    pub fragment_operations: u64,
    /// Texture lookups of both.
    pub texture_lookups: u64,
}

/// Counts for one piece of the drawing.
#[derive(Debug)]
struct Counter {
    operations: u64,
    lookups: u64,
    totals: Arc<Mutex<Vec<Work>>>,
}

impl Observer<F32> for Counter {
    fn see(&mut self, event: &Event<'_, F32>) {
        let lanes = u64::from(event.lanes.0.count_ones());
        match event.what {
            What::Floats { kind, results, .. } => {
                self.operations += lanes * results.len() as u64;
                self.lookups += if kind == Kind::Texture { lanes } else { 0 };
            }
            What::Answer { .. } => self.operations += lanes,
            What::Choice(_) | What::Output(_) => {}
        }
    }

    fn finish(self: Box<Self>, order: Order) {
        let mut totals = self.totals.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(work) = totals.get_mut(order.draw) else { return };
        match order.piece.stage() {
            Stage::Vertex | Stage::Geometry => work.vertex_operations += self.operations,
            Stage::Fragment => work.fragment_operations += self.operations,
        }
        work.texture_lookups += self.lookups;
    }
}

/// The cost of the fragment stages in the domain of envelopes, in additions for 64 fragments: the work of a verdict, which follows undecided
/// conditions both ways, on registers of their own, and computes lanes without a bound again.
///
/// # Errors
/// As [`render`](crate::render).
pub fn envelope_work(scene: &Scene, options: &RenderOptions) -> Result<u64, Vec<Diagnostic>> {
    let executed = AtomicU64::new(0);
    let study = Study { executed: Some(&executed), ..Study::NONE };
    pipeline::render_studied::<Envelope>(scene, options, study)?;
    Ok(executed.into_inner())
}

/// Counts what each draw of a scene executes.
///
/// # Errors
/// As [`render`](crate::render).
pub fn work(scene: &Scene, options: &RenderOptions) -> Result<Vec<Work>, Vec<Diagnostic>> {
    let totals = Arc::new(Mutex::new(vec![Work::default(); scene.draws.len()]));
    let shared = Arc::clone(&totals);
    let make = move || -> Box<dyn Observer<F32>> {
        Box::new(Counter { operations: 0, lookups: 0, totals: Arc::clone(&shared) })
    };
    let study = Study { observers: Some(&make), form: Form::Executed, ..Study::NONE };
    pipeline::render_studied::<F32>(scene, options, study)?;
    let totals = totals.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(totals.clone())
}
