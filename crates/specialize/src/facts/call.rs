//! [`Call`]: a built-in function with the facts of its arguments.

use super::{Fact, Facts, at};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{Scalar, TypeId, Types};

/// A call.
pub(crate) struct Call<'a> {
    /// The types of the program.
    pub(crate) types: &'a Types,
    /// The function.
    pub(crate) function: F,
    /// The facts and the type of each argument.
    pub(crate) arguments: &'a [(Facts, TypeId)],
    /// The type of the result.
    pub(crate) ty: TypeId,
    /// Whether the first two arguments are one and the same.
    pub(crate) twice: bool,
}

impl Call<'_> {
    pub(super) fn all(&self, argument: usize) -> &[Fact] {
        self.arguments.get(argument).map_or(&[], |(facts, _)| facts)
    }

    /// A component of an argument; a scalar is every component.
    pub(super) fn operand(&self, argument: usize, index: usize) -> Fact {
        match self.arguments.get(argument) {
            Some((facts, ty)) if self.types.flat_len(*ty) == 1 => at(facts, 0),
            Some((facts, _)) => at(facts, index),
            // There is none: it changes nothing.
            None => Fact { constant: true, ..Fact::ANY },
        }
    }

    pub(super) fn scalar(&self) -> Scalar {
        self.arguments.first().and_then(|(_, ty)| self.types.scalar_of(*ty)).unwrap_or(Scalar::Float)
    }

    pub(super) fn pairs(&self) -> Vec<(Fact, Fact)> {
        let len = self.arguments.first().map_or(0, |(_, ty)| self.types.flat_len(*ty) as usize);
        (0..len).map(|index| (at(self.all(0), index), at(self.all(1), index))).collect()
    }
}
