//! [`Verification`]: the results of all runners, and the conclusion of all of them.
//!
//! *In:* runs. *Out:* the conclusion, pictures, the message of a test.

use super::maps::{difference, evidence};
use super::undefined::UndefinedAt;
use super::weakness::Weakness;
use super::{Run, Skip, part};
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::Sample;
use glisten_scene::compare::{Class, Conclusion, Demands};
use glisten_scene::picture::Picture;
use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;

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
    /// For each pixel, the class that says least, of all runs.
    pub classes: Vec<Option<Class>>,
    /// The share of the picture that was judged: 1, unless a sample stands for it ([`Options::most_work`](super::Options::most_work)).
    pub share: f64,
    /// The part of the picture that was judged.
    pub(super) sample: Sample,
    /// The origin of the worst pixel's envelope, if [`Options::sources`](super::Options::sources) is set and the pixel is wrong.
    pub note: Option<Diagnostic>,
    /// Why too little was judged, if that is so.
    pub weakness: Option<Weakness>,
    /// The places in the picture that the language leaves undefined, if [`Options::sources`](super::Options::sources) is set.
    pub undefined: Vec<UndefinedAt>,
    /// The folder with the pictures of a failure, or the reason why they could not be written.
    pub pictures: Option<Result<PathBuf, String>>,
    /// The demands of the options.
    pub demands: Demands,
    pub(super) allow_inconclusive: bool,
}

impl Verification {
    /// A picture with the reference's colors where it was not judged, so that a figure of both is one of what was.
    pub fn judged<'p>(&self, picture: &'p Picture) -> Cow<'p, Picture> {
        part::only(picture, self.sample, &self.reference)
    }

    /// Whether all differences of all runs are explained, and something was drawn at all.
    pub fn holds(&self) -> bool {
        match self.conclusion() {
            Conclusion::Holds => true,
            Conclusion::Inconclusive => self.allow_inconclusive,
            Conclusion::Fails => false,
        }
    }

    /// Whether a run has a difference that nothing explains.
    pub fn fails(&self) -> bool {
        self.conclusion() == Conclusion::Fails
    }

    /// The conclusion of all runs together: the worst of their conclusions.
    pub fn conclusion(&self) -> Conclusion {
        conclusion(&self.runs, &self.demands)
    }

    /// A picture of [`shares`](Self::shares), on black: see [`DIFFERENCE_LEGEND`](super::DIFFERENCE_LEGEND).
    pub fn difference(&self) -> Picture {
        difference(&self.reference, &self.shares)
    }

    /// A picture of [`classes`](Self::classes): see [`EVIDENCE_LEGEND`](super::EVIDENCE_LEGEND).
    pub fn evidence(&self) -> Picture {
        evidence(&self.reference, &self.classes)
    }
}

/// The worst conclusion of some runs.
pub(super) fn conclusion(runs: &[Run], demands: &Demands) -> Conclusion {
    runs.iter().map(|run| run.verdict.conclusion(demands)).max().unwrap_or(Conclusion::Inconclusive)
}

/// The failures, as the message of a test: a line for each run, and the folder with the pictures.
impl fmt::Display for Verification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for run in &self.runs {
            let verdict = &run.verdict;
            let mark = mark(verdict.conclusion(&self.demands));
            write!(f, "{}: {mark}: {} of {} pixels covered, ", run.runner, verdict.covered, verdict.pixels)?;
            let share = 100.0 * verdict.share_judged(&self.demands);
            write!(f, "{share:.1} % of them {}, ", verdict.judged_word())?;
            write!(f, "{} outside, {} with another coverage, ", verdict.outside, verdict.coverage_mismatch)?;
            write!(f, "{} not finite on one side, ", verdict.finiteness_mismatch)?;
            write!(f, "{} undecided; ", verdict.undecided)?;
            match verdict.largest_error() {
                Some(error) => writeln!(f, "largest error {error:.3e}")?,
                None => writeln!(f, "no pixel was compared")?,
            }
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
        Conclusion::Inconclusive => "INCONCLUSIVE",
        Conclusion::Fails => "DOES NOT HOLD",
    }
}
