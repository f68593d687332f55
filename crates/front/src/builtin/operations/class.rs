//! [`Class`]: how a built-in function is computed, which folding, the executor and lowering match without a wildcard.

use super::{Binary, Composite, Ternary, TextureForm, Unary};

/// How a built-in function is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// One float, component by component.
    Unary(Unary),
    /// Two floats, component by component; a scalar goes with every component of a vector.
    Binary(Binary),
    /// Three floats, likewise.
    Ternary(Ternary),
    /// The number and types of the arguments decide by what.
    Numbers(Numbers),
    /// Whole vectors or square matrices of floats.
    Composite(Composite),
    /// Matrices, without a sum.
    Matrix(MatrixFunction),
    /// A comparison of vectors, component by component (§8.6).
    Relation(Relation),
    /// A function of `bvec`s (§8.6).
    Boolean(BooleanFunction),
    /// Of which kind a float is.
    Test(Test),
    /// `modf`, which writes an argument.
    Modf,
    /// A difference of neighboring fragments (§8.8).
    Derivative(Derivative),
    /// Noise of so many components (§8.9).
    Noise(Noise),
    /// A texture function (§8.7).
    Texture(TextureForm),
    /// What a geometry shader sends on (§8.10).
    Emission(Emission),
}

/// The functions of numbers that need not be floats, or of one or two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// `atan`: of one argument [`Unary::Atan`], of two [`Binary::Atan2`].
    Atan,
    /// `abs` of floats or `int`s.
    Abs,
    /// `sign` of floats or `int`s.
    Sign,
    /// `min` of floats or integers.
    Min,
    /// `max` of floats or integers.
    Max,
    /// `clamp` of floats or integers.
    Clamp,
    /// `mix` by a float, or a selection by a `bool`.
    Mix,
}

impl Numbers {
    /// Whether it jumps where its arguments are floats.
    pub fn jumps(self) -> bool {
        match self {
            Self::Atan => Unary::Atan.jumps(),
            Self::Abs => Unary::Abs.jumps(),
            Self::Sign => Unary::Sign.jumps(),
            Self::Min => Binary::Min.jumps(),
            Self::Max => Binary::Max.jumps(),
            Self::Clamp => Ternary::Clamp.jumps(),
            Self::Mix => Ternary::Mix.jumps(),
        }
    }
}

macro_rules! plain {
    ($(#[$doc:meta])* $name:ident { $($variant:ident),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum $name { $($variant),* }
    };
}

plain!(
    /// Functions of matrices that add nothing up (§8.5).
    MatrixFunction { ComponentProduct, OuterProduct, Transpose }
);
plain!(
    /// Comparisons, by operator.
    Relation { Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual }
);
plain!(
    /// `any`, `all`, `not`
    BooleanFunction { Any, All, Not }
);
plain!(
    /// `isnan`, `isinf`
    Test { Nan, Infinite }
);
plain!(
    /// `dFdx`, `dFdy`, `fwidth`
    Derivative { X, Y, Width }
);
plain!(
    /// `EmitVertex`, `EndPrimitive`
    Emission { Vertex, Primitive }
);

/// How many components `noise1` to `noise4` give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noise(pub u8);
