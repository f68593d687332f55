//! Faults of texture lookups: operands that are dropped, off or exchanged (SPIR-V §3.14, §3.32.10).
//!
//! *In:* a module. *Out:* mutations.

use super::module::{Builder, Module};
use super::words::{Instruction, encoded, op};
use super::{Kind, Mutation};

const IMPLICIT: u16 = 87;
const EXPLICIT: u16 = 88;
const COMPARE_IMPLICIT: u16 = 89;
const COMPARE_EXPLICIT: u16 = 90;
const FETCH: u16 = 95;

/// The bits of image operands, in the order of their words, with the number of words.
const OPERANDS: [(u32, usize); 6] = [(BIAS, 1), (LOD, 1), (GRAD, 2), (CONST_OFFSET, 1), (8 << 1, 1), (8 << 2, 1)];
const BIAS: u32 = 1;
const LOD: u32 = 2;
const GRAD: u32 = 4;
const CONST_OFFSET: u32 = 8;

/// A lookup: where its optional operands are.
struct Lookup<'m, 'a> {
    module: &'m Module<'a>,
    one: &'a Instruction<'a>,
    /// The place of the mask; the operands follow.
    mask: usize,
}

/// All faults of lookups.
pub(super) fn faults(module: &Module<'_>) -> Vec<Mutation> {
    let mut found = Vec::new();
    for one in module.code() {
        let mask = match one.opcode() {
            IMPLICIT | EXPLICIT | FETCH => 5,
            COMPARE_IMPLICIT | COMPARE_EXPLICIT | 96 | 97 => 6,
            _ => continue,
        };
        let lookup = Lookup { module, one, mask };
        let all = [lookup.levels(), lookup.offsets(), lookup.gradients(), lookup.coordinates(), lookup.comparison()];
        found.extend(all.into_iter().flatten().flatten());
    }
    found
}

impl<'m, 'a> Lookup<'m, 'a> {
    fn builder(&self) -> Builder<'m, 'a> {
        Builder::new(self.module)
    }

    fn fault(&self, builder: Builder<'_, '_>, what: &str) -> Option<Mutation> {
        let name = format!("%{} texture lookup: {what}", self.one.word(2));
        Some(Mutation { kind: Kind::Image, name, rewrite: builder.finish() })
    }

    /// The place of an optional operand.
    fn place(&self, wanted: u32) -> Option<usize> {
        let mask = self.one.word(self.mask);
        let before = OPERANDS.iter().take_while(|(bit, _)| *bit != wanted).filter(|(bit, _)| mask & bit != 0);
        (mask & wanted != 0).then(|| self.mask + 1 + before.map(|(_, words)| words).sum::<usize>())
    }

    /// The instruction with another opcode, without one optional operand and with another one, which must come first.
    fn changed(&self, opcode: u16, without: u32, with: Option<(u32, u32)>) -> Vec<u32> {
        let mut operands = self.one.words[1..].to_vec();
        let index = self.mask - 1;
        if operands.len() == index {
            operands.push(0);
        }
        if let Some(place) = self.place(without) {
            operands.remove(place - 1);
            operands[index] &= !without;
        }
        if let Some((bit, id)) = with {
            operands[index] |= bit;
            operands.insert(index + 1, id);
        }
        if operands[index] == 0 {
            operands.truncate(index);
        }
        encoded(opcode, &operands)
    }

    /// The instruction after others, with another operand.
    fn with(&self, mut before: Vec<Vec<u32>>, place: usize, id: u32) -> Vec<Vec<u32>> {
        let mut words = self.one.words.to_vec();
        words[place] = id;
        before.push(words);
        before
    }

    fn levels(&self) -> Vec<Option<Mutation>> {
        let mut found = Vec::new();
        let opcode = self.one.opcode();
        if self.place(BIAS).is_some() {
            let mut builder = self.builder();
            builder.replace(self.one, vec![self.changed(opcode, BIAS, None)]);
            found.push(self.fault(builder, "the bias is dropped"));
        }
        if matches!(opcode, IMPLICIT | COMPARE_IMPLICIT) {
            found.push(self.explicit(opcode + 1));
        }
        let Some(place) = self.place(LOD) else { return found };
        let lod = self.one.word(place);
        let Some(ty) = self.module.type_of(lod) else { return found };
        if matches!(opcode, EXPLICIT | COMPARE_EXPLICIT) {
            let mut builder = self.builder();
            builder.replace(self.one, vec![self.changed(opcode - 1, LOD, None)]);
            found.push(self.fault(builder, "the explicit level of detail is dropped"));
        }
        let mut builder = self.builder();
        let zero = builder.splat(ty, 0);
        if zero != lod {
            builder.splices.push(self.one.with(place, zero));
            found.push(self.fault(builder, "the level of detail becomes 0"));
        }
        let mut builder = self.builder();
        let (add, one) = match self.module.is_float(ty) {
            true => (op::F_ADD, 1.0_f32.to_bits()),
            false => (op::I_ADD, 1),
        };
        let [step, more] = [builder.splat(ty, one), builder.id()];
        let code = self.with(vec![encoded(add, &[ty, more, lod, step])], place, more);
        builder.replace(self.one, code);
        found.push(self.fault(builder, "the level of detail is 1 more"));
        found
    }

