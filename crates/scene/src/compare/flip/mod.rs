//! FLIP: how much of a difference a person sees when flipping between two pictures.
//!
//! *In:* two pictures of the same size, whose colors are those of sRGB. *Out:* the mean of the errors of their pixels.
//!
//! *The rule:* the color pipeline compares the pictures as the eye resolves them at a distance; the feature pipeline
//! compares their edges and points. The error of a pixel is the difference of the colors, raised to a power that is
//! smaller where the features differ.
//!
//! Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating
//! Images", Proc. ACM Comput. Graph. Interact. Tech. 3 (2), 2020.
//!
//! *Holds:* equal pictures have the error 0. No size makes it panic.
//!
//! *Not done here:* pictures with a high dynamic range (HDR-FLIP), and maps of the errors.

mod color;
mod contrast;
mod features;
mod filter;
#[cfg(test)]
mod tests;

use crate::picture::{Picture, byte};
use color::Opponent;

/// The pixels per degree of visual angle: those of 3840 pixels on 0.7 m, seen from 0.7 m (67.02), rounded.
const PIXELS_PER_DEGREE: f64 = 67.0;

/// The mean FLIP error of the first attachment of two pictures, 0 (the same) to 1, at the default viewing distance.
/// Colors are clamped to [0, 1]; non-finite colors are black. Pictures of different sizes have the error 1.
pub fn flip(reference: &Picture, test: &Picture) -> f64 {
    let (ours, theirs) = (rgb8(reference), rgb8(test));
    if ours.len() != theirs.len() || (reference.width, reference.height) != (test.width, test.height) {
        return 1.0;
    }
    if ours == theirs { 0.0 } else { mean_error(reference.width as usize, &ours, &theirs) }
}

fn rgb8(picture: &Picture) -> Vec<[u8; 3]> {
    let colors = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    colors.iter().map(|[red, green, blue, _]| [*red, *green, *blue].map(byte)).collect()
}

fn mean_error(width: usize, reference: &[[u8; 3]], test: &[[u8; 3]]) -> f64 {
    let (reference, test) = (Opponent::of(width, reference), Opponent::of(width, test));
    let colors = contrast::color_differences(&reference, &test);
    let features = features::differences(&reference.y, &test.y);
    let errors = colors.iter().zip(&features).map(|(color, feature)| f64::from(error(*color, *feature)));
    errors.sum::<f64>() / reference.y.values.len().max(1) as f64
}

/// The final difference.
fn error(color_difference: f32, feature_difference: f32) -> f32 {
    color_difference.powf(1.0 - feature_difference)
}
