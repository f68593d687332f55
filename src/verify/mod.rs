//! Compares the pictures of runners with the CPU reference and its envelope.
//!
//! *In:* a [`Scene`], the [`Runner`]s that draw it, [`Options`]. *Out:* a [`Verification`]: a picture and a
//! [`Verdict`] for each runner, the origin of the worst pixel's envelope, a picture of the differences.
//!
//! ```text
//!  Scene ──► Expected   the reference's picture with its envelope; if need be, again with known faults excused
//!        ──► Runner     SPIR-V or WGSL on a GPU, the sources on OpenGL, the reference in another precision
//!        ──► Verdict    every pixel against the envelope ──► Verification
//! ```
//!
//! A test suite of a renderer calls it like this (`examples/verify.rs` is a complete one):
//!
//! ```
//! use glisten::scene::{MemoryFiles, load};
//! use glisten::verify::{Cpu, Options, Runner, verify};
//! use glisten::{Compiler, Precision};
//!
//! let files = MemoryFiles::new([
//!     ("a.toml", "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
//!                 primitive = \"triangles\"\nvertex_count = 3\n"),
//!     ("a.vert", "#version 150\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }"),
//!     ("a.frag", "#version 150\nout vec4 color;\nvoid main() { color = vec4(sin(gl_FragCoord.x), 0, 0, 1); }"),
//! ]);
//! let scene = load("a.toml", &files, &Compiler::new(Default::default())).scene.expect("the scene is valid");
//! // `OnGpu` and `OnOpenGl` are the runners of real drivers.
//! let runner = Cpu::new(Precision::F32);
//! let verification = verify(&scene, &[&runner as &dyn Runner], &Options::default()).expect("it can be drawn");
//! assert!(verification.holds(), "{verification}");
//! ```
//!
//! *Holds:* a difference is excused by a known fault of a driver only if the specifications do not explain it, and it is
//! counted under the fault's name. Files are written only to [`Options::failures`], and only if the verification fails.

mod expected;
mod explain;
mod files;
mod runner;

pub use expected::Expected;
pub use files::write_pictures;
#[cfg(feature = "gpu")]
pub use runner::OnGpu;
#[cfg(feature = "gl")]
pub use runner::OnOpenGl;
pub use runner::{Channel, Cpu, Drawn, Failure, Reference, Runner, ThisThread};

use crate::scene::Scene;
use explain::Explanations;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::SourceMap;
use glisten_reference::domain::Profile;
use glisten_reference::domain::faults::Faults;
use glisten_reference::{LineRule, Precision, RenderOptions};
pub use glisten_scene::compare::Conclusion;
use glisten_scene::compare::{self, Criterion, Verdict};
use glisten_scene::picture::Picture;
use std::fmt;
use std::path::PathBuf;

/// Options for verification.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The criterion for differences: the envelope (the default), or a tolerance.
    pub criterion: Criterion,
    /// The rule for lines of the targets: Vulkan's, unless set otherwise.
    pub lines: LineRule,
    /// Whether the known faults of drivers are excused. Default: yes.
    pub excuse_known_faults: bool,
    /// Whether any number of undecided pixels is accepted. Default: no, at most 1 % of the covered pixels.
    pub allow_undecided: bool,
    /// Whether a picture that shows nothing is accepted, such as one in which no pixel is covered. Default: no.
    pub allow_inconclusive: bool,
    /// What the device may do where the specifications leave it open. Default: what Mesa's llvmpipe does.
    pub profile: Profile,
    /// The texts of the scene (`Loaded::sources`), for the origin of the worst pixel's envelope.
    pub sources: Option<&'a SourceMap>,
    /// A folder for the pictures of a failed verification: one of each runner (`spirv.png`), `cpu.png` and
    /// `difference.png`. It is created if it is missing.
    pub failures: Option<&'a std::path::Path>,
    /// The reference. Default: on this thread.
    pub reference: &'a dyn Reference,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            criterion: Criterion::Envelope,
            lines: LineRule::Vulkan,
            excuse_known_faults: true,
            allow_undecided: false,
            allow_inconclusive: false,
            profile: Profile::default(),
            sources: None,
            failures: None,
            reference: &ThisThread,
        }
    }
}

