//! The time that a verdict takes, counted and not measured, so that it is the same on every machine.
//!
//! *In:* instructions, and what is done for undecided conditions. *Out:* their time in the domain of envelopes, for 64 lanes, in additions of
//! floats.

use super::inst::{Float1, Float2, Inst};
use super::machine::Machine;
use crate::domain::Domain;

/// Of a function that each lane calls by itself.
const CALL: u64 = 15;

impl Inst {
    /// The time of the instruction. Integers cost nothing next to floats with bounds.
    #[inline(always)]
    pub(super) fn cost(&self) -> u64 {
        match self {
            Self::Int1 { .. } | Self::Int2 { .. } => 0,
            Self::Float1 {
                op: Float1::Sin | Float1::Cos | Float1::Tan | Float1::Asin | Float1::Acos | Float1::Atan,
                ..
            }
            | Self::Float2 { op: Float2::Mod | Float2::Pow | Float2::Atan2, .. } => CALL,
            _ => 1,
        }
    }
}

impl<D: Domain> Machine<D> {
    /// Counts work on some lanes of all registers, which takes so many halves of an addition for a register and 64 lanes.
    pub(super) fn count_registers(&mut self, lanes: usize, halves: u64) {
        let registers = self.registers.floats.len() + self.registers.ints.len();
        self.executed += (registers * lanes) as u64 * halves / 128;
    }
}
