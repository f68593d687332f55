//! The fragment stage: primitives over a bin, shaded 64 fragments at a time.
//!
//! *In:* the primitives that touch a bin, in order. *Out:* the bin, drawn.
//!
//! *Holds:* fragments of several primitives share a batch, so that small triangles do not leave lanes idle; where
//! derivatives are taken whole quads are batched, with helper lanes, else single fragments. Within a batch lanes are in
//! the order of the primitives, and so are the writes. A fragment is tested against depth before it is shaded where that
//! cannot be seen: the shader neither discards nor writes depth.

use super::assembly::Prim;
use super::plan::Plan;
use super::source::{Fragment, Source};
use super::target::{Bin, is_integer};
use super::vertices::{Vertices, read_float, read_int};
use crate::builtin::BuiltinVariable;
use crate::cpu::domain::{Domain, Integer, Number};
use crate::cpu::exec::{LANES, Machine, Mask};
use crate::hir::{FragCoordLayout, GlobalId, Scalar, Stage, Type};
use crate::scene::{Draw, Format, Framebuffer};

/// What all bins of a draw share.
pub(super) struct Shading<'a, D: Domain> {
    pub(super) draw: &'a Draw,
    pub(super) plan: &'a Plan,
    pub(super) vertices: &'a Vertices<D>,
    pub(super) prims: &'a [Prim],
    pub(super) framebuffer: Framebuffer,
    pub(super) outputs: &'a [OutputPlan],
    pub(super) mark_edges: bool,
}

/// Where a color comes from and goes to.
#[derive(Clone, Debug)]
pub(super) struct OutputPlan {
    attachment: usize,
    global: GlobalId,
    first: u32,
    components: u32,
    scalar: Scalar,
}

/// The color outputs of a program.
pub(super) fn output_plans(draw: &Draw, attachments: u32) -> Vec<OutputPlan> {
    let types = &draw.program.types;
    let fragment = draw.program.stage(Stage::Fragment);
    let mut plans = Vec::new();
    for output in &draw.program.interface.outputs {
        let (element, count) = match types.get(output.ty) {
            Type::Array(element, _) => (element, types.flat_len(output.ty) / types.flat_len(element).max(1)),
            _ => (output.ty, 1),
        };
        let components = types.flat_len(element);
        let scalar = types.scalar_of(element).unwrap_or(Scalar::Float);
        let builtin = fragment.and_then(|shader| shader.globals.get(output.global.index())).and_then(|g| g.builtin);
        // gl_FragColor goes to every attachment (OpenGL 3.2 §3.9.2).
        let copies = if builtin == Some(BuiltinVariable::FragColor) { attachments } else { 1 };
        for index in 0..count.max(copies) {
            let attachment = (output.location + index) as usize;
            let first = if copies > 1 { 0 } else { index * components };
            if attachment < attachments as usize && output.index == 0 {
                plans.push(OutputPlan { attachment, global: output.global, first, components, scalar });
            }
        }
    }
    plans
}

/// Fragments that wait to be shaded.
struct Batch<D: Domain> {
    count: usize,
    live: u64,
    helpers: u64,
    x: [i64; LANES],
    y: [i64; LANES],
    front: [bool; LANES],
    primitive: [u32; LANES],
    undecided: [bool; LANES],
    floats: Vec<[D::Float; LANES]>,
    ints: Vec<[D::Int; LANES]>,
    coord: [[D::Float; LANES]; 4],
    sprite: [[D::Float; LANES]; 2],
}

impl<D: Domain> Batch<D> {
    fn new(plan: &Plan) -> Self {
        Self {
            count: 0,
            live: 0,
            helpers: 0,
            x: [0; LANES],
            y: [0; LANES],
            front: [true; LANES],
            primitive: [0; LANES],
            undecided: [false; LANES],
            floats: vec![[D::Float::default(); LANES]; plan.floats.len()],
            ints: vec![[D::Int::default(); LANES]; plan.ints.len()],
            coord: [[D::Float::default(); LANES]; 4],
            sprite: [[D::Float::default(); LANES]; 2],
        }
    }
}

