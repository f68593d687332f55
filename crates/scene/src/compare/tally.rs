//! [`Comparison`]: compares two pictures, pixel by pixel.
//!
//! *In:* a GPU's picture, the reference's, the [`Criterion`]. *Out:* a [`Verdict`], and the [`Class`] of each pixel.
//!
//! *Holds:* each pixel is counted exactly once. Either only one side covers it (`coverage_mismatch`, or `edge_pixels` at
//! a silhouette, where rounding decides), or the reference cannot decide it (`undecided`), or its colors are compared.
//! Colors never decide coverage. A pixel that may be uncovered must have a color of its envelope if it is covered. Near
//! an edge, the envelope is the hull of the colors of the primitives that may own the pixel. Numbers that are not finite
//! are counted separately and never enter an error figure; if the envelope contains them, they are no mismatch. A
//! difference that only a known fault of the driver explains is counted under the fault's name. What depends on something
//! that the language leaves undefined may have any color: it is counted in the evidence, or as undecided if only one side
//! covers it, and nowhere else.

use super::evidence::{Class, Ruler, Widths, Written};
use super::population::{MARGIN, Place, Population, are_too_many};
use super::verdict::{Criterion, FaultCount, Verdict, Worst, ulp_f32};
use crate::picture::{Interval, Picture};

/// The standards of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// The standard by which a difference is explained.
    pub criterion: Criterion,
    /// A further picture of the reference for each known fault of the driver that is excused.
    pub faults: &'a [(&'static str, Picture)],
    /// The channels that the programs write, and the range of their format; `None`: all, of floats.
    pub written: Option<&'a Written>,
    /// The largest width of the envelope of a judged pixel; `None`: 1/255 of the range of the picture's values.
    pub width: Option<f64>,
    /// The pictures of simulated GPUs.
    pub population: Option<&'a Population>,
    /// By how many of its widths the hull of the simulated GPUs' numbers is widened for what is likely.
    pub likely_margin: f64,
    /// The picture that the device draws by what is known of its arithmetic, if the other one is to be compared with it where
    /// nothing else judges.
    pub device: Option<&'a Picture>,
    /// For each pixel, whether it depends on what the language leaves undefined; empty if none does.
    pub undefined: &'a [bool],
}

impl Default for Comparison<'_> {
    fn default() -> Self {
        Self {
            criterion: Criterion::Envelope,
            faults: &[],
            written: None,
            width: None,
            population: None,
            likely_margin: MARGIN,
            device: None,
            undefined: &[],
        }
    }
}

/// The result of a comparison.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The figures.
    pub verdict: Verdict,
    /// The class of each pixel that both sides cover.
    pub classes: Vec<Option<Class>>,
}

impl Comparison<'_> {
    /// Compares two pictures of the same size and number of attachments.
    pub fn compare(&self, gpu: &Picture, cpu: &Picture) -> Compared {
        let everything = Written::everything(cpu.attachments.len());
        let ruler = Ruler::new(cpu, self.written.unwrap_or(&everything), self.width);
        let mut tally = Tally::new(*self, gpu, cpu);
        (tally.verdict.range, tally.verdict.width) = (ruler.range, ruler.goal);
        for pixel in 0..cpu.covered.len() {
            tally.pixel(&ruler, pixel);
        }
        tally.finish()
    }
}

impl Verdict {
    /// Compares two pictures of the same size and number of attachments.
    pub fn new(gpu: &Picture, cpu: &Picture, criterion: Criterion) -> Self {
        Self::excusing(gpu, cpu, criterion, &[])
    }

