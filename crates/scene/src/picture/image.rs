//! [`Image`]: a picture file in memory.

use std::fmt;

/// The reason why a picture cannot be read or written: one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageError(pub(super) String);

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ImageError {}

/// RGBA numbers, top row first, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels from left to right.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The color of each pixel. Gray is copied to red, green and blue. Missing alpha is 1.
    pub pixels: Vec<[f32; 4]>,
}

impl Image {
    /// The picture with its rows in reverse order.
    #[must_use]
    pub fn flipped(mut self) -> Self {
        let width = self.width.max(1) as usize;
        self.pixels = self.pixels.chunks(width).rev().flatten().copied().collect();
        self
    }
}

/// The size limit of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) max_side: u32,
    pub(super) max_pixels: u64,
    /// A rule for the width and the height.
    pub(super) shape: Shape,
}

/// A rule for the width and the height of a picture: what is wrong with them, if something is.
pub type Shape = fn(u32, u32) -> Result<(), String>;

impl Size {
    /// Rejects larger pictures, and those of a wrong shape, before memory is allocated for them.
    pub(super) fn check(self, width: usize, height: usize) -> Result<(u32, u32), ImageError> {
        let (width, height) = self.bound(width, height)?;
        (self.shape)(width, height).map_err(ImageError)?;
        Ok((width, height))
    }

    /// Rejects larger pictures.
    pub(super) fn bound(self, width: usize, height: usize) -> Result<(u32, u32), ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError(format!("it has {width}x{height} pixels, which is none")));
        }
        let side = |side: usize| u32::try_from(side).ok().filter(|side| *side <= self.max_side);
        match (side(width), side(height)) {
            (Some(width), Some(height)) if u64::from(width) * u64::from(height) <= self.max_pixels => {
                Ok((width, height))
            }
            _ => Err(ImageError(format!("it has {width}x{height} pixels, and {} are read", self.words()))),
        }
    }

    fn words(self) -> String {
        match self.max_side {
            u32::MAX => format!("at most {}", self.max_pixels),
            side => format!("at most {} with sides of {side}", self.max_pixels),
        }
    }
}
