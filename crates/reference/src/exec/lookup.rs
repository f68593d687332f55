//! Runs texture instructions: turns operands of lanes and quads into lookups, one lane at a time.

use super::inst::{Lookup, Operand, TextureCall};
use super::machine::Machine;
use super::registers::Registers;
use super::{LANES, Mask};
use crate::domain::{Corner, Domain, Integer, Number, limits, rules};
use crate::texture::{self, BoundedFloat, BoundedInt, Gradients, MISSING, Request, Sampled, Steps};
use glisten_front::hir::{SamplerDim, Scalar, Stage};
use glisten_scene::Texture;
use glisten_scene::picture::Interval;

impl<D: Domain> Machine<D> {
    /// Runs a texture instruction in these lanes. Returns the lanes whose texture is undecided.
    pub(super) fn texture(&mut self, call: &TextureCall, stage: Stage, mask: u64) -> u64 {
        if self.texture_once(call, stage) || self.fetch_plain(call, mask) {
            return 0;
        }
        let mut undecided = 0;
        for lane in Mask(mask).lanes() {
            let slot = self.registers.int(call.sampler).at(lane);
            let bound = self.textures.get(slot.bits() as usize).and_then(Option::as_deref);
            let lookup = LaneLookup { registers: &self.registers, call, lane, second: false };
            let sampled = lookup.sampled(bound, stage);
            if D::Float::PAIRED {
                let second = LaneLookup { second: true, ..lookup }.sampled(bound, stage);
                self.put_pair(call, lane, sampled, second);
            } else if slot.is_decided() {
                self.put(call, lane, sampled);
            } else {
                undecided |= 1 << lane;
                self.put(call, lane, sampled.unknown());
            }
        }
        undecided
    }

    fn put(&mut self, call: &TextureCall, lane: usize, sampled: Sampled) {
        for (k, result) in call.results.iter().enumerate() {
            match sampled {
                Sampled::Floats(values) => {
                    self.registers.floats.register(*result).spread().set(lane, number(values[k % 4]));
                }
                Sampled::Ints(bits) => {
                    let BoundedInt { bits, low, high } = bits[k % 4];
                    self.registers.ints.register(*result).spread().set(lane, D::Int::with_interval(bits, low, high));
                }
            }
        }
    }
}

/// A component of a result, as the domain has it.
#[inline(always)]
pub(super) fn number<N: Number>(BoundedFloat { value, low, high }: BoundedFloat) -> N {
    N::with_interval(value, Interval { low, high, may_be_nan: value.is_nan() })
}

impl<D: Domain> Machine<D> {
    /// Stores the result for the coordinates and that for the second values of the coordinates.
    fn put_pair(&mut self, call: &TextureCall, lane: usize, sampled: Sampled, second: Sampled) {
        for (k, result) in call.results.iter().enumerate() {
            match (sampled, second) {
                (Sampled::Floats(a), Sampled::Floats(b)) => {
                    self.registers
                        .floats
                        .register(*result)
                        .spread()
                        .set(lane, D::Float::paired(a[k % 4].value, b[k % 4].value));
                }
                (Sampled::Ints(a), Sampled::Ints(b)) => {
                    self.registers
                        .ints
                        .register(*result)
                        .spread()
                        .set(lane, D::Int::paired(a[k % 4].bits, b[k % 4].bits));
                }
                // An instruction yields only one kind.
                _ => {}
            }
        }
    }
}

fn nothing(call: &TextureCall) -> Sampled {
    if call.kind.texel == Scalar::Float || call.kind.shadow {
        Sampled::Floats(MISSING.map(BoundedFloat::exact))
    } else {
        Sampled::Ints([0, 0, 0, 1].map(BoundedInt::exact))
    }
}

/// A texture instruction in one lane.
pub(super) struct LaneLookup<'a, D: Domain> {
    pub(super) registers: &'a Registers<D>,
    pub(super) call: &'a TextureCall,
    pub(super) lane: usize,
    /// Whether to use the second values.
    pub(super) second: bool,
}

