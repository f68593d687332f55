//! [`Availability`]: for which language and stage a built-in exists.
//!
//! *In:* the version, profile and extensions that hold at a place in a text, and its stage. *Out:* yes or no. Nothing
//! else in glisten compares version numbers.

use crate::language::Stage;
use crate::language::{Extensions, Profile, Version};

bitflags::bitflags! {
    /// A set of stages.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct Stages: u8 {
        /// Vertex shaders.
        const VERTEX = 1;
        /// Geometry shaders.
        const GEOMETRY = 2;
        /// Fragment shaders.
        const FRAGMENT = 4;
    }
}

impl Stages {
    /// Whether the stage is among them.
    pub fn has(self, stage: Stage) -> bool {
        self.contains(match stage {
            Stage::Vertex => Self::VERTEX,
            Stage::Geometry => Self::GEOMETRY,
            Stage::Fragment => Self::FRAGMENT,
        })
    }
}

/// For which language and stage a built-in exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Availability {
    /// The first version that has it without an extension; `u16::MAX` if none has.
    pub since: u16,
    /// Any one of these brings it to older versions.
    pub extensions: Extensions,
    /// Whether the core profile lacks it.
    pub compatibility_only: bool,
    /// Where it may be named.
    pub stages: Stages,
}

impl Availability {
    /// In every stage from a version on.
    pub const fn since(version: u16) -> Self {
        Self { since: version, extensions: Extensions::empty(), compatibility_only: false, stages: Stages::all() }
    }

    /// Only with an extension.
    pub const fn extension(extensions: Extensions) -> Self {
        Self { since: u16::MAX, extensions, compatibility_only: false, stages: Stages::all() }
    }

    /// The same for some stages alone.
    #[must_use]
    pub const fn stages(self, stages: Stages) -> Self {
        Self { stages, ..self }
    }

    /// The same, and in older versions by an extension.
    #[must_use]
    pub const fn or(self, extensions: Extensions) -> Self {
        Self { extensions, ..self }
    }

    /// Whether a text of this language has it, in whatever stage.
    pub fn in_language(self, version: Version, extensions: Extensions) -> bool {
        let profile = !self.compatibility_only || version.profile == Profile::Compatibility;
        profile && (version.number >= self.since || self.extensions.intersects(extensions))
    }

    /// Whether a text of this language and stage has it.
    pub fn holds(self, version: Version, extensions: Extensions, stage: Stage) -> bool {
        self.stages.has(stage) && self.in_language(version, extensions)
    }
}
