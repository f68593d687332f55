//! [`Evidence`]: how much of a picture a comparison really judged.
//!
//! *In:* the reference's picture with its envelopes. *Out:* a class for each covered pixel, their counts, and a
//! histogram of the widths of the envelopes.
//!
//! *The rule:* a pixel is of the first class that applies:
//!
//! 1. [`Class::Excused`]: outside its envelope, and explained by a known fault of the driver.
//! 2. [`Class::Undecided`]: a discard, a depth test or a branch is undecided there.
//! 3. [`Class::Unlimited`]: a channel has no finite bound, the full range of the format, or may be NaN.
//! 4. [`Class::Weak`]: a channel's envelope is wider than the goal. Near an edge, the envelope of each primitive that may
//!    own the pixel counts alone, not their hull.
//! 5. [`Class::Edge`]: near an edge; judged by the hull of the colors of the primitives that may own it.
//! 6. [`Class::Judged`]: all others.
//!
//! `Tally` goes on from there: what the language leaves undefined comes before all of them
//! ([`Class::Undefined`]), and one of classes 2 to 4 on which simulated GPUs agree is [`Class::Likely`].
//!
//! The goal is 1/255 of the range of the picture's values, unless it is given: of all channels that the programs write,
//! over the covered pixels, alpha included. A picture of one value has no range; its goal is 1/255 of 1/255 of its
//! largest magnitude. In 8 bits, the goal is at least one step, because nothing
//! is between, and two steps where a draw blends, which rounds twice. In floats of 16 bits, these are steps at the largest magnitude.
//!
//! *Holds:* the counts of the classes add up to the number of covered pixels, and so do those of the widths.

use crate::picture::{Interval, Picture};
use crate::{Format, Scene};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{Stage, Type};
use serde::Serialize;

/// The goal for the width of an envelope, as a share of the range of the picture's values.
pub const GOAL: f64 = 1.0 / 255.0;

/// The least difference that says something, as a share of the range of the picture's values.
pub const LEAST: f64 = 1.0 / 65_536.0;

/// The share of what a number may be off for no reason that a mean of many may be off, in floats of 32 bits. A coarser format
/// may be rounded to one side.
pub const OF_A_MEAN: f64 = 0.125;

/// The largest f32.
const LARGEST: f64 = f32::MAX as f64;

/// How a covered pixel was compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// By a narrow envelope.
    Judged,
    /// By an envelope wider than the goal.
    Weak,
    /// By an envelope that excludes nothing.
    Unlimited,
    /// Hardly: the reference cannot decide what is drawn there.
    Undecided,
    /// By the hull of the colors of the primitives that may own it.
    Edge,
    /// Not at all: a known fault of the driver explains it.
    Excused,
    /// By the hull of what simulated GPUs drew, because its envelope is too wide.
    Likely,
    /// Not at all: it depends on what the language leaves undefined.
    Undefined,
}

impl Class {
    /// All classes, in the order of reports.
    pub const ALL: [Self; 8] = [
        Self::Judged,
        Self::Likely,
        Self::Weak,
        Self::Unlimited,
        Self::Undecided,
        Self::Undefined,
        Self::Edge,
        Self::Excused,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Judged => "judged",
            Self::Weak => "weak",
            Self::Unlimited => "unlimited",
            Self::Undecided => "undecided",
            Self::Edge => "edge",
            Self::Excused => "excused",
            Self::Likely => "likely",
            Self::Undefined => "undefined",
        }
    }
}

/// The number of covered pixels of each class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[expect(missing_docs, reason = "the fields are the names of the classes")]
pub struct Evidence {
    pub judged: u64,
    pub likely: u64,
    pub weak: u64,
    pub unlimited: u64,
    pub undecided: u64,
    pub undefined: u64,
    pub edge: u64,
    pub excused: u64,
}

