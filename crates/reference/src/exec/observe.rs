//! [`Observer`]: sees what a machine computes, instruction by instruction.
//!
//! *In:* instructions as they run. *Out:* [`Event`]s with the operands and results of the lanes that count.
//! *Holds:* watching changes nothing. Copies, loads and stores are not shown: they compute nothing. Helper lanes are
//! never shown.

use super::Mask;
use super::code::Section;
use super::inst::{Class, Composite, Float2, Inst, Lookup, Operand, TextureCall, Use};
use super::machine::Machine;
use crate::domain::{Domain, Source};
use glisten_front::hir::Scalar;
use glisten_front::source::Span;
use smallvec::SmallVec;
use std::fmt::Debug;

/// A scalar in all lanes: one number each, or one for all.
pub type Values<'a, T> = Source<'a, T>;

/// Where a piece of a run stands among all pieces of a drawing, whichever thread ran it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Order {
    /// The draw of the scene.
    pub draw: usize,
    /// The first instance of the group.
    pub instance: u32,
    /// 0 and 1: what is the same for all vertices and all fragments; 2: vertices; 3: fragments.
    pub stage: u8,
    /// The batch of vertices, or the bin of the framebuffer.
    pub part: usize,
}

/// What kind of operation gave floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `a + b`, `a - b`
    Sum,
    /// `dot(a, b)`; the operands are those of `a`, then those of `b`.
    Dot,
    /// A function that jumps: `floor`, `sign`, `step`, `fract`, `mod` and their like.
    Jump,
    /// A difference of neighboring lanes.
    Derivative,
    /// A texture's texels, from coordinates.
    Texture,
    /// Anything else.
    Other,
}

