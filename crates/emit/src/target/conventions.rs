//! [`Conventions`]: what the target's host expects, as the flags of `glisten compile` say it.

/// A target language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Target {
    Wgsl,
    Spirv,
    Msl,
    Hlsl,
    Glsl,
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 5] = [Self::Wgsl, Self::Spirv, Self::Msl, Self::Hlsl, Self::Glsl];

    /// As it is spoken of: `WGSL`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "WGSL",
            Self::Spirv => "SPIR-V",
            Self::Msl => "MSL",
            Self::Hlsl => "HLSL",
            Self::Glsl => "GLSL",
        }
    }
}

/// The range of clip space z that the target clips to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ClipZ {
    /// `[0, w]`: WebGPU, Vulkan, Metal, Direct3D. The position is rewritten.
    #[default]
    ZeroToOne,
    /// `[-w, w]`: kept as it is.
    MinusOneToOne,
}

/// Where row 0 of the framebuffer is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum WindowOrigin {
    /// No flip: upright on the screen; `gl_FragCoord.y`, `dFdy` and `gl_PointCoord` are corrected.
    #[default]
    UpperLeft,
    /// The vertex stage flips y, so that a texture rendered to holds the rows that OpenGL's would.
    LowerLeft,
}

/// Which way y points in the normalized device coordinates that SPIR-V is written for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SpirvEnv {
    /// Up, as wgpu arranges it with a negative viewport.
    #[default]
    Webgpu,
    /// Down: a plain Vulkan viewport.
    Vulkan,
}

/// What the host expects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Conventions {
    /// Clip space z.
    pub clip_z: ClipZ,
    /// Framebuffer rows.
    pub window_origin: WindowOrigin,
    /// For SPIR-V.
    pub spirv_env: SpirvEnv,
    /// How many clip distances are enabled; `None` for all that are written.
    pub clip_distances: Option<u32>,
    /// Whether `gl_PointSize` counts.
    pub program_point_size: bool,
    /// Whether SPIR-V carries source lines.
    pub debug_lines: bool,
}
