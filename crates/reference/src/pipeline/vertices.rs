//! The vertex stage: vertex data in, shaded vertices out.
//!
//! *In:* a draw and its compiled vertex stage. *Out:* [`Vertices`]: positions, clip distances and varyings of every
//! vertex of every instance, in the draw's domain, and positions also in f32, which decide coverage. *Holds:* a
//! vertex that several indices refer to is shaded once. The order does not depend on threads.

use super::clip::AtEye;
use super::invoke::Job;
use super::jitter::jittered;
use super::plan::Plan;
use super::watch::Watch;
use crate::Positions;
use crate::domain::faults::Faults;
use crate::domain::{Domain, F32, Integer, Number, Profile};
use crate::exec::{Code, Machine, Mask, Piece};
use glisten_front::hir::{GlobalId, Interpolation, ScalarValue, Stage, Type, TypeId, Types};
use glisten_front::source::Span;
use glisten_scene::Draw;
use std::sync::OnceLock;

/// Shaded vertices, structure of arrays.
#[derive(Debug)]
pub(super) struct Vertices<D: Domain> {
    /// `gl_Position`
    pub(super) clip: Vec<[D::Float; 4]>,
    /// `gl_Position`, computed in f32.
    pub(super) clip32: Vec<[f32; 4]>,
    /// Window x and y (picture rows, y down) and z, and 1/w.
    pub(super) window: Vec<[D::Float; 4]>,
    /// Window x, y and z of `clip32`, in the order of operations of Mesa's software drivers.
    pub(super) window32: Vec<[f32; 3]>,
    /// The planes of the view volume that the vertex is outside, followed by those of the clip distances; see `clip`.
    pub(super) outside: Vec<Option<u32>>,
    /// `gl_PointSize`
    pub(super) size: Vec<D::Float>,
    /// `gl_PointSize`, computed in f32.
    pub(super) size32: Vec<f32>,
    /// The enabled clip distances, `distance_count` for each vertex.
    pub(super) distances: Vec<D::Float>,
    /// The enabled clip distances in f32.
    pub(super) distances32: Vec<f32>,
    /// The number of enabled clip distances.
    pub(super) distance_count: usize,
    /// The varyings as written, `float_count` for each vertex.
    pub(super) floats: Vec<D::Float>,
    /// Smooth varyings divided by w, others as written: the values that (108) and (106) interpolate.
    pub(super) quotients: Vec<D::Float>,
    /// The vertices that cuts have added where w is about 0.
    pub(super) at_eye: Vec<AtEye<D::Float>>,
    /// The number of scalars.
    pub(super) float_count: usize,
    /// Integer varyings, `int_count` for each vertex.
    pub(super) ints: Vec<D::Int>,
    /// The number of integers.
    pub(super) int_count: usize,
    /// Whether a branch in the vertex stage was undecided.
    pub(super) undecided: Vec<bool>,
    /// The interpolation of each varying.
    pub(super) interpolations: Vec<Interpolation>,
    /// The width and height of the window in pixels.
    pub(super) viewport: [f32; 2],
    /// The faults of a driver that are excused.
    pub(super) faults: Faults,
    /// The freedom of the device where the specifications leave it open.
    pub(super) profile: Profile,
}

impl<D: Domain> Vertices<D> {
    /// The varyings of a vertex as written.
    pub(super) fn floats_of(&self, vertex: u32) -> &[D::Float] {
        let start = vertex as usize * self.float_count;
        self.floats.get(start..start + self.float_count).unwrap_or(&[])
    }

    /// The interpolated values of a vertex.
    pub(super) fn quotients_of(&self, vertex: u32) -> &[D::Float] {
        let start = vertex as usize * self.float_count;
        self.quotients.get(start..start + self.float_count).unwrap_or(&[])
    }

    /// The integer varyings of a vertex.
    pub(super) fn ints_of(&self, vertex: u32) -> &[D::Int] {
        let start = vertex as usize * self.int_count;
        self.ints.get(start..start + self.int_count).unwrap_or(&[])
    }