    /// An implicit level of detail becomes level 0.
    fn explicit(&self, opcode: u16) -> Option<Mutation> {
        let mut builder = self.builder();
        let float = self.module.type_id(super::module::Type::Float)?;
        let zero = builder.float(float, 0.0);
        builder.replace(self.one, vec![self.changed(opcode, BIAS, Some((LOD, zero)))]);
        self.fault(builder, "the implicit level of detail becomes 0")
    }

    fn offsets(&self) -> Vec<Option<Mutation>> {
        let Some(place) = self.place(CONST_OFFSET) else { return Vec::new() };
        let mut dropped = self.builder();
        dropped.replace(self.one, vec![self.changed(self.one.opcode(), CONST_OFFSET, None)]);
        let mut found = vec![self.fault(dropped, "the offset is dropped")];
        let Some((_, constant)) = self.module.definition(self.one.word(place)) else { return found };
        let first = if constant.opcode() == op::CONSTANT_COMPOSITE { constant.word(3) } else { constant.word(2) };
        if let Some(&(ty, bits)) = self.module.constants.get(&first) {
            let mut builder = self.builder();
            let mut new = builder.constant(ty, bits.wrapping_add(1));
            if first != constant.word(2) {
                let mut words = constant.words[1..].to_vec();
                words[1] = builder.id();
                words[2] = new;
                new = words[1];
                builder.declare(op::CONSTANT_COMPOSITE, &words);
            }
            builder.splices.push(self.one.with(place, new));
            found.push(self.fault(builder, "the offset is one more"));
        }
        found
    }

    fn gradients(&self) -> Vec<Option<Mutation>> {
        let Some(place) = self.place(GRAD) else { return Vec::new() };
        let mut swapped = self.one.words.to_vec();
        swapped.swap(place, place + 1);
        let mut exchanged = self.builder();
        exchanged.replace(self.one, vec![swapped]);
        let mut found = vec![self.fault(exchanged, "the gradients are exchanged")];
        let dx = self.one.word(place);
        if let Some(ty) = self.module.type_of(dx) {
            let mut builder = self.builder();
            let [two, scaled] = [builder.float(ty, 2.0), builder.id()];
            let code = self.with(vec![encoded(op::F_MUL, &[ty, scaled, dx, two])], place, scaled);
            builder.replace(self.one, code);
            found.push(self.fault(builder, "the gradient along x is doubled"));
        }
        found
    }

    /// The projection dropped; `v` from the other side; `u` and `v` exchanged.
    fn coordinates(&self) -> Vec<Option<Mutation>> {
        let at = self.one.word(4);
        let Some((_, definition)) = self.module.definition(at) else { return Vec::new() };
        let ty = definition.word(1);
        let (scalar, count) = self.module.components(ty);
        let mut found = Vec::new();
        if definition.opcode() == op::F_DIV {
            let mut builder = self.builder();
            builder.splices.push(self.one.with(4, definition.word(3)));
            found.push(self.fault(builder, "the projection is dropped"));
        }
        if !self.module.is_float(ty) || count < 2 {
            return found;
        }
        let mut builder = self.builder();
        let [one, v, other, new] = [builder.float(scalar, 1.0), builder.id(), builder.id(), builder.id()];
        let flipped = vec![
            encoded(op::COMPOSITE_EXTRACT, &[scalar, v, at, 1]),
            encoded(op::F_SUB, &[scalar, other, one, v]),
            encoded(op::COMPOSITE_INSERT, &[ty, new, other, at, 1]),
        ];
        let code = self.with(flipped, 4, new);
        builder.replace(self.one, code);
        found.push(self.fault(builder, "v counts from the other side"));
        let mut builder = self.builder();
        let new = builder.id();
        let order: Vec<u32> = [ty, new, at, at, 1, 0].into_iter().chain(2..count).collect();
        let code = self.with(vec![encoded(op::VECTOR_SHUFFLE, &order)], 4, new);
        builder.replace(self.one, code);
        found.push(self.fault(builder, "u and v are exchanged"));
        found
    }

    /// The reference of a comparison reversed, a little off, or the comparison dropped.
    fn comparison(&self) -> Vec<Option<Mutation>> {
        if !matches!(self.one.opcode(), COMPARE_IMPLICIT | COMPARE_EXPLICIT | 97) {
            return Vec::new();
        }
        let reference = self.one.word(5);
        let Some(ty) = self.module.type_of(reference) else { return Vec::new() };
        let changed = |what: &str, opcode: u16, by: f32| {
            let mut builder = self.builder();
            let [number, new] = [builder.float(ty, by), builder.id()];
            let code = self.with(vec![encoded(opcode, &[ty, new, number, reference])], 5, new);
            builder.replace(self.one, code);
            self.fault(builder, what)
        };
        let mut found = vec![
            changed("the reference is reversed", op::F_SUB, 1.0),
            changed("the reference is 1/64 more", op::F_ADD, 1.0 / 64.0),
            changed("the reference is 1 % more", op::F_MUL, 1.01),
        ];
        let mut builder = self.builder();
        let lit = builder.float(self.one.word(1), 1.0);
        builder.replace(self.one, vec![encoded(op::COPY_OBJECT, &[self.one.word(1), self.one.word(2), lit])]);
        found.push(self.fault(builder, "the comparison is dropped"));
        found
    }
}
