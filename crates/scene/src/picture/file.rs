//! [`ImageFormat`]: the format of a picture file; reading and writing any of them.
//!
//! *In:* the bytes of a PNG, an OpenEXR or a NumPy file, or RGBA numbers. *Out:* the respective other.
//!
//! *Holds:* `.npy` and `.exr` contain float32 RGBA as in the framebuffer; `.png` contains 8 bits, straight alpha,
//! clamped to [0, 1] and rounded, encoded by an [`Encoding`] if one is asked for. Nothing here touches the file system.

use super::image::{Image, ImageError, Shape, Size};
use super::{Encoding, Picture, byte, exr, hdr, jpeg, npy, png};
use std::path::Path;

/// The format of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// NumPy's array file: float32 `[height, width, 4]`.
    Npy,
    /// Portable Network Graphics: 8 bits per channel, RGBA.
    Png,
    /// OpenEXR: float32 RGBA.
    Exr,
}

impl ImageFormat {
    /// The format for the extension of a file name, in upper or lower case.
    pub fn of_name(name: &Path) -> Option<Self> {
        match name.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "npy" => Some(Self::Npy),
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }

    /// Whether [`Image::read`] knows the format of these bytes.
    pub(crate) fn can_read(bytes: &[u8]) -> bool {
        Self::of_bytes(bytes).is_some() || jpeg::is_jpeg(bytes) || hdr::is_hdr(bytes)
    }

    /// The format for the first bytes of a file.
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        [(npy::MAGIC, Self::Npy), (png::MAGIC, Self::Png), (exr::MAGIC, Self::Exr)]
            .into_iter()
            .find_map(|(magic, format)| bytes.starts_with(magic).then_some(format))
    }
}

impl Image {
    /// Reads a PNG of any color type and bit depth, a JPEG, an OpenEXR, a Radiance HDR or a NumPy file. The integers of a PNG and a JPEG become
    /// numbers in [0, 1], without gamma.
    ///
    /// # Errors
    /// The bytes are none of these, are damaged, or have more than `max_side` pixels on a side or `max_pixels` in all.
    pub fn read(bytes: &[u8], max_side: u32, max_pixels: u64) -> Result<Self, ImageError> {
        Self::read_if(bytes, max_side, max_pixels, |_, _| Ok(()))
    }

    /// Reads a picture like [`read`](Self::read), unless its width and height are wrong, which is told before any pixel is read.
    ///
    /// # Errors
    /// Those of [`read`](Self::read), and that of `shape`.
    pub fn read_if(bytes: &[u8], max_side: u32, max_pixels: u64, shape: Shape) -> Result<Self, ImageError> {
        let allowed = Size { max_side, max_pixels, shape };
        match ImageFormat::of_bytes(bytes) {
            Some(ImageFormat::Png) => png::read(bytes, allowed),
            Some(ImageFormat::Exr) => exr::read(bytes, allowed),
            Some(ImageFormat::Npy) => npy::read(bytes, allowed),
            None if jpeg::is_jpeg(bytes) => jpeg::read(bytes, allowed),
            None if hdr::is_hdr(bytes) => hdr::read(bytes, allowed),
            None => Err(ImageError("it is none of PNG, JPEG, OpenEXR, Radiance HDR and NumPy".to_owned())),
        }
    }
}

impl Picture {
    /// A picture of one attachment that covers every pixel. `pixels` has `width * height` colors, top row first.
    pub fn of_colors(width: u32, height: u32, pixels: Vec<[f64; 4]>) -> Self {
        let n_pixels = pixels.len();
        Self {
            width,
            height,
            attachments: vec![pixels],
            covered: vec![true; n_pixels],
            intervals: None,
            undecided: vec![false; n_pixels],
            near_edge: vec![false; n_pixels],
            silhouette: Vec::new(),
            owner_width: Vec::new(),
        }
    }

    /// The bytes of a file with one attachment, counted from 0. A NaN is 0 in a PNG ([`n_nans`](Self::n_nans) counts them).
    ///
    /// # Errors
    /// There is no such attachment, or a side is 0 and the format cannot represent an empty picture.
    pub fn encode(&self, attachment: usize, format: ImageFormat) -> Result<Vec<u8>, ImageError> {
        self.encode_by(attachment, format, Encoding::default())
    }

    /// The bytes of a file like [`encode`](Self::encode), with the colors of a PNG encoded by a transfer function.
    ///
    /// # Errors
    /// As for [`encode`](Self::encode).
    pub fn encode_by(&self, attachment: usize, format: ImageFormat, by: Encoding) -> Result<Vec<u8>, ImageError> {
        let pixels = self.attachments.get(attachment).ok_or_else(|| ImageError("no such attachment".to_owned()))?;
        let (width, height) = (self.width, self.height);
        match format {
            ImageFormat::Npy => Ok(npy::write(width, height, pixels)),
            ImageFormat::Exr => exr::write(width, height, pixels),
            ImageFormat::Png => {
                let bytes: Vec<u8> = pixels.iter().flat_map(|&pixel| by.encode_pixel(pixel)).map(byte).collect();
                png::write(width, height, &bytes, png::Channels::Rgba, png::Effort::Fast)
            }
        }
    }

