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
    /// The implemented extensions that are enabled at a place in the text.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Extensions: u32 {
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
        /// For each extension, a second bit: its uses are warned about.
        const WARNED = 0x7f << Self::WARN_SHIFT;
    }
}

impl Extensions {
    const WARN_SHIFT: u32 = 8;

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
