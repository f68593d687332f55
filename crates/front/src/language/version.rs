//! [`Version`] and [`Profile`]: the language that a text is written in (GLSL 1.50 §3.3).

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
