//! [`Conventions`]: what the host expects of the emitted code, as chosen by the flags of `glisten compile`.

/// The range of clip-space z to which the target clips.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ClipZ {
    /// `[0, w]`: WebGPU, Vulkan, Metal, Direct3D. The vertex stage rewrites the position.
    #[default]
    ZeroToOne,
    /// `[-w, w]`: the position is unchanged.
    MinusOneToOne,
}

/// The position of row 0 of the framebuffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum WindowOrigin {
    /// No flip: the picture is upright on the screen; `gl_FragCoord.y`, `dFdy` and `gl_PointCoord` are corrected.
    #[default]
    UpperLeft,
    /// The vertex stage flips y, so that a render target contains the same rows as in OpenGL.
    LowerLeft,
}

/// The direction of y in the normalized device coordinates of emitted SPIR-V, and of GLSL for Vulkan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SpirvEnv {
    /// Up, which wgpu provides with a negative viewport.
    #[default]
    Webgpu,
    /// Down, as with a plain Vulkan viewport.
    Vulkan,
}

/// The version of emitted GLSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GlslVersion {
    /// `#version 330`: OpenGL 3.3, the first with locations in the text.
    #[default]
    Desktop330,
    /// `#version 450`: OpenGL 4.5.
    Desktop450,
    /// `#version 300 es`: OpenGL ES 3.0 and WebGL 2.
    Es300,
    /// `#version 450` by the rules of GL_KHR_vulkan_glsl: sets, bindings and locations, and a block for the loose
    /// uniforms. [`ClipZ`], [`WindowOrigin`] and [`SpirvEnv`] apply.
    Vulkan,
}

impl GlslVersion {
    /// All versions.
    pub const ALL: [Self; 4] = [Self::Desktop330, Self::Desktop450, Self::Es300, Self::Vulkan];

    /// Its word in options and in the reflection.
    pub fn word(self) -> &'static str {
        match self {
            Self::Desktop330 => "330",
            Self::Desktop450 => "450",
            Self::Es300 => "300es",
            Self::Vulkan => "vulkan",
        }
    }
}

/// The width of floating-point numbers in emitted code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FloatWidth {
    /// f16 in the fragment stage: 11 bits, and numbers up to 65,504. The vertex stage keeps f32, since positions need it.
    Half,
    /// f32, as OpenGL has it.
    #[default]
    Single,
    /// f64 in both stages, which WGSL does not have.
    Double,
}

impl FloatWidth {
    /// Its word in options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Half => "half",
            Self::Single => "single",
            Self::Double => "double",
        }
    }

    /// `f16`, `f32`, `f64`
    pub fn ty(self) -> &'static str {
        match self {
            Self::Half => "f16",
            Self::Single => "f32",
            Self::Double => "f64",
        }
    }
}

/// The texel of an integer texture that is read for a coordinate outside of it. No target samples integers, so the code
/// computes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelWrap {
    /// REPEAT, which is OpenGL's default.
    #[default]
    Repeat,
    /// CLAMP_TO_EDGE
    ClampToEdge,
    /// MIRRORED_REPEAT
    MirroredRepeat,
}

/// The expectations of the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Conventions {
    /// The range of clip-space z.
    pub clip_z: ClipZ,
    /// The order of framebuffer rows.
    pub window_origin: WindowOrigin,
    /// The environment of SPIR-V.
    pub spirv_env: SpirvEnv,
    /// How many clip distances are enabled; `None` for all that are written.
    pub clip_distances: Option<u32>,
    /// Whether `gl_PointSize` has an effect.
    pub program_point_size: bool,
    /// Whether points are drawn as quads in targets whose points are one pixel wide: WGSL and HLSL.
    pub point_sprites: bool,
    /// The wrap mode of integer textures, in targets whose code loads their texels: all but GLSL. Rectangles and cubes clamp.
    pub texel_wrap: TexelWrap,
    /// How many color attachments `gl_FragColor` is written to, in all targets but GLSL; `None` for the first alone.
    pub color_attachments: Option<u32>,
    /// The version of emitted GLSL.
    pub glsl_version: GlslVersion,
    /// Whether SPIR-V contains source lines.
    pub debug_lines: bool,
    /// The width of floats.
    pub floats: FloatWidth,
}