    /// Compares like [`Self::new`], given a further reference picture for each known fault of the driver that is
    /// excused.
    pub fn excusing(gpu: &Picture, cpu: &Picture, criterion: Criterion, faults: &[(&'static str, Picture)]) -> Self {
        Comparison { criterion, faults, ..Comparison::default() }.compare(gpu, cpu).verdict
    }
}

/// For each pixel, the largest difference of its channels relative to the bound. It is infinite where only one side
/// covers a decided pixel, or where a number is not finite but must be.
pub fn shares(gpu: &Picture, cpu: &Picture, criterion: Criterion) -> Vec<f64> {
    let tally = Tally::new(Comparison { criterion, ..Comparison::default() }, gpu, cpu);
    (0..cpu.covered.len())
        .map(|pixel| {
            let covers = [&gpu.covered, &cpu.covered].map(|covered| tally.is_flagged(covered, pixel));
            match covers {
                [true, true] => (0..cpu.attachments.len())
                    .map(|attachment| tally.judge_channels(attachment, pixel))
                    .map(|error| if error.finiteness_mismatch > 0 { f64::INFINITY } else { error.share })
                    .fold(0.0, f64::max),
                [false, false] => 0.0,
                _ if tally.is_flagged(&cpu.undecided, pixel) || tally.may_miss(pixel) => 0.0,
                _ => f64::INFINITY,
            }
        })
        .collect()
}

/// A comparison in progress.
struct Tally<'a> {
    comparison: Comparison<'a>,
    gpu: &'a Picture,
    cpu: &'a Picture,
    verdict: Verdict,
    classes: Vec<Option<Class>>,
    widths: Widths,
    /// Pixels that are compared with the population.
    examined: u64,
    /// Pixels that only the pixels around keep from being suspect.
    jumps: u64,
    squares: f64,
    channels: u64,
    worst_rank: f64,
}

/// The comparison of one pixel of one attachment.
#[derive(Default)]
struct PixelError {
    non_finite: [bool; 2],
    finiteness_mismatch: u64,
    outside: bool,
    /// The largest difference relative to the bound.
    share: f64,
    /// The rank for choosing the worst pixel. Every pixel outside its bound ranks before all those inside. Among the
    /// latter, half an ULP does not count, so that a number known except for its final rounding does not appear as
    /// the worst.
    rank: f64,
    /// The channel with that rank.
    channel: usize,
}

impl<'a> Tally<'a> {
    fn new(comparison: Comparison<'a>, gpu: &'a Picture, cpu: &'a Picture) -> Self {
        let judged_by = match comparison.criterion {
            Criterion::Envelope => "envelope",
            Criterion::Tolerance(_) => "tolerance",
        };
        let suspect = comparison.population.map(|_| 0);
        Self {
            comparison,
            gpu,
            cpu,
            verdict: Verdict { judged_by, suspect, ..Verdict::default() },
            classes: vec![None; cpu.covered.len()],
            widths: Widths::default(),
            examined: 0,
            jumps: 0,
            squares: 0.0,
            channels: 0,
            worst_rank: -1.0,
        }
    }

    fn is_flagged(&self, flags: &[bool], pixel: usize) -> bool {
        flags.get(pixel).copied().unwrap_or(false)
    }

    /// Whether a conforming GPU may leave a pixel uncovered because of an edge. A reference without envelopes has no
    /// hull of the owners; near its edges anything goes.
    fn may_miss(&self, pixel: usize) -> bool {
        let flags = if self.cpu.intervals.is_some() { &self.cpu.silhouette } else { &self.cpu.near_edge };
        self.is_flagged(flags, pixel)
    }

    fn pixel(&mut self, ruler: &Ruler<'_>, pixel: usize) {
        let covers = [self.gpu, self.cpu].map(|side| self.is_flagged(&side.covered, pixel));
        let (may_miss, undecided) = (self.may_miss(pixel), self.is_flagged(&self.cpu.undecided, pixel));
        match covers {
            [false, false] => {}
            [true, true] => {
                self.verdict.covered += 1;
                if self.is_undefined(pixel) {
                    self.count_not_finite(pixel);
                    return self.classify(ruler, pixel, Class::Undefined);
                }
                self.colors(pixel, undecided, Some(ruler));
            }
            _ if self.is_undefined(pixel) => self.verdict.undecided += 1,
            [gpu_covers, _] if undecided || may_miss => {
                let count = if may_miss { &mut self.verdict.edge_pixels } else { &mut self.verdict.undecided };
                *count += 1;
                let suspect = |all: &Population| !may_miss && all.is_covered_by_chance(gpu_covers, pixel);
                self.count_suspect(suspect);
                let is_outline = |all: &Population| all.is_covered_otherwise(gpu_covers, pixel) && !suspect(all);
                self.jumps += u64::from(!may_miss && self.comparison.population.is_some_and(is_outline));
                if gpu_covers && self.cpu.intervals.is_some() {
                    self.colors(pixel, true, None);
                }
            }
            _ if self.excused(pixel) => {}
            _ => self.verdict.coverage_mismatch += 1,
        }
    }

