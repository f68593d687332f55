//! The report as a table for a terminal.

use super::model::{Ended, Report, Timing, Way};
use std::fmt::Write as _;

/// The columns.
const HEAD: [&str; 10] =
    ["way", "max error", "RMSE", "FLIP", "operations", "lookups", "ms", "time", "95 %", "front: work, time"];

/// Writes lines of at most some 100 columns, then an explanation of the figures.
pub(super) fn table(report: &Report) -> String {
    let mut rows = vec![HEAD.map(str::to_owned).to_vec()];
    rows.extend(report.ways.iter().map(row));
    let mut text = right_aligned(&rows);
    // Writing to a String cannot fail.
    let weights = &report.weights;
    let _ = writeln!(text, "\noperations: by the weights `{weights}`, counted on the reference; the same on every run");
    text.push_str(&times(&report.timing));
    for truth in &report.truths {
        let mesh = truth.tessellation.map(|[s, r]| format!(" at {s}x{r}")).unwrap_or_default();
        let _ = writeln!(text, "truth of {}: {}{mesh} on the CPU in {}", truth.model, truth.way, truth.precision);
    }
    let mismatches: u64 = report.ways.iter().map(|way| way.error.coverage_mismatch).sum();
    let _ = writeln!(
        text,
        "errors are over pixels that both cover; silhouettes differ at {mismatches} pixels of all ways together"
    );
    for skipped in &report.skipped {
        let _ = writeln!(text, "skipped: {}: {}", skipped.name, skipped.because);
    }
    if !report.complete {
        text.push_str("ended before it was complete: the figures are those that there were\n");
    }
    text
}

fn row(way: &Way) -> Vec<String> {
    let [low, high] = way.ratio.interval;
    vec![
        way.title(),
        format!("{:.1e}", way.error.max_abs),
        format!("{:.1e}", way.error.rmse),
        way.error.flip.map_or_else(|| "-".into(), |flip| format!("{flip:.1e}")),
        way.work.operations.to_string(),
        way.work.texture_lookups.to_string(),
        figure(way.milliseconds, 3),
        figure(way.ratio.median, 2),
        format!("{}-{}", figure(low, 2), figure(high, 2)),
        format!("{}, {}", if way.pareto { "yes" } else { "no" }, way.pareto_time.name()),
    ]
}

/// A figure, if there is one.
fn figure(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { "?".into() }
}

/// How times were measured, and how far they can be trusted.
fn times(timing: &Timing) -> String {
    let ended = match timing.ended {
        Ended::Narrow => "until every interval was narrower than 3 %",
        Ended::Rounds => "the limit",
        Ended::Seconds => "until the limit of seconds",
        Ended::Stopped => "until it was stopped",
    };
    let [low, high] = timing.same_again.interval.map(|end| figure(end, 2));
    format!(
        "time: ratios to `{}` ({} ms; a frame that only clears: {} ms), median of {} rounds ({ended}) and its\n\
         interval; the same again: {} ({low}-{high})\n\
         front: no way of the model is nearer to the truth and takes less work, or less time by {:.0} % beyond doubt\n",
        timing.baseline,
        figure(timing.baseline_ms, 3),
        figure(timing.empty_ms, 3),
        timing.rounds,
        figure(timing.same_again.median, 2),
        timing.margin * 100.0,
    )
}

/// A table of numbers: the first column is aligned to the left, all others to the right.
fn right_aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0))
        .collect();
    let mut text = String::new();
    for row in rows {
        let line: Vec<String> = row
            .iter()
            .zip(&widths)
            .enumerate()
            .map(
                |(column, (cell, &width))| {
                    if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
                },
            )
            .collect();
        text.push_str(line.join("  ").trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::right_aligned;

    #[test]
    fn columns_line_up() {
        let rows = [vec!["a".to_owned(), "1".to_owned()], vec!["bcd".to_owned(), "20".to_owned()]];
        assert_eq!(right_aligned(&rows), "a     1\nbcd  20\n");
    }
}
