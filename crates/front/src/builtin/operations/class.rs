//! [`Class`]: the kind of computation of a built-in function. Folding, the executor and lowering match it without a
//! wildcard.

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use super::{Binary, Composite, Ternary, TextureForm, Unary};

/// The kind of computation of a built-in function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A function of one float, component by component.
    Unary(Unary),
    /// A function of two floats, component by component. A scalar is combined with every component of a vector.
    Binary(Binary),
    /// A function of three floats, component by component.
    Ternary(Ternary),
    /// A function that depends on the number and types of the arguments.
    Numbers(Numbers),
    /// A function of whole vectors or square matrices of floats.
    Composite(Composite),
    /// A function of matrices without sums.
    Matrix(MatrixFunction),
    /// A comparison of vectors, component by component (§8.6).
    Relation(Relation),
    /// A function of `bvec`s (§8.6).
    Boolean(BooleanFunction),
    /// A test of a float.
    Test(Test),
    /// The bits of a float as an integer, or of an integer as a float.
    BitCast(BitCast),
    /// A function of the bits of integers, component by component.
    Bits(BitFunction),
    /// Floats of fewer bits in a `uint`.
    Packing(Packing),
    /// `modf`, which writes an argument.
    Modf,
    /// A function that the analysis writes out in other operations, so that no later phase knows it.
    Composed,
    /// A difference between neighboring fragments (§8.8).
    Derivative(Derivative),
    /// Noise with a number of components (§8.9).
    Noise(Noise),
    /// A texture function (§8.7).
    Texture(TextureForm),
    /// A function that emits from a geometry shader (§8.10).
    Emission(Emission),
}

/// Functions that accept other numbers than floats, or one or two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// `atan`: with one argument [`Unary::Atan`], with two [`Binary::Atan2`].
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
    /// Whether the function is discontinuous for float arguments.
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
    /// Functions of matrices without sums (§8.5).
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
    /// `floatBitsToInt`, `floatBitsToUint`, `intBitsToFloat`, `uintBitsToFloat`
    BitCast { FloatToInt, FloatToUint, IntToFloat, UintToFloat }
);
plain!(
    /// `bitfieldExtract`, `bitfieldInsert`, `bitfieldReverse`, `bitCount`, `findLSB`, `findMSB`
    BitFunction { Extract, Insert, Reverse, Count, Lowest, Highest }
);
plain!(
    /// `dFdx`, `dFdy`, `fwidth`, and these of the own row or column alone, or one for the whole quad (GLSL 4.50 §8.14.1).
    Derivative { X, Y, Width, XFine, YFine, WidthFine, XCoarse, YCoarse, WidthCoarse }
);
plain!(
    /// The axis of a derivative.
    DerivativeAxis { X, Y, Width }
);
plain!(
    /// Which neighbors a derivative is from: any of the quad, those of the own row and column, or the same for the whole quad.
    DerivativeControl { Any, Fine, Coarse }
);

impl Derivative {
    /// Every derivative.
    pub const ALL: [Self; 9] = [
        Self::X,
        Self::Y,
        Self::Width,
        Self::XFine,
        Self::YFine,
        Self::WidthFine,
        Self::XCoarse,
        Self::YCoarse,
        Self::WidthCoarse,
    ];

    /// The name of the function.
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "dFdx",
            Self::Y => "dFdy",
            Self::Width => "fwidth",
            Self::XFine => "dFdxFine",
            Self::YFine => "dFdyFine",
            Self::WidthFine => "fwidthFine",
            Self::XCoarse => "dFdxCoarse",
            Self::YCoarse => "dFdyCoarse",
            Self::WidthCoarse => "fwidthCoarse",
        }
    }

    /// The axis.
    pub fn axis(self) -> DerivativeAxis {
        match self {
            Self::X | Self::XFine | Self::XCoarse => DerivativeAxis::X,
            Self::Y | Self::YFine | Self::YCoarse => DerivativeAxis::Y,
            Self::Width | Self::WidthFine | Self::WidthCoarse => DerivativeAxis::Width,
        }
    }

    /// The neighbors.
    pub fn control(self) -> DerivativeControl {
        match self {
            Self::X | Self::Y | Self::Width => DerivativeControl::Any,
            Self::XFine | Self::YFine | Self::WidthFine => DerivativeControl::Fine,
            Self::XCoarse | Self::YCoarse | Self::WidthCoarse => DerivativeControl::Coarse,
        }
    }
}
plain!(
    /// `EmitVertex`, `EndPrimitive`
    Emission { Vertex, Primitive }
);

/// The number of components of `noise1` to `noise4`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noise(pub u8);

/// How floats are packed into a `uint`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// 0 to 1 as the integers from 0.
    Unorm,
    /// -1 to 1 as signed integers.
    Snorm,
    /// Floats of 16 bits.
    Half,
}

/// `packUnorm4x8`, `unpackHalf2x16` and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Packing {
    /// Whether the `uint` is the argument.
    pub unpacks: bool,
    /// The meaning of the bits.
    pub format: Format,
    /// The number of components: 2 of 16 bits or 4 of 8 bits.
    pub components: u8,
}

impl Packing {
    /// The bits of a component.
    pub fn bits(self) -> u32 {
        32 / u32::from(self.components.max(1))
    }

    /// 1.0 as an integer, for the normalized formats.
    pub fn one(self) -> u32 {
        (1u32 << (self.bits() - u32::from(self.format == Format::Snorm))) - 1
    }
}
