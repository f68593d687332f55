//! [`Verdict`]: how far a GPU's picture is from the reference's, and whether that is explained.
//!
//! *In:* two pictures of one scene, the reference's with its bounds, or a tolerance. *Out:* counts and error figures.
//!
//! *Holds:* each pixel is counted in one way only: one side alone covers it (`coverage_mismatch`, or `edge_pixels` if its
//! center is so near an edge that rounding decides), or the reference leaves open what it is (`undecided`), or its colors
//! are compared. Colors never decide what is covered. Numbers that are not finite are counted apart and never enter an
//! error figure.

use super::Picture;
use serde::Serialize;

/// What decides whether a difference is explained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Judge {
    /// The reference's own bound for each channel of each pixel.
    Bound,
    /// The same absolute difference for all channels.
    Tolerance(f64),
}

/// A pixel that is further off than all others, measured by what it may be off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// The GPU's color.
    pub gpu: [f64; 4],
    /// The reference's color.
    pub cpu: [f64; 4],
    /// How far each channel may be off.
    pub bound: [f64; 4],
}

/// Figures and counts of one comparison. Errors are absolute, over all channels of all attachments of the pixels that
/// both sides cover and that are decided and finite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// The largest difference.
    pub max_abs: f64,
    /// The root of the mean square of the differences.
    pub rmse: f64,
    /// `-20 log10(rmse)` in dB for a peak of 1; `None` (null) if the pictures are equal.
    pub psnr: Option<f64>,
    /// The largest difference in units in the last place of the reference's value as an f32.
    pub max_ulp: f64,
    /// How many pixels a picture has.
    pub pixels: u64,
    /// Pixels that both sides cover.
    pub covered: u64,
    /// Pixels that one side alone covers.
    pub coverage_mismatch: u64,
    /// Pixels within 1/128 pixel of an edge that differ in coverage or in more than they may.
    pub edge_pixels: u64,
    /// Pixels that both cover with a number of the GPU that is not finite.
    pub non_finite_gpu: u64,
    /// Likewise of the reference.
    pub non_finite_cpu: u64,
    /// Channels that are finite on one side alone.
    pub finiteness_mismatch: u64,
    /// `bound` or `tolerance`.
    pub judged_by: &'static str,
    /// Pixels that are further off than they may be.
    pub outside: u64,
    /// Pixels where a branch or a test may go either way within the bound.
    pub undecided: u64,
    /// The pixel that is furthest off; `None` (null) if none is compared.
    pub worst: Option<Worst>,
}

/// The largest share of undecided pixels that is accepted.
const MAX_UNDECIDED_SHARE: f64 = 0.01;

impl Verdict {
    /// Compares two pictures of the same size and number of attachments.
    pub fn new(gpu: &Picture, cpu: &Picture, judge: Judge) -> Self {
        let judged_by = match judge {
            Judge::Bound => "bound",
            Judge::Tolerance(_) => "tolerance",
        };
        let mut tally =
            Tally { gpu, cpu, judge, verdict: Self { judged_by, ..Self::default() }, ..Tally::new(gpu, cpu) };
        for pixel in 0..cpu.covered.len() {
            tally.pixel(pixel);
        }
        tally.finish()
    }

    /// Whether everything is explained. Undecided pixels count against it from 1 % of the covered ones on, unless they
    /// are allowed.
    pub fn holds(&self, allow_undecided: bool) -> bool {
        let undecided = self.undecided as f64 > MAX_UNDECIDED_SHARE * self.covered as f64;
        self.outside == 0
            && self.coverage_mismatch == 0
            && self.finiteness_mismatch == 0
            && (allow_undecided || !undecided)
    }

    /// The worse of two verdicts in every figure.
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
            worst: far.worst.or(near.worst),
        }
    }
}

/// A comparison in progress.
struct Tally<'a> {
    gpu: &'a Picture,
    cpu: &'a Picture,
    judge: Judge,
    verdict: Verdict,
    squares: f64,
    channels: u64,
    worst_share: f64,
}

