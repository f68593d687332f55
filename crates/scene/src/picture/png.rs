//! Portable Network Graphics (ISO/IEC 15948).
//!
//! *In:* bytes of RGB or RGBA, or a file's bytes. *Out:* the respective other.

use super::image::{Image, ImageError, Size};
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Filter, Info, Limits, Transformations};
use std::io::Cursor;

/// The first bytes of every such file.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The channels of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channels {
    Rgb,
    Rgba,
}

/// The effort to make a small file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Low: for files that are written often.
    Fast,
    /// High: for files that are kept.
    Best,
}

/// The PNG file of an opaque picture: `width * height` pixels, top row first.
///
/// # Errors
/// A side is 0, or the number of pixels does not match.
pub fn png_rgb(width: u32, height: u32, pixels: &[[u8; 3]], effort: Effort) -> Result<Vec<u8>, ImageError> {
    write(width, height, pixels.as_flattened(), Channels::Rgb, effort)
}

pub(super) fn write(
    width: u32,
    height: u32,
    data: &[u8],
    channels: Channels,
    effort: Effort,
) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::new();
    encode(&mut bytes, width, height, data, channels, effort).map_err(|error| ImageError(error.to_string()))?;
    Ok(bytes)
}

fn encode(
    bytes: &mut Vec<u8>,
    width: u32,
    height: u32,
    data: &[u8],
    channels: Channels,
    effort: Effort,
) -> Result<(), png::EncodingError> {
    let mut encoder = Encoder::with_info(bytes, Info::with_size(width, height))?;
    encoder.set_color(match channels {
        Channels::Rgb => ColorType::Rgb,
        Channels::Rgba => ColorType::Rgba,
    });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(match effort {
        Effort::Fast => Compression::Fast,
        Effort::Best => Compression::High,
    });
    encoder.set_filter(Filter::Adaptive);
    encoder.write_header()?.write_image_data(data)
}

/// Reads any color type and bit depth: palettes and fewer than 8 bits are expanded, transparent colors become alpha.
pub(super) fn read(bytes: &[u8], size: Size) -> Result<Image, ImageError> {
    decode(bytes, size).map_err(|error| match error {
        Failure::Png(error) => ImageError(error.to_string()),
        Failure::Image(error) => error,
    })
}

enum Failure {
    Png(png::DecodingError),
    Image(ImageError),
}

impl From<png::DecodingError> for Failure {
    fn from(error: png::DecodingError) -> Self {
        Self::Png(error)
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        Self::Image(error)
    }
}

/// More than the largest picture with 16 bits per channel needs. `Size` is the limit.
const MAX_BYTES: usize = 1 << 30;

fn decode(bytes: &[u8], size: Size) -> Result<Image, Failure> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_BYTES });
    decoder.set_transformations(Transformations::EXPAND);
    let info = decoder.read_header_info()?;
    let (width, height) = size.check(info.width as usize, info.height as usize)?;
    let mut reader = decoder.read_info()?;
    let length =
        reader.output_buffer_size().ok_or_else(|| ImageError(format!("it has more than {MAX_BYTES} bytes")))?;
    let mut data = vec![0; length];
    let frame = reader.next_frame(&mut data)?;
    let data = data.get(..frame.buffer_size()).unwrap_or_default();
    let numbers: Vec<f32> = match frame.bit_depth {
        BitDepth::Sixteen => {
            data.as_chunks::<2>().0.iter().map(|&two| f32::from(u16::from_be_bytes(two)) / 65535.0).collect()
        }
        _ => data.iter().map(|&one| f32::from(one) / 255.0).collect(),
    };
    Ok(Image { width, height, pixels: colors(&numbers, frame.color_type) })
}

