//! The report as a table for a terminal.

use super::model::{Ended, Report, Timing, Truth, Way};
use std::fmt::Write as _;

/// The columns.
const HEAD: [&str; 11] =
    ["variant", "max error", "RMSE", "FLIP", "operations", "lookups", "ms", "time", "95 %", "work front", "time front"];

/// Writes lines of at most some 100 columns, then an explanation of the figures.
pub(super) fn table(report: &Report) -> String {
    let mut rows = vec![HEAD.map(str::to_owned).to_vec()];
    rows.extend(report.ways.iter().map(row));
    let mut text = right_aligned(&rows);
    // Writing to a String cannot fail.
    let weights = &report.weights;
    let _ = writeln!(text, "\noperations: counted on the reference by the weights `{weights}`, deterministic");
    text.push_str(&times(&report.timing));
    text.push_str(&references(&report.truths));
    let mismatches: u64 = report.ways.iter().map(|way| way.error.coverage_mismatch).sum();
    let _ = writeln!(
        text,
        "errors: over pixels that both pictures cover; silhouettes differ at {mismatches} pixels of all variants together"
    );
    for way in report.ways.iter().filter(|way| way.error.non_finite > 0) {
        let (title, lost, covered) = (way.title(), way.error.non_finite, way.error.covered);
        let _ = writeln!(
            text,
            "{MARK} {title}: {lost} of {covered} pixels are not finite in it or its reference, and no error counts them"
        );
    }
    for skipped in &report.skipped {
        let _ = writeln!(text, "skipped: {}: {}", skipped.name, skipped.because);
    }
    if !report.complete {
        text.push_str("interrupted: the table covers what had finished\n");
    }
    text
}

fn row(way: &Way) -> Vec<String> {
    let [low, high] = way.ratio.interval;
    vec![
        way.title(),
        format!("{:.1e}{}", way.error.max_abs, if way.error.non_finite > 0 { MARK } else { "" }),
        format!("{:.1e}", way.error.rmse),
        way.error.flip.map_or_else(|| "-".into(), |flip| format!("{flip:.1e}")),
        way.work.operations.to_string(),
        way.work.texture_lookups.to_string(),
        figure(way.milliseconds, 3),
        figure(way.ratio.median, 2),
        range(low, high),
        if way.pareto { "yes" } else { "no" }.to_owned(),
        if way.ratio.median.is_finite() { way.pareto_time.name() } else { NONE }.to_owned(),
    ]
}

/// Marks errors that leave out pixels that are not finite.
const MARK: &str = "*";

/// The place of a figure that there is not.
const NONE: &str = "-";

/// A figure, if there is one.
fn figure(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { NONE.into() }
}

/// An interval, if there is one.
fn range(low: f64, high: f64) -> String {
    if low.is_finite() && high.is_finite() { format!("{low:.2}-{high:.2}") } else { NONE.into() }
}

/// How times were measured, and how far they can be trusted.
fn times(timing: &Timing) -> String {
    if timing.rounds == 0 {
        return "time: not measured\nfront: variants of a model that no other variant beats in both error and work\n"
            .to_owned();
    }
    let ended = match timing.ended {
        Ended::Narrow => "until every interval was narrower than 3 %",
        Ended::Rounds => "the limit of rounds",
        Ended::Seconds => "the limit of seconds",
        Ended::Stopped => "interrupted",
    };
    let [low, high] = timing.same_again.interval;
    format!(
        "time: ratio to `{}` ({} ms; a frame that only clears: {} ms),\n\
         \x20     median of {} rounds ({ended}) and its interval; A/A control {} ({})\n\
         front: variants of a model that no other variant beats in both error and cost (time differences under {:.0} % are noise)\n",
        timing.baseline,
        figure(timing.baseline_ms, 3),
        figure(timing.empty_ms, 3),
        timing.rounds,
        figure(timing.same_again.median, 2),
        range(low, high),
        timing.margin * 100.0,
    )
}

/// The pictures that errors are taken from: one line if all models have theirs from the same variant.
fn references(truths: &[Truth]) -> String {
    let mesh = |truth: &Truth| truth.tessellation.map(|[s, r]| format!(" at {s}x{r}")).unwrap_or_default();
    let line = |of: &str, way: &str, truth: &Truth| {
        format!("reference of {of}: {way}{} on the CPU in {}\n", mesh(truth), truth.precision)
    };
    match (truths, common_reference(truths)) {
        ([first, ..], Some(way)) => line("each model", &format!("its variant `{way}`"), first),
        _ => truths.iter().map(|truth| line(&truth.model, &format!("`{}`", truth.way), truth)).collect(),
    }
}

/// The name without its model's, of the variant that is the reference of each of several models.
pub(super) fn common_reference(truths: &[Truth]) -> Option<String> {
    let own = |truth: &Truth| {
        let rest = truth.way.strip_prefix(&truth.model)?.trim_start_matches([',', ':', ' ']);
        (!rest.is_empty()).then(|| (rest.to_owned(), truth.tessellation, truth.precision))
    };
    let first = truths.first().filter(|_| truths.len() > 1).and_then(own)?;
    truths.iter().all(|truth| own(truth).as_ref() == Some(&first)).then_some(first.0)
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
    use super::super::page::tests::example;
    use super::{common_reference, range, right_aligned, table};

    #[test]
    fn a_reference_that_all_models_share_is_one_line() {
        let mut report = example();
        assert_eq!(common_reference(&report.truths).as_deref(), Some("per fragment"));
        assert_eq!(table(&report).matches("\nreference of ").count(), 1);
        report.truths[1].tessellation = None;
        assert_eq!(common_reference(&report.truths), None);
        assert_eq!(table(&report).matches("\nreference of ").count(), 2);
        report.truths.truncate(1);
        assert_eq!(common_reference(&report.truths), None);
    }

    #[test]
    fn pixels_that_are_not_finite_are_told() {
        let mut report = example();
        assert!(!table(&report).contains('*'));
        (report.ways[0].error.non_finite, report.ways[0].error.covered) = (64, 256);
        let told = format!("* {}: 64 of 256 pixels are not finite", report.ways[0].title());
        assert!(table(&report).contains(&told), "{}", table(&report));
    }

    #[test]
    fn what_was_not_measured_is_a_dash() {
        let mut report = example();
        report.timing.rounds = 0;
        for way in &mut report.ways {
            (way.milliseconds, way.ratio.median, way.ratio.interval) = (f64::NAN, f64::NAN, [f64::NAN; 2]);
        }
        let text = table(&report);
        assert!(text.contains("time: not measured") && !text.contains('?') && !text.contains("NaN"), "{text}");
        assert_eq!(range(f64::NAN, 1.0), "-");
    }

    #[test]
    fn columns_line_up() {
        let rows = [vec!["a".to_owned(), "1".to_owned()], vec!["bcd".to_owned(), "20".to_owned()]];
        assert_eq!(right_aligned(&rows), "a     1\nbcd  20\n");
    }
}
