//! The type keywords (§3.6, §4.1), one row each. The table of keywords (`syntax`) has their versions.

use crate::hir::{SamplerDim, SamplerType, Scalar, Type};
use crate::language::{Extensions, Version};
use crate::syntax::keywords::is_keyword;

/// A keyword that names a type.
pub(super) struct Keyword {
    name: &'static str,
    ty: Type,
}

const fn row(name: &'static str, ty: Type) -> Keyword {
    Keyword { name, ty }
}

const fn sampler(texel: Scalar, dim: SamplerDim, arrayed: bool, shadow: bool) -> Type {
    Type::Sampler(SamplerType { texel, dim, arrayed, shadow })
}

use SamplerDim::{Buffer, Cube, D1, D2, D3, Multisample, Rect};
use Scalar::{Bool, Float, Int, Uint};

#[rustfmt::skip]
static KEYWORDS: &[Keyword] = &[
    row("void", Type::Void),
    row("bool", Type::Scalar(Bool)), row("int", Type::Scalar(Int)),
    row("uint", Type::Scalar(Uint)), row("float", Type::Scalar(Float)),
    row("vec2", Type::Vector(Float, 2)), row("vec3", Type::Vector(Float, 3)),
    row("vec4", Type::Vector(Float, 4)),
    row("bvec2", Type::Vector(Bool, 2)), row("bvec3", Type::Vector(Bool, 3)),
    row("bvec4", Type::Vector(Bool, 4)),
    row("ivec2", Type::Vector(Int, 2)), row("ivec3", Type::Vector(Int, 3)),
    row("ivec4", Type::Vector(Int, 4)),
    row("uvec2", Type::Vector(Uint, 2)), row("uvec3", Type::Vector(Uint, 3)),
    row("uvec4", Type::Vector(Uint, 4)),
    row("mat2", Type::Matrix(2, 2)), row("mat3", Type::Matrix(3, 3)), row("mat4", Type::Matrix(4, 4)),
    row("mat2x2", Type::Matrix(2, 2)), row("mat2x3", Type::Matrix(2, 3)), row("mat2x4", Type::Matrix(2, 4)),
    row("mat3x2", Type::Matrix(3, 2)), row("mat3x3", Type::Matrix(3, 3)), row("mat3x4", Type::Matrix(3, 4)),
    row("mat4x2", Type::Matrix(4, 2)), row("mat4x3", Type::Matrix(4, 3)), row("mat4x4", Type::Matrix(4, 4)),
    row("sampler1D", sampler(Float, D1, false, false)),
    row("sampler2D", sampler(Float, D2, false, false)),
    row("sampler3D", sampler(Float, D3, false, false)),
    row("samplerCube", sampler(Float, Cube, false, false)),
    row("sampler1DShadow", sampler(Float, D1, false, true)),
    row("sampler2DShadow", sampler(Float, D2, false, true)),
    row("samplerCubeShadow", sampler(Float, Cube, false, true)),
    row("sampler1DArray", sampler(Float, D1, true, false)),
    row("sampler2DArray", sampler(Float, D2, true, false)),
    row("sampler1DArrayShadow", sampler(Float, D1, true, true)),
    row("sampler2DArrayShadow", sampler(Float, D2, true, true)),
    row("isampler1D", sampler(Int, D1, false, false)), row("isampler2D", sampler(Int, D2, false, false)),
    row("isampler3D", sampler(Int, D3, false, false)), row("isamplerCube", sampler(Int, Cube, false, false)),
    row("isampler1DArray", sampler(Int, D1, true, false)), row("isampler2DArray", sampler(Int, D2, true, false)),
    row("usampler1D", sampler(Uint, D1, false, false)), row("usampler2D", sampler(Uint, D2, false, false)),
    row("usampler3D", sampler(Uint, D3, false, false)), row("usamplerCube", sampler(Uint, Cube, false, false)),
    row("usampler1DArray", sampler(Uint, D1, true, false)), row("usampler2DArray", sampler(Uint, D2, true, false)),
    row("sampler2DRect", sampler(Float, Rect, false, false)),
    row("sampler2DRectShadow", sampler(Float, Rect, false, true)),
    row("isampler2DRect", sampler(Int, Rect, false, false)), row("usampler2DRect", sampler(Uint, Rect, false, false)),
    row("samplerBuffer", sampler(Float, Buffer, false, false)),
    row("isamplerBuffer", sampler(Int, Buffer, false, false)),
    row("usamplerBuffer", sampler(Uint, Buffer, false, false)),
    row("sampler2DMS", sampler(Float, Multisample, false, false)),
    row("isampler2DMS", sampler(Int, Multisample, false, false)),
    row("usampler2DMS", sampler(Uint, Multisample, false, false)),
    row("sampler2DMSArray", sampler(Float, Multisample, true, false)),
    row("isampler2DMSArray", sampler(Int, Multisample, true, false)),
    row("usampler2DMSArray", sampler(Uint, Multisample, true, false)),
    row("samplerCubeArray", sampler(Float, Cube, true, false)),
    row("samplerCubeArrayShadow", sampler(Float, Cube, true, true)),
    row("isamplerCubeArray", sampler(Int, Cube, true, false)),
    row("usamplerCubeArray", sampler(Uint, Cube, true, false)),
];

/// The type that a keyword denotes. Where a word is a keyword, the table of keywords knows.
pub(super) fn type_of(name: &str) -> Option<Type> {
    KEYWORDS.iter().find(|keyword| keyword.name == name).map(|keyword| keyword.ty)
}

/// The type keywords of a language that are constructors, for "did you mean".
pub(super) fn constructors(version: Version, extensions: Extensions) -> impl Iterator<Item = &'static str> {
    let constructs = |ty: &Type| matches!(ty, Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..));
    of_language(version, extensions).filter(move |keyword| constructs(&keyword.ty)).map(|keyword| keyword.name)
}

/// All type keywords of a language, for "did you mean".
pub(super) fn names(version: Version, extensions: Extensions) -> impl Iterator<Item = &'static str> {
    of_language(version, extensions).map(|keyword| keyword.name)
}

fn of_language(version: Version, extensions: Extensions) -> impl Iterator<Item = &'static Keyword> {
    KEYWORDS.iter().filter(move |keyword| is_keyword(keyword.name, version, extensions))
}
