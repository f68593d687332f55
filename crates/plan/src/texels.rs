//! Texels on the device: 32 bits per channel, in the form of the sampler that reads them.

use glisten_front::hir::Scalar;
use glisten_scene::Texels;
use wgpu_types as wgpu;

/// The format of the texels of a sampler.
pub fn texel_format(texel: Scalar) -> wgpu::TextureFormat {
    match texel {
        Scalar::Int => wgpu::TextureFormat::Rgba32Sint,
        Scalar::Uint => wgpu::TextureFormat::Rgba32Uint,
        Scalar::Bool | Scalar::Float => wgpu::TextureFormat::Rgba32Float,
    }
}

/// The texels as RGBA with 4 bytes per channel, converted if the data's type differs from the sampler's.
pub fn texel_bytes(texels: &Texels, texel: Scalar) -> Vec<u8> {
    let bytes = |values: &mut dyn Iterator<Item = f64>| -> Vec<u8> {
        values
            .flat_map(|value| match texel {
                Scalar::Int => (value as i32).to_ne_bytes(),
                Scalar::Uint => (value as u32).to_ne_bytes(),
                Scalar::Bool | Scalar::Float => (value as f32).to_ne_bytes(),
            })
            .collect()
    };
    match (texels, texel) {
        // This keeps the bits of NaNs in the most frequent case.
        (Texels::Float(texels), Scalar::Float) => texels.iter().flatten().flat_map(|v| v.to_ne_bytes()).collect(),
        (Texels::Float(texels), _) => bytes(&mut texels.iter().flatten().map(|&value| f64::from(value))),
        (Texels::Int(texels), _) => bytes(&mut texels.iter().flatten().map(|&value| f64::from(value))),
        (Texels::Uint(texels), _) => bytes(&mut texels.iter().flatten().map(|&value| f64::from(value))),
    }
}

/// The depths of a texture, which are in its first channel.
pub fn depths(texels: &Texels) -> Vec<f32> {
    match texels {
        Texels::Float(texels) => texels.iter().map(|texel| texel[0]).collect(),
        Texels::Int(texels) => texels.iter().map(|texel| texel[0] as f32).collect(),
        Texels::Uint(texels) => texels.iter().map(|texel| texel[0] as f32).collect(),
    }
}
