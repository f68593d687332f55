//! [`ErrorMap`]: the difference between the pictures of f32 and exact arithmetic, pixel by pixel.
//!
//! *In:* two pictures of one scene. *Out:* the error of each pixel, and the figures of the picture. *Holds:* a pixel whose
//! center is within 1/128 pixel of an edge does not count, since either side may cover it. A pixel that is not finite on
//! the f32 side has an infinite error.

use glisten_scene::picture::Picture;
use glisten_scene::{Format, Framebuffer};

/// The error of each pixel.
#[derive(Clone, Debug)]
pub struct ErrorMap {
    /// The width of the picture in pixels.
    pub width: u32,
    /// The largest difference in any channel of any attachment, row by row; 0 where the pixel does not count, infinite
    /// where the f32 side is not finite.
    pub errors: Vec<f64>,
    /// Whether a pixel counts.
    pub counted: Vec<bool>,
}

/// The part of a color that a picture shows.
pub(super) fn shown(value: f64, format: Format) -> f64 {
    match format {
        Format::Rgba8Unorm if value.is_nan() => value,
        Format::Rgba8Unorm => value.clamp(0.0, 1.0),
        _ => value,
    }
}

/// The scene's framebuffer without the rounding of its format, which would hide or exaggerate errors.
pub(super) fn unrounded(framebuffer: Framebuffer) -> Framebuffer {
    match framebuffer.format {
        Format::Rgba32Sint | Format::Rgba32Uint => framebuffer,
        _ => Framebuffer { format: Format::Rgba32Float, ..framebuffer },
    }
}

impl ErrorMap {
    /// The differences of a picture of f32 arithmetic from the exact one, as the format shows them.
    pub(super) fn new(single: &Picture, exact: &Picture, format: Format) -> Self {
        let count = exact.covered.len();
        let near = |picture: &Picture, at: usize| picture.near_edge.get(at).copied().unwrap_or(false);
        let counted: Vec<bool> = (0..count).map(|at| !near(single, at) && !near(exact, at)).collect();
        let error = |at: usize| -> f64 {
            let attachments = single.attachments.iter().zip(&exact.attachments);
            let pixels = attachments.filter_map(|(single, exact)| Some((single.get(at)?, exact.get(at)?)));
            pixels.map(|(single, exact)| pixel_error(single, exact, format)).fold(0.0, f64::max)
        };
        let errors = (0..count).map(|at| if counted[at] { error(at) } else { 0.0 }).collect();
        Self { width: exact.width, errors, counted }
    }

    /// The errors that are larger than a share of the pixel's exact color, by its largest channel; the others are 0.
    #[must_use]
    pub fn beyond(mut self, exact: &Picture, relative: f64) -> Self {
        if relative > 0.0 {
            for (at, error) in self.errors.iter_mut().enumerate() {
                if *error <= relative * size(exact, at) {
                    *error = 0.0;
                }
            }
        }
        self
    }

    /// The largest finite error as a share of the pixel's exact color, by its largest channel; a color below 1 counts as 1.
    pub fn worst_relative(&self, exact: &Picture) -> f64 {
        let finite = self.errors.iter().enumerate().filter(|(_, error)| error.is_finite());
        finite.map(|(at, error)| error / size(exact, at).max(1.0)).fold(0.0, f64::max)
    }

    /// The column and row of a pixel by its index.
    pub fn place(&self, index: usize) -> [u32; 2] {
        let width = self.width.max(1) as usize;
        [(index % width) as u32, (index / width) as u32]
    }

    /// The error of a pixel by its column and row; 0 outside of the picture.
    pub fn at(&self, [x, y]: [u32; 2]) -> f64 {
        let is_inside = x < self.width;
        let index = y as usize * self.width as usize + x as usize;
        self.errors.get(index).copied().filter(|_| is_inside).unwrap_or(0.0)
    }

    /// The largest finite error, and the index of its pixel.
    pub fn worst(&self) -> Option<(usize, f64)> {
        let finite = self.errors.iter().copied().enumerate().filter(|(_, error)| error.is_finite() && *error > 0.0);
        finite.fold(None, |worst: Option<(usize, f64)>, (index, error)| match worst {
            Some((_, most)) if most >= error => worst,
            _ => Some((index, error)),
        })
    }

    /// The largest error; infinite if a pixel is not finite in f32, 0 if there is none.
    pub fn largest(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// The first pixel that is not finite in f32.
    pub fn first_not_finite(&self) -> Option<usize> {
        self.errors.iter().position(|error| error.is_infinite())
    }

    /// The number of pixels that are not finite in f32.
    pub fn not_finite(&self) -> u64 {
        self.errors.iter().filter(|error| error.is_infinite()).count() as u64
    }

    /// The root of the mean squared finite error over the pixels that count.
    pub fn rmse(&self) -> f64 {
        let finite: Vec<f64> = self.errors.iter().copied().filter(|error| error.is_finite()).collect();
        let count = self.counted.iter().filter(|counted| **counted).count().max(1);
        // An empty sum is -0.
        (finite.iter().map(|error| error * error).fold(0.0, |sum, square| sum + square) / count as f64).sqrt()
    }
}

/// The largest finite channel of a pixel.
fn size(picture: &Picture, at: usize) -> f64 {
    let channels = picture.attachments.iter().filter_map(|pixels| pixels.get(at)).flatten();
    channels.map(|channel| channel.abs()).filter(|size| size.is_finite()).fold(0.0, f64::max)
}

/// The largest error of a channel.
pub(super) fn pixel_error(single: &[f64; 4], exact: &[f64; 4], format: Format) -> f64 {
    let channels = single.iter().zip(exact).map(|(single, exact)| {
        let (single, exact) = (shown(*single, format), shown(*exact, format));
        // A picture of an f32 domain holds integers as f32 numbers.
        let is_integer = matches!(format, Format::Rgba32Sint | Format::Rgba32Uint);
        let exact = if is_integer { f64::from(exact as f32) } else { exact };
        match (single.is_finite(), exact.is_finite()) {
            (true, true) => (single - exact).abs(),
            // The model has no finite color here, and f32 has one by chance.
            (true, false) => 0.0,
            (false, _) => f64::INFINITY,
        }
    });
    channels.fold(0.0, f64::max)
}