/// What the channels of one pixel of one attachment come to.
#[derive(Default)]
struct PixelError {
    non_finite: [bool; 2],
    finiteness_mismatch: u64,
    outside: bool,
    /// The largest difference as a share of what is allowed.
    share: f64,
}

impl<'a> Tally<'a> {
    fn new(gpu: &'a Picture, cpu: &'a Picture) -> Self {
        let (judge, verdict) = (Judge::Bound, Verdict::default());
        Self { gpu, cpu, judge, verdict, squares: 0.0, channels: 0, worst_share: -1.0 }
    }

    fn pixel(&mut self, pixel: usize) {
        let flag = |flags: &[bool]| flags.get(pixel).copied().unwrap_or(false);
        let (gpu_covers, cpu_covers) = (flag(&self.gpu.covered), flag(&self.cpu.covered));
        let near_edge = flag(&self.cpu.near_edge) || flag(&self.gpu.near_edge);
        let undecided = flag(&self.cpu.undecided);
        if gpu_covers != cpu_covers {
            match (near_edge, undecided) {
                (true, _) => self.verdict.edge_pixels += 1,
                (false, true) => self.verdict.undecided += 1,
                (false, false) => self.verdict.coverage_mismatch += 1,
            }
            return;
        }
        if !cpu_covers {
            return;
        }
        self.verdict.covered += 1;
        if undecided {
            self.verdict.undecided += 1;
            return;
        }
        self.colors(pixel, near_edge);
    }

    fn colors(&mut self, pixel: usize, near_edge: bool) {
        let mut errors = Vec::new();
        for attachment in 0..self.cpu.attachments.len() {
            errors.push(self.judge_channels(attachment, pixel));
        }
        if near_edge && errors.iter().any(|error| error.outside || error.finiteness_mismatch > 0) {
            // Which of two triangles drew it is what rounding decides there.
            self.verdict.edge_pixels += 1;
            return;
        }
        let any = |test: fn(&PixelError) -> bool| u64::from(errors.iter().any(test));
        self.verdict.non_finite_gpu += any(|error| error.non_finite[0]);
        self.verdict.non_finite_cpu += any(|error| error.non_finite[1]);
        self.verdict.outside += any(|error| error.outside);
        self.verdict.finiteness_mismatch += errors.iter().map(|error| error.finiteness_mismatch).sum::<u64>();
        for (attachment, error) in errors.iter().enumerate() {
            self.add_differences(attachment, pixel);
            if error.share > self.worst_share {
                self.worst_share = error.share;
                self.verdict.worst = Some(self.worst_at(attachment, pixel));
            }
        }
    }

    fn color(picture: &Picture, attachment: usize, pixel: usize) -> [f64; 4] {
        picture.attachments.get(attachment).and_then(|colors| colors.get(pixel)).copied().unwrap_or([0.0; 4])
    }

    fn bound(&self, attachment: usize, pixel: usize) -> [f64; 4] {
        match self.judge {
            Judge::Tolerance(tolerance) => [tolerance; 4],
            Judge::Bound => self
                .cpu
                .bounds
                .as_ref()
                .and_then(|bounds| bounds.get(attachment)?.get(pixel))
                .copied()
                .unwrap_or([0.0; 4]),
        }
    }

