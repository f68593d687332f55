//! [`Scene`]: a scene with every name resolved.
//!
//! *Holds:* indices are below the length of each attribute's data; the values of a root have the length of its type;
//! a runner can draw a scene without further checks of sizes.

use crate::fixed::{FixedFunction, Pipeline};
use crate::picture::Encoding;
use glisten_front::hir::{PrimitiveIn, SamplerDim, SamplerType, Scalar, ScalarValue, Stage};
use glisten_front::link::{FixedState, Program};
use std::sync::Arc;

/// Everything that one picture needs.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The stem of the scene file's name.
    pub name: String,
    /// The framebuffer.
    pub framebuffer: Framebuffer,
    /// The draws, in order.
    pub draws: Vec<Draw>,
}

impl Scene {
    /// The scene with other programs in the place of its own. Draws of one program share the other one too.
    #[must_use]
    pub fn with_programs(&self, other: &dyn Fn(&Program) -> Program) -> Self {
        let mut scene = self.clone();
        let mut known: Vec<(Arc<Program>, Arc<Program>)> = Vec::new();
        for draw in &mut scene.draws {
            let made = match known.iter().find(|(program, _)| Arc::ptr_eq(program, &draw.program)) {
                Some((_, made)) => Arc::clone(made),
                None => {
                    let made = Arc::new(other(&draw.program));
                    known.push((Arc::clone(&draw.program), Arc::clone(&made)));
                    made
                }
            };
            draw.program = made;
        }
        scene
    }
}

/// The color attachments, and the depth buffer (cleared to 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framebuffer {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The color that every attachment is cleared to.
    pub clear: [f64; 4],
    /// The format of every attachment.
    pub format: Format,
    /// The number of color attachments.
    pub attachments: u32,
    /// How the colors of an 8-bit picture file are encoded. It changes nothing of the framebuffer.
    pub encode: Encoding,
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

/// How vertices form primitives (OpenGL 3.2 §2.6.1).
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
    LinesAdjacency,
    LineStripAdjacency,
    TrianglesAdjacency,
    TriangleStripAdjacency,
}

impl Primitive {
    /// Whether primitives have adjacent vertices, which only a geometry shader sees.
    pub fn has_adjacency(self) -> bool {
        matches!(
            self,
            Self::LinesAdjacency | Self::LineStripAdjacency | Self::TrianglesAdjacency | Self::TriangleStripAdjacency
        )
    }

    /// Whether a geometry shader with this input primitive takes these primitives (§2.12.1).
    pub fn feeds(self, input: PrimitiveIn) -> bool {
        let wanted = match self {
            Self::Points => PrimitiveIn::Points,
            Self::Lines | Self::LineStrip | Self::LineLoop => PrimitiveIn::Lines,
            Self::Triangles | Self::TriangleStrip | Self::TriangleFan => PrimitiveIn::Triangles,
            Self::LinesAdjacency | Self::LineStripAdjacency => PrimitiveIn::LinesAdjacency,
            Self::TrianglesAdjacency | Self::TriangleStripAdjacency => PrimitiveIn::TrianglesAdjacency,
        };
        wanted == input
    }
}

/// Which faces are culled.
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

impl Compare {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[
        ("never", Self::Never),
        ("less", Self::Less),
        ("equal", Self::Equal),
        ("lequal", Self::Lequal),
        ("greater", Self::Greater),
        ("notequal", Self::Notequal),
        ("gequal", Self::Gequal),
        ("always", Self::Always),
    ];

    /// By OpenGL's name: `GL_` and the scene file's name in capitals.
    pub fn of_opengl(name: &str) -> Option<Self> {
        of_opengl(name, Self::NAMES)
    }
}

/// Blend factors (OpenGL 3.2 table 4.2).
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
    ConstantColor,
    OneMinusConstantColor,
    ConstantAlpha,
    OneMinusConstantAlpha,
}

impl BlendFactor {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[
        ("zero", Self::Zero),
        ("one", Self::One),
        ("src_color", Self::SrcColor),
        ("one_minus_src_color", Self::OneMinusSrcColor),
        ("dst_color", Self::DstColor),
        ("one_minus_dst_color", Self::OneMinusDstColor),
        ("src_alpha", Self::SrcAlpha),
        ("one_minus_src_alpha", Self::OneMinusSrcAlpha),
        ("dst_alpha", Self::DstAlpha),
        ("one_minus_dst_alpha", Self::OneMinusDstAlpha),
        ("src_alpha_saturate", Self::SrcAlphaSaturate),
        ("constant_color", Self::ConstantColor),
        ("one_minus_constant_color", Self::OneMinusConstantColor),
        ("constant_alpha", Self::ConstantAlpha),
        ("one_minus_constant_alpha", Self::OneMinusConstantAlpha),
    ];

    /// Whether it reads the red, green and blue of the constant color.
    pub fn reads_constant_color(self) -> bool {
        matches!(self, Self::ConstantColor | Self::OneMinusConstantColor)
    }

