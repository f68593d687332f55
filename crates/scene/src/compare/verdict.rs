//! [`Verdict`]: how far a GPU's picture is from the reference's, whether the difference is explained, and how much of
//! the picture was judged at all.
//!
//! *In:* the counts of a comparison ([`Comparison`](super::Comparison)). *Out:* error figures, and a
//! [`Conclusion`] by [`Demands`].

use super::evidence::{Evidence, Width};
use super::population;
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
    /// Every difference is explained, and enough of the picture was judged.
    Holds,
    /// Every difference is explained, but too little of the picture was judged: nothing is covered, too few of the
    /// covered pixels have a narrow envelope, or too many depend on what the language leaves undefined.
    Inconclusive,
    /// There is a difference that is not explained.
    Fails,
}

/// The share of the covered pixels that may depend on what the language leaves undefined.
const UNDEFINED_SHARE: f64 = 0.01;

/// The demands on a verdict that holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demands {
    /// The smallest share of the covered pixels that is judged, likely, at an edge, or excused.
    pub evidence_share: f64,
    /// Whether undecided pixels count as judged.
    pub allow_undecided: bool,
    /// Whether suspects fail.
    pub likely: bool,
}

impl Default for Demands {
    fn default() -> Self {
        Self { evidence_share: 0.95, allow_undecided: false, likely: true }
    }
}

/// The figures and counts of one comparison. Errors are absolute, over all channels of all attachments of the pixels
/// that both sides cover and that are decided and finite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// The largest difference; 0 if nothing was compared ([`Verdict::largest_error`]).
    pub max_abs: f64,
    /// The root mean square difference; 0 if nothing was compared.
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
    /// Pixels at a silhouette that only one side covers.
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
    /// The covered pixels by how they were compared.
    pub evidence: Evidence,
    /// The widths of the envelopes of the covered pixels, by decades.
    pub widths: Vec<Width>,
    /// The range of the picture's values.
    pub range: f64,
    /// The largest width of the envelope of a judged pixel.
    pub width: f64,
    /// Pixels inside their envelope, but far outside of what a population of simulated GPUs drew; `None` (null) without a
    /// population.
    pub suspect: Option<u64>,
    /// Pixels that are judged by the hull of what simulated GPUs drew ([`Class::Likely`](super::Class::Likely)), and are
    /// outside of it.
    pub outside_likely: u64,
    /// Pixels that count as likely because the picture agrees with what is known of this device's arithmetic, where simulated GPUs
    /// differ: noise of `fract(sin(x) * 43758.5)` and its like.
    pub as_device: u64,
    /// Pixels that only a known fault of the driver explains; they count nowhere else but in `evidence`.
    pub known_faults: Vec<FaultCount>,
    /// The pixel with the largest difference; `None` (null) if none was compared.
    pub worst: Option<Worst>,
}

impl Verdict {
    /// The result in one word.
    pub fn conclusion(&self, demands: &Demands) -> Conclusion {
        let suspects = demands.likely && self.is_suspect();
        match () {
            () if self.needs_excuse() || suspects => Conclusion::Fails,
            () if self.covered == 0 || self.share_judged(demands) < demands.evidence_share => Conclusion::Inconclusive,
            () if self.is_undefined(demands) => Conclusion::Inconclusive,
            () => Conclusion::Holds,
        }
    }

    /// Whether so many pixels are suspect, or outside of what is likely, that the picture is.
    pub fn is_suspect(&self) -> bool {
        population::fails(self.suspect.unwrap_or(0) + self.outside_likely, self.covered)
    }

    /// Whether so many pixels depend on what the language leaves undefined that the program should be changed: more than
    /// 1 % of the covered ones, and at least eight. Who asks for less evidence than usual accepts these, too.
    pub fn is_undefined(&self, demands: &Demands) -> bool {
        let (undefined, most) = (self.evidence.undefined, UNDEFINED_SHARE * self.covered as f64);
        demands.evidence_share >= Demands::default().evidence_share
            && undefined >= population::MIN_PIXELS
            && undefined as f64 > most
    }

