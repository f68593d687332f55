//! The identities of built-in functions and variables.

macro_rules! identities {
    ($(#[$doc:meta])* $name:ident { $($variant:ident = $spelling:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the names are those of the specification")]
        pub enum $name { $($variant,)* }

        impl $name {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name in GLSL.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $spelling,)* }
            }
        }
    };
}

identities!(
    /// A built-in function by what it computes; which overload is meant, the argument types tell. Older names of one
    /// computation (`texture2D`, `shadow2D`) share an identity.
    BuiltinFunction {
        Radians = "radians",
        Degrees = "degrees",
        Sin = "sin",
        Cos = "cos",
        Tan = "tan",
        Asin = "asin",
        Acos = "acos",
        Atan = "atan",
        Sinh = "sinh",
        Cosh = "cosh",
        Tanh = "tanh",
        Asinh = "asinh",
        Acosh = "acosh",
        Atanh = "atanh",
        Pow = "pow",
        Exp = "exp",
        Log = "log",
        Exp2 = "exp2",
        Log2 = "log2",
        Sqrt = "sqrt",
        Inversesqrt = "inversesqrt",
        Abs = "abs",
        Sign = "sign",
        Floor = "floor",
        Trunc = "trunc",
        Round = "round",
        RoundEven = "roundEven",
        Ceil = "ceil",
        Fract = "fract",
        Mod = "mod",
        Modf = "modf",
        Min = "min",
        Max = "max",
        Clamp = "clamp",
        Mix = "mix",
        Step = "step",
        Smoothstep = "smoothstep",
        Isnan = "isnan",
        Isinf = "isinf",
        Length = "length",
        Distance = "distance",
        Dot = "dot",
        Cross = "cross",
        Normalize = "normalize",
        Faceforward = "faceforward",
        Reflect = "reflect",
        Refract = "refract",
        MatrixCompMult = "matrixCompMult",
        OuterProduct = "outerProduct",
        Transpose = "transpose",
        Determinant = "determinant",
        Inverse = "inverse",
        LessThan = "lessThan",
        LessThanEqual = "lessThanEqual",
        GreaterThan = "greaterThan",
        GreaterThanEqual = "greaterThanEqual",
        Equal = "equal",
        NotEqual = "notEqual",
        Any = "any",
        All = "all",
        Not = "not",
        TextureSize = "textureSize",
        Texture = "texture",
        TextureProj = "textureProj",
        TextureLod = "textureLod",
        TextureOffset = "textureOffset",
        TexelFetch = "texelFetch",
        TexelFetchOffset = "texelFetchOffset",
        TextureProjOffset = "textureProjOffset",
        TextureLodOffset = "textureLodOffset",
        TextureProjLod = "textureProjLod",
        TextureProjLodOffset = "textureProjLodOffset",
        TextureGrad = "textureGrad",
        TextureGradOffset = "textureGradOffset",
        TextureProjGrad = "textureProjGrad",
        TextureProjGradOffset = "textureProjGradOffset",
        DFdx = "dFdx",
        DFdy = "dFdy",
        Fwidth = "fwidth",
        Noise1 = "noise1",
        Noise2 = "noise2",
        Noise3 = "noise3",
        Noise4 = "noise4",
        EmitVertex = "EmitVertex",
        EndPrimitive = "EndPrimitive",
    }
);

identities!(
    /// A built-in variable (§7.1, §7.2, §7.5). `gl_in` is the block of a geometry shader's inputs, whose members are
    /// ordinary struct members named `gl_Position`, `gl_PointSize`, `gl_ClipDistance`. `gl_DepthRange` is a loose uniform
    /// like any other, which link gives the default (0, 1, 1).
    BuiltinVariable {
        Position = "gl_Position",
        PointSize = "gl_PointSize",
        ClipDistance = "gl_ClipDistance",
        VertexId = "gl_VertexID",
        InstanceId = "gl_InstanceID",
        In = "gl_in",
        PrimitiveIdIn = "gl_PrimitiveIDIn",
        PrimitiveId = "gl_PrimitiveID",
        Layer = "gl_Layer",
        FragCoord = "gl_FragCoord",
        FrontFacing = "gl_FrontFacing",
        PointCoord = "gl_PointCoord",
        FragColor = "gl_FragColor",
        FragData = "gl_FragData",
        FragDepth = "gl_FragDepth",
        DepthRange = "gl_DepthRange",
    }
);