    /// The number of NaNs in an attachment.
    pub fn n_nans(&self, attachment: usize) -> usize {
        self.attachments.get(attachment).map_or(0, |pixels| pixels.iter().flatten().filter(|x| x.is_nan()).count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        Picture::of_colors(2, 1, vec![[0.0, 0.25, 2.5, 1.0], [-1.0, f64::NAN, 0.5, 0.0]])
    }

    fn read(bytes: &[u8]) -> Image {
        Image::read(bytes, 16, 64).expect("it can be read")
    }

    fn written(format: ImageFormat) -> Vec<u8> {
        picture().encode(0, format).expect("it can be written")
    }

    #[test]
    fn npy_is_float32_height_width_4_without_clamping() {
        let bytes = written(ImageFormat::Npy);
        // An independent reader.
        let npy = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
        assert_eq!(npy.shape(), [1, 2, 4]);
        let values: Vec<f32> = npy.into_vec().expect("float32");
        assert_eq!((values[1], values[2], values[4]), (0.25, 2.5, -1.0));
        assert!(values[5].is_nan());
        assert_eq!(read(&bytes).pixels[0], [0.0, 0.25, 2.5, 1.0]);
    }

    #[test]
    fn png_clamps_and_rounds_and_counts_nan() {
        let image = read(&written(ImageFormat::Png));
        let bytes: Vec<f32> = image.pixels.iter().flatten().map(|value| value * 255.0).collect();
        assert_eq!(bytes, [0.0, 64.0, 255.0, 255.0, 0.0, 0.0, 128.0, 0.0]);
        assert_eq!((image.width, image.height, picture().n_nans(0), picture().n_nans(1)), (2, 1, 1, 0));
    }

    #[test]
    fn a_transfer_function_concerns_the_colors_of_pngs() {
        let picture = Picture::of_colors(1, 1, vec![[0.0, 0.5, 1.0, 0.5]]);
        let encode =
            |format| picture.encode_by(0, format, crate::picture::Transfer::Srgb.into()).expect("it can be written");
        let bytes: Vec<f32> = read(&encode(ImageFormat::Png)).pixels[0].map(|value| value * 255.0).to_vec();
        assert_eq!(bytes, [0.0, 188.0, 255.0, 128.0]);
        for format in [ImageFormat::Npy, ImageFormat::Exr] {
            assert_eq!(read(&encode(format)).pixels[0], [0.0, 0.5, 1.0, 0.5]);
        }
    }

    #[test]
    fn exr_keeps_floats() {
        let image = read(&written(ImageFormat::Exr));
        assert_eq!((image.pixels[0], image.pixels[1][0]), ([0.0, 0.25, 2.5, 1.0], -1.0));
    }

    #[test]
    fn files_are_known_by_name_and_by_content() {
        for (name, format) in [("a.NPY", ImageFormat::Npy), ("b.png", ImageFormat::Png), ("c.exr", ImageFormat::Exr)] {
            assert_eq!(ImageFormat::of_name(Path::new(name)), Some(format));
            assert_eq!(ImageFormat::of_bytes(&written(format)), Some(format));
        }
        assert_eq!((ImageFormat::of_name(Path::new("a.jpg")), ImageFormat::of_bytes(b"")), (None, None));
    }

    #[test]
    fn what_is_damaged_or_too_large_is_an_error() {
        for format in [ImageFormat::Npy, ImageFormat::Png, ImageFormat::Exr] {
            let bytes = written(format);
            assert!(Image::read(&bytes, 1, 64).is_err(), "{format:?}: a side is 2");
            assert!(Image::read(&bytes, 16, 1).is_err(), "{format:?}: there are 2 pixels");
            for length in 0..bytes.len() {
                // A truncated file is rejected, or read (if only a checksum is missing); it never panics.
                let _ = Image::read(&bytes[..length], 16, 64);
            }
            assert!(Image::read(&bytes[..bytes.len() / 2], 16, 64).is_err(), "{format:?}: half of it is gone");
        }
        assert!(Image::read(b"GIF89a", 16, 64).is_err());
    }

    #[test]
    fn flipping_reverses_rows_alone() {
        let image = Image { width: 2, height: 2, pixels: [1.0, 2.0, 3.0, 4.0].map(|red| [red; 4]).to_vec() };
        let reds: Vec<f32> = image.flipped().pixels.iter().map(|color| color[0]).collect();
        assert_eq!(reds, [3.0, 4.0, 1.0, 2.0]);
    }
}
