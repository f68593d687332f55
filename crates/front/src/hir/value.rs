//! [`Value`]: constant values (§4.3.3) and default values.

use super::{Scalar, TypeId};

/// A scalar constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScalarValue {
    /// `bool`
    Bool(bool),
    /// `int`
    Int(i32),
    /// `uint`
    Uint(u32),
    /// `float`
    Float(f32),
}

impl ScalarValue {
    /// The type.
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Bool(_) => Scalar::Bool,
            Self::Int(_) => Scalar::Int,
            Self::Uint(_) => Scalar::Uint,
            Self::Float(_) => Scalar::Float,
        }
    }
}

/// A constant of any type, in flat layout: members in order, elements in order, matrices by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The type.
    pub ty: TypeId,
    /// The scalars, [`Types::flat_len`](super::Types::flat_len) of them.
    pub scalars: Vec<ScalarValue>,
}