    /// Counts a pixel whose value is undefined, of which nothing else is compared.
    fn count_not_finite(&mut self, pixel: usize) {
        let is_finite = |picture: &Picture| {
            (0..picture.attachments.len())
                .all(|attachment| Self::color(picture, attachment, pixel).iter().all(|channel| channel.is_finite()))
        };
        self.verdict.non_finite_gpu += u64::from(!is_finite(self.gpu));
        self.verdict.non_finite_cpu += u64::from(!is_finite(self.cpu));
    }

    /// Compares the colors of a pixel that the GPU covers. Without a ruler, the reference does not cover it.
    fn colors(&mut self, pixel: usize, is_open: bool, ruler: Option<&Ruler<'_>>) {
        let errors: Vec<PixelError> =
            (0..self.cpu.attachments.len()).map(|attachment| self.judge_channels(attachment, pixel)).collect();
        let is_wrong = errors.iter().any(|error| error.outside || error.finiteness_mismatch > 0);
        let is_edge = self.is_flagged(&self.cpu.near_edge, pixel);
        // Where exact arithmetic has no number, any number is right, whatever simulated GPUs make of it.
        let is_defined = !errors.iter().any(|error| error.non_finite[1]);
        if is_wrong && !(is_edge && self.cpu.intervals.is_none()) && self.excused(pixel) {
            if let Some(ruler) = ruler {
                self.classify(ruler, pixel, Class::Excused);
            }
            return;
        }
        let mut likely = None;
        let mut is_open = is_open;
        if let Some(ruler) = ruler {
            let mut class = self.hard_class(ruler, pixel);
            if is_defined && matches!(class, Class::Weak | Class::Unlimited | Class::Undecided) {
                likely = self.likely(ruler, pixel);
                let is_as_known = |device: &Picture| ruler.agree(self.gpu, device, pixel);
                if likely.is_none() && self.comparison.device.is_some_and(is_as_known) {
                    likely = Some(Place::Near);
                    self.verdict.as_device += 1;
                }
            }
            if likely.is_some() {
                (class, is_open) = (Class::Likely, false);
            }
            self.classify(ruler, pixel, class);
        }
        if is_wrong && is_edge && self.cpu.intervals.is_none() {
            self.verdict.edge_pixels += 1;
            return;
        }
        let any = |test: fn(&PixelError) -> bool| u64::from(errors.iter().any(test));
        self.verdict.outside += any(|error| error.outside);
        self.verdict.finiteness_mismatch += errors.iter().map(|error| error.finiteness_mismatch).sum::<u64>();
        if is_open {
            self.verdict.undecided += u64::from(ruler.is_some());
        } else {
            self.verdict.non_finite_gpu += any(|error| error.non_finite[0]);
            self.verdict.non_finite_cpu += any(|error| error.non_finite[1]);
        }
        if let Some(place) = likely.filter(|_| !is_wrong) {
            self.examined += u64::from(!is_edge);
            self.verdict.outside_likely += u64::from(place == Place::Far);
            self.jumps += u64::from(place == Place::AcrossJump && !is_edge);
        } else if let Some(ruler) = ruler.filter(|_| !is_wrong && !is_edge && is_defined) {
            let (gpu, cpu) = (self.gpu, self.cpu);
            self.examined += 1;
            let place = self.comparison.population.map(|population| population.place(gpu, cpu, ruler, pixel));
            self.count_suspect(|_| place == Some(Place::Far));
            self.jumps += u64::from(place == Some(Place::AcrossJump));
        }
        for (attachment, error) in errors.iter().enumerate() {
            if !is_open {
                self.add_differences(attachment, pixel, is_wrong);
            }
            if error.rank > self.worst_rank && (error.outside || !is_open && !is_edge) {
                self.worst_rank = error.rank;
                self.verdict.worst = Some(self.worst_at(attachment, pixel, error.channel));
            }
        }
    }

