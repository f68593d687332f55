//! Pictures of what a host read back.
//!
//! *In:* the bytes of the attachments and of the stencil, without padding, top row first. *Out:* a [`Picture`]. *Holds:* values are those
//! that the format stores, without clamping or conversion except to `f64`. Coverage is the stencil that each written fragment sets
//! ([`crate::states::depth_stencil`]), never inferred from colors. A device does not report edges: `near_edge` and `undecided` are all `false`.

use crate::states::pixel_size;
use glisten_scene::picture::Picture;
use glisten_scene::{Format, Framebuffer};

/// The picture of these planes, the stencil last. Bytes that are missing are 0.
pub fn picture(framebuffer: &Framebuffer, mut planes: Vec<Vec<u8>>) -> Picture {
    let pixels = framebuffer.width as usize * framebuffer.height as usize;
    let mut covered: Vec<bool> = planes.pop().unwrap_or_default().into_iter().map(|stencil| stencil != 0).collect();
    covered.resize(pixels, false);
    let attachment = |bytes: &Vec<u8>| {
        let mut decoded = decode(framebuffer.format, bytes);
        decoded.resize(pixels, [0.0; 4]);
        decoded
    };
    Picture {
        width: framebuffer.width,
        height: framebuffer.height,
        attachments: planes.iter().map(attachment).collect(),
        covered,
        intervals: None,
        undecided: vec![false; pixels],
        near_edge: vec![false; pixels],
        silhouette: Vec::new(),
        owner_width: Vec::new(),
    }
}

/// The pixels of an attachment.
pub fn decode(format: Format, bytes: &[u8]) -> Vec<[f64; 4]> {
    let word = |chunk: &[u8]| match chunk {
        [a, b, c, d] => u32::from_ne_bytes([*a, *b, *c, *d]),
        _ => 0,
    };
    let channel: &dyn Fn(&[u8]) -> f64 = match format {
        Format::Rgba32Float => &|chunk| f64::from(f32::from_bits(word(chunk))),
        Format::Rgba32Sint => &|chunk| f64::from(word(chunk).cast_signed()),
        Format::Rgba32Uint => &|chunk| f64::from(word(chunk)),
        Format::Rgba16Float => &|chunk| match chunk {
            [a, b] => half(u16::from_ne_bytes([*a, *b])),
            _ => 0.0,
        },
        Format::Rgba8Unorm => &|chunk| chunk.first().map_or(0.0, |&byte| f64::from(byte) / 255.0),
    };
    let size = pixel_size(format) as usize;
    bytes
        .chunks_exact(size)
        .map(|pixel| {
            let mut channels = pixel.chunks_exact(size / 4).map(channel);
            std::array::from_fn(|_| channels.next().unwrap_or(0.0))
        })
        .collect()
}

/// The value of a half-precision number (IEEE 754 binary16).
fn half(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let exponent = i32::from(bits >> 10 & 0x1f);
    let fraction = f64::from(bits & 0x3ff);
    sign * match exponent {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2f64.powi(exponent - 25),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves() {
        let table = [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_477_539_063e-8),
        ];
        for (bits, value) in table {
            assert_eq!(half(bits), value, "{bits:#06x}");
        }
        assert_eq!(half(0xfc00), f64::NEG_INFINITY);
        assert!(half(0x7e00).is_nan());
    }

    #[test]
    fn integers_come_back_as_numbers() {
        let bytes: Vec<u8> = [-1, 2, i32::MIN, i32::MAX].iter().flat_map(|v: &i32| v.to_ne_bytes()).collect();
        assert_eq!(decode(Format::Rgba32Sint, &bytes), [[-1.0, 2.0, -2147483648.0, 2147483647.0]]);
        assert_eq!(decode(Format::Rgba8Unorm, &[0, 51, 255, 102]), [[0.0, 0.2, 1.0, 0.4]]);
    }
}
