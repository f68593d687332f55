//! The rows for operators on floats and built-in functions, with one line for each.
//!
//! *In:* nothing. *Out:* the identities that the rows name, and their properties. *Holds:* if a built-in function is
//! one operation on one, two or three floats, or on whole vectors, one line declares both the identity of the
//! function and that of the operation. `floats` marks functions that accept only floats, `numbers` those that depend
//! on the types of the arguments. `jumps` and `smooth` state whether the function is discontinuous.

use super::cost::{LOOKUP, each, special, whole};
use super::precision::{self, Rule};
use super::{
    BitCast, BitFunction, BooleanFunction, CallCost, Class, Derivative, Emission, Format, Lookup, MatrixFunction,
};
use super::{Noise, Numbers, Operation, Packing, Relation, Test, TextureForm, kernel};

macro_rules! class {
    (floats $kind:ident $name:ident) => {
        Class::$kind($kind::$name)
    };
    (numbers $kind:ident $name:ident) => {
        Class::Numbers(Numbers::$name)
    };
}

macro_rules! jumps {
    (jumps) => {
        true
    };
    (smooth) => {
        false
    };
}

/// Declares the identities of the operations on one, two and three floats. `(x)` names the arguments, the second time
/// as they are passed to the kernel.
macro_rules! componentwise {
    ($(#[$doc:meta])* $kind:ident($($x:ident),*) $arguments:tt { $($name:ident $spelling:literal $jumps:ident $rule:ident $kernel:expr;)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum $kind { $($name),* }

        impl $kind {
            /// All operations.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The name in GLSL.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $spelling),* }
            }

            /// Whether the operation is discontinuous.
            pub const fn jumps(self) -> bool {
                match self { $(Self::$name => jumps!($jumps)),* }
            }

            /// The error that a conforming GPU may add.
            pub const fn rule(self) -> &'static Rule {
                match self { $(Self::$name => &precision::$rule),* }
            }

            /// The result in f64.
            #[inline]
            pub fn of(self, $($x: f64),*) -> f64 {
                match self { $(Self::$name => $kernel $arguments),* }
            }
        }
    };
}

macro_rules! operations {
    (
        unary { $($uk:ident $u:ident $un:literal $uj:ident $uc:expr, $ur:ident, $uf:expr;)* }
        unary operators { $($uo:ident $uon:literal $uoj:ident $uor:ident, $uof:expr;)* }
        binary { $($bk:ident $b:ident $bn:literal $bj:ident $bc:expr, $br:ident, $bf:expr;)* }
        binary operators { $($bo:ident $bon:literal $boj:ident $bor:ident, $bof:expr;)* }
        ternary { $($tk:ident $t:ident $tn:literal $tj:ident $tc:expr, $tr:ident, $tf:expr;)* }
        composite { $($c:ident $cn:literal $cj:ident $cc:expr, $cr:ident;)* }
        other { $($o:ident $on:literal $oclass:expr, $oc:expr, $or:expr;)* }
    ) => {
        componentwise!(
            /// An operation on one float.
            Unary(x) (x) { $($uo $uon $uoj $uor $uof;)* $($u $un $uj $ur $uf;)* }
        );
        componentwise!(
            /// An operation on two floats.
            Binary(x, y) (x, y) { $($bo $bon $boj $bor $bof;)* $($b $bn $bj $br $bf;)* }
        );
        componentwise!(
            /// An operation on three floats.
            Ternary(x, y, z) (x, y, z) { $($t $tn $tj $tr $tf;)* }
        );

        /// An operation on whole vectors or matrices of floats (§8.4, §8.5).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum Composite { $($c),* }

        impl Composite {
            /// All operations.
            pub const ALL: &[Self] = &[$(Self::$c),*];

            /// The name in GLSL.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$c => $cn),* }
            }

            /// Whether the operation is discontinuous.
            pub const fn jumps(self) -> bool {
                match self { $(Self::$c => jumps!($cj)),* }
            }

            /// The error that a conforming GPU may add.
            pub const fn rule(self) -> &'static Rule {
                match self { $(Self::$c => &precision::$cr),* }
            }
        }

        /// A built-in function. The argument types determine the overload. Older names of one computation
        /// (`texture2D`, `shadow2D`) share an identity.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum BuiltinFunction { $($u,)* $($b,)* $($t,)* $($c,)* $($o,)* }

        impl BuiltinFunction {
            /// All functions.
            pub const ALL: &[Self] = &[$(Self::$u,)* $(Self::$b,)* $(Self::$t,)* $(Self::$c,)* $(Self::$o,)*];

            /// The name in GLSL.
            pub fn name(self) -> &'static str {
                self.operation().name
            }

            /// Its row.
            pub fn operation(self) -> &'static Operation {
                const fn row(
                    function: BuiltinFunction,
                    name: &'static str,
                    class: Class,
                    cost: CallCost,
                    rule: Option<&'static Rule>,
                ) -> Operation {
                    Operation { function, name, class, cost, rule }
                }
                match self {
                    $(Self::$u => const {
                        &row(Self::$u, $un, class!($uk Unary $u), $uc, Some(&precision::$ur))
                    },)*
                    $(Self::$b => const {
                        &row(Self::$b, $bn, class!($bk Binary $b), $bc, Some(&precision::$br))
                    },)*
                    $(Self::$t => const {
                        &row(Self::$t, $tn, class!($tk Ternary $t), $tc, Some(&precision::$tr))
                    },)*
                    $(Self::$c => const {
                        &row(Self::$c, $cn, Class::Composite(Composite::$c), $cc, Some(&precision::$cr))
                    },)*
                    $(Self::$o => const { &row(Self::$o, $on, $oclass, $oc, $or) },)*
                }
            }
        }
    };
}

