//! [`Job`]: runs a stage before the rasterizer over its invocations, 64 at a time, on all threads.
//!
//! *In:* invocations. *Out:* the results of each batch, in order. *Holds:* each batch runs in the domain and in f32, whose
//! positions decide coverage. If a loop does not come to an end, the batches that are left do not run.

use super::watch::Watch;
use crate::domain::{Domain, F32, Profile};
use crate::exec::{Code, LANES, Machine, Piece};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Draw;
use rayon::prelude::*;
use std::sync::OnceLock;

/// A stage to run.
pub(super) struct Job<'a, D: Domain> {
    pub(super) stage: Stage,
    pub(super) piece: Piece,
    pub(super) code: &'a Code,
    pub(super) draw: &'a Draw,
    pub(super) profile: Profile,
    pub(super) endless: &'a OnceLock<Span>,
    pub(super) watch: &'a Watch<'a, D>,
}

impl<D: Domain> Job<'_, D> {
    /// Calls `batch` with a machine of each domain for every 64 invocations.
    pub(super) fn run<T: Sync, R: Send>(
        &self,
        invocations: &[T],
        batch: impl Fn(&mut Machine<D>, &mut Machine<F32>, &[T]) -> R + Sync,
    ) -> Vec<R> {
        let Self { stage, piece, code, draw, profile, endless, watch } = *self;
        let machines = || {
            let machine = watch.machine(stage, code, draw, profile);
            (machine, Machine::<F32>::new(code, &draw.uniforms, &draw.textures))
        };
        let run = |(machine, single): &mut (Machine<D>, Machine<F32>), (part, lanes): (usize, &[T])| {
            if endless.get().is_some() {
                // Nothing will be drawn.
                return None;
            }
            watch.begin(machine);
            let result = batch(machine, single, lanes);
            watch.end(machine, piece, part);
            if let Some(found) = machine.endless_loop().or(single.endless_loop()) {
                endless.get_or_init(|| found);
            }
            Some(result)
        };
        let parts = invocations.par_chunks(LANES).enumerate().with_min_len(4);
        let results: Vec<Option<R>> = parts.map_init(machines, run).collect();
        results.into_iter().flatten().collect()
    }
}
