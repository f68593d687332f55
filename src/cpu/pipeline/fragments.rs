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
use super::target::{Bin, Test};
use super::vertices::Vertices;
use crate::builtin::BuiltinVariable;
use crate::compare::Range;
use crate::cpu::domain::faults::Faults;
use crate::cpu::domain::{Domain, Integer, Number};
use crate::cpu::exec::{Code, LANES, Machine, Mask};
use crate::hir::{FragCoordLayout, GlobalId, Scalar, Stage, Type};
use crate::scene::{Draw, Format, Framebuffer};
use smallvec::SmallVec;

/// What all bins of a draw share.
pub(super) struct Shading<'a, D: Domain> {
    pub(super) draw: &'a Draw,
    pub(super) plan: &'a Plan,
    pub(super) vertices: &'a Vertices<D>,
    pub(super) prims: &'a [Prim],
    pub(super) framebuffer: Framebuffer,
    pub(super) outputs: &'a [OutputPlan],
    pub(super) mark_edges: bool,
    pub(super) faults: Faults,
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
    /// Whether the fragment is there at all may go either way.
    open: [bool; LANES],
    /// Whether it is there by the values.
    there: [bool; LANES],
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
            open: [false; LANES],
            there: [true; LANES],
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
    /// A machine for the fragment stage.
    pub(super) fn machine(&self, code: &Code) -> Machine<D> {
        Machine::admitting(self.faults, code, &self.draw.uniforms, &self.draw.textures)
    }

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
            let mut passed = [Test::FAILED; 4];
            for (bit, fragment) in fragments.iter().enumerate() {
                let place = (x + (bit as i64 & 1), y + (bit as i64 >> 1));
                if covered >> bit & 1 == 1 {
                    passed[bit] = self.passes_early(bin, place, fragment, prim.undecided);
                    live |= u64::from(passed[bit].possible()) << bit;
                }
            }
            if live == 0 {
                return;
            }
            for (bit, fragment) in fragments.iter().enumerate() {
                self.push(batch, prim, source, (x + (bit as i64 & 1), y + (bit as i64 >> 1)), fragment, passed[bit]);
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
                let passed = self.passes_early(bin, place, &fragment, prim.undecided);
                if passed.possible() {
                    self.push(batch, prim, source, place, &fragment, passed);
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
    fn passes_early(&self, bin: &mut Bin<D>, (x, y): (i64, i64), fragment: &Fragment<D::Float>, open: bool) -> Test {
        let before = Test { passes: true, open };
        if self.plan.early_depth { bin.depth_test(x, y, fragment.z, &self.draw.state, before) } else { before }
    }

    #[inline(always)]
    fn push(
        &self,
        batch: &mut Batch<D>,
        prim: &Prim,
        source: &Source<'_, D>,
        (x, y): (i64, i64),
        fragment: &Fragment<D::Float>,
        passed: Test,
    ) {
        let lane = batch.count & (LANES - 1);
        batch.count += 1;
        batch.x[lane] = x;
        batch.y[lane] = y;
        batch.front[lane] = prim.front;
        batch.primitive[lane] = prim.id;
        batch.open[lane] = passed.open;
        batch.there[lane] = passed.passes;
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
        // Behind an endless loop nothing more is drawn: the picture will be refused.
        if batch.live != 0 && !machine.budget_exceeded() {
            self.fill_inputs(batch, machine);
            machine.run(Mask(batch.live), Mask(batch.helpers));
            let possible = !machine.discarded().0 | machine.perhaps_discarded().0;
            self.write_lanes(bin, batch, machine, Mask(batch.live & possible));
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

    /// What follows the fragment stage: late depth test, blending, storing.
    fn write_lanes(&self, bin: &mut Bin<D>, batch: &Batch<D>, machine: &Machine<D>, possible: Mask) {
        let state = &self.draw.state;
        let depth = self.plan.frag_depth.and_then(|id| machine.float_output(id, 0));
        let colors: SmallVec<[(usize, [Channel<'_, D>; 4]); 4]> =
            self.outputs.iter().map(|output| (output.attachment, self.channels(output, machine))).collect();
        let (discarded, perhaps, undecided) = (machine.discarded(), machine.perhaps_discarded(), machine.undecided());
        for lane in possible.lanes() {
            let place = (batch.x[lane], batch.y[lane]);
            let mut test = Test {
                passes: batch.there[lane] && !discarded.contains(lane),
                open: batch.open[lane] || perhaps.contains(lane),
            };
            if !self.plan.early_depth {
                let z = depth.map_or(batch.coord[2][lane], |lanes| lanes[lane]);
                test = bin.depth_test(place.0, place.1, z, state, test);
                if !test.possible() {
                    continue;
                }
            }
            bin.cover(place.0, place.1, test, undecided.contains(lane), state.blend.is_some());
            for (attachment, channels) in &colors {
                let color = channels.map(|channel| self.value(channel, lane));
                bin.write_color(place, *attachment, color, state.blend, self.framebuffer.format, test);
            }
        }
    }

    /// Where an output's channels come from; components that it lacks are (0, 0, 0, 1).
    fn channels<'m>(&self, output: &OutputPlan, machine: &'m Machine<D>) -> [Channel<'m, D>; 4] {
        std::array::from_fn(|channel| {
            let flat = output.first + channel as u32;
            let missing = Channel::Constant(if channel == 3 { 1.0 } else { 0.0 });
            if channel as u32 >= output.components {
                return missing;
            }
            // An output that is never written is undefined; here it is 0.
            let unwritten = Channel::Constant(0.0);
            match output.scalar {
                Scalar::Float => machine.float_output(output.global, flat).map_or(unwritten, Channel::Float),
                Scalar::Int | Scalar::Uint | Scalar::Bool => {
                    machine.int_output(output.global, flat).map_or(unwritten, Channel::Int)
                }
            }
        })
    }

    #[inline(always)]
    fn value(&self, channel: Channel<'_, D>, lane: usize) -> D::Float {
        match channel {
            Channel::Float(lanes) => lanes[lane],
            Channel::Int(lanes) => {
                let is_unsigned = self.framebuffer.format == Format::Rgba32Uint;
                let value = |bits: u32| if is_unsigned { f64::from(bits) } else { f64::from(bits as i32) };
                whole::<D>(lanes[lane], value)
            }
            Channel::Constant(value) => D::Float::from_f64(value),
        }
    }
}

/// An integer in an attachment of integers, which keeps all its bits: the floats of some domains have fewer.
fn whole<D: Domain>(bits: D::Int, value: impl Fn(u32) -> f64) -> D::Float {
    let likely = value(bits.bits());
    if !D::OPEN {
        return D::Float::from_f64(likely);
    }
    let (low, high) = bits.choices();
    let ends = [value(low as u32), value(high as u32)];
    let may_wrap = low < 0 && high >= 0 && ends[1] < ends[0];
    let (low, high) = if may_wrap { (0.0, f64::from(u32::MAX)) } else { (ends[0], ends[1]) };
    D::Float::whole(likely, Range { low, high, may_be_nan: false })
}

/// Where a channel of a color comes from.
#[derive(Clone, Copy)]
enum Channel<'m, D: Domain> {
    Float(&'m [D::Float; LANES]),
    Int(&'m [D::Int; LANES]),
    Constant(f64),
}
