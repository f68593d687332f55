//! Texels for a sampler of which nothing else is known.
//!
//! *In:* the type of a sampler. *Out:* a table of `[draw.textures]`. *Holds:* neighboring texels differ.

use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use std::fmt::Write;

/// A small texture whose texels differ.
pub(crate) fn values(kind: SamplerType) -> String {
    let (size, texels) = match kind.dim {
        SamplerDim::D1 => ("width = 4", 4),
        SamplerDim::Buffer => ("width = 16", 16),
        SamplerDim::D3 => ("width = 2, height = 2, depth = 2", 8),
        SamplerDim::Cube => ("width = 1", 6),
        SamplerDim::Multisample => ("width = 2, height = 2, samples = 4", 16),
        _ => ("width = 4, height = 4", 16),
    };
    let (layers, texels) = if kind.arrayed { (", layers = 2", texels * 2) } else { ("", texels) };
    let is_filtered = kind.is_filtered() && !kind.shadow && kind.dim != SamplerDim::Rect;
    let filter = if is_filtered { ", filter = \"linear\"" } else { "" };
    let mut numbers = String::new();
    for texel in 0..texels {
        // Some of a shadow's texels are near.
        let depth = if texel % 3 == 1 { 0.3 } else { 1.0 };
        let row = if kind.shadow { [depth; 4] } else { PALETTE[texel % PALETTE.len()] };
        for channel in row.iter().take(if kind.shadow { 1 } else { 4 }) {
            let _ = match kind.texel {
                Scalar::Float | Scalar::Bool => write!(numbers, "{channel:?}, "),
                Scalar::Int | Scalar::Uint => write!(numbers, "{}, ", (channel * 255.0) as i32),
            };
        }
    }
    format!("{{ {size}{layers}{filter}, values = [{}] }}", numbers.trim_end_matches(", "))
}

/// Colors of neighboring texels and of the faces of a cube.
static PALETTE: [[f32; 4]; 7] = [
    [0.9, 0.5, 0.4, 1.0],
    [0.4, 0.7, 0.9, 1.0],
    [0.6, 0.8, 1.0, 1.0],
    [0.4, 0.3, 0.2, 1.0],
    [0.9, 0.8, 0.5, 1.0],
    [0.5, 0.6, 0.5, 1.0],
    [0.7, 0.4, 0.7, 1.0],
];
