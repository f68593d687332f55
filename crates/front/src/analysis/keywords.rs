//! The type keywords (§3.6, §4.1), one row each, with the version that introduced them.

use crate::hir::{SamplerDim, SamplerType, Scalar, Type};
use crate::syntax::ast::{Extensions, Version};

/// A keyword that names a type.
pub(super) struct Keyword {
    name: &'static str,
    ty: Type,
    since: u16,
    extension: Extensions,
}

const fn row(name: &'static str, ty: Type, since: u16) -> Keyword {
    Keyword { name, ty, since, extension: Extensions::empty() }
}

const fn sampler(texel: Scalar, dim: SamplerDim, arrayed: bool, shadow: bool) -> Type {
    Type::Sampler(SamplerType { texel, dim, arrayed, shadow })
}

use SamplerDim::{Buffer, Cube, D1, D2, D3, Multisample, Rect};
use Scalar::{Bool, Float, Int, Uint};

#[rustfmt::skip]
static KEYWORDS: &[Keyword] = &[
    row("void", Type::Void, 110),
    row("bool", Type::Scalar(Bool), 110), row("int", Type::Scalar(Int), 110),
    row("uint", Type::Scalar(Uint), 130), row("float", Type::Scalar(Float), 110),
    row("vec2", Type::Vector(Float, 2), 110), row("vec3", Type::Vector(Float, 3), 110),
    row("vec4", Type::Vector(Float, 4), 110),
    row("bvec2", Type::Vector(Bool, 2), 110), row("bvec3", Type::Vector(Bool, 3), 110),
    row("bvec4", Type::Vector(Bool, 4), 110),
    row("ivec2", Type::Vector(Int, 2), 110), row("ivec3", Type::Vector(Int, 3), 110),
    row("ivec4", Type::Vector(Int, 4), 110),
    row("uvec2", Type::Vector(Uint, 2), 130), row("uvec3", Type::Vector(Uint, 3), 130),
    row("uvec4", Type::Vector(Uint, 4), 130),
    row("mat2", Type::Matrix(2, 2), 110), row("mat3", Type::Matrix(3, 3), 110), row("mat4", Type::Matrix(4, 4), 110),
    row("mat2x2", Type::Matrix(2, 2), 120), row("mat2x3", Type::Matrix(2, 3), 120), row("mat2x4", Type::Matrix(2, 4), 120),
    row("mat3x2", Type::Matrix(3, 2), 120), row("mat3x3", Type::Matrix(3, 3), 120), row("mat3x4", Type::Matrix(3, 4), 120),
    row("mat4x2", Type::Matrix(4, 2), 120), row("mat4x3", Type::Matrix(4, 3), 120), row("mat4x4", Type::Matrix(4, 4), 120),
    row("sampler1D", sampler(Float, D1, false, false), 110),
    row("sampler2D", sampler(Float, D2, false, false), 110),
    row("sampler3D", sampler(Float, D3, false, false), 110),
    row("samplerCube", sampler(Float, Cube, false, false), 110),
    row("sampler1DShadow", sampler(Float, D1, false, true), 110),
    row("sampler2DShadow", sampler(Float, D2, false, true), 110),
    row("samplerCubeShadow", sampler(Float, Cube, false, true), 130),
    row("sampler1DArray", sampler(Float, D1, true, false), 130),
    row("sampler2DArray", sampler(Float, D2, true, false), 130),
    row("sampler1DArrayShadow", sampler(Float, D1, true, true), 130),
    row("sampler2DArrayShadow", sampler(Float, D2, true, true), 130),
    row("isampler1D", sampler(Int, D1, false, false), 130), row("isampler2D", sampler(Int, D2, false, false), 130),
    row("isampler3D", sampler(Int, D3, false, false), 130), row("isamplerCube", sampler(Int, Cube, false, false), 130),
    row("isampler1DArray", sampler(Int, D1, true, false), 130), row("isampler2DArray", sampler(Int, D2, true, false), 130),
    row("usampler1D", sampler(Uint, D1, false, false), 130), row("usampler2D", sampler(Uint, D2, false, false), 130),
    row("usampler3D", sampler(Uint, D3, false, false), 130), row("usamplerCube", sampler(Uint, Cube, false, false), 130),
    row("usampler1DArray", sampler(Uint, D1, true, false), 130), row("usampler2DArray", sampler(Uint, D2, true, false), 130),
    Keyword { name: "sampler2DRect", ty: sampler(Float, Rect, false, false), since: 140, extension: Extensions::TEXTURE_RECTANGLE },
    Keyword { name: "sampler2DRectShadow", ty: sampler(Float, Rect, false, true), since: 140, extension: Extensions::TEXTURE_RECTANGLE },
    row("isampler2DRect", sampler(Int, Rect, false, false), 140), row("usampler2DRect", sampler(Uint, Rect, false, false), 140),
    row("samplerBuffer", sampler(Float, Buffer, false, false), 140),
    row("isamplerBuffer", sampler(Int, Buffer, false, false), 140),
    row("usamplerBuffer", sampler(Uint, Buffer, false, false), 140),
    row("sampler2DMS", sampler(Float, Multisample, false, false), 150),
    row("isampler2DMS", sampler(Int, Multisample, false, false), 150),
    row("usampler2DMS", sampler(Uint, Multisample, false, false), 150),
    row("sampler2DMSArray", sampler(Float, Multisample, true, false), 150),
    row("isampler2DMSArray", sampler(Int, Multisample, true, false), 150),
    row("usampler2DMSArray", sampler(Uint, Multisample, true, false), 150),
];

/// The type that a keyword denotes in a version of the language with these extensions.
pub(super) fn type_of(name: &str, version: Version, extensions: Extensions) -> Option<Type> {
    let keyword = KEYWORDS.iter().find(|keyword| keyword.name == name)?;
    let known = version.number >= keyword.since || extensions.intersects(keyword.extension);
    known.then_some(keyword.ty)
}

/// All type keywords, for "did you mean".
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    KEYWORDS.iter().map(|keyword| keyword.name)
}
