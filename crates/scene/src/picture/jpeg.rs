//! JPEG files: reading only.
//!
//! *In:* bytes. *Out:* an [`Image`] in [0, 1], without gamma. *Holds:* a size past the limit is refused before anything is decoded.

use super::image::{Image, ImageError, Size};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Whether these are the first bytes of a JPEG.
pub(super) fn is_jpeg(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xd8, 0xff])
}

/// Reads a JPEG.
pub(super) fn read(bytes: &[u8], allowed: Size) -> Result<Image, ImageError> {
    let failed = |error: &dyn std::fmt::Display| ImageError(format!("the JPEG cannot be decoded: {error}"));
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGBA)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX));
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| failed(&error))?;
    let info = decoder.info().ok_or_else(|| failed(&"it has no header"))?;
    let (width, height) = allowed.check(info.width.into(), info.height.into())?;
    let texels = decoder.decode().map_err(|error| failed(&error))?;
    let color = |texel: &[u8]| std::array::from_fn(|k| texel.get(k).map_or(1.0, |value| f32::from(*value) / 255.0));
    let pixels: Vec<[f32; 4]> = texels.chunks_exact(4).map(color).collect();
    if pixels.len() != width as usize * height as usize {
        return Err(failed(&"it has too few pixels"));
    }
    Ok(Image { width, height, pixels })
}
