//! [`Verdict`]: how far a GPU's picture is from the reference's, and whether the difference is explained.
//!
//! *In:* two pictures of one scene, and the reference's envelope or a tolerance. *Out:* counts and error figures.
//!
//! *Holds:* each pixel is counted exactly once. Either only one side covers it (`coverage_mismatch`, or `edge_pixels`
//! if its center is so near an edge that rounding decides), or the reference cannot decide it (`undecided`), or its
//! colors are compared. Colors never decide coverage. An undecided pixel may be uncovered; if it is covered, its
//! color must lie in the envelope, too. Non-finite numbers are counted separately and never enter an error figure; if
//! the envelope contains them, they are no mismatch. A difference that only a known fault of the driver explains is
//! counted under the fault's name.

use crate::picture::{Interval, Picture};
use serde::Serialize;

/// The standard by which a difference is explained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// The reference's envelope for each channel of each pixel.
    Envelope,
    /// One absolute tolerance for all channels.
    Tolerance(f64),
}

/// A place in a shader that contributes to a bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contributed {
    /// The shader.
    pub file: String,
    /// The line, counted from 1.
    pub line: u32,
    /// The column, counted from 1, in characters.
    pub column: u32,
    /// One past the last column.
    pub end_column: u32,
    /// The operation as GLSL writes it, or `interpolation`.
    pub operation: &'static str,
    /// The share by which the envelope would be narrower if this operation were exact, 0 to 1.
    pub share: f64,
}

/// The pixel with the largest difference, relative to its bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// The column from the left.
    pub x: u32,
    /// The row from the top.
    pub y: u32,
    /// The color attachment.
    pub attachment: u32,
    /// The channel with the largest difference.
    pub channel: u32,
    /// The GPU's color.
    pub gpu: [f64; 4],
    /// The reference's color.
    pub cpu: [f64; 4],
    /// How far each channel may differ towards the GPU's value; infinite (null) if it is unbounded there.
    pub bound: [f64; 4],
    /// The lower bound of each channel.
    pub low: [f64; 4],
    /// The upper bound of each channel.
    pub high: [f64; 4],
    /// The contributions to the bound, the largest share first; empty unless requested.
    pub contributions: Vec<Contributed>,
}

/// The pixels that only a known fault of the driver explains.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FaultCount {
    /// The fault's name, or `several` if it takes more than one.
    pub fault: &'static str,
    /// The number of pixels.
    pub pixels: u64,
}

/// The result of a comparison in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Conclusion {
    /// Every difference is explained.
    Holds,
    /// Nothing was compared: no pixel is covered.
    Inconclusive,
    /// There is a difference that is not explained.
    Fails,
}

/// The figures and counts of one comparison. Errors are absolute, over all channels of all attachments of the pixels
/// that both sides cover and that are decided and finite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// The largest difference.
    pub max_abs: f64,
    /// The root mean square difference.
    pub rmse: f64,
    /// `-20 log10(rmse)` in dB for a peak of 1; `None` (null) if the pictures are equal.
    pub psnr: Option<f64>,
    /// The largest difference in units in the last place (ULP) of the reference's value as an f32.
    pub max_ulp: f64,
    /// The number of pixels in a picture.
    pub pixels: u64,
    /// Pixels that both sides cover.
    pub covered: u64,
    /// Pixels that only one side covers.
    pub coverage_mismatch: u64,
    /// Pixels within 1/128 pixel of an edge whose coverage differs, or whose difference exceeds the bound.
    pub edge_pixels: u64,
    /// Pixels that both cover and whose value on the GPU is not finite.
    pub non_finite_gpu: u64,
    /// Pixels that both cover and whose value in the reference is not finite.
    pub non_finite_cpu: u64,
    /// Channels that are finite on only one side.
    pub finiteness_mismatch: u64,
    /// `envelope` or `tolerance`.
    pub judged_by: &'static str,
    /// Pixels whose difference exceeds the bound.
    pub outside: u64,
    /// Pixels whose discard, depth test or coverage is undecided, or that have too many possible paths.
    pub undecided: u64,
    /// Pixels that only a known fault of the driver explains; they count nowhere else.
    pub known_faults: Vec<FaultCount>,
    /// The pixel with the largest difference; `None` (null) if none was compared.
    pub worst: Option<Worst>,
}

