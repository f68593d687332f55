//! Tables from OpenGL's fixed-function state to wgpu's.

use glisten_scene::{Blend, BlendFactor, Compare, Cull, Filter, Format, Primitive, State, Wrap};
use wgpu_types as wgpu;

/// The texture format of a color attachment.
pub fn color_format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        Format::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        Format::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        Format::Rgba32Sint => wgpu::TextureFormat::Rgba32Sint,
        Format::Rgba32Uint => wgpu::TextureFormat::Rgba32Uint,
    }
}

/// The number of bytes of a pixel.
pub fn pixel_size(format: Format) -> u32 {
    match format {
        Format::Rgba32Float | Format::Rgba32Sint | Format::Rgba32Uint => 16,
        Format::Rgba16Float => 8,
        Format::Rgba8Unorm => 4,
    }
}

/// The list topology that strips, fans and loops are expanded to.
pub fn topology(primitive: Primitive) -> wgpu::PrimitiveTopology {
    match primitive {
        Primitive::Points => wgpu::PrimitiveTopology::PointList,
        Primitive::Lines
        | Primitive::LineStrip
        | Primitive::LineLoop
        | Primitive::LinesAdjacency
        | Primitive::LineStripAdjacency => wgpu::PrimitiveTopology::LineList,
        Primitive::Triangles
        | Primitive::TriangleStrip
        | Primitive::TriangleFan
        | Primitive::TrianglesAdjacency
        | Primitive::TriangleStripAdjacency => wgpu::PrimitiveTopology::TriangleList,
    }
}

/// Culling and front faces. The picture is upright, so counterclockwise stays counterclockwise.
pub fn primitive_state(state: &State) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology: topology(state.primitive),
        front_face: if state.front_ccw { wgpu::FrontFace::Ccw } else { wgpu::FrontFace::Cw },
        cull_mode: match state.cull {
            Cull::None => None,
            Cull::Front => Some(wgpu::Face::Front),
            Cull::Back => Some(wgpu::Face::Back),
        },
        ..wgpu::PrimitiveState::default()
    }
}

/// The comparison function.
pub fn compare(function: Compare) -> wgpu::CompareFunction {
    match function {
        Compare::Never => wgpu::CompareFunction::Never,
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::Lequal => wgpu::CompareFunction::LessEqual,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::Notequal => wgpu::CompareFunction::NotEqual,
        Compare::Gequal => wgpu::CompareFunction::GreaterEqual,
        Compare::Always => wgpu::CompareFunction::Always,
    }
}

/// The depth test, and a stencil that becomes 1 wherever a fragment is written, which is the coverage.
pub fn depth_stencil(state: &State) -> wgpu::DepthStencilState {
    let mark = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::Replace,
    };
    let test = if state.depth_test { compare(state.depth_func) } else { wgpu::CompareFunction::Always };
    wgpu::DepthStencilState {
        format: wgpu::TextureFormat::Depth32FloatStencil8,
        depth_write_enabled: Some(state.depth_test && state.depth_write),
        depth_compare: Some(test),
        stencil: wgpu::StencilState { front: mark, back: mark, read_mask: 0xff, write_mask: 0xff },
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Blend factors, the same for color and alpha. The constant is set apart: [`Blend::one_constant`].
pub fn blend(blend: Blend) -> wgpu::BlendState {
    let component = wgpu::BlendComponent {
        src_factor: factor(blend.source),
        dst_factor: factor(blend.destination),
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState { color: component, alpha: component }
}

fn factor(factor: BlendFactor) -> wgpu::BlendFactor {
    match factor {
        BlendFactor::Zero => wgpu::BlendFactor::Zero,
        BlendFactor::One => wgpu::BlendFactor::One,
        BlendFactor::SrcColor => wgpu::BlendFactor::Src,
        BlendFactor::OneMinusSrcColor => wgpu::BlendFactor::OneMinusSrc,
        BlendFactor::DstColor => wgpu::BlendFactor::Dst,
        BlendFactor::OneMinusDstColor => wgpu::BlendFactor::OneMinusDst,
        BlendFactor::SrcAlpha => wgpu::BlendFactor::SrcAlpha,
        BlendFactor::OneMinusSrcAlpha => wgpu::BlendFactor::OneMinusSrcAlpha,
        BlendFactor::DstAlpha => wgpu::BlendFactor::DstAlpha,
        BlendFactor::OneMinusDstAlpha => wgpu::BlendFactor::OneMinusDstAlpha,
        BlendFactor::SrcAlphaSaturate => wgpu::BlendFactor::SrcAlphaSaturated,
        BlendFactor::ConstantColor | BlendFactor::ConstantAlpha => wgpu::BlendFactor::Constant,
        BlendFactor::OneMinusConstantColor | BlendFactor::OneMinusConstantAlpha => wgpu::BlendFactor::OneMinusConstant,
    }
}

/// The address mode of a wrap mode.
pub fn address_mode(wrap: Wrap) -> wgpu::AddressMode {
    match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
    }
}

/// The filter within a level.
pub fn filter_mode(filter: Filter) -> wgpu::FilterMode {
    if filter.is_linear() { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest }
}
