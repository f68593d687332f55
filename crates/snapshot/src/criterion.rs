//! [`Criterion`]: whether a picture still is the stored one.
//!
//! *In:* the stored picture, in 8 bits, and the new one. *Out:* [`Comparison`]: whether it holds, why not, and a picture of the
//! differences.

use super::pending::Refusal;
use glisten_reference::{LineRule, Precision, RenderOptions, render};
use glisten_scene::compare::flip;
use glisten_scene::picture::{Image, Interval, Picture, byte};
use glisten_verify::scene::Scene;
use glisten_verify::verify::difference;

/// A rule for pictures that are equal enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// All pixels are the same in 8 bits.
    Exact,
    /// The mean FLIP error is at most this. A person does not see 0.01; 0.05 is a difference between renderers.
    Flip(f64),
}

/// A comparison of pictures.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The reason why the picture is refused; `None` if it holds.
    pub refused: Option<Refusal>,
    /// The picture of the differences.
    pub difference: Option<Picture>,
}

impl Comparison {
    const HOLDS: Self = Self { refused: None, difference: None };

    fn of_size(stored: &Image, [width, height]: [u32; 2]) -> Option<Self> {
        let is_other = stored.width != width || stored.height != height;
        let because =
            || format!("it has {width} x {height} pixels, the stored one {} x {}", stored.width, stored.height);
        is_other.then(|| {
            let of = u64::from(width) * u64::from(height);
            let refusal =
                Refusal { because: because(), criterion: "size".to_owned(), pixels: of, of, ..Refusal::default() };
            Self { refused: Some(refusal), difference: None }
        })
    }
}

impl Criterion {
    /// Compares a picture with the stored one.
    pub(super) fn compare(self, stored: &Image, picture: &Picture) -> Comparison {
        if let Some(compared) = Comparison::of_size(stored, [picture.width, picture.height]) {
            return compared;
        }
        let new = picture.attachments.first().map_or(&[][..], Vec::as_slice);
        let old = Picture::of_colors(stored.width, stored.height, colors(stored));
        let before = old.attachments.first().map_or(&[][..], Vec::as_slice);
        let apart = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).map(|(a, b)| byte(*a).abs_diff(byte(*b))).max();
        let steps: Vec<u8> = new.iter().zip(before).map(|(a, b)| apart(a, b).unwrap_or(0)).collect();
        let pixels = steps.iter().filter(|step| **step > 0).count();
        let most = steps.iter().max().copied().unwrap_or(0);
        let (because, criterion, limit, found) = match self {
            Self::Exact => {
                let because = || format!("{}, by up to {most} of 255", differ(pixels));
                ((pixels > 0).then(because), "exact", None, None)
            }
            Self::Flip(limit) => {
                let error = flip(&old, picture);
                // A limit that is no number accepts nothing.
                let holds = error <= limit;
                let because = || format!("the mean FLIP error is {error:.4}, more than {limit}");
                ((!holds).then(because), "flip", Some(limit), Some(error))
            }
        };
        let refusal = |because| Refusal {
            because,
            criterion: criterion.to_owned(),
            limit,
            found,
            pixels: pixels as u64,
            of: steps.len() as u64,
            steps: most,
        };
        let refused = because.map(refusal);
        let shares: Vec<f64> = steps.iter().map(|step| f64::from(*step)).collect();
        if refused.is_none() {
            Comparison::HOLDS
        } else {
            Comparison { refused, difference: Some(difference(&old, &shares)) }
        }
    }
}

/// Compares the stored picture with the envelope of a scene: each channel of each pixel has to be the rounding of a value that
/// a conforming GPU may draw. The second value is the picture of the reference.
///
/// # Errors
/// The reference cannot draw the scene.
pub(super) fn compare_scene(stored: Option<&Image>, scene: &Scene) -> Result<(Comparison, Picture), String> {
    let options = RenderOptions { precision: Precision::Envelope, lines: LineRule::Vulkan, ..RenderOptions::default() };
    let picture = render(scene, &options).map_err(|errors| {
        let first = errors.first().map_or_else(String::new, |error| error.message.clone());
        format!("the reference cannot draw the scene: {first}")
    })?;
    let Some(stored) = stored else { return Ok((Comparison::HOLDS, picture)) };
    if let Some(compared) = Comparison::of_size(stored, [picture.width, picture.height]) {
        return Ok((compared, picture));
    }
    let intervals = picture.intervals.as_ref().and_then(|all| all.first()).map_or(&[][..], Vec::as_slice);
    let drawn = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    let share = |pixel: usize, stored: &[f64; 4]| {
        let is_free = |flags: &[bool]| flags.get(pixel).copied().unwrap_or(false);
        if is_free(&picture.undecided) || is_free(&picture.silhouette) {
            return 0.0;
        }
        let steps = |channel: usize, value: f64| match intervals.get(pixel) {
            Some(interval) => interval.get(channel).map_or(0, |interval| steps_outside(*interval, value)),
            None => drawn.get(pixel).map_or(0, |color| byte(color[channel]).abs_diff(byte(value))),
        };
        let most = stored.iter().enumerate().map(|(channel, value)| steps(channel, *value)).max();
        // The picture of differences has its zero at the envelope.
        most.filter(|steps| *steps > 0).map_or(0.0, |steps| 1.0 + f64::from(steps))
    };
    let shares: Vec<f64> = colors(stored).iter().enumerate().map(|(pixel, stored)| share(pixel, stored)).collect();
    let count = shares.iter().filter(|share| **share > 0.0).count();
    if count == 0 {
        return Ok((Comparison::HOLDS, picture));
    }
    let most = shares.iter().copied().fold(0.0, f64::max) - 1.0;
    let (are, of) = (
        if count == 1 { "pixel of the stored picture is" } else { "pixels of the stored picture are" },
        shares.len() as u64,
    );
    let refused = Refusal {
        because: format!("{count} {are} outside of the envelope, by up to {most} of 255"),
        criterion: "envelope".to_owned(),
        pixels: count as u64,
        of,
        steps: most as u8,
        ..Refusal::default()
    };
    let map = difference(&picture, &shares);
    Ok((Comparison { refused: Some(refused), difference: Some(map) }, picture))
}

fn differ(pixels: usize) -> String {
    if pixels == 1 { "1 pixel differs".to_owned() } else { format!("{pixels} pixels differ") }
}

/// The colors of a stored picture.
fn colors(stored: &Image) -> Vec<[f64; 4]> {
    stored.pixels.iter().map(|color| color.map(f64::from)).collect()
}

/// How many steps of 8 bits a stored value is outside of an interval. Values that are not finite allow anything.
fn steps_outside(interval: Interval, stored: f64) -> u8 {
    if !interval.low.is_finite() || !interval.high.is_finite() {
        return 0;
    }
    let (low, high, stored) = (byte(interval.low), byte(interval.high), byte(stored));
    if stored < low { low - stored } else { stored.saturating_sub(high) }
}
