//! Writes pictures to files: `.npy`, `.png` or `.exr`, depending on the extension.
//!
//! *In:* a [`Picture`] and a file name, from the command line. *Out:* names and bytes of files.

use crate::exit::Failure;
use glisten_scene::picture::{Encoding, ImageFormat, Picture};
use glisten_verify::scene::Format;
use std::path::{Path, PathBuf};

/// Where to write pictures: one file for the first attachment or, with `%d` in the name, one for each.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    name: String,
    format: ImageFormat,
}

impl Target {
    /// The target of a file name.
    pub(crate) fn parse(name: &Path) -> Result<Self, Failure> {
        let text = name.to_string_lossy().into_owned();
        let Some(format) = ImageFormat::of_name(name) else {
            let failure = Failure::usage(format!("the name `{text}` does not tell the format of the picture"));
            return Err(failure.help("let it end in .npy, .png or .exr"));
        };
        Ok(Self { name: text, format })
    }

    /// Reports what the file format cannot represent.
    pub(crate) fn check(&self, format: Format) -> Result<(), Failure> {
        let integer = matches!(format, Format::Rgba32Sint | Format::Rgba32Uint);
        if self.format == ImageFormat::Png && integer {
            let failure = Failure::usage("a PNG cannot hold the numbers of an integer framebuffer");
            return Err(failure.help("write a .npy"));
        }
        Ok(())
    }

    /// The files with their contents, and how many numbers were not representable (NaN in a PNG).
    pub(crate) fn encode(&self, picture: &Picture, by: impl Into<Encoding>) -> Result<(Vec<File>, usize), Failure> {
        let by = by.into();
        let mut files = Vec::new();
        let mut nans = 0;
        let count = if self.name.contains("%d") { picture.attachments.len() } else { 1 };
        for attachment in 0..count.min(picture.attachments.len()) {
            let path = PathBuf::from(self.name.replacen("%d", &attachment.to_string(), 1));
            if self.format == ImageFormat::Png {
                nans += picture.n_nans(attachment);
            }
            let encoded = picture.encode_by(attachment, self.format, by);
            let bytes =
                encoded.map_err(|error| Failure::usage(format!("cannot encode `{}`: {error}", path.display())))?;
            files.push((path, bytes));
        }
        Ok((files, nans))
    }
}

/// A file to write.
type File = (PathBuf, Vec<u8>);

#[cfg(test)]
mod tests {
    use super::Target;
    use glisten_scene::picture::{Picture, Transfer};
    use glisten_verify::scene::Format;
    use std::path::Path;

    #[test]
    fn a_name_with_a_place_gives_a_file_for_each_attachment() {
        let mut picture = Picture::of_colors(2, 1, vec![[0.0, 0.25, 2.5, 1.0], [-1.0, f64::NAN, 0.5, 0.0]]);
        picture.attachments.push(picture.attachments[0].clone());
        let encode = |name: &str| {
            let target = Target::parse(Path::new(name)).expect("a known ending");
            let (files, nans) = target.encode(&picture, Transfer::Linear).expect("it can be encoded");
            (files.into_iter().map(|(path, _)| path.to_string_lossy().into_owned()).collect::<Vec<_>>(), nans)
        };
        assert_eq!(encode("a%d.png"), (vec!["a0.png".to_owned(), "a1.png".to_owned()], 2));
        assert_eq!(encode("a.npy"), (vec!["a.npy".to_owned()], 0));
    }

    #[test]
    fn unknown_endings_and_integer_pngs_are_refused() {
        assert!(Target::parse(Path::new("a.jpg")).is_err());
        let target = Target::parse(Path::new("a.png")).expect("a known ending");
        assert!(target.check(Format::Rgba32Sint).is_err() && target.check(Format::Rgba8Unorm).is_ok());
    }
}