impl<D: Domain> LaneLookup<'_, D> {
    pub(super) fn sampled(&self, texture: Option<&Texture>, stage: Stage) -> Sampled {
        match (texture, self.call.lookup) {
            (None, Lookup::Size | Lookup::Levels) => Sampled::Ints([BoundedInt::default(); 4]),
            (None, _) => nothing(self.call),
            (Some(texture), Lookup::Size) => self.size(texture),
            (Some(texture), Lookup::Fetch) => self.fetch(texture),
            (Some(texture), Lookup::Levels) => Sampled::Ints([BoundedInt::exact(texture.levels.len() as u32); 4]),
            (Some(texture), Lookup::Gather) => {
                let component = self.call.component.map_or(0, |component| self.int(component).bits());
                texture::gather(texture, &self.request(texture, stage), component as usize)
            }
            (Some(texture), Lookup::QueryLod) => self.query_lod(texture, stage),
            (Some(texture), Lookup::Implicit | Lookup::Lod | Lookup::Grad) => {
                texture::sample(texture, &self.request(texture, stage))
            }
        }
    }

    fn bounded(&self, operand: Operand) -> BoundedFloat {
        let number = self.registers.float(operand).at(self.lane);
        if D::Float::PAIRED && self.second {
            return BoundedFloat::exact(number.second());
        }
        let value = number.value();
        if !D::HAS_INTERVALS {
            return BoundedFloat::exact(value);
        }
        let interval = number.interval();
        if interval.may_be_nan {
            BoundedFloat::anything(value)
        } else {
            BoundedFloat { value, low: interval.low, high: interval.high }
        }
    }

    fn int(&self, operand: Operand) -> D::Int {
        let int = self.registers.int(operand).at(self.lane);
        if D::Float::PAIRED && self.second { D::Int::from_bits(int.second()) } else { int }
    }

    fn all_bounded(&self, operands: &[Operand]) -> [BoundedFloat; 3] {
        std::array::from_fn(|k| operands.get(k).map_or(BoundedFloat::default(), |operand| self.bounded(*operand)))
    }

    fn ints(&self, operands: &[Operand]) -> [i32; 3] {
        std::array::from_fn(|k| operands.get(k).map_or(0, |operand| self.int(*operand).bits() as i32))
    }

    fn size(&self, texture: &Texture) -> Sampled {
        let level = self.call.level.map(|level| self.int(level));
        let [x, y, z] = texture::size(texture, self.call.kind, level.map_or(0, |level| level.bits() as i32));
        let sizes = Sampled::Ints([x, y, z, 0].map(BoundedInt::exact));
        if level.is_none_or(Integer::is_decided) { sizes } else { sizes.unknown() }
    }

    /// Reads a texel. If the coordinates are undecided: the hull of those that they may select, if these are few.
    fn fetch(&self, texture: &Texture) -> Sampled {
        let offset = self.ints(&self.call.offset);
        let offset = &offset[..self.call.offset.len().min(3)];
        let level = self.call.level.map(|level| self.int(level));
        let at = self.ints(&self.call.coordinate);
        let of = |at: &[i32; 3]| {
            texture::fetch(texture, self.call.kind, at, level.map_or(0, |level| level.bits() as i32), offset)
        };
        let likely = of(&at);
        let mut intervals = [(0, 0); 3];
        for (interval, operand) in intervals.iter_mut().zip(&self.call.coordinate) {
            *interval = self.int(*operand).interval();
        }
        let count = intervals.iter().map(|(low, high)| i64::from(*high) - i64::from(*low) + 1);
        let count = count.fold(1i64, i64::saturating_mul);
        if count > limits::MOST_FETCHED || !level.is_none_or(Integer::is_decided) {
            return likely.unknown();
        }
        let mut hull = likely;
        if count > 1 {
            for z in intervals[2].0..=intervals[2].1 {
                for y in intervals[1].0..=intervals[1].1 {
                    for x in intervals[0].0..=intervals[0].1 {
                        hull = hull.joined(of(&[x, y, z]));
                    }
                }
            }
        }
        hull
    }

    /// The level that an implicit lookup reads between the first and the last, and the level of detail, which is at least
    /// that of the smallest normal step (GLSL 4.00 §8.9.1). A GPU computes it from its derivatives, which may be those of
    /// either row or column of the quad.
    fn query_lod(&self, texture: &Texture, stage: Stage) -> Sampled {
        // Without a mipmap filter, the base level is read.
        let last = if texture.filter.uses_levels() { texture.levels.len().saturating_sub(1) as f64 } else { 0.0 };
        let exact = self.level(texture, stage, self.all_bounded(&self.call.coordinate));
        let level = if D::HAS_INTERVALS && self.call.kind.dim != SamplerDim::Cube {
            let (x, y) = (self.step(texture, (0, 1), (2, 3)), self.step(texture, (0, 2), (1, 3)));
            let (low, high) = (x.low.max(y.low).log2(), x.high.max(y.high).log2());
            BoundedFloat { value: exact.value, low: low.min(exact.value), high: high.max(exact.value) }
        } else {
            exact
        };
        let limited = |level: f64, low: f64, high: f64| if level.is_nan() { low } else { level.clamp(low, high) };
        let level = level.widened(limits::LEVEL_QUERY).map(|level| limited(level, -126.0, f64::INFINITY));
        let used = level.map(|level| limited(level, 0.0, last));
        Sampled::Floats([used, level, BoundedFloat::default(), BoundedFloat::default()])
    }

    /// The length in texels of a step between lanes of the quad, of which there are two pairs.
    fn step(&self, texture: &Texture, a: (usize, usize), b: (usize, usize)) -> BoundedFloat {
        let sizes =
            texture.levels.first().map_or([1.0; 3], |base| [base.width, base.height, base.depth].map(f64::from));
        let count = usize::from(self.call.kind.dimensions());
        let length = |(from, to): (usize, usize)| {
            let mut sum = (0.0, 0.0);
            for (operand, size) in self.call.coordinate.iter().zip(sizes).take(count) {
                let change = self.difference(*operand, from, to).map(|change| change * size);
                // Both ends are rounded before the difference.
                let at = self.bounded(*operand);
                let change = change.widened(2.0 * rules::ulp(at.low.abs().max(at.high.abs()) * size));
                let most = change.low.abs().max(change.high.abs());
                let least =
                    if change.low <= 0.0 && change.high >= 0.0 { 0.0 } else { change.low.abs().min(change.high.abs()) };
                sum = (sum.0 + least * least, sum.1 + most * most);
            }
            BoundedFloat { value: sum.0.sqrt(), low: sum.0.sqrt(), high: sum.1.sqrt() }
        };
        length(a).joined(length(b))
    }

    fn request(&self, texture: &Texture, stage: Stage) -> Request {
        let kind = self.call.kind;
        let axes = self.call.coordinate.len().saturating_sub(usize::from(kind.arrayed));
        let (coordinate, layer) = self.call.coordinate.split_at(axes);
        let at = self.all_bounded(coordinate);
        Request {
            kind,
            at,
            layer: layer.first().map_or(BoundedFloat::default(), |layer| self.bounded(*layer)),
            reference: self.call.reference.map_or(BoundedFloat::default(), |reference| self.bounded(reference)),
            level: if texture.filter.uses_levels() || texture.sampling.has_two_filters(texture.filter) {
                self.level(texture, stage, at)
            } else {
                BoundedFloat::default()
            },
            offset: self.ints(&self.call.offset),
            bounded: D::HAS_INTERVALS,
            weights: D::weights(),
            profile: self.registers.profile,
        }
    }

    /// The level of detail with the texture's own bias (OpenGL 3.2 §3.8.11), and the steps that the domain gives it.
    fn level(&self, texture: &Texture, stage: Stage, at: [BoundedFloat; 3]) -> BoundedFloat {
        let bias = f64::from(texture.sampling.lod_bias);
        self.unbiased_level(texture, stage, at).map(|level| D::stepped_level(level + bias))
    }

    /// The level of detail.
    fn unbiased_level(&self, texture: &Texture, stage: Stage, at: [BoundedFloat; 3]) -> BoundedFloat {
        let given = self.call.level.map_or(BoundedFloat::default(), |level| self.bounded(level));
        let (gradients, steps) = match self.call.lookup {
            Lookup::Lod => return given,
            Lookup::Grad => {
                let values = |operands: &[Operand]| self.all_bounded(operands).map(|bounded| bounded.value);
                let gradients = Gradients { dx: values(&self.call.dx), dy: values(&self.call.dy) };
                (gradients, D::HAS_INTERVALS.then(|| self.given_steps()))
            }
            // Outside fragment stages there are no derivatives: the base level (§8.7).
            _ if stage != Stage::Fragment || self.call.kind.dim == SamplerDim::Rect => return given,
            _ => (self.quad_gradients(), D::HAS_INTERVALS.then(|| self.quad_steps())),
        };
        let kind = self.call.kind;
        let texels = texture::steps_in_texels(texture, kind, at.map(|bounded| bounded.value), gradients);
        let lambda = texture::level_bounds(texture, kind, at, D::level(texels), steps.as_ref());
        BoundedFloat { value: lambda.value + given.value, low: lambda.low + given.low, high: lambda.high + given.high }
    }

    /// The explicit derivatives.
    fn given_steps(&self) -> Steps {
        let mut steps = Steps::default();
        for operands in [&self.call.dx, &self.call.dy] {
            operands.iter().enumerate().for_each(|(axis, operand)| steps.add(axis, self.bounded(*operand)));
        }
        steps
    }

    /// The difference of a coordinate between two lanes of the quad.
    fn difference(&self, operand: Operand, from: usize, to: usize) -> BoundedFloat {
        let first = self.lane & !3;
        let at = |lane: usize| LaneLookup { lane: (first + lane) % LANES, ..*self }.bounded(operand);
        let (a, b) = (at(from), at(to));
        BoundedFloat { value: b.value - a.value, low: b.low - a.high, high: b.high - a.low }
    }

    /// The differences of the coordinates in the lane's quad, for both rows and both columns.
    fn quad_steps(&self) -> Steps {
        let mut steps = Steps::default();
        for (axis, operand) in self.call.coordinate.iter().enumerate().take(3) {
            let either = |a: (usize, usize), b: (usize, usize)| {
                self.difference(*operand, a.0, a.1).joined(self.difference(*operand, b.0, b.1))
            };
            steps.add(axis, either((0, 1), (2, 3)));
            steps.add(axis, either((0, 2), (1, 3)));
        }
        steps
    }

    /// The differences of the coordinates in the lane's quad.
    fn quad_gradients(&self) -> Gradients {
        let (row, column) = match D::level_corner() {
            Some(Corner { lower, right }) => (2 * usize::from(lower), usize::from(right)),
            None => (self.lane & 2, self.lane & 1),
        };
        let of = |from: usize, to: usize| -> [f64; 3] {
            let value = |operand: &Operand| self.difference(*operand, from, to).value;
            std::array::from_fn(|k| self.call.coordinate.get(k).map_or(0.0, value))
        };
        // The sign of a step does not matter for its length.
        Gradients { dx: of(row, row + 1), dy: of(column, column + 2) }
    }
}
