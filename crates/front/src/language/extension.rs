//! [`Extensions`]: the extensions that sources may enable, one row for each (GLSL 1.50 §3.3).
//!
//! *In:* nothing. *Out:* a set with a bit for each extension, and [`EXTENSIONS`], the names that `#extension` lines may have.
//! *Holds:* an extension is one row; two names of one extension are in one row, the first of which messages use. *Not done here:*
//! the features, functions and variables that an extension brings. Their own rows name it.

use super::Version;

/// The families of versions for which an extension is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Families {
    /// OpenGL's language.
    Desktop,
    /// OpenGL ES's language.
    Es,
    /// Either.
    Both,
}

/// A name in `#extension` lines.
#[derive(Clone, Copy, Debug)]
pub struct Extension {
    /// `GL_ARB_gpu_shader5`.
    pub name: &'static str,
    /// Its bit; none if it brings nothing that the oldest version lacks.
    pub bit: Extensions,
    /// The versions that may enable it.
    pub families: Families,
}

impl Extension {
    /// Whether sources of this language may enable it.
    pub fn is_for(&self, version: Version) -> bool {
        match self.families {
            Families::Both => true,
            Families::Desktop => !version.is_es(),
            Families::Es => version.is_es(),
        }
    }
}

/// Declares the extensions: `BIT NAME: FAMILY "GL_..", ..;`. Of the 64 bits, the lower 32 are theirs.
macro_rules! extensions {
    (
        $($place:literal $bit:ident: $($family:ident $name:literal),+;)*
        nothing: $($old_family:ident $old:literal),+;
    ) => {
        bitflags::bitflags! {
            /// The implemented extensions that are enabled at a place in the text. For each, a second bit says whether its uses
            /// are warned about.
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
            pub struct Extensions: u64 {
                $(
                    #[doc = concat!($("`", $name, "` "),+)]
                    const $bit = 1 << $place;
                )*
                /// For each extension, a second bit: its uses are warned about.
                const WARNED = 0xffff_ffff << Self::WARN_SHIFT;
            }
        }

        /// All that sources may enable.
        pub static EXTENSIONS: &[Extension] = &[
            $($(Extension { name: $name, bit: Extensions::$bit, families: Families::$family },)+)*
            $(Extension { name: $old, bit: Extensions::empty(), families: Families::$old_family },)+
        ];
    };
}

extensions! {
    0 EXPLICIT_ATTRIB_LOCATION: Desktop "GL_ARB_explicit_attrib_location";
    1 SHADING_LANGUAGE_420PACK: Desktop "GL_ARB_shading_language_420pack";
    2 TEXTURE_RECTANGLE: Desktop "GL_ARB_texture_rectangle";
    3 UNIFORM_BUFFER_OBJECT: Desktop "GL_ARB_uniform_buffer_object";
    4 DRAW_INSTANCED: Desktop "GL_ARB_draw_instanced";
    5 INCLUDE: Desktop "GL_ARB_shading_language_include", Both "GL_GOOGLE_cpp_style_line_directive", Both "GL_GOOGLE_include_directive";
    6 SEPARATE_SHADER_OBJECTS: Desktop "GL_ARB_separate_shader_objects";
    7 SHADER_BIT_ENCODING: Desktop "GL_ARB_shader_bit_encoding";
    8 SHADER_TEXTURE_LOD: Desktop "GL_ARB_shader_texture_lod", Es "GL_EXT_shader_texture_lod";
    9 GPU_SHADER4: Desktop "GL_EXT_gpu_shader4";
    10 TEXTURE_ARRAY: Desktop "GL_EXT_texture_array";
    11 GPU_SHADER5: Desktop "GL_ARB_gpu_shader5";
    12 TEXTURE_GATHER: Desktop "GL_ARB_texture_gather";
    13 TEXTURE_QUERY_LOD: Desktop "GL_ARB_texture_query_lod";
    14 TEXTURE_QUERY_LEVELS: Desktop "GL_ARB_texture_query_levels";
    15 CONSERVATIVE_DEPTH: Desktop "GL_ARB_conservative_depth", Desktop "GL_AMD_conservative_depth";
    16 ARRAYS_OF_ARRAYS: Desktop "GL_ARB_arrays_of_arrays";
    17 STANDARD_DERIVATIVES: Es "GL_OES_standard_derivatives";
    18 FRAG_DEPTH: Es "GL_EXT_frag_depth";
    19 FRAGMENT_COORD_CONVENTIONS: Desktop "GL_ARB_fragment_coord_conventions";
    20 TEXTURE_MULTISAMPLE: Desktop "GL_ARB_texture_multisample";
    21 SHADING_LANGUAGE_PACKING: Desktop "GL_ARB_shading_language_packing";
    22 EXPLICIT_UNIFORM_LOCATION: Desktop "GL_ARB_explicit_uniform_location";
    23 ENHANCED_LAYOUTS: Desktop "GL_ARB_enhanced_layouts";
    24 DERIVATIVE_CONTROL: Desktop "GL_ARB_derivative_control";
    25 TEXTURE_CUBE_MAP_ARRAY: Desktop "GL_ARB_texture_cube_map_array";
    26 DRAW_BUFFERS: Es "GL_EXT_draw_buffers";
    27 SHADER_INTEGER_MIX: Both "GL_EXT_shader_integer_mix";
    28 SAMPLE_SHADING: Desktop "GL_ARB_sample_shading";
    29 SHADER_TRINARY_MINMAX: Desktop "GL_AMD_shader_trinary_minmax";
    // Since 1.10 the language has what these provide; sources of that time still enable them.
    nothing: Desktop "GL_ARB_draw_buffers";
}

impl Extensions {
    /// The name of the first extension of a set.
    pub fn name(self) -> Option<&'static str> {
        EXTENSIONS.iter().find(|row| !row.bit.is_empty() && self.contains(row.bit)).map(|row| row.name)
    }

    /// The name of the first extension of a set that sources of this language may enable.
    pub(crate) fn name_for(self, version: Version) -> Option<&'static str> {
        let mut rows = EXTENSIONS.iter().filter(|row| row.is_for(version));
        rows.find(|row| !row.bit.is_empty() && self.contains(row.bit)).map(|row| row.name)
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
