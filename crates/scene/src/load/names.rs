//! The names that scene files use for fixed-function state, one row per name.

use crate::model::{Blend, BlendFactor, Cull, Filter, Format, Primitive};
use glisten_front::hir::{SamplerDim, Scalar};

pub(super) const FORMATS: &[(&str, Format)] = &[
    ("rgba32float", Format::Rgba32Float),
    ("rgba16float", Format::Rgba16Float),
    ("rgba8unorm", Format::Rgba8Unorm),
    ("rgba32sint", Format::Rgba32Sint),
    ("rgba32uint", Format::Rgba32Uint),
];

pub(super) const PRIMITIVES: &[(&str, Primitive)] = &[
    ("points", Primitive::Points),
    ("lines", Primitive::Lines),
    ("line_strip", Primitive::LineStrip),
    ("line_loop", Primitive::LineLoop),
    ("triangles", Primitive::Triangles),
    ("triangle_strip", Primitive::TriangleStrip),
    ("triangle_fan", Primitive::TriangleFan),
    ("lines_adjacency", Primitive::LinesAdjacency),
    ("line_strip_adjacency", Primitive::LineStripAdjacency),
    ("triangles_adjacency", Primitive::TrianglesAdjacency),
    ("triangle_strip_adjacency", Primitive::TriangleStripAdjacency),
];

pub(super) const CULLS: &[(&str, Cull)] = &[("none", Cull::None), ("front", Cull::Front), ("back", Cull::Back)];

/// Whether counterclockwise faces are front faces.
pub(super) const FRONT_FACES: &[(&str, bool)] = &[("ccw", true), ("cw", false)];

/// Whether the last vertex is the provoking one.
pub(super) const PROVOKING: &[(&str, bool)] = &[("last", true), ("first", false)];

pub(super) const BLENDS: &[(&str, Option<Blend>)] = &[
    ("none", None),
    ("alpha", Some(Blend::new(BlendFactor::SrcAlpha, BlendFactor::OneMinusSrcAlpha))),
    ("add", Some(Blend::new(BlendFactor::One, BlendFactor::One))),
    ("multiply", Some(Blend::new(BlendFactor::DstColor, BlendFactor::Zero))),
];

pub(super) const FILTERS: &[(&str, Filter)] = &[
    ("nearest", Filter::Nearest),
    ("linear", Filter::Linear),
    ("trilinear", Filter::Trilinear),
    ("nearest_mipmap_nearest", Filter::NearestMipmapNearest),
    ("linear_mipmap_nearest", Filter::LinearMipmapNearest),
    ("nearest_mipmap_linear", Filter::NearestMipmapLinear),
];

pub(super) const ATTRIBUTE_KINDS: &[(&str, Scalar)] =
    &[("float", Scalar::Float), ("int", Scalar::Int), ("uint", Scalar::Uint)];

/// The dimensionality of a texture, whether it is an array, and whether it is for a shadow sampler.
pub(super) type TextureKind = (SamplerDim, bool, bool);

pub(super) const TEXTURE_KINDS: &[(&str, TextureKind)] = &[
    ("1d", (SamplerDim::D1, false, false)),
    ("2d", (SamplerDim::D2, false, false)),
    ("3d", (SamplerDim::D3, false, false)),
    ("cube", (SamplerDim::Cube, false, false)),
    ("rect", (SamplerDim::Rect, false, false)),
    ("buffer", (SamplerDim::Buffer, false, false)),
    ("1d_array", (SamplerDim::D1, true, false)),
    ("2d_array", (SamplerDim::D2, true, false)),
    ("cube_array", (SamplerDim::Cube, true, false)),
    ("2d_multisample", (SamplerDim::Multisample, false, false)),
    ("2d_multisample_array", (SamplerDim::Multisample, true, false)),
    ("shadow_1d", (SamplerDim::D1, false, true)),
    ("shadow_2d", (SamplerDim::D2, false, true)),
    ("shadow_cube", (SamplerDim::Cube, false, true)),
    ("shadow_rect", (SamplerDim::Rect, false, true)),
    ("shadow_1d_array", (SamplerDim::D1, true, true)),
    ("shadow_2d_array", (SamplerDim::D2, true, true)),
    ("shadow_cube_array", (SamplerDim::Cube, true, true)),
];

/// The name of a kind, for messages.
pub(super) fn kind_name(kind: TextureKind) -> &'static str {
    TEXTURE_KINDS.iter().find(|(_, candidate)| *candidate == kind).map_or("cube", |(name, _)| name)
}