impl Evidence {
    /// Counts a pixel.
    pub fn add(&mut self, class: Class) {
        *match class {
            Class::Judged => &mut self.judged,
            Class::Weak => &mut self.weak,
            Class::Unlimited => &mut self.unlimited,
            Class::Undecided => &mut self.undecided,
            Class::Edge => &mut self.edge,
            Class::Excused => &mut self.excused,
            Class::Likely => &mut self.likely,
            Class::Undefined => &mut self.undefined,
        } += 1;
    }

    /// The count of a class.
    pub fn of(&self, class: Class) -> u64 {
        match class {
            Class::Judged => self.judged,
            Class::Weak => self.weak,
            Class::Unlimited => self.unlimited,
            Class::Undecided => self.undecided,
            Class::Edge => self.edge,
            Class::Excused => self.excused,
            Class::Likely => self.likely,
            Class::Undefined => self.undefined,
        }
    }

    /// All pixels.
    pub fn total(&self) -> u64 {
        Class::ALL.iter().map(|class| self.of(*class)).sum()
    }

    /// The pixels that were compared with something that excludes faults.
    pub fn good(&self) -> u64 {
        self.judged + self.likely + self.edge + self.excused
    }

    /// The pixels whose colors were compared with anything: all but those that are excused, undefined or undecided.
    pub fn compared(&self) -> u64 {
        self.judged + self.likely + self.edge + self.weak + self.unlimited
    }
}

/// The number of covered pixels whose envelope has a width between two powers of ten. The width of a pixel is that of its
/// widest channel, in units of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Width {
    /// The smallest width, inclusive.
    pub from: f64,
    /// The largest width, exclusive; `None` (null) if it is infinite. For exact pixels, both bounds are 0.
    pub to: Option<f64>,
    /// The number of pixels.
    pub pixels: u64,
}

/// The widths of envelopes, counted by decades.
#[derive(Clone, Debug, PartialEq)]
pub struct Widths {
    exact: u64,
    decades: [u64; Self::COUNT],
    infinite: u64,
}

impl Default for Widths {
    fn default() -> Self {
        Self { exact: 0, decades: [0; Self::COUNT], infinite: 0 }
    }
}

impl Widths {
    /// The exponent of the first decade, which also counts everything narrower.
    const FIRST: i32 = -12;
    /// The number of decades; the last one also counts everything wider that is finite.
    const COUNT: usize = 16;

    /// Counts a pixel.
    pub fn add(&mut self, width: f64) {
        if width == 0.0 {
            self.exact += 1;
        } else if width.is_finite() {
            let decade = width.log10().floor().clamp(f64::from(Self::FIRST), f64::from(Self::FIRST) + 15.0);
            self.decades[(decade as i32 - Self::FIRST) as usize] += 1;
        } else {
            self.infinite += 1;
        }
    }

    /// The decades with pixels, the narrowest first.
    pub fn rows(&self) -> Vec<Width> {
        let exact = Width { from: 0.0, to: Some(0.0), pixels: self.exact };
        let bound = |index: usize| 10f64.powi(Self::FIRST + index as i32);
        let decades = self.decades.iter().enumerate().map(|(index, pixels)| Width {
            from: if index == 0 { 0.0 } else { bound(index) },
            to: Some(if index + 1 == Self::COUNT { f64::MAX } else { bound(index + 1) }),
            pixels: *pixels,
        });
        let infinite = Width { from: f64::MAX, to: None, pixels: self.infinite };
        [exact].into_iter().chain(decades).chain([infinite]).filter(|row| row.pixels > 0).collect()
    }
}

/// The channels that the programs of a scene write, and the range of their format.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// For each attachment.
    channels: Vec<[bool; 4]>,
    /// All values of the format, if that is less than all floats.
    full: Option<(f64, f64)>,
    /// The distance of neighboring values of the format, if it is the same for all; 0 for floats.
    step: f64,
    /// For floats, the distance as a share of the value.
    relative: f64,
    /// For floats of 16 bits, how far rounding may be off, as a share of the value; else 0.
    coarse: f64,
    /// The largest number that the format has.
    largest: f64,
}