    /// No vertices yet.
    pub(super) fn with_capacity(count: usize, draw: &Draw, plan: &Plan, options: ShadeOptions) -> Self {
        let ShadeOptions { viewport, faults, profile, .. } = options;
        Self {
            clip: Vec::with_capacity(count),
            clip32: Vec::with_capacity(count),
            window: Vec::with_capacity(count),
            window32: Vec::with_capacity(count),
            outside: Vec::with_capacity(count),
            size: Vec::with_capacity(count),
            size32: Vec::with_capacity(count),
            distances: Vec::new(),
            distances32: Vec::new(),
            distance_count: distance_count(draw, plan),
            floats: Vec::with_capacity(count * plan.floats.len()),
            quotients: Vec::with_capacity(count * plan.floats.len()),
            at_eye: Vec::new(),
            float_count: plan.floats.len(),
            ints: Vec::with_capacity(count * plan.ints.len()),
            int_count: plan.ints.len(),
            undecided: Vec::with_capacity(count),
            interpolations: plan.floats.iter().map(|varying| varying.interpolation).collect(),
            viewport,
            faults,
            profile,
        }
    }

    /// Adds the window position and the quotients of the last vertex.
    pub(super) fn finish_last(&mut self) {
        let (Some(&clip), Some(&clip32)) = (self.clip.last(), self.clip32.last()) else { return };
        let one = D::Float::from_f64(1.0);
        let reciprocal = one.div(clip[3]);
        let half = |side: f32| D::Float::from_f64(f64::from(side) / 2.0);
        let (half_width, half_height) = (half(self.viewport[0]), half(self.viewport[1]));
        let x = clip[0].mul(reciprocal).mul(half_width).add(half_width);
        let y = half_height.sub(clip[1].mul(reciprocal).mul(half_height));
        let z = clip[2].mul(reciprocal).add(one).mul(D::Float::from_f64(0.5));
        self.window.push([x, y, z, reciprocal]);
        self.window32.push(window32(clip32, self.viewport));
        self.outside.push(self.find_outside(self.clip.len() as u32 - 1));
        let start = self.quotients.len();
        for (scalar, interpolation) in self.floats.iter().skip(start).zip(&self.interpolations) {
            let is_smooth = *interpolation == Interpolation::Smooth;
            self.quotients.push(if is_smooth { scalar.mul(reciprocal) } else { *scalar });
        }
    }
}

/// OpenGL's window position in f32, in the order of operations of Mesa's vertex pipeline: the reciprocal of w, a
/// product, and a product and sum with the viewport. Rows count from the top, as in Vulkan.
fn window32(clip: [f32; 4], viewport: [f32; 2]) -> [f32; 3] {
    let reciprocal = 1.0 / clip[3];
    let (half_width, half_height) = (viewport[0] * 0.5, viewport[1] * 0.5);
    let x = (clip[0] * reciprocal).mul_add(half_width, half_width);
    let y = (clip[1] * reciprocal).mul_add(-half_height, half_height);
    let z = (clip[2] + clip[3]) * 0.5 * reciprocal;
    [x, y, z]
}

/// A vertex to shade: `gl_VertexID` and `gl_InstanceID`.
pub(super) type Invocation = (u32, u32);

/// Options of the vertex stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadeOptions {
    /// The width and height of the window in pixels.
    pub(super) viewport: [f32; 2],
    pub(super) faults: Faults,
    pub(super) profile: Profile,
    pub(super) positions: Positions,
}

/// Shades `invocations`.
pub(super) fn shade<D: Domain>(
    draw: &Draw,
    code: &Code,
    plan: &Plan,
    invocations: &[Invocation],
    ShadeOptions { viewport, faults, profile, positions }: ShadeOptions,
    endless: &OnceLock<Span>,
    watch: &Watch<'_, D>,
) -> Vertices<D> {
    let job = Job { stage: Stage::Vertex, piece: Piece::Vertices, code, draw, profile, endless, watch };
    let chunks: Vec<Chunk<D>> = job.run(invocations, |machine, single, lanes| {
        let mut chunk = shade_chunk(draw, plan, lanes, machine, single, watch);
        if positions == Positions::Own {
            chunk.cover_by_own_positions();
        }
        chunk
    });
    let mut vertices =
        Vertices::with_capacity(invocations.len(), draw, plan, ShadeOptions { viewport, faults, profile, positions });
    watch.enter();
    for chunk in chunks {
        vertices.append(chunk);
    }
    vertices
}

/// The number of clip distances that are both enabled and written.
pub(super) fn distance_count(draw: &Draw, plan: &Plan) -> usize {
    let written = plan.clip_distance.and_then(|id| {
        let shader = draw.program.stage(plan.producer)?;
        shader.globals.get(id.index()).map(|global| draw.program.types.flat_len(global.ty))
    });
    written.unwrap_or(0).min(draw.state.clip_distances) as usize
}

