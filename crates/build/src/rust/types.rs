//! Types of GLSL as types of Rust.
//!
//! *In:* a scalar, vector or matrix. *Out:* [`Element`]: its type as people write it, and its type in a uniform buffer.
//!
//! *Holds:* `bool` is a `u32` in buffers; columns of matrices, and elements of arrays, take 16 bytes each (std140).

use glisten_front::hir::{MatrixLayout, Scalar, Type, TypeId, Types};

/// A scalar, vector or matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) scalar: Scalar,
    pub(super) shape: Shape,
}

/// The extent of an [`Element`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar,
    Vector(u8),
    /// Columns and rows, and whether rows are stored instead of columns.
    Matrix(u8, u8, bool),
}

impl Element {
    /// The element of a type; `None` for everything else.
    pub(super) fn of(types: &Types, ty: TypeId, layout: MatrixLayout) -> Option<Self> {
        Some(match types.get(ty) {
            Type::Scalar(scalar) => Self { scalar, shape: Shape::Scalar },
            Type::Vector(scalar, size) => Self { scalar, shape: Shape::Vector(size) },
            Type::Matrix(columns, rows) => {
                let by_rows = layout == MatrixLayout::RowMajor;
                Self { scalar: Scalar::Float, shape: Shape::Matrix(columns, rows, by_rows) }
            }
            _ => return None,
        })
    }

    /// The scalar in memory.
    pub(super) fn stored_scalar(self) -> &'static str {
        match self.scalar {
            Scalar::Float => "f32",
            Scalar::Int => "i32",
            Scalar::Uint | Scalar::Bool => "u32",
        }
    }

    /// The scalar as people write it.
    pub(super) fn scalar(self) -> &'static str {
        if self.scalar == Scalar::Bool { "bool" } else { self.stored_scalar() }
    }

    /// The type as people write it: `[[f32; 3]; 3]`, by columns.
    pub(super) fn written(self) -> String {
        let scalar = self.scalar();
        match self.shape {
            Shape::Scalar => scalar.into(),
            Shape::Vector(size) => format!("[{scalar}; {size}]"),
            Shape::Matrix(columns, rows, _) => format!("[[{scalar}; {rows}]; {columns}]"),
        }
    }

    /// The type of `glam`, if it has one.
    pub(super) fn glam(self) -> Option<String> {
        match self.shape {
            Shape::Matrix(columns, rows, _) if columns == rows => Some(format!("glam::Mat{columns}")),
            _ => None,
        }
    }

    /// The type in a uniform buffer.
    pub(super) fn stored(self) -> String {
        let scalar = self.stored_scalar();
        match self.shape {
            Shape::Scalar => scalar.into(),
            Shape::Vector(size) => format!("[{scalar}; {size}]"),
            Shape::Matrix(..) => format!("[[{scalar}; 4]; {}]", self.vectors()),
        }
    }

    /// The type of an element of an array in a uniform buffer.
    pub(super) fn stored_in_array(self) -> String {
        match self.shape {
            Shape::Matrix(..) => self.stored(),
            _ => format!("[{}; 4]", self.stored_scalar()),
        }
    }

    /// The bytes that it takes.
    pub(super) fn size(self) -> u32 {
        match self.shape {
            Shape::Scalar => 4,
            Shape::Vector(size) => 4 * u32::from(size),
            Shape::Matrix(..) => 16 * self.vectors(),
        }
    }

    /// The bytes that it takes in an array.
    pub(super) fn stride(self) -> u32 {
        self.size().next_multiple_of(16)
    }

    /// The number of vectors of a matrix in memory.
    pub(super) fn vectors(self) -> u32 {
        match self.shape {
            Shape::Matrix(columns, rows, by_rows) => u32::from(if by_rows { rows } else { columns }),
            _ => 1,
        }
    }

    /// Scalars in flat layout.
    pub(super) fn scalars(self) -> usize {
        match self.shape {
            Shape::Scalar => 1,
            Shape::Vector(size) => usize::from(size),
            Shape::Matrix(columns, rows, _) => usize::from(columns) * usize::from(rows),
        }
    }
}
