//! [`Scenery`]: the classes of scenes, by the feature that makes them hard.
//!
//! *In:* the emitted words of all stages of a scene. *Out:* the first class that applies.

use super::words::{instructions, op};
use super::{Code, Form};
use glisten::scene::Scene;
use glisten_front::hir::Stage;
use std::fmt;

/// A class of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Scenery {
    /// The fragment stage has a loop.
    Loops,
    /// It has derivatives.
    Derivatives,
    /// It compares with depth textures.
    Shadows,
    /// It looks up textures with several levels of detail.
    Levels,
    /// It looks up textures.
    Textures,
    /// It has hashes or `fract`.
    Noise,
    /// It has branches.
    Branches,
    /// The vertex or the fragment stage lights by `normalize`, `pow` or `reflect`.
    Lighting,
    /// None of these.
    Plain,
}

impl Scenery {
    pub(crate) const ALL: [Self; 9] = [
        Self::Loops,
        Self::Derivatives,
        Self::Shadows,
        Self::Levels,
        Self::Textures,
        Self::Noise,
        Self::Branches,
        Self::Lighting,
        Self::Plain,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Loops => "loops",
            Self::Derivatives => "derivatives",
            Self::Shadows => "shadows",
            Self::Levels => "levels",
            Self::Textures => "textures",
            Self::Noise => "noise",
            Self::Branches => "branches",
            Self::Lighting => "lighting",
            Self::Plain => "plain",
        }
    }

    /// The class of a scene.
    pub(super) fn of(scene: &Scene, modules: &[(Stage, Code)]) -> Self {
        let has = |in_fragments: bool, wanted: &dyn Fn(u16, u32) -> bool| {
            modules
                .iter()
                .filter(|(stage, code)| code.form() == Form::Spirv && (!in_fragments || *stage == Stage::Fragment))
                .any(|(_, code)| match code {
                    Code::Words(words) => instructions(words).iter().any(|one| wanted(one.opcode(), one.word(4))),
                    Code::Text(_) => false,
                })
        };
        let is_extended =
            |wanted: &'static [u32]| move |opcode: u16, number: u32| opcode == op::EXT_INST && wanted.contains(&number);
        let deep = scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten()).any(|one| one.levels.len() > 1);
        let looks_up = has(true, &|opcode, _| (87..=97).contains(&opcode));
        match () {
            () if has(true, &|opcode, _| opcode == op::LOOP_MERGE) => Self::Loops,
            () if has(true, &|opcode, _| (207..=215).contains(&opcode)) => Self::Derivatives,
            () if has(true, &|opcode, _| matches!(opcode, 89 | 90 | 97)) => Self::Shadows,
            () if looks_up && deep => Self::Levels,
            () if looks_up => Self::Textures,
            // Fract; BitwiseXor.
            () if has(true, &is_extended(&[10])) || has(true, &|opcode, _| opcode == 198) => Self::Noise,
            () if has(true, &|opcode, _| opcode == op::SELECTION_MERGE) => Self::Branches,
            () if has(false, &is_extended(&[26, 69, 71])) => Self::Lighting,
            () => Self::Plain,
        }
    }
}

impl fmt::Display for Scenery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