    /// Whether the conclusion is [`Conclusion::Holds`] by the usual [`Demands`], with undecided pixels as judged ones if
    /// they are allowed.
    pub fn holds(&self, allow_undecided: bool) -> bool {
        self.conclusion(&Demands { allow_undecided, ..Demands::default() }) == Conclusion::Holds
    }

    /// Whether there is a difference that nothing explains, by the usual [`Demands`]: the conclusion is
    /// [`Conclusion::Fails`].
    pub fn fails(&self) -> bool {
        self.conclusion(&Demands::default()) == Conclusion::Fails
    }

    /// The share of the covered pixels that is judged, likely, at an edge, or excused. Undecided pixels that only one side covers
    /// count as covered here.
    pub fn share_judged(&self, demands: &Demands) -> f64 {
        let one_sided = self.undecided.saturating_sub(self.evidence.undecided);
        let allowed = if demands.allow_undecided { self.undecided } else { 0 };
        (self.evidence.good() + allowed) as f64 / (self.covered + one_sided).max(1) as f64
    }

    /// The largest difference; `None` if pixels are covered, but none was compared: all are excused, undefined or undecided.
    pub fn largest_error(&self) -> Option<f64> {
        (self.covered == 0 || self.evidence.compared() > 0).then_some(self.max_abs)
    }

