//! The fragment stage: shades the primitives over a bin, 64 fragments at a time.
//!
//! *In:* the primitives that touch a bin, in order. *Out:* the bin, drawn.
//!
//! *Holds:* fragments of several primitives share a batch, so that small triangles do not leave lanes idle. If
//! derivatives are taken, batches consist of whole quads, with helper lanes; otherwise of single fragments. Within a
//! batch, lanes are in the order of the primitives, and so are the writes. A fragment is tested against depth before
//! shading if that makes no visible difference: if the shader neither discards nor writes depth.

use super::assembly::Prim;
use super::batch::{Batch, Run};
use super::edges::{EdgeFragment, EdgeFragments};
use super::fragment_tests::Tests;
use super::jitter::{Jitter, jittered};
use super::outputs::{Channel, OutputPlan};
use super::plan::Plan;
use super::same_surface::Origin;
use super::source::Source;
use super::surface::BIN;
use super::target::{Bin, global, local};
use super::vertices::Vertices;
use super::watch::{Followed, PixelSet, Probe};
use crate::domain::{Domain, ErrorPart, Integer, Number, Profile};
use crate::exec::{Fate, Invoked, LANES, Machine, Mask};
use crate::raster::band::band;
use glisten_front::hir::{FragCoordLayout, GlobalId, Interpolation, Stage};
use glisten_scene::{Draw, Framebuffer};
use pulp::{Simd, WithSimd};
use smallvec::SmallVec;
use std::ops::Range;
use std::sync::PoisonError;

/// The data that all bins of a draw share.
pub(super) struct Shading<'a, D: Domain> {
    pub(super) draw: &'a Draw,
    pub(super) plan: &'a Plan,
    pub(super) vertices: &'a Vertices<D>,
    pub(super) prims: &'a [Prim],
    pub(super) framebuffer: Framebuffer,
    pub(super) outputs: &'a [OutputPlan],
    pub(super) mark_edges: bool,
    pub(super) profile: Profile,
    pub(super) probe: Option<&'a Probe>,
    pub(super) pixels: Option<&'a PixelSet>,
    pub(super) followed: Option<Followed>,
    pub(super) jitter: Option<Jitter>,
    pub(super) exact_inputs: &'a [GlobalId],
    /// The surface of the instance, if another draw has the same; else 0.
    pub(super) surface: u64,
}

/// Draws the primitives of `list` over a bin.
pub(super) fn draw_bin<D: Domain>(
    shading: &Shading<'_, D>,
    bin: &mut Bin<'_, D>,
    list: &[u32],
    machine: &mut Machine<D>,
) {
    let area = bin.area;
    let mut batch = Batch::new([area.x0 as i32, area.y0 as i32]);
    let edges = if shading.mark_edges && D::HAS_INTERVALS {
        EdgeFragments::of(shading.prims, list, shading.vertices, area)
    } else {
        EdgeFragments::default()
    };
    for (number, prim) in list.iter().map(|&index| shading.prims.get(index as usize)).enumerate() {
        let Some(prim) = prim else { continue };
        if shading.mark_edges && !D::HAS_INTERVALS {
            band(&prim.shape, prim.inner, area, |near| bin.mark_near_edge(near.x, near.y));
        }
        batch.begin(prim, Source::new(prim, shading.vertices));
        let mut near = EdgeRows::new(edges.of_prim(number));
        if shading.plan.needs_quads {
            shading.add_quads(bin, &mut batch, machine, prim, &mut near);
        } else {
            shading.add_rows(bin, &mut batch, machine, prim, &near);
        }
        shading.settle(bin, &mut batch, machine);
    }
    shading.flush(bin, &mut batch, machine);
    bin.end_draw();
}

/// The fragments of a primitive near its edges, and their pixels in the rows of the bin.
struct EdgeRows<'e> {
    fragments: &'e [EdgeFragment],
    rows: [u32; BIN as usize],
}

impl<'e> EdgeRows<'e> {
    fn new(fragments: &'e [EdgeFragment]) -> Self {
        let mut rows = [0; BIN as usize];
        for fragment in fragments {
            rows[fragment.place as usize / BIN as usize % BIN as usize] |= 1 << (fragment.place % BIN as u32);
        }
        Self { fragments, rows }
    }

