//! [`Study`]: all trials, and the tables printed from them.

use super::trial::{Cover, Subject, Trial};
use super::{Choice, Kind, Outcome};
use glisten::scene::Scene;
use glisten_gpu::Gpu;
use std::fmt;

/// Trials on some scenes.
#[derive(Debug, Default)]
pub(crate) struct Study {
    pub(crate) trials: Vec<Trial>,
    /// Scenes that could not be tried, with the reason.
    pub(crate) left_out: Vec<(String, String)>,
    /// Scenes that fail 1/255 without a fault.
    pub(crate) false_alarms: Vec<String>,
}

/// The number of trials by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    pub(crate) invalid: usize,
    pub(crate) refused: usize,
    pub(crate) unseen: usize,
    pub(crate) seen: usize,
    pub(crate) caught: usize,
    /// How many of those seen are in scenes that pass 1/255 without a fault.
    pub(crate) by_hand_of: usize,
    pub(crate) by_hand: usize,
}

fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

impl Study {
    /// Tries the selected faults of each scene; `progress` gets the name of each scene and the number of its faults.
    pub(crate) fn of(
        gpu: &Gpu,
        scenes: &[(String, Scene)],
        choice: Choice,
        progress: &mut dyn FnMut(&str, usize),
    ) -> Self {
        let mut study = Self::default();
        for (name, scene) in scenes {
            match Subject::new(gpu, name, scene) {
                Err(why) => study.left_out.push((name.clone(), why)),
                Ok(subject) => {
                    let faults = subject.faults(choice);
                    progress(name, faults.len());
                    study.false_alarms.extend(subject.false_alarm.then(|| name.clone()));
                    study.trials.extend(faults.iter().map(|(module, one)| subject.try_out(*module, one)));
                }
            }
        }
        study
    }

    /// Counts the trials for which a condition holds.
    pub(crate) fn count(&self, holds: impl Fn(&Trial) -> bool) -> Count {
        let mut count = Count::default();
        for trial in self.trials.iter().filter(|trial| holds(trial)) {
            match &trial.outcome {
                Outcome::Invalid => count.invalid += 1,
                Outcome::Refused(_) => count.refused += 1,
                Outcome::Unseen => count.unseen += 1,
                Outcome::Seen { caught, by_hand, .. } => {
                    count.seen += 1;
                    count.caught += usize::from(*caught);
                    count.by_hand_of += usize::from(by_hand.is_some());
                    count.by_hand += usize::from(*by_hand == Some(true));
                }
            }
        }
        count
    }

    /// The faults that change the picture and pass `verify`, by the reason for passing.
    pub(crate) fn survivors(&self, wanted: Cover) -> Vec<&Trial> {
        let survives =
            |trial: &&Trial| matches!(trial.outcome, Outcome::Seen { caught: false, cover, .. } if cover == wanted);
        self.trials.iter().filter(survives).collect()
    }
}

impl fmt::Display for Study {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "fault       planted  invalid  refused  unseen    seen   verify catches      1/255 catches")?;
        let line = |f: &mut fmt::Formatter<'_>, name: &str, count: Count| {
            let Count { invalid, refused, unseen, seen, caught, by_hand_of, by_hand } = count;
            let planted = invalid + refused + unseen + seen;
            write!(f, "{name:<10} {planted:>8} {invalid:>8} {refused:>8} {unseen:>7} {seen:>7}")?;
            let (ours, theirs) = (percent(caught, seen), percent(by_hand, by_hand_of));
            writeln!(f, " {caught:>8} {ours:>5.1} % {by_hand:>6} of {by_hand_of:>4} {theirs:>5.1} %")
        };
        for kind in Kind::ALL {
            line(f, kind.name(), self.count(|trial| trial.kind == kind))?;
        }
        line(f, "all", self.count(|_| true))?;
        writeln!(f, "1/255 fails without a fault: {}", self.false_alarms.join(", "))?;
        for (scene, why) in &self.left_out {
            writeln!(f, "left out: {scene}: {why}")?;
        }
        for trial in self.trials.iter().filter(|trial| matches!(trial.outcome, Outcome::Refused(_))) {
            writeln!(f, "{trial}")?;
        }
        for cover in Cover::ALL {
            let survivors = self.survivors(cover);
            let of = |kind: Kind| survivors.iter().filter(|trial| trial.kind == kind).count();
            write!(f, "\nmissed, {}: {}", cover.name(), survivors.len())?;
            for kind in Kind::ALL.into_iter().filter(|kind| of(*kind) > 0) {
                write!(f, "; {} {}", kind.name(), of(kind))?;
            }
            writeln!(f)?;
            for trial in survivors {
                writeln!(f, "  {trial}")?;
            }
        }
        Ok(())
    }
}
