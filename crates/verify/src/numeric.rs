//! The types of GLSL that consist of numbers, by their names (GLSL 1.50 §4.1).
//!
//! *In:* a name, or a type of a program. *Out:* a [`Shape`]. *Not done here:* `double`, structs, arrays.

use glisten_front::hir::{Scalar, Type, TypeId, Types};

/// A scalar, vector or matrix; a vector has one column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) scalar: Scalar,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
}

/// All types; the first name of a type is the one to say.
pub(crate) const TYPES: &[(&str, Shape)] = &[
    ("float", shape(Scalar::Float, 1, 1)),
    ("vec2", shape(Scalar::Float, 1, 2)),
    ("vec3", shape(Scalar::Float, 1, 3)),
    ("vec4", shape(Scalar::Float, 1, 4)),
    ("int", shape(Scalar::Int, 1, 1)),
    ("ivec2", shape(Scalar::Int, 1, 2)),
    ("ivec3", shape(Scalar::Int, 1, 3)),
    ("ivec4", shape(Scalar::Int, 1, 4)),
    ("uint", shape(Scalar::Uint, 1, 1)),
    ("uvec2", shape(Scalar::Uint, 1, 2)),
    ("uvec3", shape(Scalar::Uint, 1, 3)),
    ("uvec4", shape(Scalar::Uint, 1, 4)),
    ("bool", shape(Scalar::Bool, 1, 1)),
    ("bvec2", shape(Scalar::Bool, 1, 2)),
    ("bvec3", shape(Scalar::Bool, 1, 3)),
    ("bvec4", shape(Scalar::Bool, 1, 4)),
    ("mat2", shape(Scalar::Float, 2, 2)),
    ("mat3", shape(Scalar::Float, 3, 3)),
    ("mat4", shape(Scalar::Float, 4, 4)),
    ("mat2x2", shape(Scalar::Float, 2, 2)),
    ("mat2x3", shape(Scalar::Float, 2, 3)),
    ("mat2x4", shape(Scalar::Float, 2, 4)),
    ("mat3x2", shape(Scalar::Float, 3, 2)),
    ("mat3x3", shape(Scalar::Float, 3, 3)),
    ("mat3x4", shape(Scalar::Float, 3, 4)),
    ("mat4x2", shape(Scalar::Float, 4, 2)),
    ("mat4x3", shape(Scalar::Float, 4, 3)),
    ("mat4x4", shape(Scalar::Float, 4, 4)),
];

const fn shape(scalar: Scalar, columns: u32, rows: u32) -> Shape {
    Shape { scalar, columns, rows }
}

impl Shape {
    /// The shape of a type, if it consists of numbers alone.
    pub(crate) fn of(types: &Types, ty: TypeId) -> Option<Self> {
        Some(match types.get(ty) {
            Type::Scalar(scalar) => shape(scalar, 1, 1),
            Type::Vector(scalar, size) => shape(scalar, 1, u32::from(size)),
            Type::Matrix(columns, rows) => shape(Scalar::Float, u32::from(columns), u32::from(rows)),
            _ => return None,
        })
    }

    /// The shape of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        TYPES.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// The name of the type.
    pub(crate) fn name(self) -> &'static str {
        TYPES.iter().find(|row| row.1 == self).map_or("", |row| row.0)
    }

    /// How many numbers it has.
    pub(crate) fn size(self) -> usize {
        (self.columns * self.rows) as usize
    }

    /// Whether it is a vector of floats.
    pub(crate) fn is_vector(self) -> bool {
        self.scalar == Scalar::Float && self.columns == 1 && self.rows > 1
    }
}
