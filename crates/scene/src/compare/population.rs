//! [`Population`]: what a number of simulated conforming GPUs drew, and whether a pixel lies far outside of that.
//!
//! *In:* the pictures of the members, and a GPU's. *Out:* which of its pixels are suspect.
//!
//! *The rule:* a channel is suspect if it is further outside of the population's range than [`FAR`] times its spread: the
//! width of that range, but at least [`LEAST`](super::evidence::LEAST) of the range of the picture's values and what the format rounds to. A few
//! dozen members do not reach the ends of what rounding may do, so what is nearer says nothing. It is also suspect if it
//! is not finite and no member's is. Where a member has NaN, the language leaves the result undefined, and nothing is
//! suspect. Where the envelope is wider than the goal for evidence, it may hide a jump: on which
//! side of it a pixel lies may be decided by one rounding, so there the eight pixels around count as well. But a jump is a
//! line: where more than [`MAX_JUMPS`] of the covered pixels need those around them, they are suspect. A pixel that
//! only one side covers is suspect if no pixel around differs in coverage within the population; if that pixel alone does not, it
//! is at an outline, and counts like one across a jump. If the picture as a whole
//! is far from those of the members ([`Gauge`]), each pixel of it is suspect. From [`MIN_SHARE`] of the
//! covered pixels and [`MIN_PIXELS`] pixels on, suspects fail a comparison.
//!
//! *What is likely:* a pixel whose envelope is too wide to be judged is judged by the members, if they agree: the hull of
//! their numbers, widened by [`MARGIN`] times its width and by what the format rounds to, is at most as wide as the goal in
//! each channel that the programs write. It takes [`MIN_MEMBERS`] members that cover the pixel, none with NaN; they are as
//! drivers are. Further members err as far as the rules allow. What they draw is no
//! fault: a number up to [`BEYOND_RULES`] widths outside of the range of all members is right as well. But where it is
//! further than [`MAX_RULES`] from the hull, the members do not agree, and the pixel is not likely. At a jump, and near
//! an edge, where another primitive may own the pixel, the eight pixels around count as above.
//!
//! *Restricted:* members may draw a part of the picture. Elsewhere only the others count. Fewer members make more pixels
//! suspect, never fewer, so a picture that is not suspect would not be with members that draw everything.

use super::evidence::Ruler;
use super::whole::{Figures, Gauge};
use crate::picture::{Interval, Picture};

/// How many spreads of the population a number may be outside of its range.
pub const FAR: f64 = 4.0;

/// By how many of its widths the range of the population is widened for what is likely, unless it is given.
pub const MARGIN: f64 = 4.0;

/// The number of members that a pixel needs at least to be likely. They are as drivers are; further ones err as far as the
/// rules allow.
pub const MIN_MEMBERS: u32 = 16;

/// How many widths of the range of all members a number may be outside of it, if there are more than [`MIN_MEMBERS`].
pub const BEYOND_RULES: f64 = 0.5;

/// How far from what the first members drew a number may be that further members make right, as a share of the range of the picture's values.
/// What is further away is the other side of a jump: the members do not agree, and the pixel is no evidence.
pub const MAX_RULES: f64 = 0.0625;

/// How many widths of the range of the pixels around a number may be outside of it across a jump: a color goes on beyond the
/// pixels that have it.
pub const BEYOND_JUMP: f64 = 1.0;

/// The share of the covered pixels from which suspects fail.
pub const MIN_SHARE: f64 = 0.001;

/// The share of the covered pixels that may lie on the other side of a jump.
pub const MAX_JUMPS: f64 = 0.01;

/// The number of suspects that fail at least.
pub const MIN_PIXELS: u64 = 8;

/// The pictures of a number of simulated conforming GPUs, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Population {
    /// The number of members.
    pub members: u32,
    /// The seed of their differences.
    pub seed: u64,
    /// The width of the pictures.
    pub width: u32,
    /// For each attachment, pixel and channel, the lowest and highest number of the members, and whether one of them is
    /// NaN. Infinities are bounds like other numbers.
    pub ranges: Vec<Vec<[Interval; 4]>>,
    /// The ranges of the first [`MIN_MEMBERS`], once there are more.
    typical: Option<Vec<Vec<[Interval; 4]>>>,
    /// The number of members that cover each pixel.
    pub covered: Vec<u32>,
    /// The measure of pictures as a whole, with the figures of each member that draws everything.
    whole: Option<(Gauge, Vec<Figures>)>,
    restricted: Option<Restricted>,
}