impl Options<'_> {
    /// The options with which the reference draws.
    pub fn reference_options(&self, faults: Faults) -> RenderOptions {
        let (lines, profile) = (self.lines, self.profile);
        RenderOptions { precision: Precision::Envelope, lines, faults, profile, ..RenderOptions::default() }
    }
}

/// The result of one runner.
#[derive(Clone, Debug)]
pub struct Run {
    /// The name of the runner.
    pub runner: &'static str,
    /// Its picture.
    pub picture: Picture,
    /// Its time in milliseconds.
    pub milliseconds: f64,
    /// The comparison with the reference.
    pub verdict: Verdict,
}

/// A runner that cannot draw the scene's programs, although another one can.
#[derive(Clone, Debug)]
pub struct Skip {
    /// The name of the runner.
    pub runner: &'static str,
    /// The features that the target lacks.
    pub diagnostics: Vec<Diagnostic>,
}

/// The result of a verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The reference's picture with its envelope.
    pub reference: Picture,
    /// The reference's time in milliseconds.
    pub reference_milliseconds: f64,
    /// The results of the runners, in the order of the runners.
    pub runs: Vec<Run>,
    /// Runners that cannot draw the scene's programs. The first runner is never among them.
    pub skipped: Vec<Skip>,
    /// For each pixel, the largest difference of all runs, as a share of the allowed difference.
    pub shares: Vec<f64>,
    /// The origin of the worst pixel's envelope, if [`Options::sources`] is set.
    pub note: Option<Diagnostic>,
    /// The folder with the pictures of a failure, or the reason why they could not be written.
    pub pictures: Option<Result<PathBuf, String>>,
    allow_undecided: bool,
    allow_inconclusive: bool,
}

impl Verification {
    /// Whether all differences of all runs are explained, and something was drawn at all.
    pub fn holds(&self) -> bool {
        match self.conclusion() {
            Conclusion::Holds => true,
            Conclusion::Inconclusive => self.allow_inconclusive,
            Conclusion::Fails => false,
        }
    }

    /// The conclusion of all runs together: the worst of their conclusions.
    pub fn conclusion(&self) -> Conclusion {
        let conclusions = self.runs.iter().map(|run| run.verdict.conclusion(self.allow_undecided));
        conclusions.max().unwrap_or(Conclusion::Inconclusive)
    }

    /// A picture of [`shares`](Self::shares), on black: see [`DIFFERENCE_LEGEND`].
    pub fn difference(&self) -> Picture {
        difference(&self.reference, &self.shares)
    }
}

/// The meaning of the colors of a [difference](Verification::difference).
pub const DIFFERENCE_LEGEND: &str = "black: equal; to bright blue: up to the bound; yellow to red: up to and beyond ten \
                                     times the bound; magenta: covered or finite on one side alone";

/// The picture of `shares` ([`compare::shares`]) in the size of the reference's, by the colors of
/// [`DIFFERENCE_LEGEND`].
pub fn difference(reference: &Picture, shares: &[f64]) -> Picture {
    Picture::of_colors(reference.width, reference.height, shares.iter().map(|share| share_color(*share)).collect())
}

/// The color of a difference relative to its bound. Within the bound, all colors are calm ones.
fn share_color(share: f64) -> [f64; 4] {
    let mix = |from: [f64; 3], to: [f64; 3], x: f64| {
        let [r, g, b] = std::array::from_fn(|i| from[i] * (1.0 - x) + to[i] * x);
        [r, g, b, 1.0]
    };
    match share {
        _ if !share.is_finite() => [1.0, 0.0, 1.0, 1.0],
        _ if share > 1.0 => mix([1.0, 0.9, 0.2], [1.0, 0.0, 0.0], share.log10().min(1.0)),
        _ => mix([0.0; 3], [0.25, 0.55, 1.0], share.max(0.0)),
    }
}

