//! The geometry stage: shaded vertices in, emitted vertices and their primitives out (GLSL 1.50 §4.3.8, §7.1, §8.10;
//! OpenGL 3.2 §2.12).
//!
//! *In:* [`Staged`] vertices, and what the stage sees of each primitive. *Out:* [`Emitted`]: vertices as from a vertex
//! stage, and primitives in the order of the input primitives, then of emission. *Holds:* a primitive without enough
//! vertices is dropped (§2.12.2). The invocations for a primitive follow each other (GLSL 4.00 §4.3.8.1). `gl_Layer` has no effect, as framebuffers are not layered (§4.4.7). Without a written
//! `gl_PrimitiveID`, which leaves the fragment stage's undefined, it is the number of the input primitive.

use super::adjacency::Seen;
use super::assembly::{Assembled, assemble};
use super::invoke::Job;
use super::plan::{FlatScalar, Plan};
use super::seen::seen;
use super::staged::{Feeds, Staged};
use super::vertices::{Chunk, ShadeOptions, Vertices, distance_count, may_jump};
use crate::Positions;
use crate::domain::{Domain, F32, Integer, Number};
use crate::exec::{Code, Machine, Mask, Stream};
use glisten_front::hir::{PrimitiveOut, Stage};
use glisten_scene::{Draw, Primitive};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The largest number of vertices that a draw emits for one instance.
pub(super) const MAX_EMITTED: usize = 1 << 22;

/// The input of one invocation of the stage: a primitive, which several invocations may get one after the other.
#[derive(Clone, Debug)]
struct Input {
    /// `gl_PrimitiveIDIn`
    id: u32,
    /// `gl_InvocationID`
    invocation: u32,
    seen: Seen,
}

/// The result of the geometry stage for one instance.
#[derive(Debug)]
pub(super) struct Emitted<D: Domain> {
    pub(super) vertices: Vertices<D>,
    /// The primitives, each with its `gl_PrimitiveID`.
    pub(super) primitives: Vec<(Assembled, u32)>,
}

/// The places of what is needed in a stream's rows.
struct Layout<'a> {
    code: &'a Code,
    position: [Option<usize>; 4],
    size: Option<usize>,
    distances: Vec<Option<usize>>,
    floats: Vec<Option<usize>>,
    ints: Vec<Option<usize>>,
    id: Option<usize>,
    shape: Primitive,
}

impl<'a> Layout<'a> {
    fn new(draw: &Draw, code: &'a Code, plan: &Plan) -> Self {
        let float = |(global, flat): FlatScalar| code.emitted_float(global, flat);
        let sized = plan.point_size.filter(|_| draw.state.program_point_size);
        let output = draw.program.stage(Stage::Geometry).and_then(|shader| shader.geometry.output);
        Self {
            code,
            position: [0, 1, 2, 3].map(|flat| plan.position.and_then(|id| float((id, flat)))),
            size: sized.and_then(|id| float((id, 0))),
            distances: (0..distance_count(draw, plan) as u32)
                .map(|flat| plan.clip_distance.and_then(|id| float((id, flat))))
                .collect(),
            floats: plan.floats.iter().map(|varying| float(varying.from)).collect(),
            ints: plan.ints.iter().map(|varying| code.emitted_int(varying.from.0, varying.from.1)).collect(),
            id: plan.written_id.and_then(|id| code.emitted_int(id, 0)),
            shape: match output {
                Some(PrimitiveOut::LineStrip) => Primitive::LineStrip,
                Some(PrimitiveOut::TriangleStrip) => Primitive::TriangleStrip,
                Some(PrimitiveOut::Points) | None => Primitive::Points,
            },
        }
    }

    fn row<'n, T>(&self, class: usize, numbers: &'n [T], vertex: u32) -> &'n [T] {
        let size = self.code.emitted_sizes()[class];
        let start = vertex as usize * size;
        numbers.get(start..start + size).unwrap_or(&[])
    }
}