    /// The class of a pixel that both sides cover, by its envelope.
    fn hard_class(&self, ruler: &Ruler<'_>, pixel: usize) -> Class {
        match self.comparison.criterion {
            Criterion::Envelope => ruler.class(pixel),
            // Whoever names a tolerance finds it narrow enough.
            Criterion::Tolerance(_) => {
                let flags = [&self.cpu.undecided, &self.cpu.near_edge].map(|flags| self.is_flagged(flags, pixel));
                match flags {
                    [true, _] => Class::Undecided,
                    [_, true] => Class::Edge,
                    _ => Class::Judged,
                }
            }
        }
    }

    /// Where a pixel lies among simulated GPUs that agree on it.
    fn likely(&self, ruler: &Ruler<'_>, pixel: usize) -> Option<Place> {
        let population = self.comparison.population?;
        population.likely(self.gpu, ruler, pixel, self.comparison.likely_margin)
    }

    /// Counts a pixel that both sides cover by its class and its width.
    fn classify(&mut self, ruler: &Ruler<'_>, pixel: usize, class: Class) {
        let width = match self.comparison.criterion {
            Criterion::Envelope => ruler.width(pixel),
            Criterion::Tolerance(tolerance) => 2.0 * tolerance,
        };
        self.verdict.evidence.add(class);
        self.widths.add(width);
        if let Some(slot) = self.classes.get_mut(pixel) {
            *slot = Some(class);
        }
    }

    fn is_undefined(&self, pixel: usize) -> bool {
        self.is_flagged(self.comparison.undefined, pixel)
    }

    fn count_suspect(&mut self, is_suspect: impl FnOnce(&Population) -> bool) {
        if let (Some(population), Some(count)) = (self.comparison.population, &mut self.verdict.suspect) {
            *count += u64::from(is_suspect(population));
        }
    }

    /// Whether a known fault explains the pixel, which is then counted under that fault.
    fn excused(&mut self, pixel: usize) -> bool {
        let covers = self.gpu.covered.get(pixel).copied().unwrap_or(false);
        let explains = |picture: &Picture| {
            let open = picture.undecided.get(pixel).copied().unwrap_or(false);
            let known = picture.covered.get(pixel).copied().unwrap_or(false);
            let inside = |attachment: usize| {
                let gpu = Self::color(self.gpu, attachment, pixel);
                let intervals = Self::intervals(picture, attachment, pixel);
                gpu.into_iter().zip(intervals).all(|(gpu, interval)| interval.contains(gpu))
            };
            match (covers, known) {
                (true, _) => (known || open) && (0..picture.attachments.len()).all(inside),
                (false, true) => open,
                (false, false) => true,
            }
        };
        let Some(fault) = self.comparison.faults.iter().find(|(_, picture)| explains(picture)).map(|(name, _)| *name)
        else {
            return false;
        };
        match self.verdict.known_faults.iter_mut().find(|count| count.fault == fault) {
            Some(count) => count.pixels += 1,
            None => self.verdict.known_faults.push(FaultCount { fault, pixels: 1 }),
        }
        true
    }

    fn color(picture: &Picture, attachment: usize, pixel: usize) -> [f64; 4] {
        picture.attachments.get(attachment).and_then(|colors| colors.get(pixel)).copied().unwrap_or([0.0; 4])
    }

    fn intervals(picture: &Picture, attachment: usize, pixel: usize) -> [Interval; 4] {
        let found = picture.intervals.as_ref().and_then(|intervals| intervals.get(attachment)?.get(pixel)).copied();
        found.unwrap_or_else(|| Self::color(picture, attachment, pixel).map(Interval::point))
    }

    /// The allowed values of each channel.
    fn allowed(&self, attachment: usize, pixel: usize) -> [Interval; 4] {
        let envelopes = || Self::intervals(self.cpu, attachment, pixel);
        match self.comparison.criterion {
            Criterion::Tolerance(tolerance) if self.is_flagged(&self.cpu.near_edge, pixel) => {
                // Which primitive owns the pixel is open, whatever the tolerance.
                envelopes().map(|hull| Interval { low: hull.low - tolerance, high: hull.high + tolerance, ..hull })
            }
            Criterion::Tolerance(tolerance) => {
                Self::color(self.cpu, attachment, pixel).map(|value| Interval::around(value, tolerance))
            }
            Criterion::Envelope => envelopes(),
        }
    }

