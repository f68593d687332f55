//! [`Availability`]: the languages and stages in which a built-in exists.
//!
//! *In:* the version, profile and extensions at a position in a text, and its stage. *Out:* yes or no. Nothing else
//! in glisten compares version numbers.

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
    /// Whether the set contains the stage.
    pub fn has(self, stage: Stage) -> bool {
        self.contains(match stage {
            Stage::Vertex => Self::VERTEX,
            Stage::Geometry => Self::GEOMETRY,
            Stage::Fragment => Self::FRAGMENT,
        })
    }
}

/// The languages and stages in which a built-in exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Availability {
    /// The first version that has it without an extension; `u16::MAX` if there is none.
    pub since: u16,
    /// Extensions, each of which adds it to older versions.
    pub extensions: Extensions,
    /// Whether the core profile lacks it.
    pub compatibility_only: bool,
    /// The stages in which it may be named.
    pub stages: Stages,
}

impl Availability {
    /// In every stage, from a version.
    pub const fn since(version: u16) -> Self {
        Self { since: version, extensions: Extensions::empty(), compatibility_only: false, stages: Stages::all() }
    }

    /// Only with an extension.
    pub const fn extension(extensions: Extensions) -> Self {
        Self { since: u16::MAX, extensions, compatibility_only: false, stages: Stages::all() }
    }

    /// Restricts it to some stages.
    #[must_use]
    pub const fn stages(self, stages: Stages) -> Self {
        Self { stages, ..self }
    }

    /// Adds it to older versions with an extension.
    #[must_use]
    pub const fn or(self, extensions: Extensions) -> Self {
        Self { extensions, ..self }
    }

    /// Whether it exists in this language, in any stage.
    pub fn in_language(self, version: Version, extensions: Extensions) -> bool {
        let profile = !self.compatibility_only || version.profile == Profile::Compatibility;
        profile && (version.number >= self.since || self.extensions.intersects(extensions))
    }

    /// Whether it exists in this language and stage.
    pub fn holds(self, version: Version, extensions: Extensions, stage: Stage) -> bool {
        self.stages.has(stage) && self.in_language(version, extensions)
    }
}
