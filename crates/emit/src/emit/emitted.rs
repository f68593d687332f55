//! [`Emitted`]: what a writer writes; [`Traced`]: with the places of the source that its lines come from.

use glisten_front::source::Span;

/// The output of a writer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Emitted {
    /// WGSL, MSL, HLSL, GLSL.
    Text(String),
    /// SPIR-V.
    Words(Vec<u32>),
}

impl Emitted {
    /// The contents of the file: UTF-8, or little-endian words.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.into_bytes(),
            Self::Words(words) => words.into_iter().flat_map(u32::to_le_bytes).collect(),
        }
    }
}

/// A line that comes from a place of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The line of the written text, from 1.
    pub line: u32,
    /// The statement, or the head of the function.
    pub span: Span,
}

/// The output of a writer, and where its lines come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Traced {
    /// The text or the words.
    pub emitted: Emitted,
    /// The lines that begin statements and functions, in ascending order: of WGSL, none of other targets. A line may come from several
    /// places: from a declaration, and from the first assignment, which it has taken over.
    pub origins: Vec<Origin>,
}

impl Traced {
    /// A text or words whose lines come from nowhere.
    pub(super) fn of(emitted: Emitted) -> Self {
        Self { emitted, origins: Vec::new() }
    }

    /// Puts a text before it.
    pub(super) fn behind(self, text: &str) -> Self {
        let added = text.matches('\n').count() as u32;
        let origins = self.origins.into_iter().map(|origin| Origin { line: origin.line + added, ..origin }).collect();
        let emitted = match self.emitted {
            Emitted::Text(rest) => Emitted::Text(text.to_owned() + &rest),
            words => words,
        };
        Self { emitted, origins }
    }
}