    /// Whether it reads the alpha of the constant color for all components.
    pub fn reads_constant_alpha(self) -> bool {
        matches!(self, Self::ConstantAlpha | Self::OneMinusConstantAlpha)
    }

    /// By OpenGL's name: `GL_` and the scene file's name in capitals.
    pub fn of_opengl(name: &str) -> Option<Self> {
        of_opengl(name, Self::NAMES)
    }
}

/// How the color of a fragment and that of its pixel are added, the same for color and alpha (OpenGL 3.2 §4.1.7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// The factor of the fragment's color.
    pub source: BlendFactor,
    /// The factor of the pixel's color.
    pub destination: BlendFactor,
    /// The constant color, from 0 to 1; OpenGL's initial one is 0.
    pub constant: [f32; 4],
}

impl Blend {
    /// Blending by two factors, with a constant color of 0.
    pub const fn new(source: BlendFactor, destination: BlendFactor) -> Self {
        Self { source, destination, constant: [0.0; 4] }
    }

    /// The constant of an API that has one for all factors, as WebGPU has: where a factor reads the constant alpha, that is in
    /// every component. No scene reads both.
    pub fn one_constant(&self) -> [f32; 4] {
        let [.., alpha] = self.constant;
        let by_alpha = [self.source, self.destination].iter().any(|factor| factor.reads_constant_alpha());
        if by_alpha { [alpha; 4] } else { self.constant }
    }
}

/// The fixed-function state of a draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The primitive.
    pub primitive: Primitive,
    /// Which faces are culled.
    pub cull: Cull,
    /// Whether counterclockwise triangles in the window are front faces.
    pub front_ccw: bool,
    /// Whether the last vertex is the provoking one (OpenGL's default), or the first.
    pub provoking_last: bool,
    /// Whether the depth test is enabled; without it, depth is not written either.
    pub depth_test: bool,
    /// Whether a passed test writes depth.
    pub depth_write: bool,
    /// The comparison function of the depth test.
    pub depth_func: Compare,
    /// How colors are blended; `None` for no blending.
    pub blend: Option<Blend>,
    /// How many clip distances are enabled.
    pub clip_distances: u32,
    /// Whether `gl_PointSize` has an effect; otherwise points are one pixel wide.
    pub program_point_size: bool,
}

impl State {
    /// The initial state of OpenGL, for triangles.
    pub const INITIAL: Self = Self {
        primitive: Primitive::Triangles,
        cull: Cull::None,
        front_ccw: true,
        provoking_last: true,
        depth_test: false,
        depth_write: true,
        depth_func: Compare::Less,
        blend: None,
        clip_distances: 0,
        program_point_size: false,
    };
}

/// One draw call.
#[derive(Clone, Debug)]
pub struct Draw {
    /// The program.
    pub program: Arc<Program>,
    /// The fixed-function state.
    pub state: State,
    /// The number of vertices to draw, or of entries of `indices`, if there are any.
    pub vertex_count: u32,
    /// The vertex indices, each below the length of each attribute's data.
    pub indices: Option<Vec<u32>>,
    /// The number of instances.
    pub instances: u32,
    /// The data of each of the interface's attributes, in order; `None` for those without data, which are inactive or
    /// can reach no output.
    pub attributes: Vec<Option<AttributeData>>,
    /// The value of each of the interface's roots, in order, flat ([`Types::flat_len`](glisten_front::hir::Types::flat_len)).
    pub uniforms: Vec<Vec<ScalarValue>>,
    /// The texture of each of the interface's sampler slots, in order.
    pub textures: Vec<Option<Arc<Texture>>>,
    /// The uniforms that change from frame to frame.
    pub dynamic: Vec<String>,
    /// The state of the fixed-function pipeline, for programs of that time. It is in the uniforms and in the program
    /// already; a runner that has the pipeline itself sets it.
    pub fixed: Option<Arc<FixedDraw>>,
}

/// The state of the fixed-function pipeline for a draw.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedDraw {
    /// Matrices, lights and so on.
    pub state: FixedFunction,
    /// The switches that the program was compiled for.
    pub switches: FixedState,
    /// The stage that the draw does not name, and the pipeline from which it was written.
    pub generated: Option<(Stage, Pipeline)>,
}

/// The data of one attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeData {
    /// The number of components per vertex, at most as many as the declared type has; for matrices, those of all
    /// columns.
    pub size: u32,
    /// 0: one row per vertex; n: one row per n instances.
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
    /// The number of values.
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
    /// Component `component` of column `column` (of columns that are `rows` components high) for a vertex and an
    /// instance. Missing components come from (0, 0, 0, 1); rows past the end are (0, 0, 0, 1), too.
    #[inline]
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

/// The filter, the same for magnification and minification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Filter {
    Nearest,
    Linear,
    /// Linear within levels and between them.
    Trilinear,
    /// Nearest within the nearest level.
    NearestMipmapNearest,
    /// Linear within the nearest level.
    LinearMipmapNearest,
    /// Nearest within levels, linear between them.
    NearestMipmapLinear,
}

