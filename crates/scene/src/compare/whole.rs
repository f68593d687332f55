//! [`Gauge`]: the error of a picture as a whole, in a few figures that do not depend on few pixels.
//!
//! *In:* the reference's picture, then other pictures of the scene. *Out:* [`Figures`] of each, and whether those of one
//! are far from those of others.
//!
//! *The rule:* for each channel that the programs write, over the pixels away from edges that the reference decides (at
//! most [`SAMPLES`] of them, evenly spread): the mean of the error, the mean of its size, and the mean of the error times
//! the deviation of the reference's value from its median, which grows where the contrast does. Each mean leaves out
//! [`TRIMMED`] of the pixels at either end, so that jumps do not count. A wrong factor moves all pixels to one side by
//! less than roundings may move each; roundings do not add up to that.

use super::evidence::Ruler;
use crate::picture::Picture;

/// The number of pixels that are looked at.
pub const SAMPLES: usize = 1 << 14;

/// The share of the pixels that a mean leaves out at either end.
pub const TRIMMED: f64 = 0.05;

/// How many spreads of the others the figures of a picture may be outside of theirs.
pub const FAR_AS_A_WHOLE: f64 = 2.0;

/// The number of pixels below which nothing is concluded.
const LEAST_SAMPLES: usize = 64;

/// The reference's values of a channel.
#[derive(Clone, Debug, PartialEq)]
struct Channel {
    attachment: usize,
    channel: usize,
    /// How far a figure may be off for no reason.
    unit: f64,
    /// The pixels, the reference's values, and how far these are from the median, -1 to 1.
    samples: Vec<(usize, f64, f64)>,
}

/// The pixels and values of the reference's picture that others are measured by.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    channels: Vec<Channel>,
}

/// The figures of a picture, for each channel; `None` where too few pixels have numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures(Vec<Option<[f64; 3]>>);

impl Gauge {
    /// The gauge of the reference's picture.
    pub fn new(ruler: &Ruler<'_>) -> Self {
        let places = ruler.places();
        let step = places.len().div_ceil(SAMPLES).max(1);
        let channels = ruler.written_channels().map(|(attachment, channel, colors)| {
            let value = |pixel: &usize| Some((*pixel, colors.get(*pixel)?[channel]));
            let values: Vec<(usize, f64)> =
                places.iter().step_by(step).filter_map(value).filter(|(_, value)| value.is_finite()).collect();
            Channel::new(attachment, channel, &values, ruler)
        });
        Self { channels: channels.collect() }
    }

    /// The figures of a picture.
    pub fn figures(&self, picture: &Picture) -> Figures {
        Figures(self.channels.iter().map(|channel| channel.figures(picture)).collect())
    }

    /// Whether a picture's figures are far from those of others.
    pub fn is_far(&self, found: &Figures, others: &[Figures]) -> bool {
        self.channels.iter().enumerate().any(|(index, channel)| {
            let of = |figures: &Figures| figures.0.get(index).copied().flatten();
            let Some(found) = of(found) else { return false };
            let others: Vec<[f64; 3]> = others.iter().filter_map(of).collect();
            !others.is_empty() && (0..3).any(|kind| channel.is_far(found[kind], others.iter().map(|other| other[kind])))
        })
    }
}

impl Channel {
    fn new(attachment: usize, channel: usize, values: &[(usize, f64)], ruler: &Ruler<'_>) -> Self {
        let mut sorted: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let spread = values.iter().map(|(_, value)| (value - median).abs()).sum::<f64>() / values.len().max(1) as f64;
        let deviation = |value: f64| if spread > 0.0 { ((value - median) / spread).clamp(-1.0, 1.0) } else { 0.0 };
        let samples = values.iter().map(|(pixel, value)| (*pixel, *value, deviation(*value))).collect();
        Self { attachment, channel, unit: ruler.unit_of_a_mean(median.abs() + spread), samples }
    }

    fn figures(&self, picture: &Picture) -> Option<[f64; 3]> {
        let colors = picture.attachments.get(self.attachment)?;
        let mut found: [Vec<f64>; 3] = Default::default();
        for (pixel, value, deviation) in &self.samples {
            let error = colors.get(*pixel).map_or(f64::NAN, |color| color[self.channel] - value);
            if error.is_finite() && picture.covered.get(*pixel) == Some(&true) {
                let kinds = found.iter_mut().zip([error, error.abs(), error * deviation]);
                kinds.for_each(|(kind, figure)| kind.push(figure));
            }
        }
        (found[0].len() >= LEAST_SAMPLES).then(|| found.map(trimmed_mean))
    }

    fn is_far(&self, found: f64, others: impl Iterator<Item = f64>) -> bool {
        // No error at all is right as well.
        let (low, high) = others.fold((0.0, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
        let outside = (low - found).max(found - high);
        outside > FAR_AS_A_WHOLE * (high - low).max(self.unit)
    }
}

/// The mean of all but the smallest and the largest numbers.
fn trimmed_mean(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_unstable_by(f64::total_cmp);
    let left_out = (numbers.len() as f64 * TRIMMED) as usize;
    let kept = numbers.get(left_out..numbers.len() - left_out).unwrap_or_default();
    kept.iter().sum::<f64>() / kept.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Written;

    const COUNT: u32 = 1000;

    /// A gray ramp, changed by a function of the pixel's number and its value.
    fn ramp(change: impl Fn(u32, f64) -> f64) -> Picture {
        let gray = |pixel: u32| change(pixel, 0.2 + 0.6 * f64::from(pixel) / f64::from(COUNT));
        let colors = (0..COUNT).map(|pixel| [gray(pixel), gray(pixel), gray(pixel), 1.0]).collect();
        Picture::of_colors(COUNT, 1, colors)
    }

    /// An error of a member, up to 1e-3 in size, to either side.
    fn noise(seed: u32) -> impl Fn(u32, f64) -> f64 {
        move |pixel, value| {
            value + 2e-3 * (crate::random::unit(crate::random::mixed(u64::from(pixel * 64 + seed) + 1)) - 0.5)
        }
    }

    fn is_far(change: impl Fn(u32, f64) -> f64) -> bool {
        let reference = ramp(|_, value| value);
        let written = Written::everything(1);
        let gauge = Gauge::new(&Ruler::new(&reference, &written, None));
        let others: Vec<Figures> = (0..8).map(|seed| gauge.figures(&ramp(noise(seed)))).collect();
        gauge.is_far(&gauge.figures(&ramp(change)), &others)
    }

    #[test]
    fn roundings_do_not_add_up_and_factors_do() {
        assert!(!is_far(|_, value| value), "exact: errors may be smaller");
        assert!(!is_far(noise(99)));
        // Each of these is within the noise of a pixel.
        assert!(is_far(|pixel, value| noise(99)(pixel, value + 4e-4)), "an offset");
        assert!(is_far(|pixel, value| noise(99)(pixel, 0.5 + (value - 0.5) * 1.002)), "contrast");
        assert!(is_far(|pixel, value| value + 4.0 * (noise(99)(pixel, value) - value)), "noise four times as large");
    }

    #[test]
    fn few_pixels_and_missing_ones_say_nothing() {
        assert!(!is_far(|pixel, value| if pixel % 25 == 0 { value + 0.5 } else { noise(99)(pixel, value) }));
        assert!(!is_far(|pixel, value| if pixel % 3 == 0 { f64::NAN } else { noise(99)(pixel, value) }));
        assert!(!is_far(|pixel, _| if pixel < 960 { f64::NAN } else { 0.0 }));
    }
}
