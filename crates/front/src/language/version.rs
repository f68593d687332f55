//! [`Version`], [`Profile`] and [`Extensions`]: the language that a text is written in (GLSL 1.50 §3.3).

use crate::source::Span;

/// The profile in a `#version` line. 1.50 has `core` (the default) and `compatibility`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Profile {
    /// `core`.
    #[default]
    Core,
    /// `compatibility`.
    Compatibility,
    /// `es`.
    Es,
}

/// The language that a shader is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Version {
    /// 150 for GLSL 1.50.
    pub number: u16,
    /// The profile.
    pub profile: Profile,
    /// The `#version` line; unknown if there is none (the language is then 1.10 by §3.3).
    pub span: Span,
}

/// A version later than all others.
pub const NEVER: u16 = u16::MAX;

/// The first version that has something, in each of the two families of versions; [`NEVER`] where none has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Since {
    /// Of OpenGL's language: 110 to 460.
    pub desktop: u16,
    /// Of OpenGL ES's language: 100, 300, 310, 320.
    pub es: u16,
}

impl Since {
    /// In no version.
    pub const NEVER: Self = Self::new(NEVER, NEVER);

    /// The first versions of both families.
    pub const fn new(desktop: u16, es: u16) -> Self {
        Self { desktop, es }
    }

    /// The first desktop version and, unless a table says otherwise, the ES version that took it over: 1.00 was made
    /// from 1.10, and 3.00 from 1.30.
    pub const fn of(desktop: u16) -> Self {
        let es = match desktop {
            ..=110 => 100,
            120 | 130 => 300,
            _ => NEVER,
        };
        Self::new(desktop, es)
    }

    /// These versions with another ES version.
    #[must_use]
    pub const fn es(self, es: u16) -> Self {
        Self { es, ..self }
    }
}

impl Version {
    /// Whether the language is that of OpenGL ES.
    pub const fn is_es(self) -> bool {
        matches!(self.profile, Profile::Es)
    }

    /// Whether the language is at least the version of its family.
    pub const fn reaches(self, since: Since) -> bool {
        self.number >= if self.is_es() { since.es } else { since.desktop }
    }

    /// Whether the language is before the version that dropped something. The compatibility profile drops nothing.
    pub const fn still_has(self, gone: Since) -> bool {
        matches!(self.profile, Profile::Compatibility) || !self.reaches(gone)
    }

    /// `GLSL 3.30`, `GLSL ES 3.00`
    pub fn name(self) -> String {
        let es = if self.is_es() { "ES " } else { "" };
        format!("GLSL {es}{}.{:02}", self.number / 100, self.number % 100)
    }
}

/// The behavior that an `#extension` line asks for (§3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Behavior {
    /// Off.
    Disable,
    /// On, with a warning at each use.
    Warn,
    /// On, with a warning if it is not supported.
    Enable,
    /// On, with an error if it is not supported.
    Require,
}

bitflags::bitflags! {
    /// The implemented extensions that are enabled at a place in the text. For each, a second bit says whether its uses
    /// are warned about.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Extensions: u64 {
        /// `GL_ARB_explicit_attrib_location`
        const EXPLICIT_ATTRIB_LOCATION = 1 << 0;
        /// `GL_ARB_shading_language_420pack`
        const SHADING_LANGUAGE_420PACK = 1 << 1;
        /// `GL_ARB_texture_rectangle`
        const TEXTURE_RECTANGLE = 1 << 2;
        /// `GL_ARB_uniform_buffer_object`
        const UNIFORM_BUFFER_OBJECT = 1 << 3;
        /// `GL_ARB_draw_instanced`
        const DRAW_INSTANCED = 1 << 4;
        /// `GL_ARB_shading_language_include`, `GL_GOOGLE_include_directive`
        const INCLUDE = 1 << 5;
        /// `GL_ARB_separate_shader_objects`
        const SEPARATE_SHADER_OBJECTS = 1 << 6;
        /// `GL_ARB_shader_bit_encoding`
        const SHADER_BIT_ENCODING = 1 << 7;
        /// `GL_ARB_shader_texture_lod`, `GL_EXT_shader_texture_lod`
        const SHADER_TEXTURE_LOD = 1 << 8;
        /// `GL_EXT_gpu_shader4`
        const GPU_SHADER4 = 1 << 9;
        /// `GL_EXT_texture_array`
        const TEXTURE_ARRAY = 1 << 10;
        /// `GL_ARB_gpu_shader5`
        const GPU_SHADER5 = 1 << 11;
        /// `GL_ARB_texture_gather`
        const TEXTURE_GATHER = 1 << 12;
        /// `GL_ARB_texture_query_lod`
        const TEXTURE_QUERY_LOD = 1 << 13;
        /// `GL_ARB_texture_query_levels`
        const TEXTURE_QUERY_LEVELS = 1 << 14;
        /// `GL_ARB_conservative_depth`, `GL_AMD_conservative_depth`, `GL_EXT_conservative_depth`
        const CONSERVATIVE_DEPTH = 1 << 15;
        /// `GL_ARB_arrays_of_arrays`
        const ARRAYS_OF_ARRAYS = 1 << 16;
        /// `GL_OES_standard_derivatives`
        const STANDARD_DERIVATIVES = 1 << 17;
        /// `GL_EXT_frag_depth`
        const FRAG_DEPTH = 1 << 18;
        /// `GL_ARB_fragment_coord_conventions`
        const FRAGMENT_COORD_CONVENTIONS = 1 << 19;
        /// `GL_ARB_texture_multisample`
        const TEXTURE_MULTISAMPLE = 1 << 20;
        /// `GL_ARB_shading_language_packing`
        const SHADING_LANGUAGE_PACKING = 1 << 21;
        /// `GL_ARB_explicit_uniform_location`
        const EXPLICIT_UNIFORM_LOCATION = 1 << 22;
        /// `GL_ARB_enhanced_layouts`
        const ENHANCED_LAYOUTS = 1 << 23;
        /// `GL_ARB_derivative_control`
        const DERIVATIVE_CONTROL = 1 << 24;
        /// `GL_ARB_texture_cube_map_array`
        const TEXTURE_CUBE_MAP_ARRAY = 1 << 25;
        /// `GL_EXT_draw_buffers`: writes to `gl_FragData` beyond its first element in ES 1.00.
        const DRAW_BUFFERS = 1 << 26;
        /// `GL_EXT_shader_integer_mix`
        const SHADER_INTEGER_MIX = 1 << 27;
        /// `GL_ARB_sample_shading`
        const SAMPLE_SHADING = 1 << 28;
        /// For each extension, a second bit: its uses are warned about.
        const WARNED = 0xffff_ffff << Self::WARN_SHIFT;
    }
}

