//! Texture instructions: operands of lanes and quads to lookups, one lane at a time.

use super::inst::{Lookup, Operand, TextureCall};
use super::machine::Machine;
use super::registers::Registers;
use super::{LANES, Mask};
use crate::cpu::domain::{Domain, Integer, Number, rules};
use crate::cpu::texture::{self, Gradients, MISSING, Near, Request, Sampled};
use crate::hir::{SamplerDim, Scalar, Stage};
use crate::scene::{Filter, Texture};

impl<D: Domain> Machine<D> {
    /// Runs a texture instruction in these lanes; gives the lanes whose texel or sampler is not sure.
    pub(super) fn texture(&mut self, call: &TextureCall, stage: Stage, mask: u64) -> u64 {
        let mut undecided = 0;
        for lane in Mask(mask).lanes() {
            let slot = self.registers.int(call.sampler).at(lane);
            let bound = self.textures.get(slot.bits() as usize).and_then(Option::as_deref);
            let lookup = At { registers: &self.registers, call, lane };
            let sampled = match (bound, call.lookup) {
                (None, Lookup::Size) => Sampled::Bits([0; 4], true),
                (None, _) => nothing(call),
                (Some(texture), Lookup::Size) => lookup.size(texture),
                (Some(texture), Lookup::Fetch) => lookup.fetch(texture),
                (Some(texture), _) => lookup.filtered(texture, stage),
            };
            if !slot.sure() {
                undecided |= 1 << lane;
            }
            self.put(call, lane, sampled);
        }
        undecided
    }

    fn put(&mut self, call: &TextureCall, lane: usize, sampled: Sampled) {
        for (k, result) in call.results.iter().enumerate() {
            match sampled {
                Sampled::Floats(values) => {
                    let Near { value, error } = values[k % 4];
                    self.registers.floats[result.number()][lane] = D::Float::with_error(value, error);
                }
                Sampled::Bits(bits, sure) => {
                    self.registers.ints[result.number()][lane] = D::Int::with_doubt(bits[k % 4], !sure);
                }
            }
        }
    }
}

fn nothing(call: &TextureCall) -> Sampled {
    if call.kind.texel == Scalar::Float || call.kind.shadow {
        Sampled::Floats(MISSING.map(Near::exact))
    } else {
        Sampled::Bits([0, 0, 0, 1], true)
    }
}

/// A texture instruction in one lane.
struct At<'a, D: Domain> {
    registers: &'a Registers<D>,
    call: &'a TextureCall,
    lane: usize,
}

impl<D: Domain> At<'_, D> {
    fn near(&self, operand: Operand) -> Near {
        let value = self.registers.float(operand).at(self.lane);
        Near { value: value.value(), error: value.error() }
    }

    fn int(&self, operand: Operand) -> D::Int {
        self.registers.int(operand).at(self.lane)
    }

    fn nears(&self, operands: &[Operand]) -> [Near; 3] {
        std::array::from_fn(|k| operands.get(k).map_or(Near::default(), |operand| self.near(*operand)))
    }

    fn ints(&self, operands: &[Operand]) -> ([i32; 3], bool) {
        let all = operands.iter().map(|operand| self.int(*operand));
        let sure = all.clone().all(Integer::sure);
        let mut bits = [0; 3];
        bits.iter_mut().zip(all).for_each(|(to, value)| *to = value.bits() as i32);
        (bits, sure)
    }

    fn size(&self, texture: &Texture) -> Sampled {
        let level = self.call.level.map(|level| self.int(level));
        let [x, y, z] = texture::size(texture, self.call.kind, level.map_or(0, |level| level.bits() as i32));
        Sampled::Bits([x, y, z, 0], level.is_none_or(Integer::sure))
    }

    fn fetch(&self, texture: &Texture) -> Sampled {
        let (at, sure) = self.ints(&self.call.coordinate);
        let (offset, _) = self.ints(&self.call.offset);
        let level = self.call.level.map(|level| self.int(level));
        let sure = sure && level.is_none_or(Integer::sure);
        let offset = &offset[..self.call.offset.len().min(3)];
        match texture::fetch(texture, self.call.kind, &at, level.map_or(0, |level| level.bits() as i32), offset) {
            Sampled::Bits(bits, _) => Sampled::Bits(bits, sure),
            Sampled::Floats(values) if sure => Sampled::Floats(values),
            Sampled::Floats(values) => {
                Sampled::Floats(values.map(|near| Near { value: near.value, error: f64::INFINITY }))
            }
        }
    }

    fn filtered(&self, texture: &Texture, stage: Stage) -> Sampled {
        let kind = self.call.kind;
        let axes = self.call.coordinate.len().saturating_sub(usize::from(kind.arrayed));
        let (coordinate, layer) = self.call.coordinate.split_at(axes);
        let at = self.nears(coordinate);
        let bounded = D::Float::with_error(0.0, 1.0).error() > 0.0;
        let request = Request {
            kind,
            at,
            layer: layer.first().map_or(Near::default(), |layer| self.near(*layer)),
            reference: self.call.reference.map_or(Near::default(), |reference| self.near(reference)),
            level: if texture.filter == Filter::Trilinear { self.level(texture, stage, at) } else { Near::default() },
            offset: self.ints(&self.call.offset).0,
            bounded,
        };
        texture::sample(texture, &request)
    }

    /// The level of detail.
    fn level(&self, texture: &Texture, stage: Stage, at: [Near; 3]) -> Near {
        let given = self.call.level.map_or(Near::default(), |level| self.near(level));
        let gradients = match self.call.lookup {
            Lookup::Lod => return given,
            Lookup::Grad => {
                let values = |operands: &[Operand]| self.nears(operands).map(|near| near.value);
                Gradients { dx: values(&self.call.dx), dy: values(&self.call.dy) }
            }
            // Outside fragment stages there are no derivatives: the base level (§8.7).
            _ if stage != Stage::Fragment || self.call.kind.dim == SamplerDim::Rect => return given,
            _ => self.quad_gradients(),
        };
        let lambda = texture::level_of_detail(texture, self.call.kind, at.map(|near| near.value), gradients);
        Near { value: lambda + given.value, error: given.error + rules::LEVEL_OF_DETAIL.allowance.at(lambda, 0.0) }
    }

    /// Differences of the coordinates in the lane's quad.
    fn quad_gradients(&self) -> Gradients {
        let first = self.lane & !3;
        let difference = |operand: Operand, from: usize, to: usize| {
            let lanes = self.registers.float(operand);
            lanes.at((first + to) % LANES).value() - lanes.at((first + from) % LANES).value()
        };
        let row = self.lane & 2;
        let column = self.lane & 1;
        let of = |from: usize, to: usize| -> [f64; 3] {
            std::array::from_fn(|k| self.call.coordinate.get(k).map_or(0.0, |operand| difference(*operand, from, to)))
        };
        // The sign of a step does not matter for its length.
        Gradients { dx: of(row, row + 1), dy: of(column, column + 2) }
    }
}