    fn judge_channels(&self, attachment: usize, pixel: usize) -> PixelError {
        let gpu = Self::color(self.gpu, attachment, pixel);
        let cpu = Self::color(self.cpu, attachment, pixel);
        let bound = self.bound(attachment, pixel);
        let mut error = PixelError::default();
        for ((gpu, cpu), bound) in gpu.into_iter().zip(cpu).zip(bound) {
            error.non_finite[0] |= !gpu.is_finite();
            error.non_finite[1] |= !cpu.is_finite();
            match (gpu.is_finite(), cpu.is_finite()) {
                (true, true) => {
                    let difference = (gpu - cpu).abs();
                    // A bound that is not a number allows nothing.
                    error.outside |= difference > bound || bound.is_nan();
                    let share = if difference == 0.0 { 0.0 } else { difference / bound.max(f64::MIN_POSITIVE) };
                    error.share = error.share.max(share);
                }
                (false, false) => {}
                _ => error.finiteness_mismatch += 1,
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

    fn worst_at(&self, attachment: usize, pixel: usize) -> Worst {
        let width = (self.cpu.width as usize).max(1);
        Worst {
            x: (pixel % width) as u32,
            y: (pixel / width) as u32,
            gpu: Self::color(self.gpu, attachment, pixel),
            cpu: Self::color(self.cpu, attachment, pixel),
            bound: self.bound(attachment, pixel),
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

/// The distance between neighboring f32 numbers at `value`; that of the smallest normal number below it.
pub fn ulp_f32(value: f64) -> f64 {
    let magnitude = value.abs().max(f64::from(f32::MIN_POSITIVE));
    // Exact: the exponent is found in f64, which holds every f32 and its neighbors.
    2.0_f64.powi(magnitude.log2().floor() as i32 - 23)
}

#[cfg(test)]
mod tests {
    use super::{Judge, Picture, Verdict, ulp_f32};

    fn picture(values: &[f64]) -> Picture {
        let n = values.len();
        Picture {
            width: n as u32,
            height: 1,
            attachments: vec![values.iter().map(|&value| [value, 0.0, 0.0, 1.0]).collect()],
            covered: vec![true; n],
            bounds: Some(vec![vec![[1e-6; 4]; n]]),
            undecided: vec![false; n],
            near_edge: vec![false; n],
        }
    }

    #[test]
    fn equal_pictures_hold() {
        let verdict = Verdict::new(&picture(&[0.5, 1.0]), &picture(&[0.5, 1.0]), Judge::Bound);
        assert!(verdict.holds(false));
        assert_eq!((verdict.max_abs, verdict.psnr, verdict.covered), (0.0, None, 2));
    }

    #[test]
    fn a_pixel_outside_its_bound_is_found() {
        let (gpu, cpu) = (picture(&[0.5, 0.25, 0.5]), picture(&[0.5, 0.5, 0.5 + 5e-7]));
        let verdict = Verdict::new(&gpu, &cpu, Judge::Bound);
        assert_eq!((verdict.outside, verdict.max_abs), (1, 0.25));
        assert_eq!(verdict.worst.map(|worst| (worst.x, worst.y)), Some((1, 0)));
        assert!(!verdict.holds(true));
        assert!(Verdict::new(&gpu, &cpu, Judge::Tolerance(0.3)).holds(false));
        assert_eq!(verdict.max_ulp, 0.25 / 2.0_f64.powi(-24));
    }

    #[test]
    fn coverage_edges_and_undecided_pixels_are_counted_once() {
        let mut gpu = picture(&[1.0; 4]);
        let mut cpu = picture(&[0.0, 0.0, 0.0, 1.0]);
        gpu.covered = vec![false, false, true, true];
        cpu.near_edge[1] = true;
        cpu.undecided[2] = true;
        let verdict = Verdict::new(&gpu, &cpu, Judge::Bound);
        assert_eq!((verdict.coverage_mismatch, verdict.edge_pixels, verdict.undecided, verdict.outside), (1, 1, 1, 0));
        assert_eq!((verdict.covered, verdict.max_abs), (2, 0.0));
    }

    #[test]
    fn undecided_pixels_are_accepted_up_to_one_percent() {
        let (gpu, mut cpu) = (picture(&[0.0; 200]), picture(&[0.0; 200]));
        cpu.undecided[..2].fill(true);
        assert!(Verdict::new(&gpu, &cpu, Judge::Bound).holds(false));
        cpu.undecided[..3].fill(true);
        let verdict = Verdict::new(&gpu, &cpu, Judge::Bound);
        assert!(!verdict.holds(false) && verdict.holds(true));
    }

    #[test]
    fn numbers_that_are_not_finite_are_counted_apart() {
        let verdict = Verdict::new(&picture(&[f64::NAN, f64::INFINITY]), &picture(&[0.0, f64::NAN]), Judge::Bound);
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