impl Written {
    /// The channels of a scene (OpenGL 3.2 §3.9.2).
    pub fn of(scene: &Scene) -> Self {
        let mut channels = vec![[false; 4]; scene.framebuffer.attachments as usize];
        for draw in &scene.draws {
            let types = &draw.program.types;
            for output in draw.program.interface.outputs.iter().filter(|output| output.index == 0) {
                let (element, count) = match types.get(output.ty) {
                    Type::Array(element, _) => (element, types.flat_len(output.ty) / types.flat_len(element).max(1)),
                    _ => (output.ty, 1),
                };
                let fragment = draw.program.stage(Stage::Fragment);
                let global = fragment.and_then(|shader| shader.globals.get(output.global.index()));
                let goes_to_all = global.is_some_and(|global| global.builtin == Some(BuiltinVariable::FragColor));
                let count = if goes_to_all { channels.len() } else { count as usize };
                let components = types.flat_len(element) as usize;
                for attachment in channels.iter_mut().skip(output.location as usize).take(count) {
                    attachment.iter_mut().take(components).for_each(|channel| *channel = true);
                }
            }
        }
        let format = scene.framebuffer.format;
        let blends = scene.draws.iter().any(|draw| draw.state.blend.is_some());
        // Blending rounds its factors and products as well (§4.1.7).
        let steps = if blends { 2.0 } else { 1.0 };
        let relative = relative_step(format);
        let coarse = if format == Format::Rgba16Float { steps * relative } else { 0.0 };
        let full = full_range(format);
        let largest = full.filter(|_| format == Format::Rgba16Float).map_or(LARGEST, |(_, largest)| largest);
        Self { channels, full, step: steps * step(format), relative, coarse, largest }
    }

    /// Every channel of some attachments, of floats.
    pub fn everything(attachments: usize) -> Self {
        Self {
            channels: vec![[true; 4]; attachments],
            full: None,
            step: 0.0,
            relative: relative_step(Format::Rgba32Float),
            coarse: 0.0,
            largest: LARGEST,
        }
    }

    /// Whether a program writes the channel.
    pub fn is_written(&self, attachment: usize, channel: usize) -> bool {
        self.channels.get(attachment).is_some_and(|channels| channels[channel])
    }

    /// How far rounding to the format may be off at a value; 0 for floats of 32 bits.
    fn step_at(&self, value: f64) -> f64 {
        self.step.max(self.coarse * value.abs())
    }

    /// Whether an interval excludes nothing.
    fn is_unlimited(&self, interval: Interval) -> bool {
        let is_full = self.full.is_some_and(|(low, high)| interval.low <= low && interval.high >= high);
        is_full || !interval.width().is_finite()
    }
}

/// The distance of neighboring values, and what rounding adds to it.
fn step(format: Format) -> f64 {
    match format {
        Format::Rgba8Unorm => 1.0001 / 255.0,
        Format::Rgba32Sint | Format::Rgba32Uint | Format::Rgba32Float | Format::Rgba16Float => 0.0,
    }
}

/// The distance of neighboring floats, as a share of the larger one.
fn relative_step(format: Format) -> f64 {
    match format {
        Format::Rgba16Float => 1.0 / 1024.0,
        Format::Rgba32Float => f64::from(f32::EPSILON),
        Format::Rgba8Unorm | Format::Rgba32Sint | Format::Rgba32Uint => 0.0,
    }
}

/// All values of a format whose numbers are bounded.
fn full_range(format: Format) -> Option<(f64, f64)> {
    match format {
        Format::Rgba32Float => None,
        Format::Rgba16Float => Some((-65504.0, 65504.0)),
        Format::Rgba8Unorm => Some((0.0, 1.0)),
        Format::Rgba32Sint => Some((f64::from(i32::MIN), f64::from(i32::MAX))),
        Format::Rgba32Uint => Some((0.0, f64::from(u32::MAX))),
    }
}

