//! The vertex stage before a geometry stage: all outputs that it reads, in the domain and in f32.
//!
//! *In:* a draw and its compiled stages. *Out:* [`Staged`]: the numbers of each vertex of each instance. *Holds:* as in
//! [`vertices`](super::vertices), a vertex that several indices refer to is shaded once.

use super::invoke::Job;
use super::plan::{FlatScalar, Plan};
use super::vertices::{Invocation, fill_inputs, jitter_attributes, read_float, read_int};
use crate::domain::{Domain, F32};
use crate::exec::{Code, Machine, Mask};
use glisten_front::hir::{Stage, TypeId};
use glisten_front::link::Program;

/// A scalar that the geometry stage reads of each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Feed {
    /// The output of the vertex stage.
    pub(super) from: FlatScalar,
    /// The input, and the scalar in the element of one vertex.
    to: FlatScalar,
    /// The number of scalars in the element of one vertex.
    stride: u32,
}

impl Feed {
    /// The place in the input's flat layout for a vertex of the primitive.
    pub(super) fn at(self, vertex: u32) -> FlatScalar {
        (self.to.0, vertex * self.stride + self.to.1)
    }
}

/// All that the geometry stage reads of its vertices, floats and ints.
#[derive(Clone, Debug, Default)]
pub(super) struct Feeds {
    pub(super) floats: Vec<Feed>,
    pub(super) ints: Vec<Feed>,
}

impl Feeds {
    /// The feeds of a program with a geometry stage, as far as its code reads them.
    pub(super) fn new(program: &Program, geometry: &Code) -> Self {
        let mut feeds = Self::default();
        let Some(consumer) = program.stage(Stage::Geometry) else { return feeds };
        for input in &program.interface.geometry_inputs {
            let element = program.types.element(consumer.global(input.to.global).ty).unwrap_or(TypeId::ERROR);
            let stride = program.types.flat_len(element).max(1);
            for scalar in 0..input.scalars {
                let from = (input.from.global, input.from.flat_offset + scalar);
                let feed = Feed { from, to: (input.to.global, input.to.flat_offset + scalar), stride };
                match geometry.reads(|global, flat| global == feed.to.0 && flat % stride == feed.to.1) {
                    Some(true) => feeds.floats.push(feed),
                    Some(false) => feeds.ints.push(feed),
                    None => {}
                }
            }
        }
        feeds
    }
}

/// The outputs of the vertices, one row for each.
#[derive(Debug)]
pub(super) struct Staged<D: Domain> {
    pub(super) floats: Vec<D::Float>,
    pub(super) floats32: Vec<f32>,
    pub(super) ints: Vec<D::Int>,
    pub(super) ints32: Vec<u32>,
    /// Whether a branch in the vertex stage was undecided.
    pub(super) undecided: Vec<bool>,
}

impl<D: Domain> Staged<D> {
    fn empty() -> Self {
        Self { floats: Vec::new(), floats32: Vec::new(), ints: Vec::new(), ints32: Vec::new(), undecided: Vec::new() }
    }
}

/// Shades the vertices.
pub(super) fn stage<D: Domain>(job: &Job<'_, D>, plan: &Plan, feeds: &Feeds, invocations: &[Invocation]) -> Staged<D> {
    let parts = job.run(invocations, |machine, single, lanes| {
        fill_inputs(job.draw, plan, lanes, machine);
        if let Some(seed) = job.watch.study.jitter {
            jitter_attributes(seed, job.draw, lanes, machine);
        }
        fill_inputs(job.draw, plan, lanes, single);
        let live = Mask::first(lanes.len());
        job.watch.announce(machine, lanes);
        machine.run(live, Mask::NONE);
        job.watch.conclude(machine, lanes);
        single.run(live, Mask::NONE);
        rows(feeds, lanes.len(), machine, single)
    });
    let mut all = Staged::empty();
    for part in parts {
        all.floats.extend(part.floats);
        all.floats32.extend(part.floats32);
        all.ints.extend(part.ints);
        all.ints32.extend(part.ints32);
        all.undecided.extend(part.undecided);
    }
    all
}

fn rows<D: Domain>(feeds: &Feeds, count: usize, machine: &Machine<D>, single: &Machine<F32>) -> Staged<D> {
    let mut part = Staged::empty();
    for lane in 0..count {
        part.floats.extend(feeds.floats.iter().map(|feed| read_float(machine, feed.from, lane)));
        part.floats32.extend(feeds.floats.iter().map(|feed| read_float(single, feed.from, lane)));
        part.ints.extend(feeds.ints.iter().map(|feed| read_int(machine, feed.from, lane)));
        part.ints32.extend(feeds.ints.iter().map(|feed| read_int(single, feed.from, lane)));
        part.undecided.push(machine.undecided().contains(lane));
    }
    part
}
