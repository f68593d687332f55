//! The feature pipeline: edges and points, and how far those of two pictures are apart.
//!
//! *In:* the luminances of pictures. *Out:* the feature difference of each pixel, 0 to 1.
//!
//! *The rule:* the first derivative of a Gaussian finds edges, the second one finds points, along both axes. The difference
//! is that of the lengths of the gradients, of edges or of points, whichever is larger.

use super::PIXELS_PER_DEGREE;
use super::filter::Plane;
use std::f32::consts::FRAC_1_SQRT_2;

/// The width of features in degrees, w: twice the standard deviation of the Gaussian.
const WIDTH: f64 = 0.082;

/// A Gaussian and its derivatives along an axis.
struct Derivatives {
    gaussian: Vec<f32>,
    first: Vec<f32>,
    second: Vec<f32>,
}

impl Derivatives {
    /// The weights at whole pixels, up to three standard deviations.
    fn new() -> Self {
        let deviation = 0.5 * WIDTH * PIXELS_PER_DEGREE;
        let radius = (3.0 * deviation).ceil() as i32;
        let kernel = |factor: fn(f64, f64) -> f64| {
            let distances = (-radius..=radius).map(|pixels| f64::from(pixels) / deviation);
            normalized(distances.map(|x| factor(x, (-0.5 * x * x).exp())).collect())
        };
        Self {
            gaussian: kernel(|_, gaussian| gaussian),
            first: kernel(|x, gaussian| -x * gaussian),
            second: kernel(|x, gaussian| (x * x - 1.0) * gaussian),
        }
    }

    /// The lengths of the gradients at edges and at points.
    fn magnitudes(&self, luminance: &Plane) -> [Vec<f32>; 2] {
        let smooth = luminance.across(&self.gaussian);
        [&self.first, &self.second].map(|derivative| {
            let along_x = luminance.filtered(derivative, &self.gaussian);
            lengths(&along_x, &smooth.down(derivative))
        })
    }
}

/// The weights, so that the positive ones sum up to 1, and the negative ones to -1.
fn normalized(weights: Vec<f64>) -> Vec<f32> {
    let sum = |sign: f64| weights.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    let scaled = |weight: &f64| (weight / if *weight > 0.0 { positive } else { negative }) as f32;
    weights.iter().map(scaled).collect()
}

/// The lengths of the vectors of two planes.
fn lengths(x: &Plane, y: &Plane) -> Vec<f32> {
    x.values.iter().zip(&y.values).map(|(x, y)| (x * x + y * y).sqrt()).collect()
}

/// The feature difference of each pixel, of luminances from -16 to 100.
pub(super) fn differences(reference: &Plane, test: &Plane) -> Vec<f32> {
    let derivatives = Derivatives::new();
    let magnitudes = |y: &Plane| derivatives.magnitudes(&y.map(|y| (y + 16.0) / 116.0));
    let ([edges, points], [other_edges, other_points]) = (magnitudes(reference), magnitudes(test));
    let apart = apart(&edges, &other_edges).zip(apart(&points, &other_points));
    apart.map(|(edge, point)| (FRAC_1_SQRT_2 * edge.max(point)).sqrt()).collect()
}

/// How far the numbers are apart.
fn apart(ours: &[f32], theirs: &[f32]) -> impl Iterator<Item = f32> {
    ours.iter().zip(theirs).map(|(ours, theirs)| (ours - theirs).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest edge and the largest point of a square.
    fn largest(luminance: impl Fn(usize, usize) -> f32) -> [f32; 2] {
        let values = (0..40 * 40).map(|pixel| luminance(pixel % 40, pixel / 40)).collect();
        let magnitudes = Derivatives::new().magnitudes(&Plane::new(40, values));
        magnitudes.map(|lengths| lengths.into_iter().fold(0.0, f32::max))
    }

    #[test]
    fn a_step_is_an_edge_and_a_flat_picture_has_none() {
        assert!(largest(|_, _| 0.7).iter().all(|length| *length < 1e-6));
        let [across, down] = [largest(|x, _| f32::from(x < 20)), largest(|_, y| f32::from(y < 20))];
        assert!(across[0] > 0.9 && across[1] < across[0] && (across[0] - down[0]).abs() < 1e-6, "{across:?} {down:?}");
    }

    #[test]
    fn a_dot_is_a_point_more_than_an_edge() {
        let [edge, point] = largest(|x, y| f32::from(x == 20 && y == 20));
        assert!(point > edge && edge > 0.0, "{point} {edge}");
    }

    #[test]
    fn weights_of_either_sign_add_up_to_1() {
        let Derivatives { gaussian, first, second } = Derivatives::new();
        let sum = |weights: &[f32]| weights.iter().sum::<f32>();
        assert!((sum(&gaussian) - 1.0).abs() < 1e-6 && sum(&first).abs() < 1e-6 && sum(&second).abs() < 1e-6);
        assert!((first.iter().map(|weight| weight.abs()).sum::<f32>() - 2.0).abs() < 1e-6);
        assert_eq!(gaussian.len(), 19);
    }
}
