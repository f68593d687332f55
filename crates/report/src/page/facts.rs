//! The facts at the head of the page: what was drawn, where, and how far the times can be trusted.
//!
//! *In:* a report. *Out:* terms with their facts. *Holds:* what is not known is said to be unknown.

use super::super::model::{Ended, Report, Timing, Way};
use glisten_page::words::{fixed, interval, percent};
use minijinja::{Value, context};

/// The terms in their order, each with its fact and a remark.
pub(super) fn facts(report: &Report) -> Vec<Value> {
    let timing = &report.timing;
    let [width, height] = report.size;
    let models = report.truths.len();
    let count = |count: usize, one: &str, more: &str| format!("{count} {}", if count == 1 { one } else { more });
    let same = &timing.same_again;
    let [low, high] = widths(&report.ways);
    let table = [
        (
            "Variants",
            count(report.ways.len(), "variant", "variants"),
            format!("of {}, {} skipped", count(models, "model", "models"), report.skipped.len()),
        ),
        ("Picture", format!("{width} \u{d7} {height}"), "pixels".to_owned()),
        ("Adapter", report.adapter.name.clone(), format!("ran emitted {}", form(report.via))),
        ("Driver", report.adapter.driver.clone(), String::new()),
        (
            "CPU",
            report.machine.cpu.clone().unwrap_or_else(|| "unknown".into()),
            format!("{}{}", count(report.machine.threads, "thread", "threads"), load(report)),
        ),
        ("Rounds", timing.rounds.to_string(), ended(timing.ended).to_owned()),
        (
            "A/A control",
            format!("{} ({})", fixed(same.median, 2), interval(same.interval)),
            "the baseline timed twice: its distance from 1 is noise".to_owned(),
        ),
        (
            "Interval width",
            percent(low),
            format!("of the median variant, {} of the widest, at 95 % confidence", percent(high)),
        ),
        (
            "Margin",
            percent(timing.margin),
            "a variant must be faster than another by so much to beat it; smaller differences are noise".to_owned(),
        ),
        ("Baseline", timing.baseline.clone(), frames(timing)),
        ("Weights", report.weights.clone(), "by which operations are counted".to_owned()),
    ];
    let fact = |(term, text, remark): (&str, String, String)| context! { term, text, remark };
    table.into_iter().map(fact).collect()
}

fn load(report: &Report) -> String {
    report.machine.load.map_or_else(String::new, |load| format!(", load {load:.1} before"))
}

fn form(via: &str) -> &'static str {
    if via == "spirv" { "SPIR-V" } else { "WGSL" }
}

fn ended(ended: Ended) -> &'static str {
    match ended {
        Ended::Narrow => "until every interval was narrow enough",
        Ended::Rounds => "until the limit of rounds",
        Ended::Seconds => "until the limit of seconds",
        Ended::Stopped => "until the user interrupted it",
    }
}

/// The widths of the intervals of the times, relative to the median: that of the middle variant, and the largest.
fn widths(ways: &[Way]) -> [f64; 2] {
    let width = |way: &Way| (way.ratio.interval[1] - way.ratio.interval[0]) / way.ratio.median;
    let mut widths: Vec<f64> = ways.iter().map(width).filter(|width| width.is_finite()).collect();
    widths.sort_by(f64::total_cmp);
    [widths.get(widths.len() / 2), widths.last()].map(|width| width.copied().unwrap_or(f64::NAN))
}

/// The time of the baseline, and the part that clears.
fn frames(timing: &Timing) -> String {
    let [whole, empty] = [timing.baseline_ms, timing.empty_ms].map(|time| fixed(time, 3));
    format!("{whole} ms a frame; {empty} ms for one that only clears")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{example, way};
    use super::*;

    #[test]
    fn widths_are_relative() {
        let mut ways = vec![way("m", 0.1, 1), way("m", 0.1, 1), way("m", 0.1, 1)];
        ways[0].ratio.interval = [0.9, 1.1];
        ways[1].ratio.interval = [0.8, 1.2];
        ways[2].ratio.interval = [f64::NAN; 2];
        let [middle, widest] = widths(&ways);
        assert!((middle - 0.4).abs() < 1e-12 && (widest - 0.4).abs() < 1e-12);
        assert!(widths(&[])[0].is_nan());
    }

    #[test]
    fn the_facts_tell_of_a_report_that_was_ended() {
        let mut report = example();
        report.timing.ended = Ended::Stopped;
        report.machine.cpu = None;
        let told = format!("{:?}", facts(&report));
        for part in ["until the user interrupted it", "unknown", "llvmpipe", "0.99"] {
            assert!(told.contains(part), "{part}: {told}");
        }
    }
}
