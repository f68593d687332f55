//! Tables from a scene's fixed-function state to OpenGL's enumerants.

use super::api::PixelLayout;
use glisten_scene::{BlendFactor, Compare, Format, Primitive, Wrap};

/// How an attachment is stored and read.
pub(super) fn color_layout(format: Format) -> PixelLayout {
    let layout = |internal, format, kind, bytes| PixelLayout { internal, format, kind, bytes };
    match format {
        Format::Rgba32Float => layout(glow::RGBA32F, glow::RGBA, glow::FLOAT, 16),
        Format::Rgba16Float => layout(glow::RGBA16F, glow::RGBA, glow::FLOAT, 16),
        Format::Rgba8Unorm => layout(glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE, 4),
        Format::Rgba32Sint => layout(glow::RGBA32I, glow::RGBA_INTEGER, glow::INT, 16),
        Format::Rgba32Uint => layout(glow::RGBA32UI, glow::RGBA_INTEGER, glow::UNSIGNED_INT, 16),
    }
}

/// How the stencil is stored (next to a 32-bit float depth) and read.
pub(super) const STENCIL: PixelLayout =
    PixelLayout { internal: glow::DEPTH32F_STENCIL8, format: glow::STENCIL_INDEX, kind: glow::UNSIGNED_BYTE, bytes: 1 };

/// The mode of `glDraw*` for a primitive.
pub(super) fn mode(primitive: Primitive) -> u32 {
    match primitive {
        Primitive::Points => glow::POINTS,
        Primitive::Lines => glow::LINES,
        Primitive::LineStrip => glow::LINE_STRIP,
        Primitive::LineLoop => glow::LINE_LOOP,
        Primitive::Triangles => glow::TRIANGLES,
        Primitive::TriangleStrip => glow::TRIANGLE_STRIP,
        Primitive::TriangleFan => glow::TRIANGLE_FAN,
        Primitive::LinesAdjacency => glow::LINES_ADJACENCY,
        Primitive::LineStripAdjacency => glow::LINE_STRIP_ADJACENCY,
        Primitive::TrianglesAdjacency => glow::TRIANGLES_ADJACENCY,
        Primitive::TriangleStripAdjacency => glow::TRIANGLE_STRIP_ADJACENCY,
    }
}

/// The comparison function.
pub(super) fn compare(function: Compare) -> u32 {
    match function {
        Compare::Never => glow::NEVER,
        Compare::Less => glow::LESS,
        Compare::Equal => glow::EQUAL,
        Compare::Lequal => glow::LEQUAL,
        Compare::Greater => glow::GREATER,
        Compare::Notequal => glow::NOTEQUAL,
        Compare::Gequal => glow::GEQUAL,
        Compare::Always => glow::ALWAYS,
    }
}

/// The blend factor.
pub(super) fn factor(factor: BlendFactor) -> u32 {
    match factor {
        BlendFactor::Zero => glow::ZERO,
        BlendFactor::One => glow::ONE,
        BlendFactor::SrcColor => glow::SRC_COLOR,
        BlendFactor::OneMinusSrcColor => glow::ONE_MINUS_SRC_COLOR,
        BlendFactor::DstColor => glow::DST_COLOR,
        BlendFactor::OneMinusDstColor => glow::ONE_MINUS_DST_COLOR,
        BlendFactor::SrcAlpha => glow::SRC_ALPHA,
        BlendFactor::OneMinusSrcAlpha => glow::ONE_MINUS_SRC_ALPHA,
        BlendFactor::DstAlpha => glow::DST_ALPHA,
        BlendFactor::OneMinusDstAlpha => glow::ONE_MINUS_DST_ALPHA,
        BlendFactor::SrcAlphaSaturate => glow::SRC_ALPHA_SATURATE,
        BlendFactor::ConstantColor => glow::CONSTANT_COLOR,
        BlendFactor::OneMinusConstantColor => glow::ONE_MINUS_CONSTANT_COLOR,
        BlendFactor::ConstantAlpha => glow::CONSTANT_ALPHA,
        BlendFactor::OneMinusConstantAlpha => glow::ONE_MINUS_CONSTANT_ALPHA,
    }
}

/// The wrap mode.
pub(super) fn wrap(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => glow::REPEAT,
        Wrap::ClampToEdge => glow::CLAMP_TO_EDGE,
        Wrap::MirroredRepeat => glow::MIRRORED_REPEAT,
    }
}
