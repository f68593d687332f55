//! The likely bound: a picture against those of a population of simulated GPUs.
//!
//! *In:* a picture, the reference's with its envelope, and a [`Population`]. *Out:* for each pixel its distance from what
//! the population drew there.
//!
//! *Holds:* the distance is in units of the spread of the population in that channel, which is at least [`LEAST`] of the
//! range of the picture's values: what is nearer than that says nothing, since a population of a few dozen does not reach
//! the ends of what rounding may do. Where the envelope leaves a jump open (it is wider than the eye sees), the pixels around
//! count as well: which side of an edge a pixel is on may be decided by one rounding.

use glisten_reference::{Drawn, Population};
use glisten_scene::picture::Picture;

/// The least spread, as a share of the range of the picture's values.
pub const LEAST: f64 = 1.0 / 65_536.0;

/// An envelope that is wider than this share of the range may contain a jump.
const JUMP: f64 = 1.0 / 255.0;

/// From this distance on a pixel is suspect.
pub const FAR: f64 = 4.0;

/// The least and the largest finite value of all channels of the covered pixels.
fn range(reference: &Picture) -> f64 {
    let covered = |colors: &Vec<[f64; 4]>| -> Vec<[f64; 4]> {
        colors.iter().zip(&reference.covered).filter(|(_, covered)| **covered).map(|(color, _)| *color).collect()
    };
    let values = reference.attachments.iter().flat_map(covered).flatten().filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low <= high { (high - low).max(high.abs()) } else { 0.0 }
}

/// The distance of each pixel of `picture` from the population.
pub fn distances(picture: &Picture, reference: &Picture, population: &Population) -> Vec<f64> {
    let unit = range(reference) * LEAST;
    let jump = range(reference) * JUMP;
    (0..picture.covered.len())
        .map(|pixel| {
            let mut most = 0.0_f64;
            for (number, colors) in picture.attachments.iter().enumerate() {
                let Some(drawn) = population.attachments.get(number) else { continue };
                for channel in 0..4 {
                    let (Some(color), Some(here)) = (colors.get(pixel), drawn.get(pixel)) else { continue };
                    let unit = unit.max(4.0 * f64::from(f32::EPSILON) * color[channel].abs());
                    let near = here[channel].distance(color[channel], unit);
                    if near <= 1.0 || near <= most {
                        continue;
                    }
                    let may_jump = reference.intervals.as_ref().is_none_or(|intervals| {
                        let interval = intervals.get(number).and_then(|of| of.get(pixel));
                        interval.is_none_or(|of| !(of[channel].high - of[channel].low <= jump))
                    });
                    let around = may_jump.then(|| around(drawn, reference, pixel, channel));
                    most = most.max(around.map_or(near, |around| around.distance(color[channel], unit).min(near)));
                }
            }
            most
        })
        .collect()
}

/// What was drawn at a pixel and the eight around it.
fn around(drawn: &[[Drawn; 4]], reference: &Picture, pixel: usize, channel: usize) -> Drawn {
    let width = reference.width.max(1) as usize;
    let (x, y) = (pixel % width, pixel / width);
    let mut joined = drawn.get(pixel).map_or(Drawn::NONE, |here| here[channel]);
    for row in y.saturating_sub(1)..(y + 2).min(reference.height as usize) {
        for column in x.saturating_sub(1)..(x + 2).min(width) {
            if let Some(there) = drawn.get(row * width + column) {
                joined.join(&there[channel]);
            }
        }
    }
    joined
}
