//! The table of operations: what each operator on floats and each built-in function (GLSL 1.50 §5.9, §8) is, once.
//!
//! *In:* nothing. *Out:* the identities [`BuiltinFunction`], [`Unary`], [`Binary`], [`Ternary`] and [`Composite`], and the
//! facts of each: name, class, cost, precision, whether it jumps, how a texture is looked up.
//! *Holds:* a fact about an operation stands in its row of [`table`] and nowhere else. Phases that do something with an
//! operation (folding, execution, lowering) match its [`Class`] without a wildcard, so that a new row does not compile
//! before each of them knows it. *Not done here:* the prototypes with their versions and stages
//! ([`functions`](super::functions)), which name the identity that they belong to.

mod class;
mod cost;
mod formula;
pub mod kernel;
mod markdown;
pub mod precision;
mod table;
mod texture;

pub use class::{BooleanFunction, Class, Derivative, Emission, MatrixFunction, Noise, Numbers, Relation, Test};
pub use cost::{CallCost, Linear};
pub use formula::Formula;
pub use markdown::{markdown, precision_markdown};
pub use precision::{Precision, Rule};
pub use table::{Binary, BuiltinFunction, Composite, Ternary, Unary};
pub use texture::{Lookup, TextureArgument, TextureForm};

/// The row of a built-in function.
#[derive(Clone, Copy, Debug)]
pub struct Operation {
    /// Which function.
    pub function: BuiltinFunction,
    /// The name in GLSL; older names of one computation (`texture2D`) stand in the prototypes alone.
    pub name: &'static str,
    /// How it is computed.
    pub class: Class,
    /// What a call costs.
    pub cost: CallCost,
    /// How far a conforming GPU may be from the exact result; `None` for what gives no computed floats.
    pub rule: Option<&'static Rule>,
}

impl Operation {
    /// The prototypes, in the order of the specification.
    pub fn prototypes(&self) -> impl Iterator<Item = &'static super::functions::Row> + use<> {
        let function = self.function;
        super::functions::all().filter(move |row| row.function == function)
    }

    /// The section of GLSL 1.50.
    pub fn section(&self) -> &'static str {
        self.prototypes().next().map_or("", |row| row.section)
    }

    /// Whether a result may jump between neighboring arguments.
    pub fn jumps(&self) -> bool {
        match self.class {
            Class::Unary(op) => op.jumps(),
            Class::Binary(op) => op.jumps(),
            Class::Ternary(op) => op.jumps(),
            Class::Composite(op) => op.jumps(),
            Class::Numbers(op) => op.jumps(),
            Class::Relation(_) | Class::Boolean(_) | Class::Test(_) | Class::Modf => true,
            Class::Matrix(_) | Class::Derivative(_) | Class::Noise(_) | Class::Texture(_) | Class::Emission(_) => false,
        }
    }

    /// Whether a call may look at the neighboring fragments (§8.7, §8.8): derivatives, and texture lookups whose level of
    /// detail is implicit. Textures with one level need none: [`SamplerType::has_levels`](crate::language::SamplerType).
    pub fn implicit_derivatives(&self) -> bool {
        match self.class {
            Class::Derivative(_) => true,
            Class::Texture(form) => form.lookup == Lookup::Implicit,
            Class::Unary(_)
            | Class::Binary(_)
            | Class::Ternary(_)
            | Class::Composite(_)
            | Class::Numbers(_)
            | Class::Matrix(_)
            | Class::Relation(_)
            | Class::Boolean(_)
            | Class::Test(_)
            | Class::Modf
            | Class::Noise(_)
            | Class::Emission(_) => false,
        }
    }
}

impl BuiltinFunction {
    /// How it is computed.
    pub fn class(self) -> Class {
        self.operation().class
    }

    /// [`Operation::implicit_derivatives`]
    pub fn implicit_derivatives(self) -> bool {
        self.operation().implicit_derivatives()
    }
}

#[cfg(test)]
mod tests;