    /// The pixels of a row from a column on.
    fn row(&self, row: i64, column: i64) -> u64 {
        self.rows.get(row as usize).map_or(0, |set| u64::from(*set) >> column.clamp(0, BIN))
    }

    /// The pixels of a quad, by its upper left pixel.
    fn quad(&self, row: i64, column: i64) -> u32 {
        (self.row(row, column) & 0b11 | (self.row(row + 1, column) & 0b11) << 2) as u32
    }

    /// The fragments of a quad, by its upper left pixel in the bin, each with its number in the quad.
    fn in_quad(&self, first: u32) -> impl Iterator<Item = (usize, &'e EdgeFragment)> {
        let places = [first, first + 1, first + BIN as u32, first + BIN as u32 + 1];
        let lane = move |fragment: &EdgeFragment| places.iter().position(|place| *place == fragment.place);
        self.fragments.iter().filter_map(move |fragment| Some((lane(fragment)?, fragment)))
    }
}

impl<D: Domain> Shading<'_, D> {
    /// Adds the fragments of a primitive one by one: first those that are certainly covered, then those near an edge.
    #[inline(always)]
    fn add_rows<'v>(
        &self,
        bin: &mut Bin<'_, D>,
        batch: &mut Batch<'v, D>,
        machine: &mut Machine<D>,
        prim: &Prim,
        near: &EdgeRows<'_>,
    ) {
        let area = bin.area;
        prim.shape.rows(area, |y, x, pixels| {
            let certain = pixels & !near.row(y - area.y0, x - area.x0);
            let mut rest = self.pixels.map_or(certain, |wanted| wanted.in_row(x, y, certain));
            while rest != 0 {
                rest = batch.add_row(local(area, x, y), rest);
                if batch.is_full() {
                    self.settle(bin, batch, machine);
                }
            }
        });
        for fragment in near.fragments {
            let [x, y] = global(area, fragment.place);
            if self.pixels.is_some_and(|wanted| wanted.in_row(x, y, 1) == 0) {
                continue;
            }
            batch.add_edge(fragment);
            if batch.is_full() {
                self.settle(bin, batch, machine);
            }
        }
    }

    /// Adds the fragments of a primitive in whole quads: first those with a covered pixel, then those that have pixels
    /// near an edge alone.
    #[inline(always)]
    fn add_quads<'v>(
        &self,
        bin: &mut Bin<'_, D>,
        batch: &mut Batch<'v, D>,
        machine: &mut Machine<D>,
        prim: &Prim,
        near: &mut EdgeRows<'_>,
    ) {
        let area = bin.area;
        let mut done = [0_u32; BIN as usize];
        prim.shape.quads(area, |x, y, covered| {
            if self.pixels.is_some_and(|wanted| !wanted.in_quad(x, y)) {
                return;
            }
            let (row, column) = (y - area.y0, x - area.x0);
            let set = near.quad(row, column);
            batch.add_quad(local(area, x, y), BIN as u32, covered | set);
            if set != 0 {
                near.in_quad(local(area, x, y)).for_each(|(lane, fragment)| batch.mark_in_quad(lane, fragment));
                if let Some(done) = done.get_mut(row as usize / 2) {
                    *done |= 1 << column;
                }
            }
            if batch.is_full() {
                self.settle(bin, batch, machine);
            }
        });
        for fragment in near.fragments {
            let (row, column) = ((fragment.place / BIN as u32) & !1, (fragment.place % BIN as u32) & !1);
            let Some(done) = done.get_mut(row as usize / 2).filter(|done| **done >> column & 1 == 0) else { continue };
            *done |= 1 << column;
            let first = row * BIN as u32 + column;
            let [x, y] = global(area, first);
            if self.pixels.is_some_and(|wanted| !wanted.in_quad(x, y)) {
                continue;
            }
            batch.add_quad(first, BIN as u32, near.quad(i64::from(row), i64::from(column)));
            near.in_quad(first).for_each(|(lane, fragment)| batch.mark_in_quad(lane, fragment));
            if batch.is_full() {
                self.settle(bin, batch, machine);
            }
        }
    }
    /// Keeps the batch's candidates that pass the depth test, if that comes first, and shades the batch when it is
    /// full.
    fn settle(&self, bin: &mut Bin<'_, D>, batch: &mut Batch<'_, D>, machine: &mut Machine<D>) {
        let Some(before) = batch.locate() else { return };
        let tests = if self.plan.early_depth {
            let origins = self.origins(batch);
            let z = |lane: usize| batch.fragments.z[lane];
            bin.depth_tests(&batch.fragments.pixels, z, &self.draw.state, before, origins.as_ref())
        } else {
            before
        };
        if self.plan.needs_quads {
            batch.keep::<4>(tests);
        } else {
            batch.keep::<1>(tests);
        }
        if batch.is_full() {
            self.flush(bin, batch, machine);
        }
    }

    /// Shades the fragments of the batch and writes the results.
    fn flush(&self, bin: &mut Bin<'_, D>, batch: &mut Batch<'_, D>, machine: &mut Machine<D>) {
        // After an endless loop nothing more is drawn: the picture will be rejected.
        if batch.live != 0 && !machine.budget_exceeded() {
            pulp::Arch::new().dispatch(Interpolate { plan: self.plan, batch, machine });
            self.fill_fixed(batch, machine);
            for (id, flat) in self.plan.floats.iter().map(|varying| varying.to) {
                if self.exact_inputs.contains(&id)
                    && let Some(input) = machine.float_input(id, flat)
                {
                    input.update(|_, number| number.corrected(ErrorPart::All));
                }
            }
            if let Some(jitter) = &self.jitter {
                self.jitter_inputs(jitter, batch, machine);
            }
            if let Some(probe) = self.probe {
                self.examine(probe, batch);
            }
            for (lane, invoked) in self.followed(batch) {
                machine.announce(lane, &invoked);
            }
            machine.run(Mask(batch.live), batch.helpers());
            let passed = self.write_lanes(bin, batch, machine);
            for (lane, _) in self.followed(batch) {
                let is_discarded = machine.discarded().contains(lane);
                machine.conclude(lane, fate(is_discarded, passed >> lane & 1 == 1));
            }
        }
        batch.clear();
    }

    /// The primitives of the fragments, if another draw may have the same depths.
    fn origins(&self, batch: &Batch<'_, D>) -> Option<[Origin; LANES]> {
        if !D::HAS_INTERVALS || self.surface == 0 {
            return None;
        }
        let mut origins = [Origin::default(); LANES];
        for (run, lanes) in batch.runs() {
            let origin = Origin { surface: self.surface, primitive: run.id };
            lanes.for_each(|lane| origins[lane] = origin);
        }
        Some(origins)
    }

    /// Moves the float inputs that differ between fragments by an ULP of f32. What is `flat` is a number of the stage before.
    fn jitter_inputs(&self, jitter: &Jitter, batch: &Batch<'_, D>, machine: &mut Machine<D>) {
        let places = &batch.fragments.places;
        let coordinates = self.plan.frag_coord.into_iter().flat_map(|id| [(id, 0), (id, 1)]);
        let coordinates = coordinates.map(|to| (to, f64::INFINITY));
        let varyings = self.plan.floats.iter().enumerate();
        let varyings = varyings.filter(|(_, varying)| varying.interpolation != Interpolation::Flat);
        let varyings = varyings.map(|(index, varying)| (varying.to, jitter.reach(index)));
        for ((id, flat), reach) in varyings.chain(coordinates) {
            if let Some(input) = machine.float_input(id, flat) {
                let place = |lane: usize| {
                    [places.x[lane] as u64, places.y[lane] as u64, id.index() as u64 * 64 + u64::from(flat)]
                };
                let moved = |lane, value| jittered(value, reach, jitter.seed, place(lane));
                input.update(|lane, number| D::Float::from_f64(moved(lane, number.value())));
            }
        }
    }

    /// Notes the varyings of a fragment, if the batch has it.
    fn examine(&self, probe: &Probe, batch: &Batch<'_, D>) {
        let [x, y] = probe.pixel.map(|at| f64::from(at) + 0.5);
        let places = &batch.fragments.places;
        let found = Mask(batch.live).lanes().filter(|lane| places.x[*lane] == x && places.y[*lane] == y).last();
        let Some(lane) = found else { return };
        let Some((run, _)) = batch.runs().find(|(_, lanes)| lanes.contains(&lane)) else { return };
        let values = self.plan.floats.iter().enumerate().map(|(index, varying)| {
            let mut number = [D::Float::default()];
            run.source.varying(&batch.fragments, lane..lane + 1, (index, varying.interpolation), &mut number);
            (varying.to.0, varying.to.1, number[0].second())
        });
        *probe.found.lock().unwrap_or_else(PoisonError::into_inner) = values.collect();
    }

    /// Fills in the built-in inputs.
    fn fill_fixed(&self, batch: &Batch<'_, D>, machine: &mut Machine<D>) {
        let fragments = &batch.fragments;
        if let Some(id) = self.plan.frag_coord {
            // The layout of the shader determines gl_FragCoord.xy (GLSL 1.50 §4.3.8.1).
            let layout =
                self.draw.program.stage(Stage::Fragment).map_or_else(FragCoordLayout::default, |s| s.frag_coord);
            let center = if layout.pixel_center_integer { -0.5 } else { 0.0 };
            let rows = f64::from(self.framebuffer.height);
            let row = |y: f64| if layout.origin_upper_left { y } else { rows - y };
            fill_float(machine, (id, 0), |lane| D::Float::from_f64(fragments.places.x[lane] + center));
            fill_float(machine, (id, 1), |lane| D::Float::from_f64(row(fragments.places.y[lane]) + center));
            fill_float(machine, (id, 2), |lane| fragments.z[lane]);
            fill_float(machine, (id, 3), |lane| fragments.reciprocal[lane]);
        }
        if let Some(id) = self.plan.front_facing {
            fill_int(machine, (id, 0), batch, |run| D::Int::from_bool(run.front));
        }
        if let Some(id) = self.plan.primitive_id {
            fill_int(machine, (id, 0), batch, |run| D::Int::from_bits(run.id));
        }
        if let Some(id) = self.plan.sample_mask {
            fill_int(machine, (id, 0), batch, |_| D::Int::from_bits(1));
        }
        if let Some(id) = self.plan.point_coord {
            let mut sprite = [[D::Float::default(); 2]; LANES];
            for (run, lanes) in batch.runs() {
                let Some(point) = run.source.point else { continue };
                for lane in lanes {
                    sprite[lane] = point.coordinates(fragments.places.x[lane], fragments.places.y[lane]);
                }
            }
            for flat in 0..2 {
                fill_float(machine, (id, flat), |lane| sprite[lane][flat as usize]);
            }
        }
    }

    /// The fragments of the batch that observers follow.
    fn followed(&self, batch: &Batch<'_, D>) -> SmallVec<[(usize, Invoked); 1]> {
        let Some(Followed::Pixel(pixel)) = self.followed else { return SmallVec::new() };
        let [x, y] = pixel.map(|at| f64::from(at) + 0.5);
        let places = &batch.fragments.places;
        let is_there = |lane: &usize| batch.live >> lane & 1 == 1 && places.x[*lane] == x && places.y[*lane] == y;
        let of_run = |(run, lanes): (&Run<'_, D>, Range<usize>)| {
            let invoked = Invoked::Fragment { primitive: run.id, front: run.front };
            lanes.filter(is_there).map(move |lane| (lane, invoked)).collect::<SmallVec<[_; 1]>>()
        };
        batch.runs().flat_map(of_run).collect()
    }

    /// Everything after the fragment stage: late depth test, blending, storing. Returns the lanes that passed all tests.
    fn write_lanes(&self, bin: &mut Bin<'_, D>, batch: &Batch<'_, D>, machine: &Machine<D>) -> u64 {
        let state = &self.draw.state;
        let pixels = &batch.fragments.pixels;
        let (discarded, perhaps) = (machine.discarded().0, machine.perhaps_discarded().0);
        let reached = batch.live & (!discarded | perhaps);
        let mut tests = Tests {
            passes: batch.tests.passes & !discarded & reached,
            undecided: (batch.tests.undecided | perhaps) & reached,
            doubtful: (batch.tests.doubtful | perhaps) & reached,
            ..batch.tests
        };
        let lost = batch.live & tests.owners & (!tests.passes | tests.undecided);
        Mask(lost).lanes().for_each(|lane| bin.leave(pixels[lane]));
        if !self.plan.early_depth {
            let depth = self.plan.frag_depth.and_then(|id| machine.float_output(id, 0));
            let depth = |lane: usize| depth.map_or(batch.fragments.z[lane], |depth| depth.get(lane));
            let origins = self.origins(batch).filter(|_| self.plan.frag_depth.is_none());
            tests = bin.depth_tests(pixels, depth, state, tests, origins.as_ref());
        }
        bin.cover(pixels, tests, machine.undecided().0, state.blend.is_some());
        for output in self.outputs {
            let channels = output.channels(machine);
            if let [Channel::Float(r), Channel::Float(g), Channel::Float(b), Channel::Float(a)] = channels {
                let color = |lane: usize| [r, g, b, a].map(|channel| channel.get(lane));
                bin.write_colors(pixels, output.attachment, color, state.blend, tests);
            } else {
                let color = |lane: usize| channels.map(|channel| channel.at(lane));
                bin.write_colors(pixels, output.attachment, color, state.blend, tests);
            }
        }
        tests.passes
    }
}