/// The pixels as RGBA.
fn colors(numbers: &[f32], color_type: ColorType) -> Vec<[f32; 4]> {
    match color_type {
        // `EXPAND` leaves no palette.
        ColorType::Grayscale | ColorType::Indexed => numbers.iter().map(|&gray| [gray, gray, gray, 1.0]).collect(),
        ColorType::GrayscaleAlpha => {
            numbers.as_chunks().0.iter().map(|&[gray, alpha]| [gray, gray, gray, alpha]).collect()
        }
        ColorType::Rgb => numbers.as_chunks().0.iter().map(|&[red, green, blue]| [red, green, blue, 1.0]).collect(),
        ColorType::Rgba => numbers.as_chunks().0.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (2, 1);

    fn file(color: ColorType, depth: BitDepth, data: &[u8], palette: &[u8], transparent: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, SIZE.0, SIZE.1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if !palette.is_empty() {
            encoder.set_palette(palette.to_vec());
        }
        if !transparent.is_empty() {
            encoder.set_trns(transparent.to_vec());
        }
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(data).expect("the data");
        writer.finish().expect("an end");
        bytes
    }

    fn pixels(bytes: &[u8]) -> [[f32; 4]; 2] {
        let image = Image::read(bytes, 16, 16).expect("a PNG");
        assert_eq!((image.width, image.height), SIZE);
        image.pixels.try_into().expect("two pixels")
    }

    #[test]
    fn all_color_types_and_bit_depths_are_read() {
        let gray = |x: f32| [x, x, x, 1.0];
        for (depth, data, max) in [(BitDepth::One, 0b0100_0000, 1.0), (BitDepth::Two, 0b0001_0000, 3.0)] {
            let read = pixels(&file(ColorType::Grayscale, depth, &[data], &[], &[]));
            assert_eq!(read, [gray(0.0), gray(1.0 / max)], "{depth:?}");
        }
        let four = file(ColorType::Grayscale, BitDepth::Four, &[0x3f], &[], &[]);
        assert_eq!(pixels(&four), [gray(0.2), gray(1.0)]);
        let eight = file(ColorType::Grayscale, BitDepth::Eight, &[51, 85], &[], &[]);
        assert_eq!(pixels(&eight), [gray(51.0 / 255.0), gray(85.0 / 255.0)]);
        let sixteen = file(ColorType::Grayscale, BitDepth::Sixteen, &[0, 1, 255, 255], &[], &[]);
        assert_eq!(pixels(&sixteen), [gray(1.0 / 65535.0), gray(1.0)]);
        let gray_alpha = file(ColorType::GrayscaleAlpha, BitDepth::Eight, &[255, 51, 0, 255], &[], &[]);
        assert_eq!(pixels(&gray_alpha), [[1.0, 1.0, 1.0, 0.2], [0.0, 0.0, 0.0, 1.0]]);
        let rgb = file(ColorType::Rgb, BitDepth::Eight, &[255, 0, 51, 0, 255, 0], &[], &[]);
        assert_eq!(pixels(&rgb), [[1.0, 0.0, 0.2, 1.0], [0.0, 1.0, 0.0, 1.0]]);
        let wide: Vec<u8> = [0xffffu16, 0, 1, 0x3333, 0, 0, 0, 0].into_iter().flat_map(u16::to_be_bytes).collect();
        let rgba = file(ColorType::Rgba, BitDepth::Sixteen, &wide, &[], &[]);
        assert_eq!(pixels(&rgba), [[1.0, 0.0, 1.0 / 65535.0, 0.2], [0.0; 4]]);
    }

    #[test]
    fn palettes_are_expanded_and_transparent_colors_have_alpha() {
        let palette = [255, 0, 0, 0, 51, 255];
        let indexed = file(ColorType::Indexed, BitDepth::One, &[0b0100_0000], &palette, &[]);
        assert_eq!(pixels(&indexed), [[1.0, 0.0, 0.0, 1.0], [0.0, 0.2, 1.0, 1.0]]);
        let seen_through = file(ColorType::Indexed, BitDepth::Eight, &[0, 1], &palette, &[51]);
        assert_eq!(pixels(&seen_through), [[1.0, 0.0, 0.0, 0.2], [0.0, 0.2, 1.0, 1.0]]);
        let keyed = file(ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 255, 0, 0], &[], &[0, 1, 0, 2, 0, 3]);
        assert_eq!(pixels(&keyed).map(|color| color[3]), [0.0, 1.0]);
    }

    #[test]
    fn an_opaque_picture_is_written() {
        for effort in [Effort::Fast, Effort::Best] {
            let bytes = png_rgb(2, 1, &[[51, 0, 255], [255, 0, 0]], effort).expect("it can be written");
            assert_eq!(pixels(&bytes), [[0.2, 0.0, 1.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
        }
        assert!(png_rgb(2, 2, &[[0; 3]], Effort::Fast).is_err(), "three pixels are missing");
        assert!(png_rgb(0, 0, &[], Effort::Fast).is_err(), "a PNG has at least a pixel");
    }
}
