//! [`Module`]: the declarations of a module of SPIR-V, and [`Builder`]: changes of it that need more than one place.
//!
//! *In:* the words of a valid module. *Out:* the types, constants, variables and decorations by identifier; a
//! [`Rewrite`] with new constants and identifiers. *Not done here:* choosing what to change.

use super::Rewrite;
use super::words::{Instruction, Splice, bound, encoded, op};
use std::collections::BTreeMap;

/// Storage classes (§3.7).
pub(super) mod class {
    pub(crate) const INPUT: u32 = 1;
    pub(crate) const UNIFORM: u32 = 2;
    pub(crate) const OUTPUT: u32 = 3;
}

/// Decorations (§3.20).
pub(super) mod decoration {
    pub(crate) const ROW_MAJOR: u32 = 4;
    pub(crate) const COL_MAJOR: u32 = 5;
    pub(crate) const ARRAY_STRIDE: u32 = 6;
    pub(crate) const MATRIX_STRIDE: u32 = 7;
    pub(crate) const BUILT_IN: u32 = 11;
    pub(crate) const NO_PERSPECTIVE: u32 = 13;
    pub(crate) const FLAT: u32 = 14;
    pub(crate) const CENTROID: u32 = 16;
    pub(crate) const INVARIANT: u32 = 18;
    pub(crate) const NON_WRITABLE: u32 = 24;
    pub(crate) const LOCATION: u32 = 30;
    pub(crate) const BINDING: u32 = 33;
    pub(crate) const DESCRIPTOR_SET: u32 = 34;
    pub(crate) const OFFSET: u32 = 35;
    pub(crate) const NO_CONTRACTION: u32 = 42;
}

/// A type, as far as the changes need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Bool,
    /// Of 32 bits.
    Int {
        signed: bool,
    },
    /// Of 32 bits.
    Float,
    Vector {
        component: u32,
        count: u32,
    },
    Other,
}

/// The declarations of a module.
pub(super) struct Module<'a> {
    pub(super) instructions: &'a [Instruction<'a>],
    /// The index of the first instruction of a function.
    pub(super) body: usize,
    types: BTreeMap<u32, Type>,
    /// Pointer types: the storage class and the pointee.
    pub(super) pointers: BTreeMap<u32, (u32, u32)>,
    /// Variables: their pointer type and storage class.
    pub(super) variables: BTreeMap<u32, (u32, u32)>,
    /// Constants of 32 bits: their type and bits.
    pub(super) constants: BTreeMap<u32, (u32, u32)>,
    /// Results: the type and the place of the instruction in the list.
    results: BTreeMap<u32, (u32, usize)>,
    extended: u32,
    bound: u32,
}

fn ty(instruction: &Instruction<'_>) -> Option<(u32, Type)> {
    let ty = match instruction.opcode() {
        op::TYPE_BOOL => Type::Bool,
        op::TYPE_INT if instruction.word(2) == 32 => Type::Int { signed: instruction.word(3) == 1 },
        op::TYPE_FLOAT if instruction.word(2) == 32 => Type::Float,
        op::TYPE_VECTOR => Type::Vector { component: instruction.word(2), count: instruction.word(3) },
        19..=39 => Type::Other,
        _ => return None,
    };
    Some((instruction.word(1), ty))
}

