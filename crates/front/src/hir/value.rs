//! [`Value`]: constant values (§4.3.3) and default values.

use super::{Scalar, TypeId};
use std::hash::{Hash, Hasher};

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

/// The hash of the bits: zeros of both signs and all NaN are told apart.
impl Hash for ScalarValue {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let (kind, bits) = match *self {
            Self::Bool(value) => (0u8, u32::from(value)),
            Self::Int(value) => (1, value.cast_unsigned()),
            Self::Uint(value) => (2, value),
            Self::Float(value) => (3, value.to_bits()),
        };
        (kind, bits).hash(state);
    }
}

impl ScalarValue {
    /// Whether two scalars have the same type and bits: zeros of both signs differ, and a NaN is the same as itself.
    pub fn is_same(self, other: Self) -> bool {
        match (self, other) {
            (Self::Float(a), Self::Float(b)) => a.to_bits() == b.to_bits(),
            _ => self == other,
        }
    }

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
#[derive(Clone, Debug, PartialEq, Hash)]
pub struct Value {
    /// The type.
    pub ty: TypeId,
    /// The scalars, [`Types::flat_len`](super::Types::flat_len) of them.
    pub scalars: Vec<ScalarValue>,
}
