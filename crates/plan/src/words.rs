//! The words of the specification of WebGPU for wgpu's enumerations.
//!
//! *In:* a value. *Out:* its word. *Holds:* wgpu names its values after those words: `TriangleList` is `triangle-list`, `Rgba8Unorm` is
//! `rgba8unorm`. Where it does not, a table has the word.

use std::fmt::Debug;
use wgpu_types::TextureViewDimension;

/// Formats whose words have a hyphen.
const FORMATS: [(&str, &str); 1] = [("depth32floatstencil8", "depth32float-stencil8")];

/// The word of a format of texels or of attributes.
pub(crate) fn format(format: impl Debug) -> String {
    let name = format!("{format:?}").to_ascii_lowercase();
    let special = FORMATS.iter().find(|(known, _)| *known == name);
    special.map_or(name, |(_, word)| (*word).to_owned())
}

/// The word of a state.
pub(crate) fn word(value: impl Debug) -> String {
    let mut word = String::new();
    for letter in format!("{value:?}").chars() {
        if letter.is_ascii_uppercase() && !word.is_empty() {
            word.push('-');
        }
        word.push(letter.to_ascii_lowercase());
    }
    word
}

/// The word of the dimension of a view.
pub(crate) fn dimension(dimension: TextureViewDimension) -> &'static str {
    match dimension {
        TextureViewDimension::D1 => "1d",
        TextureViewDimension::D2 => "2d",
        TextureViewDimension::D2Array => "2d-array",
        TextureViewDimension::Cube => "cube",
        TextureViewDimension::CubeArray => "cube-array",
        TextureViewDimension::D3 => "3d",
    }
}

#[cfg(test)]
mod tests {
    use super::{format, word};
    use wgpu_types as wgpu;

    #[test]
    fn words_are_those_of_the_specification() {
        use wgpu::{TextureFormat, VertexFormat};
        for (found, expected) in [
            (format(TextureFormat::Rgba16Float), "rgba16float"),
            (format(TextureFormat::Rgba32Sint), "rgba32sint"),
            (format(TextureFormat::Depth24Plus), "depth24plus"),
            (format(TextureFormat::Depth32FloatStencil8), "depth32float-stencil8"),
            (format(VertexFormat::Uint32), "uint32"),
            (format(VertexFormat::Float32x4), "float32x4"),
            (word(wgpu::PrimitiveTopology::TriangleStrip), "triangle-strip"),
            (word(wgpu::CompareFunction::LessEqual), "less-equal"),
            (word(wgpu::BlendFactor::OneMinusSrcAlpha), "one-minus-src-alpha"),
            (word(wgpu::BlendFactor::SrcAlphaSaturated), "src-alpha-saturated"),
            (word(wgpu::BlendFactor::Constant), "constant"),
            (word(wgpu::BlendFactor::OneMinusConstant), "one-minus-constant"),
            (word(wgpu::AddressMode::MirrorRepeat), "mirror-repeat"),
            (word(wgpu::AddressMode::ClampToEdge), "clamp-to-edge"),
            (word(wgpu::FrontFace::Ccw), "ccw"),
            (word(wgpu::VertexStepMode::Instance), "instance"),
            (word(wgpu::MipmapFilterMode::Nearest), "nearest"),
        ] {
            assert_eq!(found, expected);
        }
    }
}
