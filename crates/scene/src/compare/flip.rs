//! FLIP: how much of a difference a person sees when flipping between two pictures.

use crate::picture::{Picture, byte};

/// The mean FLIP error of the first attachment of two pictures of the same size, 0 (the same) to 1, at the default
/// viewing distance. Colors are clamped to [0, 1]; non-finite colors are black.
///
/// Source: Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020.
pub fn flip(reference: &Picture, test: &Picture) -> f64 {
    let image = |picture: &Picture| nv_flip::FlipImageRgb8::with_data(picture.width, picture.height, &rgb8(picture));
    let error = nv_flip::flip(image(reference), image(test), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    f64::from(nv_flip::FlipPool::from_image(&error).mean())
}

fn rgb8(picture: &Picture) -> Vec<u8> {
    let colors = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    colors.iter().flat_map(|color| [color[0], color[1], color[2]]).map(byte).collect()
}