/// The measure of one picture: its range, and the goal for the widths of its envelopes.
#[derive(Clone, Debug)]
pub struct Ruler<'a> {
    cpu: &'a Picture,
    written: &'a Written,
    /// The pixels that measure nothing.
    without: &'a [bool],
    /// The range of the picture's values.
    pub range: f64,
    /// The largest width at which a pixel is judged.
    pub goal: f64,
}

impl<'a> Ruler<'a> {
    /// Whether two pictures cover a pixel and have colors there that are at most half the goal apart, in the channels that the
    /// programs write.
    pub fn agree(&self, one: &Picture, other: &Picture, pixel: usize) -> bool {
        let covers = [one, other].iter().all(|picture| picture.covered.get(pixel) == Some(&true));
        let colors = |picture: &Picture, attachment: usize| picture.attachments.get(attachment)?.get(pixel).copied();
        covers
            && self.written_channels().all(|(attachment, channel, _)| {
                match (colors(one, attachment), colors(other, attachment)) {
                    (Some(one), Some(other)) => (one[channel] - other[channel]).abs() <= self.goal / 2.0,
                    _ => false,
                }
            })
    }

    /// The measure of the reference's picture; `width` replaces the goal.
    pub fn new(cpu: &'a Picture, written: &'a Written, width: Option<f64>) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (index, attachment) in cpu.attachments.iter().enumerate() {
            let pixels = attachment.iter().zip(&cpu.covered).filter(|(_, covered)| **covered);
            for value in pixels.flat_map(|(color, _)| {
                color
                    .iter()
                    .enumerate()
                    .filter(|(channel, _)| written.is_written(index, *channel))
                    .map(|(_, value)| *value)
            }) {
                // What the format does not have is no value of the picture.
                if value.abs() <= written.largest {
                    (low, high) = (low.min(value), high.max(value));
                }
            }
        }
        let range = if low <= high { high - low } else { 0.0 };
        let magnitude = if low <= high { low.abs().max(high.abs()) } else { 0.0 };
        let goal = width.unwrap_or_else(|| (range.max(magnitude * GOAL) * GOAL).max(written.step_at(magnitude)));
        Self { cpu, written, without: &[], range, goal }
    }

    /// The same measure, with pixels that are left out of [whole pictures](super::whole).
    #[must_use]
    pub fn without(self, without: &'a [bool]) -> Self {
        Self { without, ..self }
    }

    /// The width of a pixel's envelope: that of its widest channel.
    pub fn width(&self, pixel: usize) -> f64 {
        self.channels(pixel)
            .map(Interval::width)
            .map(|width| if width.is_nan() { f64::INFINITY } else { width })
            .fold(0.0, f64::max)
    }

    /// How far a number may be off for no reason: what the format rounds to, and a small share of the range.
    pub fn unit(&self, value: f64) -> f64 {
        let rounding = (self.written.step / 2.0).max(4.0 * self.written.relative * value.abs());
        rounding.max(self.range * LEAST)
    }

    /// How far a number may be outside of what is likely for no reason: a step of the format, and a small share of the
    /// range.
    pub(super) fn rounding(&self, value: f64) -> f64 {
        self.step(value).max(self.written.relative * value.abs()).max(self.range * LEAST)
    }

    /// How far rounding to the format may be off at a value; 0 for floats of 32 bits.
    pub(super) fn step(&self, value: f64) -> f64 {
        self.written.step_at(value)
    }

    /// How far the mean of many numbers of this size may be off for no reason.
    pub(super) fn unit_of_a_mean(&self, value: f64) -> f64 {
        let is_fine = self.written.step == 0.0 && self.written.relative <= relative_step(Format::Rgba32Float);
        self.unit(value) * if is_fine { OF_A_MEAN } else { 1.0 }
    }

    /// The pixels that the reference covers and decides, away from edges.
    pub(super) fn places(&self) -> Vec<usize> {
        let flag = |flags: &[bool], pixel: usize| flags.get(pixel).copied().unwrap_or(false);
        let is_plain = |pixel: &usize| {
            let Picture { covered, undecided, near_edge, .. } = self.cpu;
            flag(covered, *pixel) && !flag(self.without, *pixel) && !flag(undecided, *pixel) && !flag(near_edge, *pixel)
        };
        (0..self.cpu.covered.len()).filter(is_plain).collect()
    }

    /// The channels that the programs write: attachment, channel, and the colors of the attachment.
    pub(super) fn written_channels(&self) -> impl Iterator<Item = (usize, usize, &'a [[f64; 4]])> {
        let (cpu, written) = (self.cpu, self.written);
        let attachments = cpu.attachments.iter().enumerate();
        attachments.flat_map(move |(attachment, colors)| {
            let channels = (0..4).filter(move |channel| written.is_written(attachment, *channel));
            channels.map(move |channel| (attachment, channel, colors.as_slice()))
        })
    }

    /// The class of a pixel that is covered and not excused.
    pub fn class(&self, pixel: usize) -> Class {
        let flag = |flags: &[bool]| flags.get(pixel).copied().unwrap_or(false);
        if flag(&self.cpu.undecided) {
            return Class::Undecided;
        }
        if self.channels(pixel).any(|interval| interval.width().is_nan() || !interval.width().is_finite()) {
            return Class::Unlimited;
        }
        if flag(&self.cpu.near_edge) {
            // The hull may be wide because the colors of the owners are far apart.
            return match self.cpu.owner_width.get(pixel).copied().map_or(0.0, f64::from) {
                width if !width.is_finite() => Class::Unlimited,
                width if width > self.goal => Class::Weak,
                _ => Class::Edge,
            };
        }
        match () {
            () if self.channels(pixel).any(|interval| interval.may_be_nan || self.written.is_unlimited(interval)) => {
                Class::Unlimited
            }
            () if self.width(pixel) > self.goal => Class::Weak,
            () => Class::Judged,
        }
    }

    /// The envelopes of the written channels of a pixel.
    fn channels(&self, pixel: usize) -> impl Iterator<Item = Interval> {
        let attachments = self.cpu.intervals.iter().flatten().enumerate();
        attachments.filter_map(move |(index, colors)| Some((index, colors.get(pixel)?))).flat_map(
            move |(index, color)| {
                let written = move |(channel, _): &(usize, &Interval)| self.written.is_written(index, *channel);
                color.iter().enumerate().filter(written).map(|(_, interval)| *interval)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One red pixel of each interval, between an exact 0 and an exact 1.
    fn reference(intervals: &[Interval]) -> Picture {
        let points = [Interval::point(0.0), Interval::point(1.0)];
        let all: Vec<[Interval; 4]> =
            points.iter().chain(intervals).map(|red| [*red, points[0], points[0], points[1]]).collect();
        let colors = all.iter().map(|color| color.map(|interval| interval.low.clamp(0.0, 1.0))).collect();
        Picture { intervals: Some(vec![all.clone()]), ..Picture::of_colors(all.len() as u32, 1, colors) }
    }

    fn between(low: f64, high: f64) -> Interval {
        Interval { low, high, may_be_nan: false }
    }

    #[test]
    fn classes_by_width() {
        let cases = [
            (between(0.5, 0.5), Class::Judged),
            (between(0.5, 0.5 + 0.99 / 255.0), Class::Judged),
            (between(0.5, 0.5 + 1.01 / 255.0), Class::Weak),
            (between(0.0, 1.0), Class::Weak),
            (between(0.0, f64::INFINITY), Class::Unlimited),
            (Interval::ALL, Class::Unlimited),
            (between(f64::INFINITY, f64::INFINITY), Class::Judged),
        ];
        let intervals = cases.map(|case| case.0);
        let picture = reference(&intervals);
        let written = Written::everything(1);
        let ruler = Ruler::new(&picture, &written, None);
        assert_eq!((ruler.range, ruler.goal), (1.0, 1.0 / 255.0));
        for (index, (interval, class)) in cases.iter().enumerate() {
            assert_eq!(ruler.class(index + 2), *class, "{interval:?}");
        }
        // In 8 bits, [0, 1] excludes nothing.
        let bytes = Written { full: full_range(Format::Rgba8Unorm), step: step(Format::Rgba8Unorm), ..written };
        assert_eq!(Ruler::new(&picture, &bytes, None).class(5), Class::Unlimited);
        assert!(Ruler::new(&picture, &bytes, None).goal > 1.0 / 255.0);
        assert_eq!(Ruler::new(&picture, &Written::everything(1), Some(2.0)).class(5), Class::Judged);
        // A 16-bit float has 1024 steps to the next power of two, and a picture of one value has no range.
        let one = Picture::of_colors(2, 1, vec![[1.0; 4]; 2]);
        let halves = Written { coarse: relative_step(Format::Rgba16Float), ..Written::everything(1) };
        assert_eq!(Ruler::new(&one, &halves, None).goal, 1.0 / 1024.0);
    }

    #[test]
    fn an_edge_is_as_good_as_its_owners() {
        let mut picture = reference(&[between(0.0, 1.0), between(0.0, 1.0), between(0.0, 1.0), Interval::ALL]);
        picture.near_edge = vec![true; 6];
        picture.undecided = vec![false, false, false, false, true, false];
        picture.owner_width = vec![0.0, 0.0, 1e-6, 0.5, 0.0, 0.0];
        let written = Written::everything(1);
        let ruler = Ruler::new(&picture, &written, None);
        let classes: Vec<Class> = (2..6).map(|pixel| ruler.class(pixel)).collect();
        assert_eq!(classes, [Class::Edge, Class::Weak, Class::Undecided, Class::Unlimited]);
    }

    #[test]
    fn a_channel_that_is_not_written_measures_nothing() {
        let picture = reference(&[Interval::ALL]);
        let written = Written {
            channels: vec![[false, true, true, false]],
            full: None,
            step: 0.0,
            relative: 0.0,
            coarse: 0.0,
            largest: 1.0,
        };
        let ruler = Ruler::new(&picture, &written, None);
        assert_eq!((ruler.range, ruler.class(2), ruler.width(2)), (0.0, Class::Judged, 0.0));
    }

    #[test]
    fn what_no_float_holds_is_no_value() {
        let mut picture = reference(&[Interval::point(0.5)]);
        let range = |picture: &Picture| Ruler::new(picture, &Written::everything(1), None).range;
        let known = range(&picture);
        picture.attachments[0][0][1] = 1e39;
        assert_eq!(range(&picture), known);
    }

    #[test]
    fn widths_are_counted_by_decades() {
        let mut widths = Widths::default();
        for width in [0.0, 0.0, 1e-30, 3e-7, 5e-7, 0.02, 1e20, f64::INFINITY] {
            widths.add(width);
        }
        let rows = widths.rows();
        assert_eq!(rows.iter().map(|row| row.pixels).collect::<Vec<_>>(), [2, 1, 2, 1, 1, 1]);
        assert!((rows[2].from - 1e-7).abs() < 1e-15 && rows.last().is_some_and(|row| row.to.is_none()));
        assert!(rows.windows(2).all(|pair| pair[0].to.is_some_and(|to| to <= pair[1].from)), "{rows:?}");
    }

    #[test]
    fn counts_add_up() {
        let mut evidence = Evidence::default();
        Class::ALL.iter().for_each(|class| evidence.add(*class));
        assert_eq!((evidence.total(), evidence.good(), evidence.compared()), (8, 4, 5));
        assert!(Class::ALL.iter().all(|class| evidence.of(*class) == 1));
    }
}