/// The results of one batch, lane by lane.
pub(super) struct Chunk<D: Domain> {
    pub(super) clip: Vec<[D::Float; 4]>,
    pub(super) clip32: Vec<[f32; 4]>,
    pub(super) size: Vec<D::Float>,
    pub(super) size32: Vec<f32>,
    pub(super) distances: Vec<D::Float>,
    pub(super) distances32: Vec<f32>,
    pub(super) floats: Vec<D::Float>,
    pub(super) ints: Vec<D::Int>,
    pub(super) undecided: Vec<bool>,
}

impl<D: Domain> Chunk<D> {
    pub(super) fn with_capacity(count: usize, plan: &Plan) -> Self {
        Self {
            clip: Vec::with_capacity(count),
            clip32: Vec::with_capacity(count),
            size: Vec::with_capacity(count),
            size32: Vec::with_capacity(count),
            distances: Vec::new(),
            distances32: Vec::new(),
            floats: Vec::with_capacity(count * plan.floats.len()),
            ints: Vec::with_capacity(count * plan.ints.len()),
            undecided: Vec::with_capacity(count),
        }
    }
}

impl<D: Domain> Chunk<D> {
    /// Lets the positions of the domain decide coverage, not those of f32.
    pub(super) fn cover_by_own_positions(&mut self) {
        for (clip32, clip) in self.clip32.iter_mut().zip(&self.clip) {
            *clip32 = clip.map(|number| number.value() as f32);
        }
        let singles = self.distances32.iter_mut().chain(&mut self.size32);
        for (single, number) in singles.zip(self.distances.iter().chain(&self.size)) {
            *single = number.value() as f32;
        }
    }
}

impl<D: Domain> Vertices<D> {
    pub(super) fn append(&mut self, chunk: Chunk<D>) {
        let mut floats = chunk.floats.chunks(self.float_count.max(1));
        self.size.extend(chunk.size);
        self.size32.extend(chunk.size32);
        self.distances.extend(chunk.distances);
        self.distances32.extend(chunk.distances32);
        self.ints.extend(chunk.ints);
        self.undecided.extend(chunk.undecided);
        for (clip, clip32) in chunk.clip.into_iter().zip(chunk.clip32) {
            self.clip.push(clip);
            self.clip32.push(clip32);
            self.floats.extend_from_slice(floats.next().unwrap_or(&[]));
            self.finish_last();
        }
    }
}

fn shade_chunk<D: Domain>(
    draw: &Draw,
    plan: &Plan,
    lanes: &[Invocation],
    machine: &mut Machine<D>,
    single: &mut Machine<F32>,
    watch: &Watch<'_, D>,
) -> Chunk<D> {
    fill_inputs(draw, plan, lanes, machine);
    if let Some(seed) = watch.study.jitter {
        jitter_attributes(seed, draw, lanes, machine);
    }
    fill_inputs(draw, plan, lanes, single);
    let live = Mask::first(lanes.len());
    watch.announce(machine, lanes);
    machine.run(live, Mask::NONE);
    watch.conclude(machine, lanes);
    single.run(live, Mask::NONE);
    let count = lanes.len();
    let distances = distance_count(draw, plan);
    let float = |place: (GlobalId, u32), lane: usize| read_float(machine, place, lane);
    let float32 = |place: (GlobalId, u32), lane: usize| read_float(single, place, lane);
    let mut chunk = Chunk::with_capacity(count, plan);
    for lane in 0..count {
        chunk.clip.push(std::array::from_fn(|i| {
            plan.position.map_or_else(D::Float::default, |p| float((p, i as u32), lane))
        }));
        chunk.clip32.push(std::array::from_fn(|i| plan.position.map_or(0.0, |p| float32((p, i as u32), lane))));
        let sized = plan.point_size.filter(|_| draw.state.program_point_size);
        chunk.size.push(sized.map_or_else(|| D::Float::from_f64(1.0), |id| float((id, 0), lane)));
        chunk.size32.push(sized.map_or(1.0, |id| float32((id, 0), lane)));
        if let Some(id) = plan.clip_distance {
            chunk.distances.extend((0..distances).map(|i| float((id, i as u32), lane)));
            chunk.distances32.extend((0..distances).map(|i| float32((id, i as u32), lane)));
        }
        chunk.floats.extend(plan.floats.iter().map(|varying| float(varying.from, lane)));
        chunk.ints.extend(plan.ints.iter().map(|varying| read_int(machine, varying.from, lane)));
        let clip = chunk.clip.last().copied().unwrap_or_default();
        chunk.undecided.push(machine.undecided().contains(lane) || may_jump::<D>(clip));
    }
    chunk
}

