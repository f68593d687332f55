//! [`Matcher`]: the types that a parameter of a built-in function accepts, and their names in the table.

#![expect(non_upper_case_globals, reason = "the constants are spelled as the specification's placeholders")]

use crate::language::{ParamMode, SamplerDim, SamplerType, Scalar, TypeId};

/// The types that a parameter accepts. All placeholders of one row vary together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matcher {
    /// One type.
    Fixed(TypeId),
    /// `genType` and similar: the scalar and the vectors of two to four components.
    Gen(Scalar),
    /// `out genType`.
    OutGen(Scalar),
    /// `vec` and similar: the vectors of two to four components.
    Vec(Scalar),
    /// `mat`: all nine matrices.
    Mat,
    /// `gsampler2D` and similar: float, `int` and `uint` texels.
    GSampler(SamplerDim, bool),
    /// `gvec4`: the texel of a `gsampler`.
    GVec4,
    /// `[, float bias]`
    OptionalBias,
}

impl Matcher {
    /// The number of types.
    pub(super) fn n_types(self) -> u8 {
        match self {
            Self::Fixed(_) | Self::OptionalBias => 1,
            Self::Gen(_) | Self::OutGen(_) => 4,
            Self::Vec(_) | Self::GSampler(..) | Self::GVec4 => 3,
            Self::Mat => 9,
        }
    }

    /// The type with this index.
    pub(super) fn choose(self, choice: u8) -> TypeId {
        let texel = match choice {
            0 => Scalar::Float,
            1 => Scalar::Int,
            _ => Scalar::Uint,
        };
        match self {
            Self::Fixed(ty) => ty,
            Self::OptionalBias => TypeId::FLOAT,
            Self::Gen(scalar) | Self::OutGen(scalar) => TypeId::vector(scalar, choice + 1),
            Self::Vec(scalar) => TypeId::vector(scalar, choice + 2),
            Self::Mat => TypeId::matrix(choice / 3 + 2, choice % 3 + 2),
            Self::GSampler(dim, arrayed) => TypeId::sampler(SamplerType { texel, dim, arrayed, shadow: false }),
            Self::GVec4 => TypeId::vector(texel, 4),
        }
    }

    /// How the argument is passed.
    pub fn mode(self) -> ParamMode {
        match self {
            Self::OutGen(_) => ParamMode::Out,
            _ => ParamMode::In,
        }
    }

    /// The spelling of the specification.
    pub fn spelling(self) -> String {
        let prefix = |scalar: Scalar| match scalar {
            Scalar::Bool => "B",
            Scalar::Int => "I",
            Scalar::Uint => "U",
            Scalar::Float => "",
        };
        match self {
            Self::Fixed(ty) => crate::language::Types::basic().name(ty),
            Self::Gen(scalar) => format!("gen{}Type", prefix(scalar)),
            Self::OutGen(scalar) => format!("out gen{}Type", prefix(scalar)),
            Self::Vec(scalar) => format!("{}vec", prefix(scalar).to_ascii_lowercase()),
            Self::Mat => "mat".into(),
            Self::GSampler(dim, arrayed) => {
                format!("g{}", SamplerType { texel: Scalar::Float, dim, arrayed, shadow: false }.name())
            }
            Self::GVec4 => "gvec4".into(),
            Self::OptionalBias => "float".into(),
        }
    }
}

const fn fixed(scalar: Scalar, size: u8) -> Matcher {
    Matcher::Fixed(TypeId::vector(scalar, size))
}

const fn matrix(columns: u8, rows: u8) -> Matcher {
    Matcher::Fixed(TypeId::matrix(columns, rows))
}

const fn plain(dim: SamplerDim, arrayed: bool) -> Matcher {
    Matcher::Fixed(TypeId::sampler(SamplerType { texel: Scalar::Float, dim, arrayed, shadow: false }))
}

const fn texels(texel: Scalar, dim: SamplerDim) -> Matcher {
    Matcher::Fixed(TypeId::sampler(SamplerType { texel, dim, arrayed: false, shadow: false }))
}

const fn shadow(dim: SamplerDim, arrayed: bool) -> Matcher {
    Matcher::Fixed(TypeId::sampler(SamplerType { texel: Scalar::Float, dim, arrayed, shadow: true }))
}

macro_rules! names {
    ($($name:ident = $matcher:expr;)*) => {
        $(pub(super) const $name: Matcher = $matcher;)*
    };
}

