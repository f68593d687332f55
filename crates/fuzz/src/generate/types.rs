//! [`Ty`]: the types of generated programs.
//!
//! *In:* nothing. *Out:* names, sizes and parts of types. *Holds:* struct `S0` is the first of its program, and so on, so that a type has
//! its name without a table.

use glisten_front::hir::{Scalar, Type, TypeId, Types};

/// A type.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ty {
    /// A scalar or a vector, by the number of its components.
    Vector(Scalar, u8),
    /// Columns and rows.
    Matrix(u8, u8),
    /// Elements, and their number.
    Array(Box<Ty>, u32),
    /// The struct of this number.
    Struct(usize),
}

/// `float`
pub(super) const FLOAT: Ty = Ty::Vector(Scalar::Float, 1);
/// `int`
pub(super) const INT: Ty = Ty::Vector(Scalar::Int, 1);
/// `uint`
pub(super) const UINT: Ty = Ty::Vector(Scalar::Uint, 1);
/// `bool`
pub(super) const BOOL: Ty = Ty::Vector(Scalar::Bool, 1);

/// The members of a struct.
pub(super) type Members = Vec<(String, Ty)>;

impl Ty {
    /// A type of the tables of built-in functions; samplers and arrays have none.
    pub(super) fn of(id: TypeId) -> Option<Self> {
        match Types::basic().get(id) {
            Type::Scalar(scalar) => Some(Self::Vector(scalar, 1)),
            Type::Vector(scalar, size) => Some(Self::Vector(scalar, size)),
            Type::Matrix(columns, rows) => Some(Self::Matrix(columns, rows)),
            _ => None,
        }
    }

    /// Its name: `vec3`, `mat2x3`, `S0`, `float[2]`.
    pub fn name(&self) -> String {
        match self {
            Self::Vector(scalar, 1) => scalar.name().to_owned(),
            Self::Vector(scalar, size) => {
                let prefix = match scalar {
                    Scalar::Bool => "b",
                    Scalar::Int => "i",
                    Scalar::Uint => "u",
                    Scalar::Float => "",
                };
                format!("{prefix}vec{size}")
            }
            Self::Matrix(columns, rows) if columns == rows => format!("mat{columns}"),
            Self::Matrix(columns, rows) => format!("mat{columns}x{rows}"),
            Self::Array(..) => self.base().name() + &self.dims(),
            Self::Struct(number) => format!("S{number}"),
        }
    }

    /// `float` of `float[2][3]`.
    fn base(&self) -> &Self {
        match self {
            Self::Array(element, _) => element.base(),
            other => other,
        }
    }

    /// `[2][3]` of `float[2][3]`.
    fn dims(&self) -> String {
        match self {
            Self::Array(element, size) => format!("[{size}]{}", element.dims()),
            _ => String::new(),
        }
    }

    /// The declaration of a name, as every version takes it: `float a[2]`.
    pub(super) fn declared(&self, name: &str) -> String {
        format!("{} {name}{}", self.base().name(), self.dims())
    }

    /// The scalar type of its components; of arrays and structs there is none.
    pub(super) fn scalar(&self) -> Option<Scalar> {
        match self {
            Self::Vector(scalar, _) => Some(*scalar),
            Self::Matrix(..) => Some(Scalar::Float),
            Self::Array(..) | Self::Struct(_) => None,
        }
    }

    /// Whether it is a scalar or a vector of this.
    pub(super) fn is_vector_of(&self, wanted: Scalar) -> bool {
        matches!(self, Self::Vector(scalar, _) if *scalar == wanted)
    }

    /// Whether it is or contains an array.
    pub(super) fn has_array(&self, structs: &[Members]) -> bool {
        match self {
            Self::Array(..) => true,
            Self::Struct(number) => {
                structs.get(*number).is_some_and(|members| members.iter().any(|(_, ty)| ty.has_array(structs)))
            }
            _ => false,
        }
    }
}
