//! [`Emitted`]: what a writer writes.

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
