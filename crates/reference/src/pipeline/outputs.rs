//! Writes colors from the fragment stage's outputs to the attachments.
//!
//! *In:* a program. *Out:* for each of its outputs, its attachment, and its channels after a run.

use crate::domain::{Domain, Integer, Lanes, Number};
use crate::exec::Machine;
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{GlobalId, Scalar, Stage, Type};
use glisten_scene::Draw;
use glisten_scene::picture::Interval;

/// The source and the destination of a color.
#[derive(Clone, Debug)]
pub(super) struct OutputPlan {
    pub(super) attachment: usize,
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

impl OutputPlan {
    /// The sources of the channels; components that the output lacks come from (0, 0, 0, 1).
    pub(super) fn channels<'m, D: Domain>(&self, machine: &'m Machine<D>) -> [Channel<'m, D>; 4] {
        std::array::from_fn(|channel| {
            let flat = self.first + channel as u32;
            let missing = Channel::Constant(if channel == 3 { 1.0 } else { 0.0 });
            if channel as u32 >= self.components {
                return missing;
            }
            // An output that is never written is undefined; here it is 0.
            let unwritten = Channel::Constant(machine.never_written());
            match self.scalar {
                Scalar::Float => machine.float_output(self.global, flat).map_or(unwritten, Channel::Float),
                Scalar::Int => machine.int_output(self.global, flat).map_or(unwritten, Channel::Int),
                Scalar::Uint | Scalar::Bool => machine.int_output(self.global, flat).map_or(unwritten, Channel::Uint),
            }
        })
    }
}

/// The source of a channel of a color.
#[derive(Clone, Copy)]
pub(super) enum Channel<'m, D: Domain> {
    Float(&'m Lanes<D::Float>),
    Int(&'m Lanes<D::Int>),
    Uint(&'m Lanes<D::Int>),
    Constant(f64),
}

impl<D: Domain> Channel<'_, D> {
    /// The number in a lane.
    #[inline(always)]
    pub(super) fn at(self, lane: usize) -> D::Float {
        match self {
            Self::Float(lanes) => lanes.get(lane),
            Self::Int(lanes) => whole::<D>(lanes.get(lane), |bits| f64::from(bits as i32)),
            Self::Uint(lanes) => whole::<D>(lanes.get(lane), f64::from),
            Self::Constant(value) => D::Float::from_f64(value),
        }
    }
}

/// An integer for an attachment of integers, with all its bits: the floats of some domains have fewer.
fn whole<D: Domain>(bits: D::Int, value: impl Fn(u32) -> f64) -> D::Float {
    let likely = value(bits.bits());
    if !D::HAS_INTERVALS {
        return D::Float::from_f64(likely);
    }
    let (low, high) = bits.interval();
    let ends = [value(low as u32), value(high as u32)];
    let may_wrap = low < 0 && high >= 0 && ends[1] < ends[0];
    let (low, high) = if may_wrap { (0.0, f64::from(u32::MAX)) } else { (ends[0], ends[1]) };
    D::Float::integer_with_interval(likely, Interval { low, high, may_be_nan: false })
}