/// The largest accepted share of undecided pixels.
const MAX_UNDECIDED_SHARE: f64 = 0.01;

impl Verdict {
    /// Compares two pictures of the same size and number of attachments.
    pub fn new(gpu: &Picture, cpu: &Picture, criterion: Criterion) -> Self {
        Self::excusing(gpu, cpu, criterion, &[])
    }

    /// Compares like [`Self::new`], given a further reference picture for each known fault of the driver that is
    /// excused.
    pub fn excusing(gpu: &Picture, cpu: &Picture, criterion: Criterion, faults: &[(&'static str, Picture)]) -> Self {
        let judged_by = match criterion {
            Criterion::Envelope => "envelope",
            Criterion::Tolerance(_) => "tolerance",
        };
        let mut tally = Tally {
            gpu,
            cpu,
            criterion,
            faults,
            verdict: Self { judged_by, ..Self::default() },
            squares: 0.0,
            channels: 0,
            worst_rank: -1.0,
        };
        for pixel in 0..cpu.covered.len() {
            tally.pixel(pixel);
        }
        tally.finish()
    }

    /// The result in one word, with undecided pixels judged as by [`Self::holds`].
    pub fn conclusion(&self, allow_undecided: bool) -> Conclusion {
        match (self.holds(allow_undecided), self.covered) {
            (false, _) => Conclusion::Fails,
            (true, 0) => Conclusion::Inconclusive,
            (true, _) => Conclusion::Holds,
        }
    }

    /// Whether every difference is explained, if there is one at all: see [`Self::conclusion`]. Undecided pixels are not accepted from 1 % of the covered ones on,
    /// unless they are allowed.
    pub fn holds(&self, allow_undecided: bool) -> bool {
        let undecided = self.undecided as f64 > MAX_UNDECIDED_SHARE * self.covered as f64;
        self.outside == 0
            && self.coverage_mismatch == 0
            && self.finiteness_mismatch == 0
            && (allow_undecided || !undecided)
    }

    /// Whether there is a difference that the specifications do not explain.
    pub fn needs_excuse(&self) -> bool {
        self.outside > 0 || self.finiteness_mismatch > 0 || self.coverage_mismatch > 0
    }

    /// The worse of two verdicts, figure by figure.
    #[must_use]
    pub fn worse(&self, other: &Self) -> Self {
        let (near, far) = if self.max_abs >= other.max_abs { (other, self) } else { (self, other) };
        let psnr = match (self.psnr, other.psnr) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        Self {
            max_abs: far.max_abs,
            rmse: self.rmse.max(other.rmse),
            psnr,
            max_ulp: self.max_ulp.max(other.max_ulp),
            pixels: self.pixels,
            covered: self.covered.min(other.covered),
            coverage_mismatch: self.coverage_mismatch.max(other.coverage_mismatch),
            edge_pixels: self.edge_pixels.max(other.edge_pixels),
            non_finite_gpu: self.non_finite_gpu.max(other.non_finite_gpu),
            non_finite_cpu: self.non_finite_cpu.max(other.non_finite_cpu),
            finiteness_mismatch: self.finiteness_mismatch.max(other.finiteness_mismatch),
            judged_by: self.judged_by,
            outside: self.outside.max(other.outside),
            undecided: self.undecided.max(other.undecided),
            known_faults: worse_faults(&self.known_faults, &other.known_faults),
            worst: far.worst.clone().or_else(|| near.worst.clone()),
        }
    }
}

/// The larger count of each fault.
fn worse_faults(a: &[FaultCount], b: &[FaultCount]) -> Vec<FaultCount> {
    let mut all = a.to_vec();
    for count in b {
        match all.iter_mut().find(|known| known.fault == count.fault) {
            Some(known) => known.pixels = known.pixels.max(count.pixels),
            None => all.push(count.clone()),
        }
    }
    all
}

/// For each pixel, the largest difference of its channels relative to the bound. It is infinite where only one side
/// covers a decided pixel, or where a number is not finite but must be.
pub fn shares(gpu: &Picture, cpu: &Picture, criterion: Criterion) -> Vec<f64> {
    let verdict = Verdict::default();
    let tally = Tally { gpu, cpu, criterion, faults: &[], verdict, squares: 0.0, channels: 0, worst_rank: -1.0 };
    let flag = |flags: &[bool], pixel: usize| flags.get(pixel).copied().unwrap_or(false);
    (0..cpu.covered.len())
        .map(|pixel| {
            let covers = [flag(&gpu.covered, pixel), flag(&cpu.covered, pixel)];
            let open = flag(&cpu.undecided, pixel) || flag(&cpu.near_edge, pixel) || flag(&gpu.near_edge, pixel);
            match covers {
                [true, true] => (0..cpu.attachments.len())
                    .map(|attachment| tally.judge_channels(attachment, pixel))
                    .map(|error| if error.finiteness_mismatch > 0 { f64::INFINITY } else { error.share })
                    .fold(0.0, f64::max),
                [false, false] => 0.0,
                _ if open => 0.0,
                _ => f64::INFINITY,
            }
        })
        .collect()
}

/// A comparison in progress.
struct Tally<'a> {
    gpu: &'a Picture,
    cpu: &'a Picture,
    criterion: Criterion,
    faults: &'a [(&'static str, Picture)],
    verdict: Verdict,
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