/// Draws the primitives `list` names over a bin.
pub(super) fn draw_bin<D: Domain>(shading: &Shading<'_, D>, bin: &mut Bin<D>, list: &[u32], machine: &mut Machine<D>) {
    let mut batch = Batch::new(shading.plan);
    for prim in list.iter().filter_map(|&index| shading.prims.get(index as usize)) {
        if shading.mark_edges {
            let area = bin.area;
            prim.shape.near_edges(area, |x, y| bin.mark_near_edge(x, y));
        }
        let source = Source::new(prim, shading.vertices);
        let area = bin.area;
        prim.shape.quads(area, |x, y, covered| {
            shading.gather(bin, &mut batch, prim, &source, (x, y), covered, machine);
        });
    }
    shading.flush(bin, &mut batch, machine);
}

impl<D: Domain> Shading<'_, D> {
    /// Adds a quad to the batch, after the depth test where that comes first.
    #[expect(
        clippy::too_many_arguments,
        reason = "the innermost loop; a struct would be made and taken apart for each quad"
    )]
    #[inline(always)]
    fn gather(
        &self,
        bin: &mut Bin<D>,
        batch: &mut Batch<D>,
        prim: &Prim,
        source: &Source<'_, D>,
        (x, y): (i64, i64),
        covered: u32,
        machine: &mut Machine<D>,
    ) {
        if self.plan.needs_quads {
            let fragments: [Fragment<D::Float>; 4] = std::array::from_fn(|bit| {
                source.fragment((x + (bit as i64 & 1)) as f64 + 0.5, (y + (bit as i64 >> 1)) as f64 + 0.5)
            });
            let mut live = 0;
            for (bit, fragment) in fragments.iter().enumerate() {
                let place = (x + (bit as i64 & 1), y + (bit as i64 >> 1));
                if covered >> bit & 1 == 1 && self.passes_early(bin, place, fragment) {
                    live |= 1_u64 << bit;
                }
            }
            if live == 0 {
                return;
            }
            for (bit, fragment) in fragments.iter().enumerate() {
                self.push(batch, prim, source, (x + (bit as i64 & 1), y + (bit as i64 >> 1)), fragment);
            }
            batch.live |= live << (batch.count - 4);
            batch.helpers |= (!live & 0xf) << (batch.count - 4);
        } else {
            for bit in 0..4 {
                if covered >> bit & 1 == 0 {
                    continue;
                }
                let place = (x + (bit & 1), y + (bit >> 1));
                let fragment = source.fragment(place.0 as f64 + 0.5, place.1 as f64 + 0.5);
                if self.passes_early(bin, place, &fragment) {
                    self.push(batch, prim, source, place, &fragment);
                    batch.live |= 1 << (batch.count - 1);
                }
            }
        }
        // A quad may add four.
        if batch.count > LANES - 4 {
            self.flush(bin, batch, machine);
        }
    }

    #[inline(always)]
    fn passes_early(&self, bin: &mut Bin<D>, (x, y): (i64, i64), fragment: &Fragment<D::Float>) -> bool {
        !self.plan.early_depth || bin.depth_test(x, y, fragment.z, &self.draw.state)
    }

    #[inline(always)]
    fn push(
        &self,
        batch: &mut Batch<D>,
        prim: &Prim,
        source: &Source<'_, D>,
        (x, y): (i64, i64),
        fragment: &Fragment<D::Float>,
    ) {
        let lane = batch.count & (LANES - 1);
        batch.count += 1;
        batch.x[lane] = x;
        batch.y[lane] = y;
        batch.front[lane] = prim.front;
        batch.primitive[lane] = prim.id;
        batch.undecided[lane] = prim.undecided;
        batch.coord[2][lane] = fragment.z;
        batch.coord[3][lane] = fragment.reciprocal;
        for ((index, varying), lanes) in self.plan.floats.iter().enumerate().zip(&mut batch.floats) {
            lanes[lane] = source.varying(fragment, index, varying.interpolation);
        }
        for (value, lanes) in source.ints.iter().zip(&mut batch.ints) {
            lanes[lane] = *value;
        }
        if self.plan.point_coord.is_some() {
            let sprite = source.point.map(|sprite| sprite.coordinates(x as f64 + 0.5, y as f64 + 0.5));
            for (lanes, value) in batch.sprite.iter_mut().zip(sprite.unwrap_or_default()) {
                lanes[lane] = value;
            }
        }
    }

    /// Shades what waits and writes it.
    fn flush(&self, bin: &mut Bin<D>, batch: &mut Batch<D>, machine: &mut Machine<D>) {
        if batch.live != 0 {
            self.fill_inputs(batch, machine);
            machine.run(Mask(batch.live), Mask(batch.helpers));
            let kept = Mask(batch.live & !machine.discarded().0);
            if !self.plan.early_depth {
                for lane in Mask(batch.live & machine.undecided().0).lanes() {
                    bin.mark_undecided_cover(batch.x[lane], batch.y[lane]);
                }
            }
            for lane in kept.lanes() {
                self.write(bin, batch, machine, lane);
            }
        }
        batch.count = 0;
        batch.live = 0;
        batch.helpers = 0;
    }

    fn fill_inputs(&self, batch: &mut Batch<D>, machine: &mut Machine<D>) {
        for (varying, lanes) in self.plan.floats.iter().zip(&batch.floats) {
            if let Some(input) = machine.float_input(varying.to.0, varying.to.1) {
                *input = *lanes;
            }
        }
        for (varying, lanes) in self.plan.ints.iter().zip(&batch.ints) {
            if let Some(input) = machine.int_input(varying.to.0, varying.to.1) {
                *input = *lanes;
            }
        }
        if let Some(id) = self.plan.frag_coord {
            self.place(batch);
            for (flat, lanes) in batch.coord.iter().enumerate() {
                if let Some(input) = machine.float_input(id, flat as u32) {
                    *input = *lanes;
                }
            }
        }
        if let Some(input) = self.plan.front_facing.and_then(|id| machine.int_input(id, 0)) {
            *input = batch.front.map(D::Int::from_bool);
        }
        if let Some(input) = self.plan.primitive_id.and_then(|id| machine.int_input(id, 0)) {
            *input = batch.primitive.map(D::Int::from_bits);
        }
        if let Some(id) = self.plan.point_coord {
            for (flat, lanes) in batch.sprite.iter().enumerate() {
                if let Some(input) = machine.float_input(id, flat as u32) {
                    *input = *lanes;
                }
            }
        }
    }

    /// `gl_FragCoord.xy` by the shader's layout (GLSL 1.50 §4.3.8.1).
    fn place(&self, batch: &mut Batch<D>) {
        let layout = self.draw.program.stage(Stage::Fragment).map_or_else(FragCoordLayout::default, |s| s.frag_coord);
        let center = if layout.pixel_center_integer { 0.0 } else { 0.5 };
        let rows = i64::from(self.framebuffer.height);
        for lane in 0..batch.count.min(LANES) {
            let row = if layout.origin_upper_left { batch.y[lane] } else { rows - 1 - batch.y[lane] };
            batch.coord[0][lane] = D::Float::from_f64(batch.x[lane] as f64 + center);
            batch.coord[1][lane] = D::Float::from_f64(row as f64 + center);
        }
    }

    /// What follows the fragment stage for one fragment: late depth test, blending, storing.
    fn write(&self, bin: &mut Bin<D>, batch: &Batch<D>, machine: &Machine<D>, lane: usize) {
        let place = (batch.x[lane], batch.y[lane]);
        let (x, y) = place;
        if !self.plan.early_depth {
            let written = self.plan.frag_depth.map(|id| read_float(machine, (id, 0), lane));
            if !bin.depth_test(x, y, written.unwrap_or(batch.coord[2][lane]), &self.draw.state) {
                return;
            }
        }
        let undecided = batch.undecided[lane] || machine.undecided().contains(lane);
        bin.cover(x, y, undecided, self.draw.state.blend.is_some());
        for output in self.outputs {
            let color = self.color(output, machine, lane);
            bin.write_color(place, output.attachment, color, self.draw.state.blend, self.framebuffer.format);
        }
    }

    /// An output's value; components that it lacks are (0, 0, 0, 1).
    fn color(&self, output: &OutputPlan, machine: &Machine<D>, lane: usize) -> [D::Float; 4] {
        std::array::from_fn(|channel| {
            let channel = channel as u32;
            if channel >= output.components {
                return D::Float::from_f64(if channel == 3 { 1.0 } else { 0.0 });
            }
            let from = (output.global, output.first + channel);
            if output.scalar == Scalar::Float {
                return read_float(machine, from, lane);
            }
            let bits = read_int(machine, from, lane).bits();
            let unsigned = output.scalar != Scalar::Int || self.framebuffer.format == Format::Rgba32Uint;
            let number =
                if unsigned && is_integer(self.framebuffer.format) { f64::from(bits) } else { f64::from(bits as i32) };
            D::Float::from_f64(number)
        })
    }
}
