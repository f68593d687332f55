//! Writes pictures to files: `.npy`, `.png` or `.exr`, depending on the extension.
//!
//! *In:* a [`Picture`], top row first. *Out:* bytes.
//! *Holds:* `.npy` and `.exr` contain float32 RGBA as in the framebuffer; `.png` contains 8 bits per channel with
//! straight alpha, clamped to [0, 1] and rounded, without gamma.

use super::exit::Failure;
use crate::scene::Format;
use glisten_scene::picture::Picture;
use image::ImageEncoder;
use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::PngEncoder;
use npyz::WriterBuilder;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The format, by the extension of the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Npy,
    Png,
    Exr,
}

/// Where to write pictures: one file for the first attachment or, with `%d` in the name, one for each.
#[derive(Clone, Debug)]
pub(super) struct Target {
    name: String,
    kind: Kind,
}

impl Target {
    /// The target of a file name.
    pub(super) fn parse(name: &Path) -> Result<Self, Failure> {
        let text = name.to_string_lossy().into_owned();
        let ending = name.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
        let kind = match ending.as_str() {
            "npy" => Kind::Npy,
            "png" => Kind::Png,
            "exr" => Kind::Exr,
            _ => {
                let failure = Failure::usage(format!("the name `{text}` does not tell the format of the picture"));
                return Err(failure.help("let it end in .npy, .png or .exr"));
            }
        };
        Ok(Self { name: text, kind })
    }

    /// Reports what the file format cannot represent.
    pub(super) fn check(&self, format: Format) -> Result<(), Failure> {
        let integer = matches!(format, Format::Rgba32Sint | Format::Rgba32Uint);
        if self.kind == Kind::Png && integer {
            let failure = Failure::usage("a PNG cannot hold the numbers of an integer framebuffer");
            return Err(failure.help("write a .npy"));
        }
        Ok(())
    }

    /// The files with their contents, and how many numbers were not representable (NaN in a PNG).
    pub(super) fn encode(&self, picture: &Picture) -> Result<(Vec<File>, usize), Failure> {
        let mut files = Vec::new();
        let mut nans = 0;
        let count = if self.name.contains("%d") { picture.attachments.len() } else { 1 };
        for (index, pixels) in picture.attachments.iter().take(count).enumerate() {
            let path = PathBuf::from(self.name.replacen("%d", &index.to_string(), 1));
            let size = (picture.width, picture.height);
            let encoded = match self.kind {
                Kind::Npy => npy(size, pixels),
                Kind::Exr => exr(size, pixels),
                Kind::Png => {
                    nans += pixels.iter().flatten().filter(|value| value.is_nan()).count();
                    png(size, pixels)
                }
            };
            let bytes =
                encoded.map_err(|error| Failure::usage(format!("cannot encode `{}`: {error}", path.display())))?;
            files.push((path, bytes));
        }
        Ok((files, nans))
    }
}

/// A file to write.
type File = (PathBuf, Vec<u8>);

/// The error of an encoder.
type EncodeError = Box<dyn std::error::Error>;

fn floats(pixels: &[[f64; 4]]) -> impl Iterator<Item = f32> {
    pixels.iter().flatten().map(|&value| value as f32)
}

/// float32 `[height, width, 4]`
fn npy((width, height): (u32, u32), pixels: &[[f64; 4]]) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[u64::from(height), u64::from(width), 4])
        .writer(&mut bytes)
        .begin_nd()?;
    writer.extend(floats(pixels))?;
    writer.finish()?;
    Ok(bytes)
}

fn exr((width, height): (u32, u32), pixels: &[[f64; 4]]) -> Result<Vec<u8>, EncodeError> {
    let data: Vec<u8> = floats(pixels).flat_map(f32::to_ne_bytes).collect();
    let mut bytes = Cursor::new(Vec::new());
    OpenExrEncoder::new(&mut bytes).write_image(&data, width, height, image::ExtendedColorType::Rgba32F)?;
    Ok(bytes.into_inner())
}

fn png((width, height): (u32, u32), pixels: &[[f64; 4]]) -> Result<Vec<u8>, EncodeError> {
    let data: Vec<u8> = pixels.iter().flatten().map(|&value| byte(value)).collect();
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(&data, width, height, image::ExtendedColorType::Rgba8)?;
    Ok(bytes)
}

/// round(255 x) of x clamped to [0, 1]; NaN is 0.
fn byte(value: f64) -> u8 {
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

#[cfg(test)]
mod tests {
    use super::{Target, byte};
    use crate::scene::Format;
    use glisten_scene::picture::Picture;
    use std::path::Path;

    fn picture() -> Picture {
        let pixels = vec![[0.0, 0.25, 2.5, 1.0], [-1.0, f64::NAN, 0.5, 0.0]];
        Picture {
            width: 2,
            height: 1,
            attachments: vec![pixels.clone(), pixels],
            covered: vec![true; 2],
            ranges: None,
            undecided: vec![false; 2],
            near_edge: vec![false; 2],
        }
    }

    fn encode(name: &str) -> (Vec<(String, Vec<u8>)>, usize) {
        let target = Target::parse(Path::new(name)).expect("a known ending");
        let (files, nans) = target.encode(&picture()).expect("it can be encoded");
        (files.into_iter().map(|(path, bytes)| (path.to_string_lossy().into_owned(), bytes)).collect(), nans)
    }

    #[test]
    fn npy_is_float32_height_width_4_without_clamping() {
        let (files, _) = encode("a.npy");
        let npy = npyz::NpyFile::new(&files[0].1[..]).expect("an npy file");
        assert_eq!(npy.shape(), [1, 2, 4]);
        let values: Vec<f32> = npy.into_vec().expect("float32");
        assert_eq!((values[1], values[2], values[4]), (0.25, 2.5, -1.0));
        assert!(values[5].is_nan());
    }

    #[test]
    fn png_clamps_and_rounds_and_counts_nan() {
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 9.0, f64::NAN].map(byte), [0, 0, 128, 255, 255, 0]);
        let (files, nans) = encode("a%d.png");
        assert_eq!(files.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["a0.png", "a1.png"]);
        assert_eq!(nans, 2);
        let read = image::load_from_memory(&files[0].1).expect("a PNG").to_rgba8();
        assert_eq!(read.as_raw(), &[0, 64, 255, 255, 0, 0, 128, 0]);
    }

    #[test]
    fn exr_keeps_floats() {
        let (files, _) = encode("a.exr");
        let read = image::load_from_memory(&files[0].1).expect("an EXR").to_rgba32f();
        assert_eq!(read.as_raw()[2], 2.5);
    }

    #[test]
    fn unknown_endings_and_integer_pngs_are_refused() {
        assert!(Target::parse(Path::new("a.jpg")).is_err());
        let target = Target::parse(Path::new("a.png")).expect("a known ending");
        assert!(target.check(Format::Rgba32Sint).is_err() && target.check(Format::Rgba8Unorm).is_ok());
    }
}