/// The failures, as the message of a test: a line for each run, and the folder with the pictures.
impl fmt::Display for Verification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for run in &self.runs {
            let verdict = &run.verdict;
            let mark = mark(verdict.conclusion(self.allow_undecided));
            write!(f, "{}: {mark}: {} of {} pixels covered, ", run.runner, verdict.covered, verdict.pixels)?;
            write!(f, "{} outside, {} with another coverage, ", verdict.outside, verdict.coverage_mismatch)?;
            write!(f, "{} not finite on one side, ", verdict.finiteness_mismatch)?;
            writeln!(f, "{} undecided; largest error {:.3e}", verdict.undecided, verdict.max_abs)?;
            if let Some(worst) = &verdict.worst {
                writeln!(f, "  worst: {worst:?}")?;
            }
        }
        match &self.pictures {
            Some(Ok(folder)) => writeln!(f, "pictures: {}", folder.display()),
            Some(Err(why)) => writeln!(f, "the pictures could not be written: {why}"),
            None => Ok(()),
        }
    }
}

/// The words of a report for a conclusion.
pub fn mark(conclusion: Conclusion) -> &'static str {
    match conclusion {
        Conclusion::Holds => "holds",
        Conclusion::Inconclusive => "INCONCLUSIVE: no pixel is covered",
        Conclusion::Fails => "DOES NOT HOLD",
    }
}

/// Draws a scene with the reference and with each runner, and compares every pixel.
///
/// # Errors
/// The reference or a runner cannot draw the scene. If the target of a runner after the first one cannot represent
/// the programs, that is not an error: the runner is [skipped](Verification::skipped).
pub fn verify(scene: &Scene, runners: &[&dyn Runner], options: &Options<'_>) -> Result<Verification, Failure> {
    let mut expected = Expected::new(scene, options)?;
    let mut runs: Vec<Run> = Vec::new();
    let mut skipped = Vec::new();
    for runner in runners {
        let Drawn { picture, milliseconds } = match runner.draw(scene) {
            Err(Failure::Diagnostics(diagnostics)) if !runs.is_empty() => {
                skipped.push(Skip { runner: runner.name(), diagnostics });
                continue;
            }
            drawn => drawn?,
        };
        let verdict = expected.compare(&picture)?;
        runs.push(Run { runner: runner.name(), picture, milliseconds, verdict });
    }
    let mut shares = vec![0.0; expected.picture().covered.len()];
    for run in &runs {
        let these = compare::shares(&run.picture, expected.picture(), options.criterion);
        shares.iter_mut().zip(these).for_each(|(most, share): (&mut f64, f64)| *most = share.max(*most));
    }
    let note = Explanations::new(scene, options).add_to(&mut runs)?;
    let (reference, reference_milliseconds) = expected.into_picture();
    let (allow_undecided, allow_inconclusive) = (options.allow_undecided, options.allow_inconclusive);
    let mut verification = Verification {
        reference,
        reference_milliseconds,
        runs,
        skipped,
        shares,
        note,
        pictures: None,
        allow_undecided,
        allow_inconclusive,
    };
    if let Some(folder) = options.failures.filter(|_| !verification.holds()) {
        let difference = verification.difference();
        let mut pictures: Vec<(&str, &Picture)> =
            verification.runs.iter().map(|run| (run.runner, &run.picture)).collect();
        pictures.extend([("cpu", &verification.reference), ("difference", &difference)]);
        let written = write_pictures(folder, &pictures);
        verification.pictures = Some(written);
    }
    Ok(verification)
}

#[cfg(test)]
mod tests {
    use super::{difference, share_color};
    use glisten_scene::picture::Picture;

    /// Nothing within the bound is red, and nothing beyond it is blue.
    #[test]
    fn differences_are_calm_up_to_the_bound() {
        assert_eq!(share_color(0.0), [0.0, 0.0, 0.0, 1.0]);
        for step in 0..=100 {
            let [red, _, blue, _] = share_color(f64::from(step) / 100.0);
            assert!(blue >= red, "{step}");
            let [red, _, blue, _] = share_color(1.001 + f64::from(step));
            assert!(red > blue, "{step}");
        }
        assert_eq!(share_color(f64::INFINITY), share_color(f64::NAN));
        let reference = Picture::of_colors(2, 1, vec![[0.0; 4]; 2]);
        assert_eq!(difference(&reference, &[0.0, 99.0]).attachments[0], [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
    }
}