/// The vertices and primitives of one batch. Vertices are numbered from its first one.
struct Part<D: Domain> {
    chunk: Chunk<D>,
    primitives: Vec<(Assembled, u32)>,
}

/// The geometry stage of a draw.
pub(super) struct Geometry<'a, D: Domain> {
    pub(super) job: &'a Job<'a, D>,
    pub(super) plan: &'a Plan,
    pub(super) feeds: &'a Feeds,
    pub(super) options: ShadeOptions,
}

impl<D: Domain> Geometry<'_, D> {
    /// Runs the stage for the primitives of one instance. `order` lists the staged vertices in the order of the draw.
    /// `None` if too much is emitted.
    pub(super) fn run(&self, staged: &Staged<D>, order: &[u32]) -> Option<Emitted<D>> {
        let Self { job, plan, options, .. } = *self;
        let vertex = |position: &u32| order.get(*position as usize).copied().unwrap_or(0);
        let stage = job.draw.program.stage(Stage::Geometry);
        let times = stage.and_then(|shader| shader.geometry.invocations).unwrap_or(1);
        let mut inputs: Vec<Input> = Vec::new();
        for (id, positions) in (0..).zip(seen(&job.draw.state, order.len() as u32)) {
            let seen: Seen = positions.iter().map(vertex).collect();
            inputs.extend((0..times).map(|invocation| Input { id, invocation, seen: seen.clone() }));
        }
        let layout = Layout::new(job.draw, job.code, plan);
        let emitted = AtomicUsize::new(0);
        let parts = job.run(&inputs, |machine, single, lanes| {
            if emitted.load(Ordering::Relaxed) > MAX_EMITTED {
                return None;
            }
            let part = self.batch(staged, &layout, lanes, machine, single);
            emitted.fetch_add(part.chunk.clip.len(), Ordering::Relaxed);
            Some(part)
        });
        job.watch.enter();
        let mut vertices = Vertices::with_capacity(0, job.draw, plan, options);
        let mut primitives = Vec::new();
        for part in parts {
            let Part { chunk, primitives: own } = part?;
            let base = vertices.clip.len() as u32;
            primitives.extend(own.into_iter().map(|(one, id)| (one.map(|vertex| base + vertex), id)));
            vertices.append(chunk);
        }
        (emitted.into_inner() <= MAX_EMITTED).then_some(Emitted { vertices, primitives })
    }

    fn batch(
        &self,
        staged: &Staged<D>,
        layout: &Layout<'_>,
        lanes: &[Input],
        machine: &mut Machine<D>,
        single: &mut Machine<F32>,
    ) -> Part<D> {
        let Self { plan, feeds, options, .. } = *self;
        fill(plan, feeds, lanes, (&staged.floats, &staged.ints), machine);
        fill(plan, feeds, lanes, (&staged.floats32, &staged.ints32), single);
        let live = Mask::first(lanes.len());
        machine.run(live, Mask::NONE);
        single.run(live, Mask::NONE);
        let mut part = Part { chunk: Chunk::with_capacity(0, plan), primitives: Vec::new() };
        for (lane, Input { id, seen, .. }) in lanes.iter().enumerate() {
            let (Some(stream), Some(alone)) = (machine.stream(lane), single.stream(lane)) else { continue };
            let is_undecided = |vertex: &u32| staged.undecided.get(*vertex as usize).copied().unwrap_or(false);
            let undecided = machine.undecided().contains(lane) || seen.iter().any(is_undecided);
            part.add(layout, stream, alone, undecided, options.positions);
            part.assemble(layout, stream, *id, self.job.draw.state.provoking_last);
        }
        part
    }
}