    fn judge_channels(&self, attachment: usize, pixel: usize) -> PixelError {
        let gpu = Self::color(self.gpu, attachment, pixel);
        let cpu = Self::color(self.cpu, attachment, pixel);
        let allowed = self.allowed(attachment, pixel);
        let mut error = PixelError::default();
        for (channel, ((gpu, cpu), interval)) in gpu.into_iter().zip(cpu).zip(allowed).enumerate() {
            error.non_finite[0] |= !gpu.is_finite();
            error.non_finite[1] |= !cpu.is_finite();
            let inside = interval.contains(gpu);
            match (gpu.is_finite(), cpu.is_finite()) {
                (true, true) => {
                    error.outside |= !inside;
                    let (difference, room) = ((gpu - cpu).abs(), interval.room(cpu, gpu));
                    let share = match difference == 0.0 {
                        true => 0.0,
                        false => difference / room.max(f64::MIN_POSITIVE),
                    };
                    error.share = error.share.max(share);
                    let beyond = (difference - 0.5 * ulp_f32(cpu)).max(0.0);
                    let rank = if inside { beyond / room.max(f64::MIN_POSITIVE) } else { 1.0 + share };
                    if rank > error.rank {
                        (error.rank, error.channel) = (rank, channel);
                    }
                }
                (false, false) => {}
                _ => error.finiteness_mismatch += u64::from(!inside),
            }
        }
        error
    }

    fn add_differences(&mut self, attachment: usize, pixel: usize, is_wrong: bool) {
        let gpu = Self::color(self.gpu, attachment, pixel);
        let cpu = Self::color(self.cpu, attachment, pixel);
        // At an edge, a larger difference inside the hull is that of two primitives' colors.
        let most = match !is_wrong && self.is_flagged(&self.cpu.near_edge, pixel) {
            true => self.cpu.owner_width.get(pixel).copied().map_or(f64::INFINITY, f64::from),
            false => f64::INFINITY,
        };
        for (gpu, cpu) in gpu.into_iter().zip(cpu).filter(|(gpu, cpu)| gpu.is_finite() && cpu.is_finite()) {
            let difference = (gpu - cpu).abs();
            if difference > most {
                continue;
            }
            self.verdict.max_abs = self.verdict.max_abs.max(difference);
            self.verdict.max_ulp = self.verdict.max_ulp.max(difference / ulp_f32(cpu));
            self.squares += difference * difference;
            self.channels += 1;
        }
    }

    fn worst_at(&self, attachment: usize, pixel: usize, channel: usize) -> Worst {
        let width = (self.cpu.width as usize).max(1);
        let (gpu, cpu) = (Self::color(self.gpu, attachment, pixel), Self::color(self.cpu, attachment, pixel));
        let intervals = self.allowed(attachment, pixel);
        Worst {
            x: (pixel % width) as u32,
            y: (pixel / width) as u32,
            attachment: attachment as u32,
            channel: channel as u32,
            gpu,
            cpu,
            bound: std::array::from_fn(|k| intervals[k].room(cpu[k], gpu[k])),
            low: intervals.map(|interval| interval.low),
            high: intervals.map(|interval| interval.high),
            contributions: Vec::new(),
        }
    }

    fn finish(mut self) -> Compared {
        if let (Some(population), Some(suspect)) = (self.comparison.population, &mut self.verdict.suspect) {
            if are_too_many(self.jumps, self.verdict.covered) {
                *suspect += self.jumps;
            }
            if population.is_far_as_a_whole(self.gpu) {
                *suspect = (*suspect).max(self.examined);
            }
        }
        self.verdict.pixels = self.cpu.covered.len() as u64;
        if self.channels > 0 {
            self.verdict.rmse = (self.squares / self.channels as f64).sqrt();
        }
        self.verdict.psnr = (self.verdict.rmse > 0.0).then(|| -20.0 * self.verdict.rmse.log10());
        self.verdict.widths = self.widths.rows();
        Compared { verdict: self.verdict, classes: self.classes }
    }
}
