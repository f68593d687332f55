//! Corrects the results of chosen instructions as they run.
//!
//! *In:* an [`Exactly`](super::Exactly). *Out:* results without a part of their f32 error. *Holds:* a float that follows from an infinity or
//! a NaN stays as it is: it passes on what began before.

use super::LANES;
use super::code::Section;
use super::inst::{Class, Inst, Use};
use super::machine::Machine;
use crate::domain::{Domain, Integer, Number};

impl<D: Domain> Machine<D> {
    /// Corrects the results of an instruction that has just run, if it is among the chosen ones.
    pub(super) fn correct(&mut self, inst: &Inst, section: &Section, place: usize) {
        let Some(exactly) = self.exactly.as_ref().filter(|exactly| exactly.holds(section.runs, place)) else { return };
        let part = exactly.part;
        let passing = self.passing(inst, section);
        for (class, operand) in self.operands(inst, section, Use::Write) {
            match class {
                Class::Float => self.registers.floats.register(operand).change_lanes(|lane, number| {
                    if passing >> lane & 1 == 1 { number } else { number.corrected(part) }
                }),
                Class::Int => self.registers.ints.register(operand).change(Integer::corrected),
            }
        }
    }

    /// The lanes where an operand is not finite. An instruction's operands still exist after it, since no register is both operand and
    /// result.
    fn passing(&self, inst: &Inst, section: &Section) -> u64 {
        let read = self.operands(inst, section, Use::Read);
        let floats = read.iter().filter(|(class, _)| *class == Class::Float);
        let floats: Vec<_> = floats.map(|(_, operand)| self.registers.float(*operand)).collect();
        let passes = |lane: &usize| floats.iter().any(|float| !float.at(*lane).value().is_finite());
        (0..LANES).filter(passes).fold(0, |lanes, lane| lanes | 1 << lane)
    }
}
