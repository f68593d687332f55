//! Runs `EmitVertex` and `EndPrimitive` (GLSL 1.50 §8.10).
//!
//! *In:* the numbers of a vertex, in the active lanes. *Out:* the lanes' [`Stream`]s.

use super::Mask;
use super::inst::Operand;
use super::machine::Machine;
use super::streams::Stream;
use crate::domain::Domain;

impl<D: Domain> Machine<D> {
    /// The vertices that a lane emitted in the last run. The last primitive need not have ended.
    pub fn stream(&self, lane: usize) -> Option<&Stream<D>> {
        self.streams.get(lane)
    }

    /// `EmitVertex` in the active lanes.
    pub(super) fn emit_vertices(&mut self, floats: &[Operand], ints: &[Operand], mask: u64) {
        for lane in Mask(mask).lanes() {
            let Some(stream) = self.streams.open(lane) else { continue };
            stream.floats.extend(floats.iter().map(|operand| self.registers.float(*operand).at(lane)));
            stream.ints.extend(ints.iter().map(|operand| self.registers.int(*operand).at(lane)));
            stream.count += 1;
        }
    }

    /// `EndPrimitive` in the active lanes.
    pub(super) fn end_primitives(&mut self, mask: u64) {
        Mask(mask).lanes().for_each(|lane| self.streams.end(lane));
    }
}
