//! [`Scene`]: a scene with every name resolved.

use glisten_front::hir::{SamplerType, ScalarValue};
use glisten_front::link::Program;
use std::sync::Arc;

/// Everything that one picture needs.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The stem of the scene file's name.
    pub name: String,
    /// What is drawn to.
    pub framebuffer: Framebuffer,
    /// What is drawn, in order.
    pub draws: Vec<Draw>,
}

/// The color attachments and the depth buffer (cleared to 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framebuffer {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from bottom to top.
    pub height: u32,
    /// The color that every attachment is cleared to.
    pub clear: [f64; 4],
    /// The format of every attachment.
    pub format: Format,
    /// How many color attachments.
    pub attachments: u32,
}

/// The format of a color attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Format {
    Rgba32Float,
    Rgba16Float,
    Rgba8Unorm,
    Rgba32Sint,
    Rgba32Uint,
}

/// How vertices make primitives (OpenGL 3.2 §2.6.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Primitive {
    Points,
    Lines,
    LineStrip,
    LineLoop,
    Triangles,
    TriangleStrip,
    TriangleFan,
}

/// Which faces are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Cull {
    None,
    Front,
    Back,
}

/// Comparison functions of the depth test and of shadow samplers: reference `op` stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Compare {
    Never,
    Less,
    Equal,
    Lequal,
    Greater,
    Notequal,
    Gequal,
    Always,
}

/// Blend factors (OpenGL 3.2 table 4.2), the constant-color ones left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BlendFactor {
    Zero,
    One,
    SrcColor,
    OneMinusSrcColor,
    DstColor,
    OneMinusDstColor,
    SrcAlpha,
    OneMinusSrcAlpha,
    DstAlpha,
    OneMinusDstAlpha,
    SrcAlphaSaturate,
}

/// Fixed state of a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The primitive.
    pub primitive: Primitive,
    /// Which faces are dropped.
    pub cull: Cull,
    /// Whether counterclockwise in the window is front.
    pub front_ccw: bool,
    /// Whether the last vertex provokes (OpenGL's default), or the first.
    pub provoking_last: bool,
    /// Whether the depth test is on; without it depth is not written either.
    pub depth_test: bool,
    /// Whether a passed test writes.
    pub depth_write: bool,
    /// The test.
    pub depth_func: Compare,
    /// Source and destination factor for color and alpha alike; `None` for no blending.
    pub blend: Option<(BlendFactor, BlendFactor)>,
    /// How many clip distances are enabled.
    pub clip_distances: u32,
    /// Whether `gl_PointSize` counts; else points are one pixel wide.
    pub program_point_size: bool,
}

/// One draw call.
#[derive(Clone, Debug)]
pub struct Draw {
    /// The program.
    pub program: Arc<Program>,
    /// Fixed state.
    pub state: State,
    /// How many vertices are drawn: entries of `indices`, if there are any.
    pub vertex_count: u32,
    /// Indices of vertices; every one is below the length of each attribute's data.
    pub indices: Option<Vec<u32>>,
    /// How many instances.
    pub instances: u32,
    /// Data of each of the interface's attributes, in its order; `None` for inactive ones without data.
    pub attributes: Vec<Option<AttributeData>>,
    /// The value of each of the interface's roots, in its order, flat ([`Types::flat_len`](glisten_front::hir::Types::flat_len)).
    pub uniforms: Vec<Vec<ScalarValue>>,
    /// The texture of each of the interface's sampler slots, in its order.
    pub textures: Vec<Option<Arc<Texture>>>,
    /// Uniforms that change from frame to frame.
    pub dynamic: Vec<String>,
}

/// Data of one attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeData {
    /// Numbers a vertex, at most as many as the declared type has; for matrices all columns.
    pub size: u32,
    /// 0: a row a vertex; n: a row every n instances.
    pub divisor: u32,
    /// The numbers.
    pub values: AttributeValues,
}

/// The numbers of an attribute.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum AttributeValues {
    Float(Vec<f32>),
    Int(Vec<i32>),
    Uint(Vec<u32>),
}

impl AttributeValues {
    /// How many numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Int(values) => values.len(),
            Self::Uint(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl AttributeData {
    /// Component `component` of column `column` (of columns `rows` components high) for a vertex and an instance.
    /// Missing components come from (0, 0, 0, 1); rows past the end are (0, 0, 0, 1), too.
    pub fn fetch(&self, vertex: u32, instance: u32, column: u32, rows: u32, component: u32) -> ScalarValue {
        let row = instance.checked_div(self.divisor).unwrap_or(vertex);
        let within = column * rows + component;
        let index = row as usize * self.size as usize + within as usize;
        let present = within < self.size && index < self.values.len();
        let missing = u8::from(component == 3);
        match &self.values {
            AttributeValues::Float(values) => {
                ScalarValue::Float(values.get(index).copied().filter(|_| present).unwrap_or(f32::from(missing)))
            }
            AttributeValues::Int(values) => {
                ScalarValue::Int(values.get(index).copied().filter(|_| present).unwrap_or(i32::from(missing)))
            }
            AttributeValues::Uint(values) => {
                ScalarValue::Uint(values.get(index).copied().filter(|_| present).unwrap_or(u32::from(missing)))
            }
        }
    }
}

/// Magnification and minification alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Filter {
    Nearest,
    Linear,
    /// Linear within and between levels.
    Trilinear,
}

/// What is outside `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Wrap {
    Repeat,
    ClampToEdge,
    MirroredRepeat,
}

/// The texels of a level, RGBA each.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Texels {
    Float(Vec<[f32; 4]>),
    Int(Vec<[i32; 4]>),
    Uint(Vec<[u32; 4]>),
}

/// A level of a texture: x fastest, then y (first row at t = 0), then z, layer or face (+X -X +Y -Y +Z -Z).
#[derive(Clone, Debug, PartialEq)]
pub struct TextureLevel {
    /// Texels along s.
    pub width: u32,
    /// Texels along t; 1 for one-dimensional ones.
    pub height: u32,
    /// Texels along p, or layers, or 6 faces; 1 otherwise.
    pub depth: u32,
    /// `width * height * depth` texels.
    pub texels: Texels,
}

/// A texture with its sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Dimension, array, shadow and texel kind, as the sampler that reads it.
    pub kind: SamplerType,
    /// At least one level; each is half of the one before, rounded down, at least 1.
    pub levels: Vec<TextureLevel>,
    /// The filter.
    pub filter: Filter,
    /// All directions alike.
    pub wrap: Wrap,
    /// For shadow samplers.
    pub compare: Compare,
}
