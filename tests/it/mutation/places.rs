//! The mutations of constants, swizzles, interpolation qualifiers and positions.

use super::words::{Instruction, bound, encoded, instructions, op};
use super::{Kind, Mutation};
use glisten_front::hir::Stage;
use std::collections::BTreeMap;

/// The bits of a constant's fraction that are flipped, counted from the lowest. The lowest eight are not flipped, as
/// that may be within what a GPU is allowed.
const FLIPPED_BITS: [u32; 4] = [8, 11, 14, 18];

/// Decorations (§3.20).
const QUALIFIERS: [(u32, &str); 3] = [(FLAT, "flat"), (NO_PERSPECTIVE, "noperspective"), (CENTROID, "centroid")];
const BUILT_IN: u32 = 11;
const NO_PERSPECTIVE: u32 = 13;
const FLAT: u32 = 14;
const CENTROID: u32 = 16;
const LOCATION: u32 = 30;
/// The number of the built-in variable for the position.
const POSITION: u32 = 0;
/// The storage class of inputs.
const INPUT: u32 = 1;

/// A change of one component of the position: times `factor`, plus `shift` times w.
struct Nudge {
    name: &'static str,
    component: u32,
    factor: f32,
    shift: f32,
}

/// The side of a picture in pixels; half of it is one unit of normalized device coordinates.
const SIDE: f32 = super::SIDE as f32;

const NUDGES: [Nudge; 6] = [
    Nudge { name: "x is 1/256 pixel off", component: 0, factor: 1.0, shift: 2.0 / SIDE / 256.0 },
    Nudge { name: "x is 1/16 pixel off", component: 0, factor: 1.0, shift: 2.0 / SIDE / 16.0 },
    Nudge { name: "x is 1 ulp off", component: 0, factor: 1.0 + f32::EPSILON, shift: 0.0 },
    Nudge { name: "y is 2^-12 of itself off", component: 1, factor: 1.0 + 1.0 / 4096.0, shift: 0.0 },
    Nudge { name: "z is 2^-12 of itself off", component: 2, factor: 1.0 + 1.0 / 4096.0, shift: 0.0 },
    Nudge { name: "w is 2^-12 of itself off", component: 3, factor: 1.0 + 1.0 / 4096.0, shift: 0.0 },
];

/// The declarations of a module.
pub(super) struct Declared<'a> {
    instructions: &'a [Instruction<'a>],
    /// The type of 32-bit floats.
    float: Option<u32>,
    /// Vector types: the number of components.
    vectors: BTreeMap<u32, u32>,
    /// Pointer types: the pointee.
    pointers: BTreeMap<u32, u32>,
    /// Variables: their pointer type and storage class.
    variables: BTreeMap<u32, (u32, u32)>,
    /// Constants of 32 bits: their type and bits.
    constants: BTreeMap<u32, (u32, u32)>,
    bound: u32,
}

