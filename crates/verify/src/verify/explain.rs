//! [`Explanations`]: the origin of the envelopes of the worst pixels.
//!
//! *In:* the runs of a verification. *Out:* contributions in their verdicts, and an excerpt for the worst of them.
//! *Holds:* a pixel that is the worst of several runs is explained once.

use super::runner::Channel;
use super::{Failure, Options, Run};
use crate::scene::Scene;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::BOUND_EXPLAINED;
use glisten_front::source::SourceMap;
use glisten_reference::Contribution;
use glisten_reference::domain::faults::Faults;
use glisten_scene::compare::Contributed;

/// The largest number of contributions in a report.
const MOST: usize = 3;
/// The smallest share in a report.
const LEAST_SHARE: f64 = 0.01;

/// The explanations of a scene's pixels.
pub(super) struct Explanations<'a> {
    scene: &'a Scene,
    pub(super) options: &'a Options<'a>,
    known: Vec<(Channel, Vec<Contribution>)>,
}

impl<'a> Explanations<'a> {
    pub(super) fn new(scene: &'a Scene, options: &'a Options<'a>) -> Self {
        Self { scene, options, known: Vec::new() }
    }

    /// Adds the origin of the envelope to each run's worst pixel. Returns the excerpt for the run with the largest
    /// error. Without the texts, or without an envelope, there is nothing to add.
    pub(super) fn add_to(&mut self, runs: &mut [Run]) -> Result<Option<Diagnostic>, Failure> {
        let Some(sources) = self.options.sources else { return Ok(None) };
        let (mut excerpt, mut largest) = (None, -1.0);
        for run in runs.iter_mut().filter(|run| run.verdict.judged_by == "envelope") {
            let max_abs = run.verdict.max_abs;
            let Some(worst) = &mut run.verdict.worst else { continue };
            let at = Channel { pixel: [worst.x, worst.y], attachment: worst.attachment, channel: worst.channel };
            let contributions = self.contributions(at)?;
            worst.contributions = contributions.iter().filter_map(|one| contributed(sources, one)).collect();
            if max_abs > largest {
                largest = max_abs;
                excerpt = note(&contributions, at);
            }
        }
        Ok(excerpt)
    }

    /// The largest contributions to an envelope.
    pub(super) fn contributions(&mut self, at: Channel) -> Result<Vec<Contribution>, Failure> {
        if let Some((_, contributions)) = self.known.iter().find(|(known, _)| *known == at) {
            return Ok(contributions.clone());
        }
        let all = self.options.reference.explain(self.scene, &self.options.reference_options(Faults::NONE), at)?;
        let largest: Vec<Contribution> = all.into_iter().filter(|one| one.share >= LEAST_SHARE).take(MOST).collect();
        self.known.push((at, largest.clone()));
        Ok(largest)
    }
}

/// The place of a contribution, for a report.
pub(super) fn contributed(sources: &SourceMap, contribution: &Contribution) -> Option<Contributed> {
    let location = sources.location(sources.call_site(contribution.span))?;
    Some(Contributed {
        file: sources.file(location.file).name().to_owned(),
        line: location.line,
        column: location.column,
        end_column: location.end_column,
        operation: contribution.operation,
        share: contribution.share,
    })
}

/// The contributions to the bound of a channel, as an excerpt.
fn note(contributions: &[Contribution], at: Channel) -> Option<Diagnostic> {
    let [x, y] = at.pixel;
    excerpt(contributions, format!("what the bound of {} at pixel ({x}, {y}) comes from", at.name()))
}

/// The contributions as an excerpt with this message.
pub(super) fn excerpt(contributions: &[Contribution], message: String) -> Option<Diagnostic> {
    let (first, rest) = contributions.split_first()?;
    let text = |one: &Contribution| format!("`{}`: {:.0} % of it", one.operation, one.share * 100.0);
    let note = Diagnostic::new(&BOUND_EXPLAINED, first.span, message).here(text(first));
    Some(rest.iter().fold(note, |note, one| note.label(one.span, text(one))))
}