/// Whether a position may be anywhere else: it depends on an undecided branch.
pub(super) fn may_jump<D: Domain>(clip: [D::Float; 4]) -> bool {
    D::HAS_INTERVALS && clip.iter().any(|value| may_be_far(*value, clip[3].value().abs()))
}

/// Whether a number may be so far from its value that more than roundings is open. `scale` is the size of what it is compared with.
pub(super) fn may_be_far<F: Number>(number: F, scale: f64) -> bool {
    const FAR: f64 = 1.0 / 256.0;
    number.error() > FAR * scale
}

pub(super) fn read_float<D: Domain>(machine: &Machine<D>, (global, flat): (GlobalId, u32), lane: usize) -> D::Float {
    machine.float_output(global, flat).map(|lanes| lanes.get(lane)).unwrap_or_default()
}

pub(super) fn read_int<D: Domain>(machine: &Machine<D>, (global, flat): (GlobalId, u32), lane: usize) -> D::Int {
    machine.int_output(global, flat).map(|lanes| lanes.get(lane)).unwrap_or_default()
}

/// Moves the attributes that are set by an ULP of f32.
pub(super) fn jitter_attributes<D: Domain>(seed: u64, draw: &Draw, lanes: &[Invocation], machine: &mut Machine<D>) {
    for attribute in &draw.program.interface.attributes {
        for flat in 0..draw.program.types.flat_len(attribute.ty) {
            let name = attribute.global.index() as u64 * 64 + u64::from(flat);
            if let Some(input) = machine.float_input(attribute.global, flat) {
                let place = |lane: usize| lanes.get(lane).map_or([0; 3], |(v, i)| [u64::from(*v), u64::from(*i), name]);
                input.update(|lane, number| {
                    D::Float::from_f64(jittered(number.value(), f64::INFINITY, seed, place(lane)))
                });
            }
        }
    }
}

pub(super) fn fill_inputs<D: Domain>(draw: &Draw, plan: &Plan, lanes: &[Invocation], machine: &mut Machine<D>) {
    for (attribute, data) in draw.program.interface.attributes.iter().zip(&draw.attributes) {
        let Some(data) = data else { continue };
        let rows = column_len(&draw.program.types, attribute.ty);
        for flat in 0..draw.program.types.flat_len(attribute.ty) {
            let fetch = |(vertex, instance): Invocation| data.fetch(vertex, instance, flat / rows, rows, flat % rows);
            if let Some(input) = machine.float_input(attribute.global, flat) {
                input.assign(lanes.iter().map(|lane| match fetch(*lane) {
                    ScalarValue::Float(value) => D::Float::from_f64(f64::from(value)),
                    ScalarValue::Int(_) | ScalarValue::Uint(_) | ScalarValue::Bool(_) => D::Float::default(),
                }));
            } else if let Some(input) = machine.int_input(attribute.global, flat) {
                input.assign(lanes.iter().map(|lane| match fetch(*lane) {
                    ScalarValue::Int(value) => D::Int::from_bits(value as u32),
                    ScalarValue::Uint(value) => D::Int::from_bits(value),
                    ScalarValue::Float(_) | ScalarValue::Bool(_) => D::Int::default(),
                }));
            }
        }
    }
    for (id, pick) in [(plan.vertex_id, 0), (plan.instance_id, 1)] {
        if let Some(input) = id.and_then(|id| machine.int_input(id, 0)) {
            input.assign(lanes.iter().map(|lane| D::Int::from_bits(if pick == 0 { lane.0 } else { lane.1 })));
        }
    }
}

/// The number of components of a column of an attribute: all of a vector, those of a matrix's column, those of an
/// array's element.
fn column_len(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Vector(_, size) => u32::from(size),
        Type::Matrix(_, rows) => u32::from(rows),
        Type::Array(element, _) => column_len(types, element),
        Type::Error | Type::Void | Type::Scalar(_) | Type::Sampler(_) | Type::Struct(_) => 1,
    }
}