impl Tally<'_> {
    fn pixel(&mut self, pixel: usize) {
        let flag = |flags: &[bool]| flags.get(pixel).copied().unwrap_or(false);
        let (gpu_covers, cpu_covers) = (flag(&self.gpu.covered), flag(&self.cpu.covered));
        let near_edge = flag(&self.cpu.near_edge) || flag(&self.gpu.near_edge);
        let undecided = flag(&self.cpu.undecided);
        if gpu_covers != cpu_covers && !(undecided && gpu_covers) {
            match (near_edge, undecided) {
                (true, _) => self.verdict.edge_pixels += 1,
                (false, true) => self.verdict.undecided += 1,
                (false, false) if self.excused(pixel) => {}
                (false, false) => self.verdict.coverage_mismatch += 1,
            }
            return;
        }
        if !gpu_covers {
            return;
        }
        self.verdict.covered += u64::from(cpu_covers);
        self.colors(pixel, near_edge, undecided);
    }

    fn colors(&mut self, pixel: usize, near_edge: bool, undecided: bool) {
        let errors: Vec<PixelError> =
            (0..self.cpu.attachments.len()).map(|attachment| self.judge_channels(attachment, pixel)).collect();
        let is_wrong = errors.iter().any(|error| error.outside || error.finiteness_mismatch > 0);
        if near_edge && is_wrong {
            // There, rounding decides which of two triangles drew it.
            self.verdict.edge_pixels += 1;
            return;
        }
        if is_wrong && self.excused(pixel) {
            return;
        }
        let any = |test: fn(&PixelError) -> bool| u64::from(errors.iter().any(test));
        self.verdict.outside += any(|error| error.outside);
        self.verdict.finiteness_mismatch += errors.iter().map(|error| error.finiteness_mismatch).sum::<u64>();
        if undecided {
            self.verdict.undecided += 1;
        } else {
            self.verdict.non_finite_gpu += any(|error| error.non_finite[0]);
            self.verdict.non_finite_cpu += any(|error| error.non_finite[1]);
        }
        for (attachment, error) in errors.iter().enumerate() {
            if !undecided {
                self.add_differences(attachment, pixel);
            }
            if error.rank > self.worst_rank && (!undecided || error.outside) {
                self.worst_rank = error.rank;
                self.verdict.worst = Some(self.worst_at(attachment, pixel, error.channel));
            }
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
        let Some(fault) = self.faults.iter().find(|(_, picture)| explains(picture)).map(|(name, _)| *name) else {
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
        match self.criterion {
            Criterion::Tolerance(tolerance) => {
                Self::color(self.cpu, attachment, pixel).map(|value| Interval::around(value, tolerance))
            }
            Criterion::Envelope => Self::intervals(self.cpu, attachment, pixel),
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

    fn add_differences(&mut self, attachment: usize, pixel: usize) {
        let gpu = Self::color(self.gpu, attachment, pixel);
        let cpu = Self::color(self.cpu, attachment, pixel);
        for (gpu, cpu) in gpu.into_iter().zip(cpu).filter(|(gpu, cpu)| gpu.is_finite() && cpu.is_finite()) {
            let difference = (gpu - cpu).abs();
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

    fn finish(mut self) -> Verdict {
        self.verdict.pixels = self.cpu.covered.len() as u64;
        if self.channels > 0 {
            self.verdict.rmse = (self.squares / self.channels as f64).sqrt();
        }
        self.verdict.psnr = (self.verdict.rmse > 0.0).then(|| -20.0 * self.verdict.rmse.log10());
        self.verdict
    }
}

/// The distance between neighboring f32 numbers at `value`; below the smallest normal number, the distance there.
pub fn ulp_f32(value: f64) -> f64 {
    let magnitude = value.abs().max(f64::from(f32::MIN_POSITIVE));
    // This is exact: the exponent is computed in f64, which represents every f32 and its neighbors.
    2.0_f64.powi(magnitude.log2().floor() as i32 - 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(values: &[f64]) -> Picture {
        let n = values.len();
        let around = |value: f64| [value, 0.0, 0.0, 1.0].map(|value| Interval::around(value, 1e-6));
        Picture {
            intervals: Some(vec![values.iter().copied().map(around).collect()]),
            ..Picture::of_colors(n as u32, 1, values.iter().map(|&value| [value, 0.0, 0.0, 1.0]).collect())
        }
    }

    #[test]
    fn equal_pictures_hold() {
        let verdict = Verdict::new(&picture(&[0.5, 1.0]), &picture(&[0.5, 1.0]), Criterion::Envelope);
        assert!(verdict.holds(false));
        assert_eq!((verdict.max_abs, verdict.psnr, verdict.covered), (0.0, None, 2));
    }

    #[test]
    fn an_empty_picture_shows_nothing() {
        let mut empty = picture(&[0.5, 0.5]);
        empty.covered = vec![false; 2];
        let verdict = Verdict::new(&empty, &empty, Criterion::Envelope);
        assert_eq!(verdict.conclusion(false), Conclusion::Inconclusive);
        let one_side = Verdict::new(&picture(&[0.5, 0.5]), &empty, Criterion::Envelope);
        assert_eq!((one_side.covered, one_side.conclusion(true)), (0, Conclusion::Fails));
        let covered = Verdict::new(&picture(&[0.5]), &picture(&[0.5]), Criterion::Envelope);
        assert_eq!(covered.conclusion(false), Conclusion::Holds);
    }

    #[test]
    fn a_pixel_outside_its_envelope_is_found() {
        let (gpu, cpu) = (picture(&[0.5, 0.25, 0.5]), picture(&[0.5, 0.5, 0.5 + 5e-7]));
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert_eq!((verdict.outside, verdict.max_abs), (1, 0.25));
        assert_eq!(verdict.worst.as_ref().map(|worst| (worst.x, worst.y)), Some((1, 0)));
        assert!(!verdict.holds(true));
        assert!(Verdict::new(&gpu, &cpu, Criterion::Tolerance(0.3)).holds(false));
        assert_eq!(verdict.max_ulp, 0.25 / 2.0_f64.powi(-24));
    }

    #[test]
    fn coverage_edges_and_undecided_pixels_are_counted_once() {
        let mut gpu = picture(&[1.0; 4]);
        let mut cpu = picture(&[0.0, 0.0, 0.0, 1.0]);
        gpu.covered = vec![false, false, true, true];
        cpu.near_edge[1] = true;
        cpu.undecided[2] = true;
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        // The undecided pixel is outside its envelope nevertheless.
        assert_eq!((verdict.coverage_mismatch, verdict.edge_pixels, verdict.undecided, verdict.outside), (1, 1, 1, 1));
        assert_eq!((verdict.covered, verdict.max_abs), (2, 0.0));
    }

    #[test]
    fn an_undecided_pixel_may_be_uncovered_and_may_be_covered_by_what_its_envelope_holds() {
        let mut gpu = picture(&[1.0, 1.0]);
        let mut cpu = picture(&[1.0, 1.0]);
        gpu.covered = vec![false, true];
        cpu.covered = vec![true, false];
        cpu.undecided = vec![true, true];
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert_eq!((verdict.undecided, verdict.coverage_mismatch, verdict.outside), (2, 0, 0));
    }

    #[test]
    fn what_a_known_fault_explains_counts_under_its_name() {
        let (gpu, cpu) = (picture(&[0.5, 0.25, f64::NAN]), picture(&[0.5, 0.5, 0.5]));
        let mut wide = cpu.clone();
        for colors in wide.intervals.iter_mut().flatten() {
            colors.iter_mut().for_each(|color| color[0] = Interval { low: 0.2, high: 0.5, may_be_nan: false });
        }
        let verdict = Verdict::excusing(&gpu, &cpu, Criterion::Envelope, &[("none", cpu.clone()), ("acos", wide)]);
        assert_eq!((verdict.outside, verdict.finiteness_mismatch), (0, 1), "NaN is in neither");
        assert_eq!(verdict.known_faults, [FaultCount { fault: "acos", pixels: 1 }]);
    }

    #[test]
    fn numbers_that_are_not_finite_hold_where_the_envelope_has_them() {
        let (gpu, mut cpu) = (picture(&[f64::NAN, f64::INFINITY]), picture(&[0.0, 0.0]));
        for colors in cpu.intervals.iter_mut().flatten() {
            colors.iter_mut().for_each(|color| color[0] = Interval::ALL);
        }
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert_eq!((verdict.non_finite_gpu, verdict.finiteness_mismatch), (2, 0));
        assert!(verdict.holds(false));
    }

    #[test]
    fn undecided_pixels_are_accepted_up_to_one_percent() {
        let (gpu, mut cpu) = (picture(&[0.0; 200]), picture(&[0.0; 200]));
        cpu.undecided[..2].fill(true);
        assert!(Verdict::new(&gpu, &cpu, Criterion::Envelope).holds(false));
        cpu.undecided[..3].fill(true);
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert!(!verdict.holds(false) && verdict.holds(true));
    }

    #[test]
    fn numbers_that_are_not_finite_are_counted_apart() {
        let verdict =
            Verdict::new(&picture(&[f64::NAN, f64::INFINITY]), &picture(&[0.0, f64::NAN]), Criterion::Envelope);
        assert_eq!((verdict.non_finite_gpu, verdict.non_finite_cpu, verdict.finiteness_mismatch), (2, 1, 1));
        assert_eq!(verdict.max_abs, 0.0);
        assert!(!verdict.holds(true));
    }

    #[test]
    fn ulps_are_those_of_f32() {
        for value in [1.0f32, 0.5, 3.0, 1e-30, 6e4, 0.999_999_94] {
            let next = f32::from_bits(value.to_bits() + 1);
            assert_eq!(ulp_f32(f64::from(value)), f64::from(next) - f64::from(value), "{value}");
        }
    }
}