impl<'a> Module<'a> {
    pub(super) fn of(words: &[u32], instructions: &'a [Instruction<'a>]) -> Self {
        let of = |opcode: u16| instructions.iter().filter(move |instruction| instruction.opcode() == opcode);
        let results = instructions.iter().enumerate().filter(|(_, one)| one.result() != 0);
        let is_function = |one: &Instruction<'_>| one.opcode() == op::FUNCTION;
        Self {
            instructions,
            body: instructions.iter().position(is_function).unwrap_or(instructions.len()),
            types: instructions.iter().filter_map(ty).collect(),
            pointers: of(op::TYPE_POINTER).map(|one| (one.word(1), (one.word(2), one.word(3)))).collect(),
            variables: of(op::VARIABLE).map(|one| (one.word(2), (one.word(1), one.word(3)))).collect(),
            constants: of(op::CONSTANT).map(|one| (one.word(2), (one.word(1), one.word(3)))).collect(),
            results: results.map(|(place, one)| (one.result(), (one.word(1), place))).collect(),
            extended: of(op::EXT_INST_IMPORT).next().map_or(0, |one| one.word(1)),
            bound: bound(words),
        }
    }

    /// The instructions of functions.
    pub(super) fn code(&self) -> &'a [Instruction<'a>] {
        self.instructions.get(self.body..).unwrap_or_default()
    }

    pub(super) fn ty(&self, id: u32) -> Type {
        self.types.get(&id).copied().unwrap_or(Type::Other)
    }

    /// The identifier of a type.
    pub(super) fn type_id(&self, wanted: Type) -> Option<u32> {
        self.types.iter().find(|(_, ty)| **ty == wanted).map(|(id, _)| *id)
    }

    /// The type of a value.
    pub(super) fn type_of(&self, value: u32) -> Option<u32> {
        self.results.get(&value).map(|(ty, _)| *ty)
    }

    /// The instruction whose result this is, and its place in the list.
    pub(super) fn definition(&self, value: u32) -> Option<(usize, &'a Instruction<'a>)> {
        let (_, place) = self.results.get(&value)?;
        Some((*place, self.instructions.get(*place)?))
    }

    /// The type of the components of a vector, or the type itself, and their number.
    pub(super) fn components(&self, ty: u32) -> (u32, u32) {
        match self.ty(ty) {
            Type::Vector { component, count } => (component, count),
            _ => (ty, 1),
        }
    }

    /// Whether a type is a float or a vector of them.
    pub(super) fn is_float(&self, ty: u32) -> bool {
        self.ty(self.components(ty).0) == Type::Float
    }

    /// Whether a type is a 32-bit integer or a vector of them.
    pub(super) fn is_int(&self, ty: u32) -> bool {
        matches!(self.ty(self.components(ty).0), Type::Int { .. })
    }

    /// The type that a variable holds.
    pub(super) fn pointee(&self, variable: u32) -> Option<u32> {
        self.pointers.get(&self.variables.get(&variable)?.0).map(|(_, pointee)| *pointee)
    }

    pub(super) fn decorations(&self, target: u32) -> impl Iterator<Item = &'a Instruction<'a>> {
        let all = self.instructions.iter().filter(|instruction| instruction.opcode() == op::DECORATE);
        all.filter(move |decoration| decoration.word(1) == target)
    }

    /// The decoration of a target.
    pub(super) fn decoration(&self, target: u32, wanted: u32) -> Option<&'a Instruction<'a>> {
        self.decorations(target).find(|decoration| decoration.word(2) == wanted)
    }

    /// Whether a variable is this built-in one of a storage class.
    pub(super) fn is_built_in(&self, variable: u32, class: u32, built_in: u32) -> bool {
        let has_class = self.variables.get(&variable).is_some_and(|(_, of)| *of == class);
        has_class && self.decoration(variable, decoration::BUILT_IN).is_some_and(|one| one.word(3) == built_in)
    }

    /// The number that a constant float is, or a constant vector in each component.
    pub(super) fn float_constant(&self, value: u32) -> Option<f32> {
        let number = |id: u32| {
            let (ty, bits) = *self.constants.get(&id)?;
            (self.ty(ty) == Type::Float).then(|| f32::from_bits(bits))
        };
        let (_, one) = self.definition(value)?;
        if one.opcode() != op::CONSTANT_COMPOSITE {
            return number(value);
        }
        let first = number(one.word(3))?;
        one.words[3..].iter().all(|id| number(*id) == Some(first)).then_some(first)
    }

    /// How many operands refer to a value.
    pub(super) fn uses(&self, value: u32) -> usize {
        let of = |one: &Instruction<'_>| one.words.iter().skip(1).filter(|word| **word == value).count();
        let all: usize = self.code().iter().map(of).sum();
        // The definition itself contains the identifier.
        all.saturating_sub(1)
    }

    /// Whether no label is between two places.
    pub(super) fn is_one_block(&self, from: usize, to: usize) -> bool {
        self.instructions.get(from..to).is_some_and(|part| part.iter().all(|one| one.opcode() != op::LABEL))
    }
}

/// A change of several places, with new identifiers.
pub(super) struct Builder<'m, 'a> {
    pub(super) module: &'m Module<'a>,
    used: u32,
    globals: Vec<u32>,
    made: BTreeMap<(u32, u32), u32>,
    pub(super) splices: Vec<Splice>,
}

impl<'m, 'a> Builder<'m, 'a> {
    pub(super) fn new(module: &'m Module<'a>) -> Self {
        Self { module, used: 0, globals: Vec::new(), made: BTreeMap::new(), splices: Vec::new() }
    }

    /// A new identifier.
    pub(super) fn id(&mut self) -> u32 {
        self.used += 1;
        self.module.bound + self.used - 1
    }

    /// Declares something before all functions.
    pub(super) fn declare(&mut self, opcode: u16, operands: &[u32]) {
        self.globals.extend(encoded(opcode, operands));
    }

    /// A constant of a scalar type.
    pub(super) fn constant(&mut self, ty: u32, bits: u32) -> u32 {
        let known = self.module.constants.iter().find(|(_, constant)| **constant == (ty, bits));
        if let Some(id) = known.map(|(id, _)| *id).or_else(|| self.made.get(&(ty, bits)).copied()) {
            return id;
        }
        let id = self.id();
        self.declare(op::CONSTANT, &[ty, id, bits]);
        self.made.insert((ty, bits), id);
        id
    }

    /// A float in each component of a type.
    pub(super) fn float(&mut self, ty: u32, value: f32) -> u32 {
        self.splat(ty, value.to_bits())
    }

    /// A constant in each component of a type.
    pub(super) fn splat(&mut self, ty: u32, bits: u32) -> u32 {
        let (scalar, count) = self.module.components(ty);
        let one = self.constant(scalar, bits);
        if count == 1 {
            return one;
        }
        let id = self.id();
        let operands: Vec<u32> = [ty, id].into_iter().chain((0..count).map(|_| one)).collect();
        self.declare(op::CONSTANT_COMPOSITE, &operands);
        id
    }

    /// An instruction of GLSL.std.450.
    pub(super) fn extended(&self, ty: u32, result: u32, number: u32, operands: &[u32]) -> Vec<u32> {
        let head = [ty, result, self.module.extended, number];
        encoded(op::EXT_INST, &head.into_iter().chain(operands.iter().copied()).collect::<Vec<_>>())
    }

    pub(super) fn replace(&mut self, instruction: &Instruction<'_>, code: Vec<Vec<u32>>) {
        self.splices.push(instruction.replaced(code.concat()));
    }

    /// The change as a whole.
    pub(super) fn finish(mut self) -> Rewrite {
        if let Some(first) = self.module.instructions.get(self.module.body)
            && !self.globals.is_empty()
        {
            self.splices.push(first.preceded(self.globals));
        }
        self.splices.sort_by_key(|splice| (splice.at, splice.len));
        Rewrite::Words { splices: self.splices, more_ids: self.used }
    }
}