impl<'a> Declared<'a> {
    pub(super) fn of(words: &[u32], instructions: &'a [Instruction<'a>]) -> Self {
        let of = |opcode: u16| instructions.iter().filter(move |instruction| instruction.opcode() == opcode);
        Self {
            instructions,
            float: of(op::TYPE_FLOAT).find(|float| float.word(2) == 32).map(|float| float.word(1)),
            vectors: of(op::TYPE_VECTOR).map(|vector| (vector.word(1), vector.word(3))).collect(),
            pointers: of(op::TYPE_POINTER).map(|pointer| (pointer.word(1), pointer.word(3))).collect(),
            variables: of(op::VARIABLE)
                .map(|variable| (variable.word(2), (variable.word(1), variable.word(3))))
                .collect(),
            constants: of(op::CONSTANT).map(|one| (one.word(2), (one.word(1), one.word(3)))).collect(),
            bound: bound(words),
        }
    }

    /// The number of components of a vector variable, and its type.
    fn vector(&self, variable: u32) -> Option<(u32, u32)> {
        let ty = *self.pointers.get(&self.variables.get(&variable)?.0)?;
        Some((*self.vectors.get(&ty)?, ty))
    }

    fn decorations(&self, target: u32) -> impl Iterator<Item = &Instruction<'a>> {
        let all = self.instructions.iter().filter(|instruction| instruction.opcode() == op::DECORATE);
        all.filter(move |decoration| decoration.word(1) == target)
    }

    /// Changes of a nonzero float constant: one bit of its fraction is flipped.
    pub(super) fn constants(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let bits = instruction.word(3);
        let is_float = instruction.opcode() == op::CONSTANT && Some(instruction.word(1)) == self.float;
        if !is_float || f32::from_bits(bits) == 0.0 {
            return Vec::new();
        }
        let flipped = |bit: u32| {
            let (id, before, after) = (instruction.word(2), f32::from_bits(bits), f32::from_bits(bits ^ 1 << bit));
            let name = format!("%{id} constant {before} becomes {after} (bit {bit})");
            Mutation::new(Kind::Constant, name, instruction.with(3, bits ^ 1 << bit))
        };
        FLIPPED_BITS.into_iter().map(flipped).collect()
    }

    /// Changes of the component that is selected.
    pub(super) fn swizzle(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let last = instruction.words.len() - 1;
        let made = |place: usize, word: u32, name: String| {
            (word != instruction.word(place)).then(|| Mutation::new(Kind::Swizzle, name, instruction.with(place, word)))
        };
        let id = instruction.word(2);
        match instruction.opcode() {
            // Each component is replaced by the next in the list, which the operands certainly have.
            op::VECTOR_SHUFFLE => (5..=last)
                .filter_map(|place| {
                    let next = instruction.word(if place == last { 5 } else { place + 1 });
                    made(place, next, format!("%{id} VectorShuffle takes component {next} at {}", place - 5))
                })
                .collect(),
            op::COMPOSITE_EXTRACT => {
                let index = instruction.word(last);
                let other = if index == 0 { 1 } else { index - 1 };
                made(last, other, format!("%{id} CompositeExtract takes {other}, not {index}")).into_iter().collect()
            }
            op::ACCESS_CHAIN if last == 4 => self.component(instruction).into_iter().collect(),
            _ => Vec::new(),
        }
    }

    /// A component of a vector variable.
    fn component(&self, instruction: Instruction<'_>) -> Option<Mutation> {
        let (count, _) = self.vector(instruction.word(3))?;
        let (ty, index) = *self.constants.get(&instruction.word(4))?;
        let wanted = (ty, (index + 1) % count);
        let other = self.constants.iter().find(|(_, constant)| **constant == wanted)?.0;
        let name = format!("%{} AccessChain takes component {}, not {index}", instruction.word(2), wanted.1);
        Some(Mutation::new(Kind::Swizzle, name, instruction.with(4, *other)))
    }

    /// Adds or removes a qualifier of an input of a fragment stage.
    pub(super) fn qualifiers(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let (variable, decoration) = (instruction.word(1), instruction.word(2));
        let is_input = self.variables.get(&variable).is_some_and(|(_, class)| *class == INPUT);
        if instruction.opcode() != op::DECORATE || !is_input {
            return Vec::new();
        }
        let named = |what: &str, name: &str| format!("%{variable} {what} `{name}`");
        if let Some((_, name)) = QUALIFIERS.iter().find(|(number, _)| *number == decoration) {
            let without = instruction.replaced(Vec::new());
            return vec![Mutation::new(Kind::Qualifier, named("loses", name), without)];
        }
        let has = |wanted: u32| self.decorations(variable).any(|decoration| decoration.word(2) == wanted);
        // `flat` and `noperspective` exclude each other and everything else.
        let free = !has(FLAT) && !has(NO_PERSPECTIVE);
        let added = QUALIFIERS.iter().filter(|(number, _)| decoration == LOCATION && free && !has(*number));
        added
            .map(|(number, name)| {
                let words = encoded(op::DECORATE, &[variable, *number]);
                Mutation::new(Kind::Qualifier, named("becomes", name), instruction.preceded(words))
            })
            .collect()
    }

    /// Changes a position slightly where it is stored.
    pub(super) fn positions(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let pointer = instruction.word(1);
        let is_position = |decoration: &Instruction<'_>| decoration.words[2..] == [BUILT_IN, POSITION];
        if instruction.opcode() != op::STORE || !self.decorations(pointer).any(is_position) {
            return Vec::new();
        }
        NUDGES.iter().filter_map(|nudge| self.nudged(instruction, nudge)).collect()
    }

    fn nudged(&self, store: Instruction<'_>, nudge: &Nudge) -> Option<Mutation> {
        let (float, (_, vector)) = (self.float?, self.vector(store.word(1))?);
        let value = store.word(2);
        let mut ids = self.bound..;
        let [factor, shift, old, w, scaled, shifted, sum, new] = std::array::from_fn(|_| ids.next().unwrap_or(0));
        let constants = [(factor, nudge.factor), (shift, nudge.shift)]
            .map(|(id, value)| encoded(op::CONSTANT, &[float, id, value.to_bits()]));
        let code = [
            encoded(op::COMPOSITE_EXTRACT, &[float, old, value, nudge.component]),
            encoded(op::COMPOSITE_EXTRACT, &[float, w, value, 3]),
            encoded(op::F_MUL, &[float, scaled, old, factor]),
            encoded(op::F_MUL, &[float, shifted, w, shift]),
            encoded(op::F_ADD, &[float, sum, scaled, shifted]),
            encoded(op::COMPOSITE_INSERT, &[vector, new, sum, value, nudge.component]),
            encoded(op::STORE, &[store.word(1), new]),
        ];
        let first = self.instructions.iter().find(|instruction| instruction.opcode() == op::FUNCTION)?;
        let splices = vec![first.preceded(constants.concat()), store.replaced(code.concat())];
        Some(Mutation { kind: Kind::Vertex, name: nudge.name.to_owned(), splices, more_ids: 8 })
    }
}

/// All mutations other than those of operations.
pub(super) fn places(words: &[u32], stage: Stage) -> Vec<Mutation> {
    let list = instructions(words);
    let declared = Declared::of(words, &list);
    let mut found = Vec::new();
    for instruction in &list {
        found.extend(declared.constants(*instruction));
        found.extend(declared.swizzle(*instruction));
        match stage {
            Stage::Fragment => found.extend(declared.qualifiers(*instruction)),
            _ => found.extend(declared.positions(*instruction)),
        }
    }
    found
}