/// The name of each extension, for messages and texts.
static NAMES: &[(Extensions, &str)] = &[
    (Extensions::EXPLICIT_ATTRIB_LOCATION, "GL_ARB_explicit_attrib_location"),
    (Extensions::SHADING_LANGUAGE_420PACK, "GL_ARB_shading_language_420pack"),
    (Extensions::TEXTURE_RECTANGLE, "GL_ARB_texture_rectangle"),
    (Extensions::UNIFORM_BUFFER_OBJECT, "GL_ARB_uniform_buffer_object"),
    (Extensions::DRAW_INSTANCED, "GL_ARB_draw_instanced"),
    (Extensions::INCLUDE, "GL_ARB_shading_language_include"),
    (Extensions::SEPARATE_SHADER_OBJECTS, "GL_ARB_separate_shader_objects"),
    (Extensions::SHADER_BIT_ENCODING, "GL_ARB_shader_bit_encoding"),
    (Extensions::SHADER_TEXTURE_LOD, "GL_ARB_shader_texture_lod"),
    (Extensions::GPU_SHADER4, "GL_EXT_gpu_shader4"),
    (Extensions::TEXTURE_ARRAY, "GL_EXT_texture_array"),
    (Extensions::GPU_SHADER5, "GL_ARB_gpu_shader5"),
    (Extensions::TEXTURE_GATHER, "GL_ARB_texture_gather"),
    (Extensions::TEXTURE_QUERY_LOD, "GL_ARB_texture_query_lod"),
    (Extensions::TEXTURE_QUERY_LEVELS, "GL_ARB_texture_query_levels"),
    (Extensions::CONSERVATIVE_DEPTH, "GL_ARB_conservative_depth"),
    (Extensions::ARRAYS_OF_ARRAYS, "GL_ARB_arrays_of_arrays"),
    (Extensions::STANDARD_DERIVATIVES, "GL_OES_standard_derivatives"),
    (Extensions::FRAG_DEPTH, "GL_EXT_frag_depth"),
    (Extensions::FRAGMENT_COORD_CONVENTIONS, "GL_ARB_fragment_coord_conventions"),
    (Extensions::TEXTURE_MULTISAMPLE, "GL_ARB_texture_multisample"),
    (Extensions::SHADING_LANGUAGE_PACKING, "GL_ARB_shading_language_packing"),
    (Extensions::EXPLICIT_UNIFORM_LOCATION, "GL_ARB_explicit_uniform_location"),
    (Extensions::ENHANCED_LAYOUTS, "GL_ARB_enhanced_layouts"),
    (Extensions::DERIVATIVE_CONTROL, "GL_ARB_derivative_control"),
    (Extensions::TEXTURE_CUBE_MAP_ARRAY, "GL_ARB_texture_cube_map_array"),
    (Extensions::DRAW_BUFFERS, "GL_EXT_draw_buffers"),
    (Extensions::SHADER_INTEGER_MIX, "GL_EXT_shader_integer_mix"),
    (Extensions::SAMPLE_SHADING, "GL_ARB_sample_shading"),
];

impl Extensions {
    /// The name of the first extension of a set.
    pub fn name(self) -> Option<&'static str> {
        NAMES.iter().find(|row| self.contains(row.0)).map(|row| row.1)
    }

    const WARN_SHIFT: u32 = 32;

    /// The extensions that a source may enable.
    pub fn implemented() -> Self {
        Self::all().difference(Self::WARNED)
    }

    /// Sets whether uses of `extensions` are warned about (`#extension NAME : warn`, §3.3).
    pub(crate) fn set_warned(&mut self, extensions: Self, warned: bool) {
        self.set(Self::from_bits_truncate(extensions.bits() << Self::WARN_SHIFT), warned);
    }

    /// The extensions to name in a warning, for a feature that any of `bringing` provides. `None` if one of them is
    /// enabled without a warning.
    pub fn to_warn_of(self, bringing: Self) -> Option<Self> {
        let on = self.intersection(bringing).difference(Self::WARNED);
        let warned = Self::from_bits_truncate(self.bits() >> Self::WARN_SHIFT);
        (!on.is_empty() && warned.contains(on)).then_some(on)
    }
}
