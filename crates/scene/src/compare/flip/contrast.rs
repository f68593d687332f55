//! The color pipeline: pictures as the eye resolves them, and how far their colors are apart.
//!
//! *In:* pictures in YCxCz. *Out:* the color difference of each pixel, 0 to 1.
//!
//! *The rule:* each channel has a contrast sensitivity function over spatial frequencies. As a filter it is a sum of Gaussians
//! in two dimensions. Such a sum is not separable, but each Gaussian is.

use super::PIXELS_PER_DEGREE;
use super::color::{Opponent, difference};
use super::filter::Plane;
use std::f64::consts::PI;

/// A Gaussian of a contrast sensitivity function: a √(π/b) exp(-π² d²/b), d in degrees.
struct Gaussian {
    a: f64,
    b: f64,
}

/// The sensitivity to luminance.
const ACHROMATIC: &[Gaussian] = &[Gaussian { a: 1.0, b: 0.0047 }];
/// The sensitivity to red against green.
const RED_GREEN: &[Gaussian] = &[Gaussian { a: 1.0, b: 0.0053 }];
/// The sensitivity to blue against yellow.
const BLUE_YELLOW: &[Gaussian] = &[Gaussian { a: 34.1, b: 0.04 }, Gaussian { a: 13.5, b: 0.025 }];

/// The b of the widest Gaussian; three of its standard deviations are the radius of all filters.
const WIDEST: f64 = 0.04;

impl Gaussian {
    /// The weights along an axis, without the factor, at whole pixels.
    fn weights(&self) -> Vec<f64> {
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
        let degrees = (-radius..=radius).map(|pixels| f64::from(pixels) / PIXELS_PER_DEGREE);
        degrees.map(|degrees| (-PI * PI * degrees * degrees / self.b).exp()).collect()
    }

    /// The sum of the weights in two dimensions, with the factor.
    fn volume(&self) -> f64 {
        let sum: f64 = self.weights().iter().sum();
        self.a * (PI / self.b).sqrt() * sum * sum
    }

    /// The channel, filtered by this Gaussian, times its share of the sum of all Gaussians.
    fn filtered(&self, channel: &Plane, share: f64) -> Plane {
        let weights = self.weights();
        let sum: f64 = weights.iter().sum();
        let kernel = |factor: f64| weights.iter().map(|weight| (factor * weight / sum) as f32).collect::<Vec<f32>>();
        channel.filtered(&kernel(1.0), &kernel(share))
    }
}

/// The color difference of each pixel.
pub(super) fn color_differences(reference: &Opponent, test: &Opponent) -> Vec<f32> {
    let (reference, test) = (resolved(reference), resolved(test));
    reference.perceived().zip(test.perceived()).map(|(ours, theirs)| difference(ours, theirs)).collect()
}

/// The picture, filtered by the contrast sensitivity functions.
fn resolved(picture: &Opponent) -> Opponent {
    Opponent {
        y: filtered(&picture.y, ACHROMATIC),
        cx: filtered(&picture.cx, RED_GREEN),
        cz: filtered(&picture.cz, BLUE_YELLOW),
    }
}

/// A channel, filtered by the sum of Gaussians whose weights sum up to 1.
fn filtered(channel: &Plane, sensitivity: &[Gaussian]) -> Plane {
    let volume: f64 = sensitivity.iter().map(Gaussian::volume).sum();
    let parts = sensitivity.iter().map(|gaussian| gaussian.filtered(channel, gaussian.volume() / volume));
    parts.reduce(|sum, part| sum.plus(&part)).unwrap_or_else(|| channel.map(|value| value))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point in the middle of a square, as a channel sees it.
    fn seen(sensitivity: &[Gaussian]) -> Vec<f32> {
        let point = (0..43 * 43).map(|pixel| if pixel == 43 * 21 + 21 { 1.0 } else { 0.0 });
        filtered(&Plane::new(43, point.collect()), sensitivity).values
    }

    #[test]
    fn filters_keep_the_light() {
        for sensitivity in [ACHROMATIC, RED_GREEN, BLUE_YELLOW] {
            assert!((seen(sensitivity).iter().sum::<f32>() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_point_is_the_wider_the_less_the_eye_resolves_it() {
        let highest = |sensitivity| seen(sensitivity).into_iter().fold(0.0, f32::max);
        let found = [ACHROMATIC, RED_GREEN, BLUE_YELLOW].map(highest);
        assert!(found.is_sorted_by(|one, next| one > next), "{found:?}");
    }

    #[test]
    fn filters_end_at_three_deviations_of_the_widest() {
        assert!(BLUE_YELLOW.iter().chain(ACHROMATIC).all(|gaussian| gaussian.b <= WIDEST));
        assert_eq!(ACHROMATIC.iter().map(|gaussian| gaussian.weights().len()).collect::<Vec<usize>>(), [21]);
    }
}
