//! The tables of a [`Study`].
//!
//! *In:* trials. *Out:* counts by kind, by class of scenes and by form; the parts in which `verify` catches less than
//! 1/255 or less than 95 %; the survivors; the legal changes that fail.

use super::scenery::Scenery;
use super::trial::Trial;
use super::{Form, Kind, Outcome, Study};
use glisten_scene::compare::Class;
use std::collections::BTreeMap;
use std::fmt;

/// The share that `verify` has to catch in every kind of scene.
const GOAL: f64 = 95.0;

/// The number of trials by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    pub(crate) invalid: usize,
    pub(crate) refused: usize,
    pub(crate) unseen: usize,
    /// How many move the picture by no more than rounding.
    pub(crate) rounding: usize,
    pub(crate) seen: usize,
    /// How many of those seen are in scenes that are inconclusive without a fault.
    pub(crate) open: usize,
    /// How many the envelope catches alone.
    pub(crate) by_envelope: usize,
    /// How many are caught at all.
    pub(crate) caught: usize,
    /// How many of those seen are in scenes that pass 1/255 without a fault.
    pub(crate) by_hand_of: usize,
    /// How many of these 1/255 catches.
    pub(crate) by_hand: usize,
    /// How many of these `verify` catches.
    pub(crate) against: usize,
}

impl Count {
    /// Counts a trial.
    pub(super) fn add(&mut self, outcome: &Outcome) {
        match outcome {
            Outcome::Invalid => self.invalid += 1,
            Outcome::Refused(_) => self.refused += 1,
            Outcome::Unseen => self.unseen += 1,
            Outcome::Seen(seen) if seen.is_rounding() => self.rounding += 1,
            Outcome::Seen(seen) => {
                self.seen += 1;
                self.open += usize::from(seen.was_open);
                self.by_envelope += usize::from(seen.by_envelope);
                self.caught += usize::from(seen.is_caught());
                self.by_hand_of += usize::from(seen.by_hand.is_some());
                self.by_hand += usize::from(seen.by_hand == Some(true));
                self.against += usize::from(seen.by_hand.is_some() && seen.is_caught());
            }
        }
    }

    /// The share of those seen that is caught, in percent.
    pub(crate) fn percent(&self) -> f64 {
        percent(self.caught, self.seen)
    }

    /// Whether 1/255 catches more.
    pub(crate) fn is_worse_than_by_hand(&self) -> bool {
        self.against < self.by_hand
    }
}

fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 100.0 } else { 100.0 * part as f64 / whole as f64 }
}

const HEAD: &str = "planted invalid refused  unseen rounding   seen (open)  envelope + likely =  caught          1/255 catches    worst scene";

fn line(f: &mut fmt::Formatter<'_>, name: &str, count: Count, worst: &str) -> fmt::Result {
    let Count { invalid, refused, unseen, rounding, seen, open, by_envelope, caught, by_hand_of, by_hand, .. } = count;
    let planted = invalid + refused + unseen + rounding + seen;
    write!(f, "{name:<12} {planted:>7} {invalid:>7} {refused:>7} {unseen:>7} {rounding:>8} {seen:>6} {open:>6}  ")?;
    let (more, ours, theirs) = (caught.saturating_sub(by_envelope), count.percent(), percent(by_hand, by_hand_of));
    write!(f, "{by_envelope:>8} {more:>8} {caught:>8} {ours:>6.1} %  {by_hand:>5} of {by_hand_of:>5} {theirs:>6.1} %")?;
    writeln!(f, "  {worst}")
}

impl Study {
    /// The scene with the most faults of a part that are missed.
    fn worst(&self, holds: impl Fn(&Trial) -> bool) -> String {
        let mut scenes: BTreeMap<&str, Count> = BTreeMap::new();
        for trial in self.trials.iter().filter(|trial| holds(trial)) {
            scenes.entry(&trial.scene).or_default().add(&trial.outcome);
        }
        let missed = |count: &Count| count.seen - count.caught;
        let worst = scenes.iter().rev().max_by_key(|(_, count)| missed(count)).filter(|(_, count)| missed(count) > 0);
        worst.map_or(String::new(), |(name, count)| format!("{name}: {} of {}", count.caught, count.seen))
    }

    fn rows<T: Copy + PartialEq>(
        &self,
        f: &mut fmt::Formatter<'_>,
        rows: &[(T, &str)],
        of: impl Fn(&Trial) -> T,
    ) -> fmt::Result {
        for (row, name) in rows {
            let count = self.count(|trial| of(trial) == *row);
            if count != Count::default() {
                line(f, name, count, &self.worst(|trial| of(trial) == *row))?;
            }
        }
        Ok(())
    }