    /// The word for the pixels of [`Self::share_judged`].
    pub fn judged_word(&self) -> &'static str {
        if self.evidence.excused > 0 { "judged or excused" } else { "judged" }
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
        let usual = Demands::default();
        let least = if self.share_judged(&usual) <= other.share_judged(&usual) { self } else { other };
        Self {
            max_abs: far.max_abs,
            rmse: self.rmse.max(other.rmse),
            psnr,
            max_ulp: self.max_ulp.max(other.max_ulp),
            pixels: self.pixels,
            covered: least.covered,
            coverage_mismatch: self.coverage_mismatch.max(other.coverage_mismatch),
            edge_pixels: self.edge_pixels.max(other.edge_pixels),
            non_finite_gpu: self.non_finite_gpu.max(other.non_finite_gpu),
            non_finite_cpu: self.non_finite_cpu.max(other.non_finite_cpu),
            finiteness_mismatch: self.finiteness_mismatch.max(other.finiteness_mismatch),
            judged_by: self.judged_by,
            outside: self.outside.max(other.outside),
            undecided: self.undecided.max(other.undecided),
            evidence: least.evidence,
            widths: least.widths.clone(),
            range: least.range,
            width: least.width,
            suspect: self.suspect.max(other.suspect),
            outside_likely: self.outside_likely.max(other.outside_likely),
            as_device: self.as_device.min(other.as_device),
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

/// The distance between neighboring f32 numbers at `value`; below the smallest normal number, the distance there.
pub fn ulp_f32(value: f64) -> f64 {
    let magnitude = value.abs().max(f64::from(f32::MIN_POSITIVE));
    // The power of two at or below it, by its exponent alone: f64 has every f32 and its neighbors as normal numbers.
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits(magnitude.to_bits() & EXPONENT) / f64::from(1 << 23)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::evidence::Class;
    use crate::compare::tally::Comparison;
    use crate::picture::{Interval, Picture};

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
        let usual = Demands::default();
        assert_eq!(verdict.conclusion(&usual), Conclusion::Inconclusive);
        let one_side = Verdict::new(&picture(&[0.5, 0.5]), &empty, Criterion::Envelope);
        assert_eq!((one_side.covered, one_side.conclusion(&usual)), (0, Conclusion::Fails));
        let covered = Verdict::new(&picture(&[0.5]), &picture(&[0.5]), Criterion::Envelope);
        assert_eq!(covered.conclusion(&usual), Conclusion::Holds);
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
        cpu.silhouette = vec![false, true, false, false];
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
        // An envelope of everything excludes nothing.
        assert_eq!(
            (verdict.evidence.unlimited, verdict.conclusion(&Demands::default())),
            (2, Conclusion::Inconclusive)
        );
        // They are counted where nothing else is compared, too.
        let undefined = Comparison { undefined: &[true, false], ..Comparison::default() };
        let verdict = undefined.compare(&gpu, &cpu).verdict;
        assert_eq!((verdict.non_finite_gpu, verdict.non_finite_cpu, verdict.evidence.undefined), (2, 0, 1));
    }

    #[test]
    fn undefined_pixels_say_that_the_program_should_change() {
        let of = |undefined: u64| Verdict {
            covered: 1000,
            evidence: Evidence { judged: 1000 - undefined, undefined, ..Evidence::default() },
            ..Verdict::default()
        };
        let usual = Demands::default();
        assert_eq!([10, 11, 60].map(|count| of(count).conclusion(&usual)), {
            [Conclusion::Holds, Conclusion::Inconclusive, Conclusion::Inconclusive]
        });
        let few = Demands { evidence_share: 0.9, ..usual };
        assert_eq!([60, 200].map(|count| of(count).conclusion(&few)), [Conclusion::Holds, Conclusion::Inconclusive]);
    }

    /// A verdict on pixels of which the first `wide` have an envelope as wide as the picture's range.
    fn partly_wide(wide: usize) -> Verdict {
        let (gpu, mut cpu) = (picture(&[0.0; 200]), picture(&[0.0; 200]));
        for color in cpu.intervals.iter_mut().flatten().flat_map(|colors| colors.iter_mut().take(wide)) {
            color[0] = Interval { low: 0.0, high: 1.0, may_be_nan: false };
        }
        Verdict::new(&gpu, &cpu, Criterion::Envelope)
    }

    #[test]
    fn a_verdict_holds_from_95_percent_of_evidence_on() {
        let usual = Demands::default();
        assert_eq!(partly_wide(10).conclusion(&usual), Conclusion::Holds);
        let verdict = partly_wide(11);
        assert_eq!((verdict.evidence.judged, verdict.evidence.weak), (189, 11));
        assert_eq!(verdict.evidence.total(), verdict.covered);
        assert_eq!(verdict.widths.iter().map(|row| row.pixels).sum::<u64>(), verdict.covered);
        assert_eq!(verdict.conclusion(&usual), Conclusion::Inconclusive);
        assert_eq!(verdict.conclusion(&Demands { evidence_share: 0.9, ..usual }), Conclusion::Holds);
    }

    #[test]
    fn undecided_pixels_are_no_evidence_unless_they_are_allowed() {
        let (mut gpu, mut cpu) = (picture(&[0.0; 200]), picture(&[0.0; 200]));
        cpu.undecided[..11].fill(true);
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert!(!verdict.holds(false) && verdict.holds(true));
        // Those that only one side covers count, too, although they are not covered.
        gpu.covered[..11].fill(false);
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert_eq!((verdict.covered, verdict.evidence.undecided, verdict.undecided), (189, 0, 11));
        assert_eq!(verdict.conclusion(&Demands::default()), Conclusion::Inconclusive);
        assert!(verdict.holds(true));
    }

    #[test]
    fn an_edge_is_judged_by_its_hull() {
        let (gpu, mut cpu) = (picture(&[0.2, 0.9, 0.5]), picture(&[0.4, 0.4, 0.5]));
        cpu.near_edge = vec![true, true, false];
        for color in cpu.intervals.iter_mut().flatten().flat_map(|colors| colors.iter_mut().take(2)) {
            color[0] = Interval { low: 0.1, high: 0.5, may_be_nan: false };
        }
        cpu.owner_width = vec![1e-6, 1e-6, 0.0];
        let compared = Comparison::default().compare(&gpu, &cpu);
        assert_eq!(compared.classes, [Some(Class::Edge), Some(Class::Edge), Some(Class::Judged)]);
        let verdict = compared.verdict;
        assert_eq!((verdict.outside, verdict.evidence.edge, verdict.edge_pixels), (1, 2, 0));
        // The first pixel has another owner's color, which is no error.
        assert_eq!((verdict.max_abs, verdict.worst.map(|worst| worst.x)), (0.5, Some(1)));
    }

    #[test]
    fn a_silhouette_may_be_missed_but_its_color_may_not() {
        let (mut gpu, mut cpu) = (picture(&[0.5, 0.5, 0.9]), picture(&[0.5, 0.0, 0.0]));
        gpu.covered = vec![false, true, true];
        cpu.covered = vec![true, false, false];
        cpu.near_edge = vec![true; 3];
        cpu.silhouette = vec![true; 3];
        for color in cpu.intervals.iter_mut().flatten().flatten() {
            color[0] = Interval { low: 0.0, high: 0.5, may_be_nan: false };
        }
        let verdict = Verdict::new(&gpu, &cpu, Criterion::Envelope);
        assert_eq!((verdict.edge_pixels, verdict.coverage_mismatch, verdict.outside), (3, 0, 1));
        // An edge between primitives of one draw is covered by one of them.
        cpu.silhouette = vec![false; 3];
        assert_eq!(Verdict::new(&gpu, &cpu, Criterion::Envelope).coverage_mismatch, 3);
    }

    #[test]
    fn suspects_fail_where_they_are_many() {
        let (gpu, mut cpu) = (picture(&[0.5; 20]), picture(&[0.6; 20]));
        for color in cpu.intervals.iter_mut().flatten().flatten() {
            color[0] = Interval { low: 0.0, high: 1.0, may_be_nan: false };
        }
        let mut population = population::Population::new(1, [20, 1], 1);
        (0..4).for_each(|_| population.add(&picture(&[0.6; 20])));
        let verdict = Comparison { population: Some(&population), ..Comparison::default() }.compare(&gpu, &cpu).verdict;
        assert_eq!((verdict.suspect, verdict.outside), (Some(20), 0));
        let usual = Demands::default();
        assert_eq!(verdict.conclusion(&usual), Conclusion::Fails);
        assert_eq!(verdict.conclusion(&Demands { likely: false, ..usual }), Conclusion::Inconclusive);
        assert_eq!(Verdict::new(&gpu, &cpu, Criterion::Envelope).suspect, None);
        // Where the exact result is not a number, nothing is suspect.
        cpu.attachments.iter_mut().flatten().for_each(|color| color[0] = f64::NAN);
        let verdict = Comparison { population: Some(&population), ..Comparison::default() }.compare(&gpu, &cpu).verdict;
        assert_eq!((verdict.suspect, verdict.outside), (Some(0), 0));
    }

    /// A gradient whose first pixels have the color of their neighbors.
    fn shifted(count: usize) -> Option<u64> {
        let gray = |x: usize| x as f64 / 40.0;
        let plain: Vec<f64> = (0..40).map(gray).collect();
        let moved: Vec<f64> = (0..40).map(|x| if x < count { gray(x + 1) } else { gray(x) }).collect();
        let mut cpu = picture(&plain);
        for color in cpu.intervals.iter_mut().flatten().flatten() {
            color[0] = Interval { low: -1.0, high: 2.0, may_be_nan: false };
        }
        let mut population = population::Population::new(1, [40, 1], 1);
        population.add(&picture(&plain));
        let comparison = Comparison { population: Some(&population), ..Comparison::default() };
        comparison.compare(&picture(&moved), &cpu).verdict.suspect
    }

    #[test]
    fn a_jump_is_no_area() {
        assert_eq!([0, 7, 8, 30].map(shifted), [Some(0), Some(0), Some(8), Some(30)]);
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
