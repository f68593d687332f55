//! Shows an observer the results of a machine.
//!
//! *In:* instructions as they run. *Out:* [`Event`]s with the operands and results of the active lanes. *Holds:*
//! observing changes nothing. Copies, loads and stores are not shown, since they compute nothing. Helper lanes are
//! never shown.

use super::Mask;
use super::code::Section;
use super::inst::{Class, Compare, FloatToInt, Inst, List, Lookup, Operand, TextureCall, Use};
use super::machine::Machine;
use super::note::{Noted, NotedScalar};
use super::observe::{Event, Fate, Invoked, Kind, Observer, Order, What};
use crate::domain::{Domain, Source};
use glisten_front::hir::Scalar;
use glisten_front::source::Span;
use smallvec::SmallVec;
use std::sync::Arc;

impl<D: Domain> Machine<D> {
    /// Lets an observer see all later runs.
    pub fn watch(&mut self, observer: Box<dyn Observer<D>>) {
        self.observer = Some(observer);
    }

    /// Informs the observer, if there is one, that the piece has ended.
    pub fn end_watch(&mut self, order: Order) {
        if let Some(observer) = self.observer.take() {
            observer.finish(order);
        }
    }

    /// Shows an instruction that has just run. Its operands still exist, since no register is both operand and
    /// result.
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
            (None, Inst::Compare { op, .. }, Some(answer)) => {
                let equality = matches!(op, Compare::Equal | Compare::NotEqual);
                What::Answer { converts: false, equality, operands: &operands, answer }
            }
            (None, Inst::FloatToInt { op, .. }, Some(answer)) => {
                let converts = matches!(op, FloatToInt::Int | FloatToInt::Uint);
                What::Answer { converts, equality: false, operands: &operands, answer }
            }
            _ => return,
        };
        let span = section.spans.get(place).copied().unwrap_or_default();
        observer.see(&Event { span, lanes: Mask(mask & self.watched), what });
    }

    /// Shows a lookup of floats by float coordinates.
    pub(super) fn show_texture(&mut self, call: &TextureCall, section: &Section, place: usize, mask: u64) {
        let Some(observer) = &mut self.observer else { return };
        let texels_are_floats = call.kind.texel == Scalar::Float || call.kind.shadow;
        if !texels_are_floats || matches!(call.lookup, Lookup::Fetch | Lookup::Size | Lookup::Levels | Lookup::QueryLod)
        {
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

    /// Shows the condition of an instruction before it runs.
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

    /// Shows the scalars of a note.
    pub(super) fn note(&mut self, number: u32, section: &Section, [floats, ints]: [List; 2], mask: u64) {
        let lanes = mask & self.watched;
        if self.ways.exploring || lanes == 0 {
            return;
        }
        let inner = Arc::clone(&self.code.inner);
        let (Some(observer), Some(note)) = (&mut self.observer, inner.notes.get(number as usize)) else { return };
        let registers = &self.registers;
        let mut floats = section.list(floats).iter();
        let mut ints = section.list(ints).iter();
        let scalar = |scalar: &Option<Scalar>| {
            if *scalar == Some(Scalar::Float) {
                floats.next().map(|operand| NotedScalar::Float(registers.float(*operand)))
            } else {
                ints.next().map(|operand| NotedScalar::Int(registers.int(*operand)))
            }
        };
        let scalars = note.scalars.iter().filter_map(scalar).collect();
        observer.note(&Noted { note, number, lanes: Mask(lanes), scalars });
    }

    /// Lets the observer follow an invocation of the next run.
    pub(crate) fn announce(&mut self, lane: usize, invocation: &Invoked) {
        if let Some(observer) = &mut self.observer {
            observer.follows(lane, invocation);
        }
    }

    /// Tells the observer the fate of an invocation of the last run.
    pub(crate) fn conclude(&mut self, lane: usize, fate: Fate) {
        if let Some(observer) = &mut self.observer {
            observer.ended(lane, fate);
        }
    }
}
