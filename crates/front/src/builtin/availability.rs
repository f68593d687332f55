//! [`Availability`]: the languages and stages in which a built-in exists.
//!
//! *In:* the version, profile and extensions at a position in a text, and its stage. *Out:* yes or no.

use crate::language::Stage;
use crate::language::{Extensions, NEVER, Since, Version};

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
    /// The first versions that have it without an extension.
    pub since: Since,
    /// The first versions that have it no more.
    pub gone: Since,
    /// Extensions, each of which adds it to older versions.
    pub extensions: Extensions,
    /// Whether the core profile lacks it from 1.40 on.
    pub compatibility_only: bool,
    /// The stages in which it may be named.
    pub stages: Stages,
}

/// The first version whose core lacks what 1.30 deprecated.
const CORE: Since = Since::new(140, NEVER);

impl Availability {
    /// In every stage, from a desktop version and the ES version that was made from it.
    pub const fn since(version: u16) -> Self {
        Self::from(Since::of(version))
    }

    /// In every stage, from these versions.
    pub const fn from(since: Since) -> Self {
        Self {
            since,
            gone: Since::NEVER,
            extensions: Extensions::empty(),
            compatibility_only: false,
            stages: Stages::all(),
        }
    }

    /// Only with an extension.
    pub const fn extension(extensions: Extensions) -> Self {
        Self { extensions, ..Self::from(Since::NEVER) }
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

    /// With another first ES version.
    #[must_use]
    pub const fn es(self, es: u16) -> Self {
        Self { since: self.since.es(es), ..self }
    }

    /// Only up to the version before these.
    #[must_use]
    pub const fn until(self, gone: Since) -> Self {
        Self { gone, ..self }
    }

    /// Whether the version alone has it, in any stage.
    pub fn in_version(self, version: Version) -> bool {
        version.reaches(self.since)
            && version.still_has(self.gone)
            && (!self.compatibility_only || version.still_has(CORE))
    }

    /// Whether it exists in this language, in any stage.
    pub fn in_language(self, version: Version, extensions: Extensions) -> bool {
        self.in_version(version) || self.extensions.intersects(extensions)
    }

    /// Whether it exists in this language and stage.
    pub fn holds(self, version: Version, extensions: Extensions, stage: Stage) -> bool {
        self.stages.has(stage) && self.in_language(version, extensions)
    }
}
