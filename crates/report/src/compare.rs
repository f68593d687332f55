//! Tells what got worse since an earlier report.
//!
//! *In:* a report and an earlier one of the same scene. *Out:* a [`Comparison`]: lines that say what got worse, and notes.
//!
//! *Holds:* errors and work are compared to the digit. Times are compared only where the drivers are the same, and only where
//! the intervals part by the margin of the noisier run, or by [`BETWEEN_RUNS`] if that is more. A variant that is gone is worse, since nothing watches its figures any
//! longer; a new one is not.

use super::model::Report;
use super::past::{Past, PastFigures, PastWay, PastWork};

/// The least margin between times of two runs: the load of the machine changes ratios, too.
const BETWEEN_RUNS: f64 = 0.25;

/// The differences from an earlier report.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Comparison {
    /// The figures that got worse, a line each.
    pub worse: Vec<String>,
    /// The number of figures that got better.
    pub better: usize,
    /// Further facts for the reader, a line each.
    pub notes: Vec<String>,
}

/// A figure of an error, less being better.
type ErrorFigure = (&'static str, fn(&PastFigures) -> Option<f64>);
/// A figure of work.
type WorkFigure = (&'static str, fn(&PastWork) -> u64);

const ERRORS: [ErrorFigure; 6] = [
    ("max_abs", |figures| figures.max_abs),
    ("rmse", |figures| figures.rmse),
    ("max_ulp", |figures| figures.max_ulp),
    ("flip", |figures| figures.flip),
    ("coverage_mismatch", |figures| figures.coverage_mismatch),
    ("non_finite", |figures| figures.non_finite),
];

const WORK: [WorkFigure; 4] = [
    ("vertices", |work| work.vertices),
    ("fragments", |work| work.fragments),
    ("texture_lookups", |work| work.texture_lookups),
    ("operations", |work| work.operations),
];

impl Report {
    /// Compares with an earlier report.
    ///
    /// # Errors
    /// A sentence that says why the two cannot be compared.
    pub fn compare(&self, old: &Past) -> Result<Comparison, String> {
        compare(&Past::of(self)?, old)
    }
}

fn compare(new: &Past, old: &Past) -> Result<Comparison, String> {
    if new.scene != old.scene {
        return Err(format!("it is a report of the scene `{}`, and not of `{}`", old.scene, new.scene));
    }
    if new.size != old.size {
        let [[w, h], [ow, oh]] = [new.size, old.size];
        return Err(format!("its pictures have {ow}x{oh} pixels, and those of this report {w}x{h}"));
    }
    let mut found = Comparison::default();
    let weights = new.weights == old.weights;
    if !weights {
        found.notes.push("other weights: operations are not compared".into());
    }
    let driver = new.adapter == old.adapter && new.via == old.via;
    if !driver {
        let [new, old] = [new, old].map(|past| format!("{}, {}, {}", past.adapter.name, past.adapter.driver, past.via));
        found.notes.push(format!("drawn by {new}, and then by {old}: times are not compared"));
    }
    let times = driver && new.timing.baseline == old.timing.baseline;
    if driver && !times {
        found.notes.push("another baseline: times are not compared".into());
    }
    let margin = [new, old].into_iter().filter_map(|past| past.timing.margin).fold(BETWEEN_RUNS, f64::max);
    for way in &old.ways {
        match new.ways.iter().find(|other| other.key() == way.key()) {
            Some(now) => found.way(now, way, weights, times.then_some(margin)),
            None => found.worse.push(format!("{}: the variant is no longer there", way.title())),
        }
    }
    for way in new.ways.iter().filter(|way| !old.ways.iter().any(|other| other.key() == way.key())) {
        found.notes.push(format!("{}: a new variant", way.title()));
    }
    Ok(found)
}

impl Comparison {
    fn way(&mut self, new: &PastWay, old: &PastWay, weights: bool, margin: Option<f64>) {
        let title = new.title();
        for (name, of) in ERRORS {
            if let (Some(now), Some(then)) = (of(&new.error), of(&old.error)) {
                self.note(now > then, now < then, || format!("{title}: {name} {} -> {}", digits(then), digits(now)));
            }
        }
        if let (Some(now), Some(then)) = (&new.work, &old.work) {
            for (name, of) in WORK.into_iter().filter(|(name, _)| weights || *name != "operations") {
                let (now, then) = (of(now), of(then));
                self.note(now > then, now < then, || format!("{title}: {name} {then} -> {now}"));
            }
        }
        if let (Some(margin), Some([Some(low), Some(high)]), Some([Some(old_low), Some(old_high)])) =
            (margin, new.ratio.interval, old.ratio.interval)
        {
            let (slower, faster) = (low > old_high * (1.0 + margin), high * (1.0 + margin) < old_low);
            let text = || format!("{title}: time {old_low:.3}-{old_high:.3} -> {low:.3}-{high:.3} of the baseline");
            self.note(slower, faster, text);
        }
    }

    fn note(&mut self, worse: bool, better: bool, text: impl FnOnce() -> String) {
        if worse {
            self.worse.push(text());
        } else if better {
            self.better += 1;
        }
    }

    /// The comparison as lines for a terminal.
    pub fn lines(&self) -> String {
        let mut text: String = self.worse.iter().map(|line| format!("worse: {line}\n")).collect();
        text.extend(self.notes.iter().map(|line| format!("note: {line}\n")));
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let worse = match self.worse.len() {
            0 => "nothing got worse".to_owned(),
            count => format!("{count} figure{} got worse", plural(count)),
        };
        text.push_str(&format!("{worse}, {} figure{} got better\n", self.better, plural(self.better)));
        text
    }
}

/// A number with as many digits as tell it from all others; large and small ones with an exponent.
fn digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::super::model::Report;
    use super::super::page::tests::example;
    use super::*;

    fn past() -> Past {
        Past::of(&example()).expect("a report can be read")
    }

    /// The lines of what is worse, from a report in which one variant was changed to an earlier one.
    fn worse(change: impl FnOnce(&mut Report)) -> Vec<String> {
        let mut report = example();
        change(&mut report);
        report.compare(&past()).expect("the same scene").worse
    }

    #[test]
    fn a_report_is_no_worse_than_itself() {
        let found = example().compare(&past()).expect("the same scene");
        assert_eq!(found, Comparison::default());
        assert_eq!(found.lines(), "nothing got worse, 0 figures got better\n");
    }

    #[test]
    fn each_figure_that_got_worse_is_told() {
        let title = example().ways[0].title();
        let said = |change: fn(&mut Report)| worse(change).join("; ");
        assert!(said(|report| report.ways[0].error.rmse *= 1.0 + 1e-15).starts_with(&format!("{title}: rmse ")));
        assert!(said(|report| report.ways[0].error.max_ulp += 1.0).contains("max_ulp"));
        assert!(said(|report| report.ways[0].error.non_finite += 1).contains("non_finite 0 -> 1"));
        assert!(said(|report| report.ways[0].work.operations += 1).contains("operations 16000 -> 16001"));
        assert!(said(|report| report.ways[0].work.texture_lookups += 1).contains("texture_lookups 0 -> 1"));
        assert!(said(|report| report.ways[0].ratio.interval = [9.0, 9.1]).contains("time"));
        assert!(said(|report| drop(report.ways.remove(0))).contains("the variant is no longer there"));
    }

    #[test]
    fn what_is_better_or_within_the_noise_is_not_worse() {
        assert_eq!(worse(|report| report.ways[0].error.rmse *= 0.5), [""; 0]);
        assert_eq!(worse(|report| report.ways[0].work.operations -= 1), [""; 0]);
        let [low, high] = example().ways[1].ratio.interval;
        assert_eq!(worse(|report| report.ways[1].ratio.interval = [low * 1.1, high * 1.1]), [""; 0]);
        // The intervals part, but not on the same driver.
        let other = |report: &mut Report| {
            report.ways[1].ratio.interval = [9.0, 9.1];
            report.adapter.driver = "another".into();
        };
        assert_eq!(worse(other), [""; 0]);
    }

    #[test]
    fn other_weights_and_new_ways_are_noted() {
        let mut report = example();
        report.weights = "gpu".into();
        report.ways.iter_mut().for_each(|way| way.work.operations *= 7);
        report.ways[0].name = "new".into();
        let found = report.compare(&past()).expect("the same scene");
        assert_eq!(found.worse.len(), 1, "{found:?}");
        assert!(found.notes.iter().any(|note| note.contains("other weights")));
        assert!(found.notes.iter().any(|note| note.contains("a new variant")));
    }

    #[test]
    fn what_is_no_report_of_the_scene_is_an_error() {
        for broken in ["", "[]", "{}", "{\"scene\": 3}", "\u{0}"] {
            assert!(Past::parse(broken).is_err(), "{broken:?}");
        }
        let mut other = past();
        other.scene = "other".into();
        assert!(example().compare(&other).is_err_and(|told| told.contains("`other`")));
        let mut other = past();
        other.size = [1, 2];
        assert!(example().compare(&other).is_err_and(|told| told.contains("1x2")));
    }
}