/// Members that draw a part of the picture.
#[derive(Clone, Debug, PartialEq)]
struct Restricted {
    /// The pixels that they draw.
    places: Vec<bool>,
    /// How many they are.
    members: u32,
}

/// Where a pixel lies in relation to what the members drew there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// In the range or near it.
    Near,
    /// Far outside, but in the range of the pixels around, or near it, and the envelope may hide a jump.
    AcrossJump,
    /// Far outside.
    Far,
}

/// No number.
const NOTHING: Interval = Interval { low: f64::INFINITY, high: f64::NEG_INFINITY, may_be_nan: false };

impl Population {
    /// The population without members.
    pub fn new(seed: u64, [width, height]: [u32; 2], attachments: u32) -> Self {
        let count = width as usize * height as usize;
        let ranges = vec![vec![[NOTHING; 4]; count]; attachments as usize];
        Self { members: 0, seed, width, ranges, typical: None, covered: vec![0; count], whole: None, restricted: None }
    }

    /// The same population without members, whose pictures are also compared as a whole.
    #[must_use]
    pub fn with_gauge(self, gauge: Gauge) -> Self {
        Self { whole: Some((gauge, Vec::new())), ..self }
    }

    /// The same population, whose further members draw these pixels alone.
    #[must_use]
    pub fn restricted_to(self, places: Vec<bool>) -> Self {
        Self { restricted: Some(Restricted { places, members: 0 }), ..self }
    }

    /// The pixels that further members draw, if that is not the whole picture.
    pub fn places(&self) -> Option<&[bool]> {
        self.restricted.as_ref().map(|restricted| restricted.places.as_slice())
    }

    /// The number of members that draw a pixel.
    fn members_at(&self, pixel: usize) -> u32 {
        match &self.restricted {
            Some(Restricted { places, members }) if places.get(pixel) != Some(&true) => self.members - members,
            _ => self.members,
        }
    }

    /// Whether a picture as a whole is far from those of the members.
    pub(super) fn is_far_as_a_whole(&self, picture: &Picture) -> bool {
        self.whole.as_ref().is_some_and(|(gauge, members)| gauge.is_far(&gauge.figures(picture), members))
    }

    /// Adds the picture of a member.
    pub fn add(&mut self, picture: &Picture) {
        if self.members == MIN_MEMBERS {
            self.typical = Some(self.ranges.clone());
        }
        self.members += 1;
        let places = self.restricted.as_mut().map(|restricted| {
            restricted.members += 1;
            restricted.places.as_slice()
        });
        let is_drawn = |pixel: usize| places.is_none_or(|places| places.get(pixel) == Some(&true));
        for (ranges, colors) in self.ranges.iter_mut().zip(&picture.attachments) {
            for (pixel, (ranges, color)) in ranges.iter_mut().zip(colors).enumerate() {
                if !is_drawn(pixel) {
                    continue;
                }
                ranges.iter_mut().zip(color).for_each(|(range, value)| *range = with(*range, *value));
            }
        }
        for (pixel, (count, covered)) in self.covered.iter_mut().zip(&picture.covered).enumerate() {
            *count += u32::from(*covered && is_drawn(pixel));
        }
        if let (Some((gauge, members)), None) = (&mut self.whole, places) {
            members.push(gauge.figures(picture));
        }
    }