impl Filter {
    /// Whether it is linear within a level.
    pub fn is_linear(self) -> bool {
        matches!(self, Self::Linear | Self::Trilinear | Self::LinearMipmapNearest)
    }

    /// Whether it uses other levels than the first.
    pub fn uses_levels(self) -> bool {
        !matches!(self, Self::Nearest | Self::Linear)
    }

    /// Whether it is linear between levels.
    pub fn blends_levels(self) -> bool {
        matches!(self, Self::Trilinear | Self::NearestMipmapLinear)
    }
}

/// The treatment of coordinates outside `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Wrap {
    Repeat,
    ClampToEdge,
    MirroredRepeat,
}

impl Wrap {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[
        ("repeat", Self::Repeat),
        ("clamp", Self::ClampToEdge),
        ("clamp_to_edge", Self::ClampToEdge),
        ("mirrored_repeat", Self::MirroredRepeat),
        ("mirror", Self::MirroredRepeat),
    ];

    /// Names that scene files have and OpenGL has not, or has for something else (`GL_CLAMP` is not to the edge).
    const SHORT: &[&str] = &["clamp", "mirror"];

    /// By OpenGL's name in small letters, without `GL_`.
    pub fn of_opengl(name: &str) -> Option<Self> {
        let own = |known: &str| known == name && !Self::SHORT.contains(&known);
        Self::NAMES.iter().find(|(known, _)| own(known)).map(|row| row.1)
    }
}

/// The texels of a level, as RGBA.
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
    /// Texels along t; 1 for one-dimensional textures.
    pub height: u32,
    /// Texels along p, or the number of layers, or 6 faces; otherwise 1.
    pub depth: u32,
    /// `width * height * depth` texels.
    pub texels: Texels,
}

/// A texture and its sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The dimensionality, array, shadow and texel kind, the same as of the sampler that reads it.
    pub kind: SamplerType,
    /// The levels, at least one; each is half the size of the one before, rounded down, at least 1. A multisample texture
    /// has an image of the same size for each sample instead, in the order of the samples.
    pub levels: Vec<TextureLevel>,
    /// The filter.
    pub filter: Filter,
    /// The wrap mode, the same in all directions.
    pub wrap: Wrap,
    /// The comparison function, for shadow samplers.
    pub compare: Compare,
    /// Further parameters.
    pub sampling: Sampling,
}

impl Texture {
    /// The texture of a unit that has none: one texel (or one per face) of (level, level, level, 1). OpenGL's level is 0 (§3.8.15).
    pub fn unset(kind: SamplerType, level: u8) -> Self {
        let depth = if kind.dim == SamplerDim::Cube { 6 } else { 1 };
        let texels = match kind.texel {
            Scalar::Int => Texels::Int(vec![[i32::from(level), i32::from(level), i32::from(level), 1]; depth as usize]),
            Scalar::Uint => {
                Texels::Uint(vec![[u32::from(level), u32::from(level), u32::from(level), 1]; depth as usize])
            }
            Scalar::Float | Scalar::Bool => {
                Texels::Float(vec![[f32::from(level), f32::from(level), f32::from(level), 1.0]; depth as usize])
            }
        };
        // As many samples as every driver has.
        let count = if kind.dim == SamplerDim::Multisample { 4 } else { 1 };
        Self {
            kind,
            levels: vec![TextureLevel { width: 1, height: 1, depth, texels }; count],
            filter: Filter::Nearest,
            wrap: Wrap::ClampToEdge,
            compare: Compare::Lequal,
            sampling: Sampling::default(),
        }
    }
}

/// Further parameters of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sampling {
    /// `TEXTURE_LOD_BIAS`, which is added to the level of detail (§3.8.11).
    pub lod_bias: f32,
    /// `TEXTURE_MAG_FILTER` if it is not the minification filter's within a level: whether it is linear.
    pub magnify_linear: Option<bool>,
    /// Whether a depth texture stores fixed-point numbers of 24 bits: a comparison's reference is then clamped to [0, 1]
    /// (§3.8.14).
    pub fixed_point_depth: bool,
}

impl Sampling {
    /// Whether magnification is linear for a filter.
    pub fn magnifies_linearly(&self, filter: Filter) -> bool {
        self.magnify_linear.unwrap_or(filter.is_linear())
    }

    /// Whether magnification and minification have different filters within a level.
    pub fn has_two_filters(&self, filter: Filter) -> bool {
        self.magnifies_linearly(filter) != filter.is_linear()
    }

    /// The level of detail up to which a texture is magnified: c of §3.8.12.
    pub fn magnified_up_to(&self, filter: Filter) -> f64 {
        let nearest_levels = matches!(filter, Filter::NearestMipmapNearest | Filter::NearestMipmapLinear);
        if nearest_levels && self.magnifies_linearly(filter) { 0.5 } else { 0.0 }
    }
}

/// The value whose name stands after `GL_` in capitals.
fn of_opengl<T: Copy>(name: &str, names: &[(&str, T)]) -> Option<T> {
    let own = name.strip_prefix("GL_")?;
    names.iter().find(|(known, _)| known.to_ascii_uppercase() == own).map(|row| row.1)
}