names! {
    void = Matcher::Fixed(TypeId::VOID);
    bool = fixed(Scalar::Bool, 1);
    int = fixed(Scalar::Int, 1);
    uint = fixed(Scalar::Uint, 1);
    float = fixed(Scalar::Float, 1);
    vec2 = fixed(Scalar::Float, 2);
    vec3 = fixed(Scalar::Float, 3);
    vec4 = fixed(Scalar::Float, 4);
    ivec2 = fixed(Scalar::Int, 2);
    ivec3 = fixed(Scalar::Int, 3);
    four_ivec2 = Matcher::Fixed(TypeId::FOUR_OFFSETS);
    mat2 = matrix(2, 2);
    mat3 = matrix(3, 3);
    mat4 = matrix(4, 4);
    mat2x3 = matrix(2, 3);
    mat2x4 = matrix(2, 4);
    mat3x2 = matrix(3, 2);
    mat3x4 = matrix(3, 4);
    mat4x2 = matrix(4, 2);
    mat4x3 = matrix(4, 3);
    genType = Matcher::Gen(Scalar::Float);
    genIType = Matcher::Gen(Scalar::Int);
    genUType = Matcher::Gen(Scalar::Uint);
    genBType = Matcher::Gen(Scalar::Bool);
    out_genType = Matcher::OutGen(Scalar::Float);
    out_genIType = Matcher::OutGen(Scalar::Int);
    out_genUType = Matcher::OutGen(Scalar::Uint);
    vec = Matcher::Vec(Scalar::Float);
    ivec = Matcher::Vec(Scalar::Int);
    uvec = Matcher::Vec(Scalar::Uint);
    bvec = Matcher::Vec(Scalar::Bool);
    mat = Matcher::Mat;
    gvec4 = Matcher::GVec4;
    optional = Matcher::OptionalBias;
    gsampler1D = Matcher::GSampler(SamplerDim::D1, false);
    gsampler2D = Matcher::GSampler(SamplerDim::D2, false);
    gsampler3D = Matcher::GSampler(SamplerDim::D3, false);
    gsamplerCube = Matcher::GSampler(SamplerDim::Cube, false);
    gsamplerCubeArray = Matcher::GSampler(SamplerDim::Cube, true);
    gsampler2DRect = Matcher::GSampler(SamplerDim::Rect, false);
    gsampler1DArray = Matcher::GSampler(SamplerDim::D1, true);
    gsampler2DArray = Matcher::GSampler(SamplerDim::D2, true);
    gsamplerBuffer = Matcher::GSampler(SamplerDim::Buffer, false);
    gsampler2DMS = Matcher::GSampler(SamplerDim::Multisample, false);
    gsampler2DMSArray = Matcher::GSampler(SamplerDim::Multisample, true);
    sampler1D = plain(SamplerDim::D1, false);
    sampler2D = plain(SamplerDim::D2, false);
    sampler3D = plain(SamplerDim::D3, false);
    samplerCube = plain(SamplerDim::Cube, false);
    sampler2DRect = plain(SamplerDim::Rect, false);
    ivec4 = fixed(Scalar::Int, 4);
    uvec4 = fixed(Scalar::Uint, 4);
    isampler1D = texels(Scalar::Int, SamplerDim::D1);
    usampler1D = texels(Scalar::Uint, SamplerDim::D1);
    isampler2D = texels(Scalar::Int, SamplerDim::D2);
    usampler2D = texels(Scalar::Uint, SamplerDim::D2);
    isampler3D = texels(Scalar::Int, SamplerDim::D3);
    usampler3D = texels(Scalar::Uint, SamplerDim::D3);
    isamplerCube = texels(Scalar::Int, SamplerDim::Cube);
    usamplerCube = texels(Scalar::Uint, SamplerDim::Cube);
    sampler1DShadow = shadow(SamplerDim::D1, false);
    sampler2DShadow = shadow(SamplerDim::D2, false);
    samplerCubeShadow = shadow(SamplerDim::Cube, false);
    samplerCubeArrayShadow = shadow(SamplerDim::Cube, true);
    sampler2DRectShadow = shadow(SamplerDim::Rect, false);
    sampler1DArrayShadow = shadow(SamplerDim::D1, true);
    sampler2DArrayShadow = shadow(SamplerDim::D2, true);
}