/// What happened.
#[derive(Debug)]
pub enum What<'a, D: Domain> {
    /// Floats were computed.
    Floats {
        /// By what.
        kind: Kind,
        /// From these; of conversions from integers nothing is shown.
        operands: &'a [Values<'a, D::Float>],
        /// One, or the components of a vector or matrix.
        results: &'a [Values<'a, D::Float>],
    },
    /// A comparison of floats, a classification or a conversion to an integer was made.
    Answer(Values<'a, D::Int>),
    /// Lanes part, or one of two values is taken, by this condition or selector.
    Choice(Values<'a, D::Int>),
    /// The stage has ended with this in an output.
    Output(Values<'a, D::Float>),
}

/// Something that happened in some lanes.
#[derive(Debug)]
pub struct Event<'a, D: Domain> {
    /// The expression or statement.
    pub span: Span,
    /// The lanes.
    pub lanes: Mask,
    /// What.
    pub what: What<'a, D>,
}

/// Sees what a machine computes.
pub trait Observer<D: Domain>: Send + Debug {
    /// Something happened.
    fn see(&mut self, event: &Event<'_, D>);
    /// A piece of the drawing has ended.
    fn finish(self: Box<Self>, order: Order);
}

impl Kind {
    /// `None` for what computes no floats.
    fn of(inst: &Inst) -> Option<Self> {
        Some(match inst {
            Inst::Float2 { op: Float2::Add | Float2::Sub, .. } => Self::Sum,
            Inst::Composite { op: Composite::Dot, .. } => Self::Dot,
            Inst::Float1 { op, .. } if op.jumps() => Self::Jump,
            Inst::Float2 { op, .. } if op.jumps() => Self::Jump,
            Inst::Derivative { .. } => Self::Derivative,
            Inst::Float1 { .. }
            | Inst::Float2 { .. }
            | Inst::Float3 { .. }
            | Inst::MulAdd { .. }
            | Inst::SumOfProducts { .. }
            | Inst::IntToFloat { .. }
            | Inst::Composite { .. } => Self::Other,
            _ => return None,
        })
    }
}

impl<D: Domain> Machine<D> {
    /// Lets an observer see all runs from here on.
    pub fn watch(&mut self, observer: Box<dyn Observer<D>>) {
        self.observer = Some(observer);
    }

    /// Tells the observer, if there is one, that this was all.
    pub fn end_watch(&mut self, order: Order) {
        if let Some(observer) = self.observer.take() {
            observer.finish(order);
        }
    }

    /// Shows an instruction that was just computed; its operands are still there, as no register is both.
    pub(super) fn show(&mut self, inst: &Inst, section: &Section, place: usize, mask: u64) {
        let Some(observer) = &mut self.observer else { return };
        let registers = &self.registers;
        let mut operands: SmallVec<[Source<'_, D::Float>; 8]> = SmallVec::new();
        let mut results: SmallVec<[Source<'_, D::Float>; 4]> = SmallVec::new();
        let mut answer = None;
        let mut copy = *inst;
        copy.visit(&mut |class, using, operand| match (class, using) {
            (Class::Float, Use::Read) => operands.push(registers.float(*operand)),
            (Class::Float, Use::Write) => results.push(registers.float(*operand)),
            (Class::Int, Use::Write) => answer = Some(registers.int(*operand)),
            (Class::Int, Use::Read) => {}
        });
        for (_, using, list) in inst.lists().into_iter().flatten().filter(|(class, ..)| *class == Class::Float) {
            let values = section.list(list).iter().map(|operand| registers.float(*operand));
            if using == Use::Read { operands.extend(values) } else { results.extend(values) }
        }
        let what = match (Kind::of(inst), inst, answer) {
            (Some(kind), ..) => What::Floats { kind, operands: &operands, results: &results },
            (None, Inst::Compare { .. } | Inst::FloatToInt { .. }, Some(answer)) => What::Answer(answer),
            _ => return,
        };
        let span = section.spans.get(place).copied().unwrap_or_default();
        observer.see(&Event { span, lanes: Mask(mask & self.watched), what });
    }

    /// Shows a lookup of floats by floats.
    pub(super) fn show_texture(&mut self, call: &TextureCall, section: &Section, place: usize, mask: u64) {
        let Some(observer) = &mut self.observer else { return };
        let texels_are_floats = call.kind.texel == Scalar::Float || call.kind.shadow;
        if !texels_are_floats || matches!(call.lookup, Lookup::Fetch | Lookup::Size) {
            return;
        }
        let registers = &self.registers;
        let values = |operand: &Operand| registers.float(*operand);
        let operands: SmallVec<[Source<'_, D::Float>; 8]> = call.coordinate.iter().map(values).collect();
        let results: SmallVec<[Source<'_, D::Float>; 4]> = call.results.iter().map(values).collect();
        let what = What::Floats { kind: Kind::Texture, operands: &operands, results: &results };
        let span = section.spans.get(place).copied().unwrap_or_default();
        observer.see(&Event { span, lanes: Mask(mask & self.watched), what });
    }

    /// Shows the condition of an instruction that is about to run.
    pub(super) fn show_choice(&mut self, inst: &Inst, section: &Section, place: usize, mask: u64) {
        let (Inst::Arm { c, .. }
        | Inst::LoopTest { c, .. }
        | Inst::CaseMask { selector: c, .. }
        | Inst::SelectFloat { c, .. }
        | Inst::SelectInt { c, .. }) = *inst
        else {
            return;
        };
        let Some(observer) = &mut self.observer else { return };
        let span = section.spans.get(place).copied().unwrap_or_default();
        let what = What::Choice(self.registers.int(c));
        observer.see(&Event { span, lanes: Mask(mask & self.watched), what });
    }

    /// Shows the float outputs after a run.
    pub(super) fn show_outputs(&mut self, lanes: u64) {
        let Some(observer) = &mut self.observer else { return };
        for port in self.code.inner.outputs.iter().filter(|port| port.class == Class::Float) {
            if let Some(values) = self.registers.floats.get(port.register) {
                let what = What::Output(values.source());
                observer.see(&Event { span: Span::default(), lanes: Mask(lanes), what });
            }
        }
    }
}