    /// Where a pixel that the GPU covers lies: see the rule above. `reference` has the envelopes.
    pub(super) fn place(&self, gpu: &Picture, reference: &Picture, ruler: &Ruler<'_>, pixel: usize) -> Place {
        if self.covered.get(pixel) != Some(&self.members_at(pixel)) {
            return if self.is_covered_by_chance(true, pixel) { Place::Far } else { Place::Near };
        }
        let places = (0..gpu.attachments.len()).flat_map(|attachment| {
            let color = gpu.attachments.get(attachment).and_then(|colors| colors.get(pixel));
            let intervals = reference.intervals.as_ref().and_then(|all| all.get(attachment)?.get(pixel));
            let both = color.zip(intervals).into_iter();
            both.flat_map(move |(color, intervals)| {
                (0..4).map(move |channel| {
                    let (value, unit) = (color[channel], ruler.unit(color[channel]));
                    let far = |range: Interval| distance(range, value, unit);
                    let is_far = || {
                        let scale = unit.max(self.usual_width(attachment, pixel, channel));
                        distance(self.range(attachment, pixel, channel), value, scale) > FAR
                    };
                    let around = || self.range_around(attachment, pixel, channel);
                    // A NaN is no width.
                    let width = intervals[channel].width();
                    let may_jump = width.is_nan() || width > ruler.goal;
                    match far(self.range(attachment, pixel, channel)) > FAR && is_far() {
                        false => Place::Near,
                        true if may_jump && far(around()) <= BEYOND_JUMP => Place::AcrossJump,
                        true => Place::Far,
                    }
                })
            })
        });
        places.max().unwrap_or(Place::Near)
    }

    /// Where a pixel that both sides cover lies, if it is likely: see the rule above. `None` if the members do not agree.
    pub(super) fn likely(&self, gpu: &Picture, ruler: &Ruler<'_>, pixel: usize, margin: f64) -> Option<Place> {
        let members = self.members_at(pixel);
        if members < MIN_MEMBERS || self.covered.get(pixel) != Some(&members) {
            return None;
        }
        let mut place = Place::Near;
        for (attachment, channel, _) in ruler.written_channels() {
            let all = self.range(attachment, pixel, channel);
            let typical =
                self.typical.as_ref().map_or(Some(all), |typical| Some(typical.get(attachment)?.get(pixel)?[channel]));
            let (low, high) = widened(typical?, ruler, margin)?;
            let value = gpu.attachments.get(attachment).and_then(|colors| colors.get(pixel))?[channel];
            if value >= low && value <= high {
                continue;
            }
            let (around, unit) = (self.range_around(attachment, pixel, channel), ruler.rounding(value));
            if self.typical.is_some() && distance(all, value, unit) <= BEYOND_RULES {
                if (low - value).max(value - high) > MAX_RULES * ruler.range {
                    return None;
                }
                continue;
            }
            let is_across = distance(around, value, unit) <= BEYOND_JUMP && value.is_finite();
            place = place.max(if is_across { Place::AcrossJump } else { Place::Far });
        }
        Some(place)
    }

    /// Whether a pixel that only one side covers is suspect.
    pub(super) fn is_covered_by_chance(&self, gpu_covers: bool, pixel: usize) -> bool {
        self.around(pixel).all(|place| self.is_covered_otherwise(gpu_covers, place))
    }

    /// Whether no member covers a pixel that the GPU covers, or all cover one that it does not.
    pub(super) fn is_covered_otherwise(&self, gpu_covers: bool, pixel: usize) -> bool {
        let expected = if gpu_covers { 0 } else { self.members_at(pixel) };
        self.members > 0 && self.covered.get(pixel) == Some(&expected)
    }

    fn range(&self, attachment: usize, pixel: usize, channel: usize) -> Interval {
        self.ranges.get(attachment).and_then(|ranges| ranges.get(pixel)).map_or(NOTHING, |ranges| ranges[channel])
    }

    /// The median width of the ranges of a pixel and those around it. A few dozen members may agree on one pixel by
    /// chance, but not on most of nine.
    fn usual_width(&self, attachment: usize, pixel: usize, channel: usize) -> f64 {
        let widths = self.around(pixel).map(|place| self.range(attachment, place, channel).width());
        let mut widths: Vec<f64> = widths.map(|width| if width.is_finite() { width } else { 0.0 }).collect();
        widths.sort_by(f64::total_cmp);
        widths.get(widths.len() / 2).copied().unwrap_or(0.0).max(0.0)
    }

    /// The range at a pixel and those around it.
    fn range_around(&self, attachment: usize, pixel: usize, channel: usize) -> Interval {
        let ranges = self.around(pixel).map(|place| self.range(attachment, place, channel));
        ranges.fold(NOTHING, |hull, range| Interval {
            low: hull.low.min(range.low),
            high: hull.high.max(range.high),
            may_be_nan: hull.may_be_nan || range.may_be_nan,
        })
    }

