//! The mutations of constants, swizzles, interpolation qualifiers and positions.

use super::module::decoration::{BUILT_IN, CENTROID, FLAT, LOCATION, NO_PERSPECTIVE};
use super::module::{Builder, Module, Type, class};
use super::words::{Instruction, encoded, op};
use super::{Kind, Mutation};
use glisten_front::hir::Stage;

/// The bits of a constant's fraction that are flipped, counted from the lowest: changes by 2^-12, 2^-9 and 2^-5, about as much
/// as digits that are missing.
const FLIPPED_BITS: [u32; 3] = [11, 14, 18];

/// The qualifiers, by their decorations.
const QUALIFIERS: [(u32, &str); 3] = [(FLAT, "flat"), (NO_PERSPECTIVE, "noperspective"), (CENTROID, "centroid")];
/// The number of the built-in variable for the position.
const POSITION: u32 = 0;

/// A change of one component of the position: times `factor`, plus `shift` times w.
struct Nudge {
    name: &'static str,
    component: u32,
    factor: f32,
    shift: f32,
}

/// The side of a picture in pixels; half of it is one unit of normalized device coordinates.
const SIDE: f32 = super::SIDE as f32;

/// A GPU may snap positions to 1/16 pixel (Vulkan, `subPixelPrecisionBits`), so a shift by 1/32 pixel is no fault. All of
/// these are larger, except for that of depth.
const NUDGES: [Nudge; 5] = [
    Nudge { name: "x is 1/16 pixel off", component: 0, factor: 1.0, shift: 2.0 / SIDE / 16.0 },
    Nudge { name: "x is 1/4 pixel off", component: 0, factor: 1.0, shift: 2.0 / SIDE / 4.0 },
    Nudge { name: "y is 2^-8 of itself off", component: 1, factor: 1.0 + 1.0 / 256.0, shift: 0.0 },
    Nudge { name: "z is 2^-12 of itself off", component: 2, factor: 1.0 + 1.0 / 4096.0, shift: 0.0 },
    Nudge { name: "w is 2^-8 of itself off", component: 3, factor: 1.0 + 1.0 / 256.0, shift: 0.0 },
];

/// The sources of mutations in a module.
struct Places<'m, 'a>(&'m Module<'a>);

impl Places<'_, '_> {
    /// The number of components of a vector variable, and its type.
    fn vector(&self, variable: u32) -> Option<(u32, u32)> {
        let ty = self.0.pointee(variable)?;
        Some((self.0.components(ty).1, ty)).filter(|(count, _)| *count > 1)
    }

    /// Changes of a nonzero float constant: one bit of its fraction is flipped.
    fn constants(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let bits = instruction.word(3);
        let is_float = instruction.opcode() == op::CONSTANT && self.0.ty(instruction.word(1)) == Type::Float;
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
    fn swizzle(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
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
        let (ty, index) = *self.0.constants.get(&instruction.word(4))?;
        let wanted = (ty, (index + 1) % count);
        let other = self.0.constants.iter().find(|(_, constant)| **constant == wanted)?.0;
        let name = format!("%{} AccessChain takes component {}, not {index}", instruction.word(2), wanted.1);
        Some(Mutation::new(Kind::Swizzle, name, instruction.with(4, *other)))
    }

    /// Adds or removes a qualifier of an input of a fragment stage.
    fn qualifiers(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let (variable, decoration) = (instruction.word(1), instruction.word(2));
        let is_input = self.0.variables.get(&variable).is_some_and(|(_, class)| *class == class::INPUT);
        if instruction.opcode() != op::DECORATE || !is_input {
            return Vec::new();
        }
        let named = |what: &str, name: &str| format!("%{variable} {what} `{name}`");
        if let Some((_, name)) = QUALIFIERS.iter().find(|(number, _)| *number == decoration) {
            let without = instruction.replaced(Vec::new());
            return vec![Mutation::new(Kind::Qualifier, named("loses", name), without)];
        }
        let has = |wanted: u32| self.0.decorations(variable).any(|decoration| decoration.word(2) == wanted);
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
    fn positions(&self, instruction: Instruction<'_>) -> Vec<Mutation> {
        let pointer = instruction.word(1);
        let is_position = |decoration: &Instruction<'_>| decoration.words[2..] == [BUILT_IN, POSITION];
        if instruction.opcode() != op::STORE || !self.0.decorations(pointer).any(is_position) {
            return Vec::new();
        }
        NUDGES.iter().filter_map(|nudge| self.nudged(instruction, nudge)).collect()
    }

    fn nudged(&self, store: Instruction<'_>, nudge: &Nudge) -> Option<Mutation> {
        let (float, (_, vector)) = (self.0.type_id(Type::Float)?, self.vector(store.word(1))?);
        let value = store.word(2);
        let mut builder = Builder::new(self.0);
        let [old, w, scaled, shifted, sum, new] = std::array::from_fn(|_| builder.id());
        let [factor, shift] = [nudge.factor, nudge.shift].map(|number| builder.float(float, number));
        let code = vec![
            encoded(op::COMPOSITE_EXTRACT, &[float, old, value, nudge.component]),
            encoded(op::COMPOSITE_EXTRACT, &[float, w, value, 3]),
            encoded(op::F_MUL, &[float, scaled, old, factor]),
            encoded(op::F_MUL, &[float, shifted, w, shift]),
            encoded(op::F_ADD, &[float, sum, scaled, shifted]),
            encoded(op::COMPOSITE_INSERT, &[vector, new, sum, value, nudge.component]),
            encoded(op::STORE, &[store.word(1), new]),
        ];
        builder.replace(&store, code);
        Some(Mutation { kind: Kind::Vertex, name: nudge.name.to_owned(), rewrite: builder.finish() })
    }
}

/// All of these mutations.
pub(super) fn places(module: &Module<'_>, stage: Stage) -> Vec<Mutation> {
    let places = Places(module);
    let mut found = Vec::new();
    for instruction in module.instructions {
        found.extend(places.constants(*instruction));
        found.extend(places.swizzle(*instruction));
        match stage {
            Stage::Fragment => found.extend(places.qualifiers(*instruction)),
            _ => found.extend(places.positions(*instruction)),
        }
    }
    found
}
