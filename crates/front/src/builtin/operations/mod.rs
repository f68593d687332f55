//! The table of operations: the definition of each operator on floats and each built-in function (GLSL 1.50 §5.9,
//! §8).
//!
//! *In:* nothing. *Out:* the identities [`BuiltinFunction`], [`Unary`], [`Binary`], [`Ternary`] and [`Composite`],
//! and the properties of each: name, class, cost, precision, continuity, texture lookup. *Holds:* a property of an
//! operation is defined only in its row of `table`. Phases that process operations (folding, execution, lowering)
//! match the [`Class`] without a wildcard, so a new row does not compile until each of them supports it. *Not done
//! here:* the prototypes with their versions and stages ([`functions`](super::functions)), which name their identity.

mod bits;
mod class;
mod cost;
mod formula;
pub mod kernel;
pub mod precision;
mod table;
mod texture;

pub use bits::{from_half, to_half};
pub use class::{
    BitCast, BitFunction, BooleanFunction, Class, Derivative, DerivativeAxis, DerivativeControl, Emission, Format,
    MatrixFunction, Noise, Numbers, Packing, Relation, Test,
};
pub use cost::{CallCost, Linear};
pub use formula::Formula;
pub use precision::{Precision, Rule};
pub use table::{Binary, BuiltinFunction, Composite, Ternary, Unary};
pub use texture::{Lookup, TextureArgument, TextureForm};

/// The row of a built-in function.
#[derive(Clone, Copy, Debug)]
pub struct Operation {
    /// The identity of the function.
    pub function: BuiltinFunction,
    /// The name in GLSL. Only the prototypes contain older names of a computation (`texture2D`).
    pub name: &'static str,
    /// The kind of computation.
    pub class: Class,
    /// The cost of a call.
    pub cost: CallCost,
    /// The error that a conforming GPU may add; `None` if the result is not computed floats.
    pub rule: Option<&'static Rule>,
}

impl Operation {
    /// Whether the function is discontinuous.
    pub fn jumps(&self) -> bool {
        match self.class {
            Class::Unary(op) => op.jumps(),
            Class::Binary(op) => op.jumps(),
            Class::Ternary(op) => op.jumps(),
            Class::Composite(op) => op.jumps(),
            Class::Numbers(op) => op.jumps(),
            Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::BitCast(_)
            | Class::Bits(_)
            | Class::Packing(_)
            | Class::Composed
            | Class::Modf => true,
            Class::Matrix(_) | Class::Derivative(_) | Class::Noise(_) | Class::Texture(_) | Class::Emission(_) => false,
        }
    }

    /// The number of the argument that a call writes (§8.3), if it writes one.
    pub fn written_argument(&self) -> Option<usize> {
        match self.class {
            Class::Modf => Some(1),
            // What these write is assigned by the operations that the analysis writes out for them.
            Class::Composed => None,
            Class::Unary(_)
            | Class::Binary(_)
            | Class::Ternary(_)
            | Class::Composite(_)
            | Class::Numbers(_)
            | Class::Matrix(_)
            | Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::BitCast(_)
            | Class::Bits(_)
            | Class::Packing(_)
            | Class::Derivative(_)
            | Class::Noise(_)
            | Class::Texture(_)
            | Class::Emission(_) => None,
        }
    }

    /// Whether the value of a call follows from its arguments alone, and it does nothing else: no texture, no other fragment has a part in it.
    /// Noise is such a function of its argument (§8.9).
    pub fn follows_from_arguments(&self) -> bool {
        match self.class {
            Class::Unary(_)
            | Class::Binary(_)
            | Class::Ternary(_)
            | Class::Composite(_)
            | Class::Numbers(_)
            | Class::Matrix(_)
            | Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::BitCast(_)
            | Class::Bits(_)
            | Class::Packing(_)
            | Class::Noise(_)
            | Class::Composed => true,
            Class::Modf | Class::Derivative(_) | Class::Texture(_) | Class::Emission(_) => false,
        }
    }

    /// Whether a call emits vertices or ends primitives (§8.10).
    pub fn emits(&self) -> bool {
        match self.class {
            Class::Emission(_) => true,
            Class::Unary(_)
            | Class::Binary(_)
            | Class::Ternary(_)
            | Class::Composite(_)
            | Class::Numbers(_)
            | Class::Matrix(_)
            | Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::BitCast(_)
            | Class::Bits(_)
            | Class::Packing(_)
            | Class::Modf
            | Class::Composed
            | Class::Derivative(_)
            | Class::Noise(_)
            | Class::Texture(_) => false,
        }
    }

    /// Whether a call may read from neighboring fragments (§8.7, §8.8): derivatives, and texture lookups with an
    /// implicit level of detail. Textures with one level need none:
    /// [`SamplerType::has_levels`](crate::language::SamplerType).
    pub fn implicit_derivatives(&self) -> bool {
        match self.class {
            Class::Derivative(_) => true,
            Class::Texture(form) => matches!(form.lookup, Lookup::Implicit | Lookup::QueryLod),
            Class::Unary(_)
            | Class::Binary(_)
            | Class::Ternary(_)
            | Class::Composite(_)
            | Class::Numbers(_)
            | Class::Matrix(_)
            | Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::BitCast(_)
            | Class::Bits(_)
            | Class::Packing(_)
            | Class::Modf
            | Class::Composed
            | Class::Noise(_)
            | Class::Emission(_) => false,
        }
    }
}

impl BuiltinFunction {
    /// The kind of computation.
    pub fn class(self) -> Class {
        self.operation().class
    }

    /// Whether a call with constant arguments is a constant expression (§4.3.3). It is not for noise functions and
    /// for functions with side effects. Texture functions never have constant arguments, because samplers are not
    /// constant.
    pub fn is_foldable(self) -> bool {
        !matches!(self.class(), Class::Noise(_) | Class::Emission(_))
    }

    /// The number of the argument that a call writes: see [`Operation::written_argument`].
    pub fn written_argument(self) -> Option<usize> {
        self.operation().written_argument()
    }

    /// Whether a call does more than to give a value: it writes an argument, or emits.
    pub fn has_effects(self) -> bool {
        self.operation().written_argument().is_some() || self.operation().emits()
    }

    /// Whether the value of a call follows from its arguments alone: see [`Operation::follows_from_arguments`].
    pub fn follows_from_arguments(self) -> bool {
        self.operation().follows_from_arguments()
    }

    /// Whether a call may read from neighboring fragments: see [`Operation::implicit_derivatives`].
    pub fn implicit_derivatives(self) -> bool {
        self.operation().implicit_derivatives()
    }
}

#[cfg(test)]
mod tests;