const fn texture(lookup: Lookup, projective: bool, offset: bool) -> Class {
    Class::Texture(TextureForm::new(lookup, projective, offset))
}

const fn pack(unpacks: bool, format: Format, components: u8) -> Class {
    Class::Packing(Packing { unpacks, format, components })
}

operations! {
    unary {
        floats Radians "radians" smooth each(1), RADIANS, kernel::radians;
        floats Degrees "degrees" smooth each(1), DEGREES, kernel::degrees;
        floats Sin "sin" smooth special(1, 0), SIN, f64::sin;
        floats Cos "cos" smooth special(1, 0), SIN, f64::cos;
        floats Tan "tan" smooth special(1, 0), TAN, f64::tan;
        floats Asin "asin" smooth special(1, 0), ASIN, f64::asin;
        floats Acos "acos" smooth special(1, 0), ACOS, f64::acos;
        numbers Atan "atan" smooth special(1, 0), ATAN, f64::atan;
        floats Sinh "sinh" smooth special(2, 2), SINH, f64::sinh;
        floats Cosh "cosh" smooth special(2, 2), COSH, f64::cosh;
        floats Tanh "tanh" smooth special(3, 4), TANH, f64::tanh;
        floats Asinh "asinh" smooth special(2, 3), ASINH, f64::asinh;
        floats Acosh "acosh" smooth special(2, 3), ACOSH, kernel::acosh;
        floats Atanh "atanh" smooth special(2, 4), ATANH, kernel::atanh;
        floats Exp "exp" smooth special(1, 1), EXP, f64::exp;
        floats Log "log" smooth special(1, 1), LOG, f64::ln;
        floats Exp2 "exp2" smooth special(1, 0), EXP, f64::exp2;
        floats Log2 "log2" smooth special(1, 0), LOG, f64::log2;
        floats Sqrt "sqrt" smooth special(1, 0), SQRT, f64::sqrt;
        floats Inversesqrt "inversesqrt" smooth special(1, 0), INVERSESQRT, |x: f64| 1.0 / x.sqrt();
        numbers Abs "abs" smooth each(1), EXACT, f64::abs;
        numbers Sign "sign" jumps each(1), EXACT, kernel::sign;
        floats Floor "floor" jumps each(1), EXACT, f64::floor;
        floats Trunc "trunc" jumps each(1), EXACT, f64::trunc;
        floats Round "round" jumps each(1), ROUND, f64::round_ties_even;
        floats Ceil "ceil" jumps each(1), EXACT, f64::ceil;
        floats Fract "fract" jumps each(1), FRACT, |x: f64| x - x.floor();
    }
    unary operators {
        Neg "-" smooth EXACT, |x: f64| -x;
    }
    binary {
        floats Pow "pow" smooth special(2, 1), POW, kernel::pow;
        floats Mod "mod" jumps each(1), MOD, kernel::modulo;
        numbers Min "min" smooth each(1), EXTREMUM, kernel::min;
        numbers Max "max" smooth each(1), EXTREMUM, kernel::max;
        floats Step "step" jumps each(1), EXACT, kernel::step;
    }
    binary operators {
        Add "+" smooth ADD, |x: f64, y: f64| x + y;
        Sub "-" smooth ADD, |x: f64, y: f64| x - y;
        Mul "*" smooth MUL, |x: f64, y: f64| x * y;
        Div "/" smooth DIV, |x: f64, y: f64| x / y;
        Atan2 "atan" smooth ATAN, f64::atan2;
    }
    ternary {
        numbers Clamp "clamp" smooth each(2), EXACT, kernel::clamp;
        numbers Mix "mix" smooth each(3), MIX, kernel::mix;
        floats Smoothstep "smoothstep" smooth special(1, 7), SMOOTHSTEP, kernel::smoothstep;
        floats Fma "fma" smooth each(2), FMA, f64::mul_add;
    }
    composite {
        Length "length" smooth whole(1, -1, 0, 2), LENGTH;
        Distance "distance" smooth whole(1, -1, 0, 3), DISTANCE;
        Dot "dot" smooth whole(0, -1, 0, 2), DOT;
        Cross "cross" smooth whole(0, 9, 0, 0), CROSS;
        Normalize "normalize" smooth whole(1, -1, 1, 2), NORMALIZE;
        Faceforward "faceforward" jumps whole(0, 0, 1, 2), FACEFORWARD;
        Reflect "reflect" smooth whole(0, 0, 2, 2), REFLECT;
        Refract "refract" jumps whole(1, 6, 3, 2), REFRACT;
        Determinant "determinant" smooth whole(0, -13, 0, 4), INVERSE;
        Inverse "inverse" smooth whole(1, -37, 0, 11), INVERSE;
    }
    other {
        RoundEven "roundEven" Class::Unary(Unary::Round), each(1), Some(&precision::ROUND);
        Modf "modf" Class::Modf, each(1), Some(&precision::FRACT);
        Isnan "isnan" Class::Test(Test::Nan), each(1), None;
        Isinf "isinf" Class::Test(Test::Infinite), each(1), None;
        MatrixCompMult "matrixCompMult" Class::Matrix(MatrixFunction::ComponentProduct), each(1), Some(&precision::MUL);
        OuterProduct "outerProduct" Class::Matrix(MatrixFunction::OuterProduct), each(1), Some(&precision::MUL);
        Transpose "transpose" Class::Matrix(MatrixFunction::Transpose), each(0), Some(&precision::EXACT);
        LessThan "lessThan" Class::Relation(Relation::Less), each(1), None;
        LessThanEqual "lessThanEqual" Class::Relation(Relation::LessEqual), each(1), None;
        GreaterThan "greaterThan" Class::Relation(Relation::Greater), each(1), None;
        GreaterThanEqual "greaterThanEqual" Class::Relation(Relation::GreaterEqual), each(1), None;
        Equal "equal" Class::Relation(Relation::Equal), each(1), None;
        NotEqual "notEqual" Class::Relation(Relation::NotEqual), each(1), None;
        Any "any" Class::Boolean(BooleanFunction::Any), each(1), None;
        All "all" Class::Boolean(BooleanFunction::All), each(1), None;
        Not "not" Class::Boolean(BooleanFunction::Not), each(1), None;
        TextureSize "textureSize" texture(Lookup::Size, false, false), each(1), None;
        Texture "texture" texture(Lookup::Implicit, false, false), LOOKUP, None;
        TextureProj "textureProj" texture(Lookup::Implicit, true, false), LOOKUP, None;
        TextureLod "textureLod" texture(Lookup::Lod, false, false), LOOKUP, None;
        TextureOffset "textureOffset" texture(Lookup::Implicit, false, true), LOOKUP, None;
        TexelFetch "texelFetch" texture(Lookup::Fetch, false, false), LOOKUP, None;
        TexelFetchOffset "texelFetchOffset" texture(Lookup::Fetch, false, true), LOOKUP, None;
        TextureProjOffset "textureProjOffset" texture(Lookup::Implicit, true, true), LOOKUP, None;
        TextureLodOffset "textureLodOffset" texture(Lookup::Lod, false, true), LOOKUP, None;
        TextureProjLod "textureProjLod" texture(Lookup::Lod, true, false), LOOKUP, None;
        TextureProjLodOffset "textureProjLodOffset" texture(Lookup::Lod, true, true), LOOKUP, None;
        TextureGrad "textureGrad" texture(Lookup::Grad, false, false), LOOKUP, None;
        TextureGradOffset "textureGradOffset" texture(Lookup::Grad, false, true), LOOKUP, None;
        TextureProjGrad "textureProjGrad" texture(Lookup::Grad, true, false), LOOKUP, None;
        TextureProjGradOffset "textureProjGradOffset" texture(Lookup::Grad, true, true), LOOKUP, None;
        TextureGather "textureGather" texture(Lookup::Gather, false, false), LOOKUP, None;
        TextureGatherOffset "textureGatherOffset" texture(Lookup::Gather, false, true), LOOKUP, None;
        TextureGatherOffsets "textureGatherOffsets" Class::Texture(TextureForm::GATHER_OFFSETS), LOOKUP, None;
        TextureQueryLod "textureQueryLod" texture(Lookup::QueryLod, false, false), LOOKUP, None;
        TextureQueryLevels "textureQueryLevels" texture(Lookup::Levels, false, false), each(1), None;
        DFdx "dFdx" Class::Derivative(Derivative::X), each(1), Some(&precision::DERIVATIVE);
        DFdy "dFdy" Class::Derivative(Derivative::Y), each(1), Some(&precision::DERIVATIVE);
        Fwidth "fwidth" Class::Derivative(Derivative::Width), each(1), Some(&precision::DERIVATIVE);
        DFdxFine "dFdxFine" Class::Derivative(Derivative::XFine), each(1), Some(&precision::DERIVATIVE);
        DFdyFine "dFdyFine" Class::Derivative(Derivative::YFine), each(1), Some(&precision::DERIVATIVE);
        FwidthFine "fwidthFine" Class::Derivative(Derivative::WidthFine), each(1), Some(&precision::DERIVATIVE);
        DFdxCoarse "dFdxCoarse" Class::Derivative(Derivative::XCoarse), each(1), Some(&precision::DERIVATIVE);
        DFdyCoarse "dFdyCoarse" Class::Derivative(Derivative::YCoarse), each(1), Some(&precision::DERIVATIVE);
        FwidthCoarse "fwidthCoarse" Class::Derivative(Derivative::WidthCoarse), each(1), Some(&precision::DERIVATIVE);
        Noise1 "noise1" Class::Noise(Noise(1)), each(1), None;
        Noise2 "noise2" Class::Noise(Noise(2)), each(1), None;
        Noise3 "noise3" Class::Noise(Noise(3)), each(1), None;
        Noise4 "noise4" Class::Noise(Noise(4)), each(1), None;
        FloatBitsToInt "floatBitsToInt" Class::BitCast(BitCast::FloatToInt), each(1), None;
        FloatBitsToUint "floatBitsToUint" Class::BitCast(BitCast::FloatToUint), each(1), None;
        IntBitsToFloat "intBitsToFloat" Class::BitCast(BitCast::IntToFloat), each(1), Some(&precision::EXACT);
        UintBitsToFloat "uintBitsToFloat" Class::BitCast(BitCast::UintToFloat), each(1), Some(&precision::EXACT);
        Ftransform "ftransform" Class::Composed, each(7), None;
        Min3 "min3" Class::Composed, each(2), Some(&precision::EXTREMUM);
        Max3 "max3" Class::Composed, each(2), Some(&precision::EXTREMUM);
        Mid3 "mid3" Class::Composed, each(4), Some(&precision::EXTREMUM);
        Frexp "frexp" Class::Composed, each(8), Some(&precision::EXACT);
        Ldexp "ldexp" Class::Composed, each(8), Some(&precision::MUL);
        UaddCarry "uaddCarry" Class::Composed, each(3), None;
        UsubBorrow "usubBorrow" Class::Composed, each(3), None;
        UmulExtended "umulExtended" Class::Composed, each(16), None;
        ImulExtended "imulExtended" Class::Composed, each(20), None;
        BitfieldExtract "bitfieldExtract" Class::Bits(BitFunction::Extract), each(2), None;
        BitfieldInsert "bitfieldInsert" Class::Bits(BitFunction::Insert), each(4), None;
        BitfieldReverse "bitfieldReverse" Class::Bits(BitFunction::Reverse), each(1), None;
        BitCount "bitCount" Class::Bits(BitFunction::Count), each(1), None;
        FindLsb "findLSB" Class::Bits(BitFunction::Lowest), each(1), None;
        FindMsb "findMSB" Class::Bits(BitFunction::Highest), each(1), None;
        PackUnorm2x16 "packUnorm2x16" pack(false, Format::Unorm, 2), each(8), None;
        PackSnorm2x16 "packSnorm2x16" pack(false, Format::Snorm, 2), each(8), None;
        PackUnorm4x8 "packUnorm4x8" pack(false, Format::Unorm, 4), each(16), None;
        PackSnorm4x8 "packSnorm4x8" pack(false, Format::Snorm, 4), each(16), None;
        PackHalf2x16 "packHalf2x16" pack(false, Format::Half, 2), each(4), None;
        UnpackUnorm2x16 "unpackUnorm2x16" pack(true, Format::Unorm, 2), each(3), None;
        UnpackSnorm2x16 "unpackSnorm2x16" pack(true, Format::Snorm, 2), each(3), None;
        UnpackUnorm4x8 "unpackUnorm4x8" pack(true, Format::Unorm, 4), each(3), None;
        UnpackSnorm4x8 "unpackSnorm4x8" pack(true, Format::Snorm, 4), each(3), None;
        UnpackHalf2x16 "unpackHalf2x16" pack(true, Format::Half, 2), each(2), None;
        EmitVertex "EmitVertex" Class::Emission(Emission::Vertex), each(1), None;
        EndPrimitive "EndPrimitive" Class::Emission(Emission::Primitive), each(1), None;
    }
}