    fn tables(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<12} {HEAD}", "fault")?;
        self.rows(f, &Kind::ALL.map(|kind| (kind, kind.name())), |trial| trial.kind)?;
        writeln!(f, "{:<12} {HEAD}", "scenes")?;
        self.rows(f, &Scenery::ALL.map(|class| (class, class.name())), |trial| trial.scenery)?;
        writeln!(f, "{:<12} {HEAD}", "form")?;
        self.rows(f, &Form::ALL.map(|form| (form, form.name())), |trial| trial.form)?;
        writeln!(f, "{:<12} {HEAD}", "no fault")?;
        line(f, "inconclusive", self.count(Trial::is_open), &self.worst(Trial::is_open))?;
        let has_verdict = |trial: &Trial| !trial.is_open();
        line(f, "all others", self.count(has_verdict), &self.worst(has_verdict))?;
        line(f, "all", self.count(|_| true), &self.worst(|_| true))
    }

    /// The kinds, the classes of scenes and their combinations in which `verify` catches less than 1/255, or too little. Scenes that
    /// are inconclusive without a fault do not count: nobody takes their verdict for a proof.
    pub(crate) fn weak_parts(&self) -> Vec<String> {
        let mut found = Vec::new();
        let count_of = |holds: &dyn Fn(&Trial) -> bool| self.count(|trial| !trial.is_open() && holds(trial));
        let mut add = |name: String, count: Count, is_goal: bool| {
            let Count { against, by_hand, caught, seen, .. } = count;
            if count.is_worse_than_by_hand() {
                found.push(format!("{name}: verify catches {against}, 1/255 {by_hand}"));
            } else if is_goal && count.percent() < GOAL {
                found.push(format!("{name}: {caught} of {seen} are less than {GOAL:.0} %"));
            }
        };
        for kind in Kind::ALL {
            add(kind.name().to_owned(), count_of(&|trial| trial.kind == kind), false);
        }
        for class in Scenery::ALL {
            add(class.name().to_owned(), count_of(&|trial| trial.scenery == class), true);
            for kind in Kind::ALL {
                let count = count_of(&|trial| trial.kind == kind && trial.scenery == class);
                add(format!("{} in {class}", kind.name()), count, false);
            }
        }
        found
    }

    fn legal_changes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.legal.is_empty() {
            return Ok(());
        }
        let failed = self.wrongly_failed();
        let drawn = self.legal.iter().filter(|one| one.conclusion.is_ok()).count();
        let seen = self.legal.iter().filter(|one| one.is_seen).count();
        writeln!(f, "\nlegal changes: {drawn} drawn, {seen} change the picture, {} fail", failed.len())?;
        for one in &self.legal {
            match &one.conclusion {
                Err(why) => writeln!(f, "  {}: {}: not drawn: {why}", one.scene, one.name)?,
                Ok(_) if failed.iter().any(|failed| std::ptr::eq(*failed, one)) => {
                    writeln!(f, "  {}: {}: FAILS: {}", one.scene, one.name, one.figures)?;
                }
                Ok(_) => {}
            }
        }
        Ok(())
    }

    fn missed(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for class in Class::ALL.map(Some).into_iter().chain([None]) {
            let survivors = self.survivors(class);
            let of = |kind: Kind| survivors.iter().filter(|trial| trial.kind == kind).count();
            write!(f, "\nmissed, {}: {}", class.map_or("not covered", Class::name), survivors.len())?;
            for kind in Kind::ALL.into_iter().filter(|kind| of(*kind) > 0) {
                write!(f, "; {} {}", kind.name(), of(kind))?;
            }
            writeln!(f)?;
            for trial in survivors {
                writeln!(f, "  {trial}")?;
            }
        }
        let roundings: Vec<_> = self.roundings().collect();
        writeln!(f, "\nno more than rounding: {}", roundings.len())?;
        roundings.into_iter().try_for_each(|trial| writeln!(f, "  {trial}"))
    }
}

impl fmt::Display for Study {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.tables(f)?;
        for part in self.weak_parts() {
            writeln!(f, "weak: {part}")?;
        }
        writeln!(f, "1/255 fails without a fault: {}", self.false_alarms.join(", "))?;
        writeln!(f, "inconclusive without a fault: {}", self.open.join(", "))?;
        for (scene, why) in &self.left_out {
            writeln!(f, "left out: {scene}: {why}")?;
        }
        for trial in self.trials.iter().filter(|trial| matches!(trial.outcome, Outcome::Refused(_))) {
            writeln!(f, "{trial}")?;
        }
        self.legal_changes(f)?;
        self.missed(f)
    }
}
