//! Shorter ways for texture instructions: one lookup for all lanes, and texels without intervals.
//!
//! *In:* a [`TextureCall`] and the registers. *Out:* its results, the same numbers as those of a lookup per lane; or nothing,
//! where a shorter way does not apply.

use super::inst::{Class, Lookup, Operand, TextureCall};
use super::lookup::{LaneLookup, number};
use super::machine::Machine;
use super::registers::Filled;
use super::{LANES, Mask};
use crate::domain::{Domain, Integer, Number, Source};
use crate::texture::{self, BoundedFloat, Sampled};
use glisten_front::hir::{Scalar, Stage};

impl<D: Domain> Machine<D> {
    /// Runs a texture instruction once, if its texture and its operands are the same in all lanes.
    pub(super) fn texture_once(&mut self, call: &TextureCall, stage: Stage) -> bool {
        let registers = &self.registers;
        let is_one = |class: Class, operand: Operand| match class {
            Class::Float => matches!(registers.float(operand), Source::One(_)),
            Class::Int => matches!(registers.int(operand), Source::One(_)),
        };
        let slot = registers.int(call.sampler).at(0);
        if D::Float::PAIRED || !slot.is_decided() || !call.all_read(is_one) {
            return false;
        }
        let bound = self.textures.get(slot.bits() as usize).and_then(Option::as_deref);
        let sampled = LaneLookup { registers, call, lane: 0, second: false }.sampled(bound, stage);
        for (k, dst) in call.results.iter().enumerate() {
            match sampled {
                Sampled::Floats(values) => self.registers.floats.register(*dst).fill(|lanes| {
                    lanes.set(0, number(values[k % 4]));
                    Filled::One
                }),
                Sampled::Ints(bits) => self.registers.ints.register(*dst).fill(|lanes| {
                    lanes.set(0, D::Int::with_interval(bits[k % 4].bits, bits[k % 4].low, bits[k % 4].high));
                    Filled::One
                }),
            }
        }
        true
    }

    /// Runs `texelFetch` of floats, if the domain has neither intervals nor pairs, and the texture and the level are the same
    /// in all lanes.
    pub(super) fn fetch_plain(&mut self, call: &TextureCall, mask: u64) -> bool {
        if D::HAS_INTERVALS || D::Float::PAIRED || call.lookup != Lookup::Fetch || call.kind.texel != Scalar::Float {
            return false;
        }
        let ints = &self.registers.ints;
        let Source::One(slot) = ints.source(call.sampler) else { return false };
        let level = match call.level.map(|level| ints.source(level)) {
            Some(Source::Lanes(_)) => return false,
            Some(Source::One(level)) => level.bits() as i32,
            None => 0,
        };
        let Some(texture) = self.textures.get(slot.bits() as usize).and_then(Option::as_deref) else { return false };
        let sources = |operands: &[Operand]| -> [Source<'_, D::Int>; 3] {
            std::array::from_fn(|axis| {
                operands.get(axis).map_or(Source::One(D::Int::from_bits(0)), |operand| ints.source(*operand))
            })
        };
        let (at, offset) = (sources(&call.coordinate), sources(&call.offset));
        let mut texels = [[0.0; 4]; LANES];
        for lane in Mask(mask).lanes() {
            let place = |sources: &[Source<'_, D::Int>; 3]| sources.each_ref().map(|s| s.at(lane).bits() as i32);
            texels[lane] = texture::fetch_floats(texture, call.kind, place(&at), level, place(&offset));
        }
        for (k, dst) in call.results.iter().enumerate() {
            let lanes = self.registers.floats.register(*dst).spread();
            for lane in Mask(mask).lanes() {
                lanes.set(lane, number(BoundedFloat::exact(texels[lane][k % 4])));
            }
        }
        true
    }
}
