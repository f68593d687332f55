//! The error that a specialized scene makes where it may change rounding.
//!
//! *In:* a scene and what is left of it. *Out:* [`PictureError`]: the pictures of both on the reference, compared.
//! *Holds:* only pixels that both pictures cover count for `max_abs` and `rmse`, and of these only numbers that are finite in
//! both; the others are counted apart. The same on every machine.

use glisten_front::diagnostic::Diagnostic;
use glisten_reference::{LineRule, Precision, RenderOptions, render};
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use serde::Serialize;

/// The difference of two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Distance {
    /// The largest absolute difference of a channel.
    pub max_abs: f64,
    /// The root of the mean square over all channels of all pixels that both cover.
    pub rmse: f64,
}

/// The error of a residual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PictureError {
    /// The largest difference of a channel from the original, both in f32.
    pub max_abs: f64,
    /// The root of the mean square of these differences.
    pub rmse: f64,
    /// Pixels of which any bit differs.
    pub pixels: u64,
    /// Pixels of which a channel is finite in one picture, and NaN or another infinity in the other.
    pub non_finite: u64,
    /// Pixels that only one picture covers.
    pub coverage_mismatch: u64,
    /// The original in f32 against the original in f64: the rounding that was there before.
    pub original: Distance,
    /// The residual in f32 against the original in f64.
    pub residual: Distance,
    /// The residual in f64 against the original in f64: the error that is no rounding.
    pub exact: Distance,
}

/// Differences that are counted apart.
#[derive(Clone, Copy, Debug, Default)]
struct Apart {
    pixels: u64,
    non_finite: u64,
    coverage_mismatch: u64,
}

/// The pictures of a scene and of what is left of it.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// The picture of the original.
    pub original: Picture,
    /// The picture of the residual.
    pub residual: Picture,
}

/// Options for a picture in a precision.
pub(super) fn options(precision: Precision) -> RenderOptions {
    RenderOptions { precision, lines: LineRule::OpenGl, mark_edges: false, ..RenderOptions::default() }
}

/// Draws both scenes on the reference.
///
/// # Errors
/// What the reference cannot do.
pub fn pictures(original: &Scene, residual: &Scene, precision: Precision) -> Result<Pictures, Vec<Diagnostic>> {
    let options = options(precision);
    Ok(Pictures { original: render(original, &options)?, residual: render(residual, &options)? })
}

/// Measures the error of a residual scene.
///
/// # Errors
/// What the reference cannot do.
pub fn picture_error(original: &Scene, residual: &Scene) -> Result<PictureError, Vec<Diagnostic>> {
    let single = pictures(original, residual, Precision::F32)?;
    let double = pictures(original, residual, Precision::F64)?;
    let (distance, apart) = compare(&single.residual, &single.original);
    Ok(PictureError {
        max_abs: distance.max_abs,
        rmse: distance.rmse,
        pixels: apart.pixels,
        non_finite: apart.non_finite,
        coverage_mismatch: apart.coverage_mismatch,
        original: compare(&single.original, &double.original).0,
        residual: compare(&single.residual, &double.original).0,
        exact: compare(&double.residual, &double.original).0,
    })
}

fn compare(picture: &Picture, truth: &Picture) -> (Distance, Apart) {
    let (mut distance, mut apart) = (Distance::default(), Apart::default());
    let (mut squares, mut n_channels) = (0.0, 0u64);
    for (pixel, (covered, wanted)) in picture.covered.iter().zip(&truth.covered).enumerate() {
        if covered != wanted {
            apart.coverage_mismatch += 1;
            apart.pixels += 1;
            continue;
        }
        let (mut differs, mut not_finite) = (false, false);
        for (colors, others) in picture.attachments.iter().zip(&truth.attachments) {
            let (Some(color), Some(other)) = (colors.get(pixel), others.get(pixel)) else { continue };
            for (a, b) in color.iter().zip(other) {
                differs |= a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan());
                let difference = (a - b).abs();
                if difference.is_finite() {
                    distance.max_abs = distance.max_abs.max(difference);
                    squares += difference * difference;
                    n_channels += u64::from(*covered);
                } else {
                    not_finite |= a != b && !(a.is_nan() && b.is_nan());
                }
            }
        }
        apart.pixels += u64::from(differs);
        apart.non_finite += u64::from(not_finite);
    }
    distance.rmse = if n_channels > 0 { (squares / n_channels as f64).sqrt() } else { 0.0 };
    (distance, apart)
}

#[cfg(test)]
mod tests {
    use super::compare;
    use glisten_scene::picture::Picture;

    fn picture(reds: &[f64], covered: &[bool]) -> Picture {
        let colors = reds.iter().map(|red| [*red, 0.0, 0.0, 1.0]).collect();
        Picture { covered: covered.to_vec(), ..Picture::of_colors(reds.len() as u32, 1, colors) }
    }

    #[test]
    fn what_is_not_finite_or_not_covered_counts_apart() {
        let truth = picture(&[0.0, f64::NAN, f64::NAN, 1.0], &[true; 4]);
        let other = picture(&[0.5, f64::NAN, 2.0, 1.0], &[true, true, true, false]);
        let (distance, apart) = compare(&other, &truth);
        assert_eq!((apart.pixels, apart.non_finite, apart.coverage_mismatch), (3, 1, 1));
        assert_eq!(distance.max_abs, 0.5);
        // One of the ten finite channels of three pixels is off.
        assert!((distance.rmse - (0.25f64 / 10.0).sqrt()).abs() < 1e-15, "{distance:?}");
    }

    #[test]
    fn a_picture_has_no_distance_from_itself() {
        let same = picture(&[0.25, f64::INFINITY], &[true, true]);
        let (distance, apart) = compare(&same, &same);
        assert_eq!((distance.max_abs, distance.rmse, apart.pixels), (0.0, 0.0, 0));
    }
}
