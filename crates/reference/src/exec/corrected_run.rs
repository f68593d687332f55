//! Corrects the results of chosen instructions as they run.
//!
//! *In:* an [`Exactly`](super::Exactly). *Out:* results without a part of their f32 error.

use super::code::Section;
use super::inst::{Class, Inst};
use super::machine::Machine;
use crate::domain::{Domain, Integer, Number};

impl<D: Domain> Machine<D> {
    /// Corrects the results of an instruction that has just run, if it is among the chosen ones.
    pub(super) fn correct(&mut self, inst: &Inst, section: &Section, place: usize) {
        let Some(exactly) = self.exactly.as_ref().filter(|exactly| exactly.holds(section.runs, place)) else { return };
        let part = exactly.part;
        for (class, operand) in self.written(inst, section) {
            match class {
                Class::Float => {
                    self.registers.floats.register(operand).change(|number| number.corrected(part));
                }
                Class::Int => self.registers.ints.register(operand).change(Integer::corrected),
            }
        }
    }
}