    /// A pixel and those around it.
    fn around(&self, pixel: usize) -> impl Iterator<Item = usize> {
        let width = self.width.max(1) as usize;
        let (x, y, height) = (pixel % width, pixel / width, self.covered.len() / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
    }
}

/// The range with a further number.
fn with(range: Interval, value: f64) -> Interval {
    match value.is_nan() {
        true => Interval { may_be_nan: true, ..range },
        false => Interval { low: range.low.min(value), high: range.high.max(value), ..range },
    }
}

/// The range of the members with its margin; `None` if it is wider than the goal, or no range of numbers. In a format with
/// steps, or of 16 bits, members that are one step apart agree.
fn widened(range: Interval, ruler: &Ruler<'_>, margin: f64) -> Option<(f64, f64)> {
    if range.may_be_nan || !(range.low <= range.high && range.low.is_finite() && range.high.is_finite()) {
        return None;
    }
    let largest = range.low.abs().max(range.high.abs());
    let (step, rounding) = (ruler.step(largest), ruler.rounding(largest));
    let width = (range.width() - step).max(0.0);
    let own = if step > 0.0 { 0.0 } else { 2.0 * rounding };
    let reach = margin * width + rounding;
    (width * (1.0 + 2.0 * margin) + own <= ruler.goal).then_some((range.low - reach, range.high + reach))
}

/// How far a number is outside of a range, in widths of the range or, if that is more, in units.
fn distance(range: Interval, value: f64, unit: f64) -> f64 {
    if range.may_be_nan || range.contains(value) {
        return 0.0;
    }
    if !value.is_finite() || range.low > range.high {
        return f64::INFINITY;
    }
    // An infinite width tells nothing.
    (range.low - value).max(value - range.high) / range.width().max(unit).max(f64::MIN_POSITIVE)
}

/// Whether so many pixels across a jump are suspect.
pub(super) fn are_too_many(jumps: u64, covered: u64) -> bool {
    jumps >= MIN_PIXELS && jumps as f64 > MAX_JUMPS * covered as f64
}

/// Whether so many suspects fail a comparison.
pub(super) fn fails(suspect: u64, covered: u64) -> bool {
    suspect >= MIN_PIXELS && suspect as f64 > MIN_SHARE * covered as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three members that draw a step of two grays, which one of them moves by a pixel.
    fn population() -> Population {
        let mut population = Population::new(1, [6, 1], 1);
        for step in [3, 3, 4] {
            let gray = |x: usize| if x < step { 0.25 } else { 0.75 };
            let colors = (0..6).map(|x| [gray(x) + 1e-6 * step as f64, 0.0, 0.0, 1.0]).collect();
            population.add(&Picture::of_colors(6, 1, colors));
        }
        population
    }

    fn suspects(reds: [f64; 6], is_wide: bool) -> Vec<usize> {
        let gpu = Picture::of_colors(6, 1, reds.map(|red| [red, 0.0, 0.0, 1.0]).to_vec());
        let mut reference = population_reference();
        let width = if is_wide { 1.0 } else { 1e-4 };
        let around = |color: &[f64; 4]| color.map(|value| Interval::around(value, width / 2.0));
        reference.intervals = Some(vec![reference.attachments[0].iter().map(around).collect()]);
        let written = super::super::evidence::Written::everything(1);
        let ruler = Ruler::new(&reference, &written, None);
        let population = population();
        (0..6).filter(|pixel| population.place(&gpu, &reference, &ruler, *pixel) == Place::Far).collect()
    }

    fn population_reference() -> Picture {
        Picture::of_colors(6, 1, [0.25, 0.25, 0.25, 0.75, 0.75, 0.75].map(|red| [red, 0.0, 0.0, 1.0]).to_vec())
    }

    #[test]
    fn far_outside_is_suspect() {
        assert_eq!(suspects([0.25, 0.25, 0.25, 0.75, 0.75, 0.75], false), [0_usize; 0]);
        assert_eq!(suspects([0.2501, 0.25, 0.25, 0.75, 0.75, 0.7499], false), [0, 5]);
        assert_eq!(distance(Interval { may_be_nan: true, ..Interval::point(1.0) }, 57.2, 1e-6), 0.0, "undefined");
        assert_eq!(suspects([f64::NAN, f64::INFINITY, 0.25, 0.75, 0.75, 0.75], false), [0, 1]);
        // The member that moves the step shows that either is possible there.
        assert_eq!(suspects([0.25, 0.25, 0.25, 0.25, 0.75, 0.75], false), [0_usize; 0]);
        // Farther away the step cannot be, unless the envelope is wide and the step one pixel away.
        assert_eq!(suspects([0.25, 0.25, 0.75, 0.75, 0.25, 0.25], false), [2, 4, 5]);
        assert_eq!(suspects([0.25, 0.25, 0.75, 0.75, 0.25, 0.25], true), [5]);
    }

    #[test]
    fn members_that_agree_on_one_pixel_by_chance_say_nothing() {
        let suspects_where = |agree: usize| {
            let mut population = Population::new(1, [9, 1], 1);
            for red in [0.25, 0.26] {
                let reds = (0..9).map(|x| if x < agree { 0.255 } else { red });
                population.add(&Picture::of_colors(9, 1, reds.map(|red| [red, 0.0, 0.0, 1.0]).collect()));
            }
            let gpu = Picture::of_colors(9, 1, vec![[0.275, 0.0, 0.0, 1.0]; 9]);
            let mut reference = Picture::of_colors(9, 1, vec![[0.255, 0.0, 0.0, 1.0]; 9]);
            reference.intervals = Some(vec![vec![[0.255, 0.0, 0.0, 1.0].map(|value| Interval::around(value, 0.5)); 9]]);
            let written = super::super::evidence::Written::everything(1);
            let ruler = Ruler::new(&reference, &written, None);
            (0..9).filter(|pixel| population.place(&gpu, &reference, &ruler, *pixel) == Place::Far).count()
        };
        assert_eq!([1, 5].map(suspects_where), [0, 5]);
    }

    #[test]
    fn coverage_is_suspect_where_no_member_leaves_it_open() {
        let mut population = population();
        population.covered = vec![3, 3, 3, 1, 0, 0];
        assert!(population.is_covered_by_chance(false, 0) && population.is_covered_by_chance(true, 5));
        assert!(!population.is_covered_by_chance(false, 2) && !population.is_covered_by_chance(true, 4));
        assert!(!Population::new(1, [2, 2], 1).is_covered_by_chance(true, 0), "nobody says anything");
    }

    #[test]
    fn members_of_a_part_count_there_alone() {
        let picture = |red: f64| Picture::of_colors(4, 1, vec![[red, 0.0, 0.0, 1.0]; 4]);
        let places = vec![false, false, true, true];
        let mut population = Population::new(1, [4, 1], 1);
        population.add(&picture(0.5));
        let mut population = population.restricted_to(places.clone());
        for red in [0.25, 0.75] {
            let mut part = picture(red);
            part.covered.clone_from(&places);
            population.add(&part);
        }
        assert_eq!((population.members, &population.covered), (3, &vec![1, 1, 3, 3]));
        assert_eq!([0, 3].map(|pixel| population.members_at(pixel)), [1, 3]);
        let width = |pixel: usize| population.range(0, pixel, 0).width();
        assert_eq!([0, 1, 2, 3].map(width), [0.0, 0.0, 0.5, 0.5]);
        assert!((0..4).all(|pixel| population.is_covered_by_chance(false, pixel)), "all members cover all pixels");
    }

    #[test]
    fn few_suspects_fail_nothing() {
        let cases = [(7, 100, false), (8, 100, true), (8, 8000, false), (9, 8000, true)];
        for (suspect, covered, expected) in cases {
            assert_eq!(fails(suspect, covered), expected, "{suspect} of {covered}");
        }
        for (jumps, covered, expected) in [(7, 100, false), (8, 100, true), (8, 800, false), (9, 800, true)] {
            assert_eq!(are_too_many(jumps, covered), expected, "{jumps} of {covered}");
        }
    }
}
