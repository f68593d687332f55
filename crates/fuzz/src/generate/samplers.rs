//! The samplers of generated programs, with small textures.
//!
//! *In:* a language. *Out:* which samplers it has, their declarations and the lines of the scene. *Holds:* every texture has two texels a side
//! at least, so that the texels 0 and 1 are there.

use super::language::Language;
use glisten_front::hir::{Type, TypeId, Types};

/// A sampler that a program may declare.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampler {
    /// Its name.
    pub(super) name: &'static str,
    /// Its type, as a word.
    pub(super) word: &'static str,
    /// The numbers of the texture, and how it is read.
    texture: &'static str,
    /// How many numbers it has.
    numbers: usize,
}

const fn sampler(name: &'static str, word: &'static str, texture: &'static str, numbers: usize) -> Sampler {
    Sampler { name, word, texture, numbers }
}

static SAMPLERS: &[Sampler] = &[
    sampler("t2", "sampler2D", "width = 4, height = 4, filter = \"trilinear\", mipmaps = true", 64),
    sampler("n2", "sampler2D", "width = 2, height = 2, filter = \"nearest\", wrap = \"mirror\"", 16),
    sampler("t3", "sampler3D", "width = 2, height = 2, depth = 2, filter = \"linear\"", 32),
    sampler("tc", "samplerCube", "width = 2, filter = \"linear\"", 96),
    sampler("t1", "sampler1D", "width = 4, filter = \"linear\", wrap = \"clamp\"", 16),
    sampler("ta", "sampler2DArray", "width = 2, height = 2, layers = 2, filter = \"linear\"", 32),
    sampler("ts", "sampler2DShadow", "width = 2, height = 2", 4),
    sampler("tas", "sampler2DArrayShadow", "width = 2, height = 2, layers = 2", 8),
    sampler("tcs", "samplerCubeShadow", "width = 2", 24),
    sampler("ti", "isampler2D", "width = 2, height = 2", 16),
    sampler("tu", "usampler2D", "width = 2, height = 2", 16),
    sampler("ti3", "isampler3D", "width = 2, height = 2, depth = 2", 32),
    sampler("tua", "usampler2DArray", "width = 2, height = 2, layers = 2", 32),
    sampler("tib", "isamplerBuffer", "width = 4", 16),
    sampler("tms", "sampler2DMS", "width = 2, height = 2, samples = 2", 32),
    sampler("tims", "isampler2DMS", "width = 2, height = 2, samples = 2", 32),
    sampler("tr", "sampler2DRect", "width = 2, height = 2, filter = \"linear\"", 16),
    sampler("tb", "samplerBuffer", "width = 4", 16),
    sampler("t1a", "sampler1DArray", "width = 2, layers = 2, filter = \"linear\"", 16),
    sampler("tca", "samplerCubeArray", "width = 2, layers = 1, filter = \"linear\"", 96),
];

impl Sampler {
    /// Those of a language.
    pub(super) fn all(language: &Language) -> impl Iterator<Item = &'static Self> {
        SAMPLERS.iter().filter(|one| language.has_word(one.word))
    }

    /// Its type.
    pub(super) fn ty(&self) -> Option<TypeId> {
        let types = Types::basic();
        types.ids().find(|id| matches!(types.get(*id), Type::Sampler(ty) if ty.name() == self.word))
    }

    /// The line of `[draw.textures]`.
    pub(super) fn line(&self) -> String {
        let is_whole = self.word.starts_with("is") || self.word.starts_with("us");
        let number = |index: usize| {
            let number = (index * 37 + 11) % 16;
            if is_whole { number.to_string() } else { (number as f64 / 16.0).to_string() }
        };
        let numbers: Vec<String> = (0..self.numbers).map(number).collect();
        format!("{} = {{ {}, values = [{}] }}", self.name, self.texture, numbers.join(", "))
    }

    /// Whether it is a type of ES that has no precision of its own (GLSL ES 3.00 §4.5.4).
    pub(super) fn lacks_precision(&self) -> bool {
        !matches!(self.word, "sampler2D" | "samplerCube")
    }
}