impl<D: Domain> Part<D> {
    /// The vertices of one stream. `alone` is that of f32, which decides coverage if it has the same vertices.
    fn add(
        &mut self,
        layout: &Layout<'_>,
        stream: &Stream<D>,
        alone: &Stream<F32>,
        undecided: bool,
        positions: Positions,
    ) {
        let alike = stream.count == alone.count && stream.ends == alone.ends;
        let undecided = undecided || stream.undecided || !alike;
        for vertex in 0..stream.count {
            let floats = layout.row(0, &stream.floats, vertex);
            let singles = layout.row(0, &alone.floats, vertex);
            let float = |place: &Option<usize>| place.and_then(|place| floats.get(place).copied()).unwrap_or_default();
            let float32 = |place: &Option<usize>| match place.and_then(|place| singles.get(place).copied()) {
                Some(value) if alike && positions == Positions::Shared => value,
                _ => float(place).value() as f32,
            };
            let ints = layout.row(1, &stream.ints, vertex);
            let int = |place: &Option<usize>| place.and_then(|place| ints.get(place).copied()).unwrap_or_default();
            let clip = layout.position.map(|place| float(&place));
            self.chunk.clip.push(clip);
            self.chunk.clip32.push(layout.position.map(|place| float32(&place)));
            let sized = layout.size.is_some();
            self.chunk.size.push(if sized { float(&layout.size) } else { D::Float::from_f64(1.0) });
            self.chunk.size32.push(if sized { float32(&layout.size) } else { 1.0 });
            self.chunk.distances.extend(layout.distances.iter().map(float));
            self.chunk.distances32.extend(layout.distances.iter().map(float32));
            self.chunk.floats.extend(layout.floats.iter().map(float));
            self.chunk.ints.extend(layout.ints.iter().map(int));
            self.chunk.undecided.push((D::HAS_INTERVALS && undecided) || may_jump::<D>(clip));
        }
    }

    /// The primitives of the stream that was just added.
    fn assemble(&mut self, layout: &Layout<'_>, stream: &Stream<D>, id: u32, provoking_last: bool) {
        let base = self.chunk.clip.len() as u32 - stream.count;
        let mut start = 0;
        for end in stream.ends.iter().copied().chain([stream.count]) {
            for assembled in assemble(layout.shape, end - start) {
                let assembled = assembled.map(|vertex| start + vertex);
                let written = layout.id.and_then(|place| {
                    let row = layout.row(1, &stream.ints, assembled.provoking(provoking_last));
                    row.get(place).map(|id| id.bits())
                });
                self.primitives.push((assembled.map(|vertex| base + vertex), written.unwrap_or(id)));
            }
            start = end;
        }
    }
}

/// Fills in the inputs of a batch from the rows of its vertices.
fn fill<D: Domain>(
    plan: &Plan,
    feeds: &Feeds,
    lanes: &[Input],
    (floats, ints): (&[D::Float], &[D::Int]),
    machine: &mut Machine<D>,
) {
    let seen_by_each = lanes.first().map_or(0, |input| input.seen.len());
    for vertex in 0..seen_by_each {
        let row = |input: &Input, size: usize| input.seen.get(vertex).map_or(0, |row| *row as usize) * size;
        for (column, feed) in feeds.floats.iter().enumerate() {
            let (global, flat) = feed.at(vertex as u32);
            let at = |lane: &Input| floats.get(row(lane, feeds.floats.len()) + column).copied();
            if let Some(input) = machine.float_input(global, flat) {
                input.assign(lanes.iter().map(|lane| at(lane).unwrap_or_default()));
            }
        }
        for (column, feed) in feeds.ints.iter().enumerate() {
            let (global, flat) = feed.at(vertex as u32);
            let at = |lane: &Input| ints.get(row(lane, feeds.ints.len()) + column).copied();
            if let Some(input) = machine.int_input(global, flat) {
                input.assign(lanes.iter().map(|lane| at(lane).unwrap_or_default()));
            }
        }
    }
    if let Some(input) = plan.primitive_id_in.and_then(|id| machine.int_input(id, 0)) {
        input.assign(lanes.iter().map(|lane| D::Int::from_bits(lane.id)));
    }
    if let Some(input) = plan.invocation_id.and_then(|id| machine.int_input(id, 0)) {
        input.assign(lanes.iter().map(|lane| D::Int::from_bits(lane.invocation)));
    }
}