/// The fate of a fragment.
fn fate(is_discarded: bool, passed: bool) -> Fate {
    match (is_discarded, passed) {
        (true, _) => Fate::Discarded,
        (false, true) => Fate::Done,
        (false, false) => Fate::Failed,
    }
}

/// Fills a `float` input, if the stage reads it.
fn fill_float<D: Domain>(machine: &mut Machine<D>, (id, flat): (GlobalId, u32), value: impl Fn(usize) -> D::Float) {
    if let Some(input) = machine.float_input(id, flat) {
        input.update(|lane, _| value(lane));
    }
}

/// Fills an `int` input with each primitive's value, if the stage reads it.
fn fill_int<D: Domain>(
    machine: &mut Machine<D>,
    (id, flat): (GlobalId, u32),
    batch: &Batch<'_, D>,
    value: impl Fn(&Run<'_, D>) -> D::Int,
) {
    if let Some(input) = machine.int_input(id, flat) {
        for (run, lanes) in batch.runs() {
            lanes.for_each(|lane| input.set(lane, value(run)));
        }
    }
}

/// Fills in the varyings, in loops to compile for wide vectors.
struct Interpolate<'a, 'v, D: Domain> {
    plan: &'a Plan,
    batch: &'a mut Batch<'v, D>,
    machine: &'a mut Machine<D>,
}

impl<D: Domain> WithSimd for Interpolate<'_, '_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { plan, batch, machine } = self;
        batch.find_w();
        let mut numbers = [D::Float::default(); LANES];
        for (index, varying) in plan.floats.iter().enumerate() {
            let Some(input) = machine.float_input(varying.to.0, varying.to.1) else { continue };
            for (run, lanes) in batch.runs() {
                let to = &mut numbers[lanes.clone()];
                run.source.varying(&batch.fragments, lanes, (index, varying.interpolation), to);
            }
            input.load(&numbers);
        }
        for (index, varying) in plan.floats.iter().enumerate().filter(|_| D::HAS_INTERVALS) {
            let Some(noise) = machine.noise_input(varying.to.0, varying.to.1) else { continue };
            for (run, lanes) in batch.runs() {
                let to = &mut numbers[lanes.clone()];
                run.source.noise(&batch.fragments, lanes, (index, varying.interpolation), to);
            }
            noise.load(&numbers);
        }
        for (index, varying) in plan.ints.iter().enumerate() {
            fill_int(machine, varying.to, batch, |run| run.source.ints.get(index).copied().unwrap_or_default());
        }
    }
}
