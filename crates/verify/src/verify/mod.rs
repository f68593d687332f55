//! Compares the pictures of runners with the CPU reference and its envelope.
//!
//! *In:* a [`Scene`], the [`Runner`]s that draw it, [`Options`]. *Out:* a [`Verification`]: a picture and a
//! [`Verdict`] for each runner, the origin of the worst pixel's envelope, pictures of the differences and of the evidence;
//! the expression that keeps a picture from being judged, if there is one ([`Weakness`]).
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
//! use glisten_front::Compiler;
//! use glisten_reference::Precision;
//! use glisten_verify::scene::{MemoryFiles, load};
//! use glisten_verify::verify::{Cpu, Options, Runner, verify};
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

mod clock;
mod expected;
mod explain;
mod files;
#[cfg(feature = "stability")]
mod headline;
mod maps;
mod part;
mod runner;
mod undefined;
mod verification;
mod weakness;

pub use expected::{Expected, POPULATION_SEED};
pub use files::write_pictures;
#[cfg(feature = "stability")]
pub use headline::{Headline, is_empty, of_attachment};
pub use maps::{DIFFERENCE_LEGEND, EVIDENCE_LEGEND, difference, evidence};
pub use part::MOST_WORK;
#[cfg(feature = "gl")]
pub use runner::OnOpenGl;
pub use runner::{Channel, Cpu, Drawn, Failure, Reference, Runner, ThisThread};
#[cfg(feature = "gpu")]
pub use runner::{OnGpu, as_compiled};
pub use undefined::UndefinedAt;
pub use verification::{Verification, mark};
pub use weakness::Weakness;

use crate::scene::Scene;
use explain::Explanations;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::SourceMap;
use glisten_reference::domain::Profile;
use glisten_reference::domain::faults::Faults;
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::compare::population::MARGIN;
use glisten_scene::compare::{self, Compared, Criterion, Verdict};
pub use glisten_scene::compare::{Conclusion, Demands};
use glisten_scene::picture::Picture;
use rayon::prelude::*;

/// Options for verification.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The criterion for differences: the envelope (the default), or a tolerance.
    pub criterion: Criterion,
    /// The rule for lines of the targets: Vulkan's, unless set otherwise.
    pub lines: LineRule,
    /// Whether the known faults of drivers are excused. Default: yes.
    pub excuse_known_faults: bool,
    /// The demands on a verdict that holds. Default: 95 % of the covered pixels are judged, at an edge, or excused.
    pub demands: Demands,
    /// Whether a picture of which too little was judged is accepted, such as one in which no pixel is covered. Default: no.
    pub allow_inconclusive: bool,
    /// The freedoms of the device where the specifications leave something open. Default: those of Mesa's llvmpipe.
    pub profile: Profile,
    /// The largest width of the envelope of a judged pixel. Default: 1/255 of the range of the picture's values.
    pub width: Option<f64>,
    /// By how many of its widths the hull of what simulated GPUs drew is widened for what is likely. Default: 4.
    pub likely_margin: f64,
    /// The work that the envelope of a whole picture may take, as [`glisten_reference::envelope_work`] counts it. Of a scene with more,
    /// blocks of 8 by 8 pixels that take no more stand for the picture. Default: [`MOST_WORK`]; `None` for all of any picture.
    pub most_work: Option<u64>,
    /// Whether a picture of llvmpipe is judged by what is known of its arithmetic where nothing else judges.
    pub as_device: bool,
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
            demands: Demands::default(),
            allow_inconclusive: false,
            profile: Profile::default(),
            width: None,
            likely_margin: MARGIN,
            most_work: Some(MOST_WORK),
            as_device: false,
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

/// Draws a scene with the reference and with each runner, and compares every pixel.
///
/// # Errors
/// The reference or a runner cannot draw the scene. If the target of a runner after the first one cannot represent
/// the programs, that is not an error: the runner is [skipped](Verification::skipped).
pub fn verify(scene: &Scene, runners: &[&dyn Runner], options: &Options<'_>) -> Result<Verification, Failure> {
    let mut expected = Expected::new(scene, options)?;
    let mut runs: Vec<Run> = Vec::new();
    let (mut skipped, mut classes, mut distinct) = (Vec::new(), Vec::new(), Vec::new());
    for runner in runners {
        let Drawn { picture, milliseconds } = match runner.draw(scene) {
            Err(Failure::Diagnostics(diagnostics)) if !runs.is_empty() => {
                skipped.push(Skip { runner: runner.name(), diagnostics });
                continue;
            }
            drawn => drawn?,
        };
        // Both forms mostly draw the same bits. Then one comparison serves both.
        let verdict = match runs.iter().find(|run| run.picture.has_bits_of(&picture)) {
            Some(run) => run.verdict.clone(),
            None => {
                distinct.push(runs.len());
                let Compared { verdict, classes: these } = expected.compared(&picture)?;
                maps::worse_classes(&mut classes, these);
                verdict
            }
        };
        runs.push(Run { runner: runner.name(), picture, milliseconds, verdict });
    }
    let mut shares = vec![0.0; expected.picture().covered.len()];
    let (reference, criterion) = (expected.picture(), options.criterion);
    let sample = expected.sample();
    let of_run =
        |run: &usize| compare::shares(&part::only(&runs[*run].picture, sample, reference), reference, criterion);
    for these in distinct.par_iter().map(of_run).collect::<Vec<_>>() {
        shares.iter_mut().zip(these).for_each(|(most, share): (&mut f64, f64)| *most = share.max(*most));
    }
    let mut explanations = Explanations::new(scene, options);
    let note = explanations.add_to(&mut runs)?;
    let weakness = match verification::conclusion(&runs, &options.demands) {
        Conclusion::Inconclusive => explanations.weakness(expected.picture(), expected.written(), &classes)?,
        Conclusion::Holds | Conclusion::Fails => None,
    };
    let undefined = UndefinedAt::all(expected.undefined(), options.sources);
    let share = sample.share([scene.framebuffer.width, scene.framebuffer.height]);
    let (reference, reference_milliseconds) = expected.into_picture();
    let mut verification = Verification {
        reference,
        reference_milliseconds,
        runs,
        skipped,
        shares,
        classes,
        share,
        sample,
        note,
        weakness,
        undefined,
        pictures: None,
        demands: options.demands,
        allow_inconclusive: options.allow_inconclusive,
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
