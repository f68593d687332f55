//! The report as a table for a terminal.

use super::model::Report;
use std::fmt::Write as _;

/// Writes lines of at most some 100 columns, then an explanation of the figures.
pub(super) fn table(report: &Report) -> String {
    let mut rows = vec![
        ["way", "max error", "RMSE", "rounding", "fragments", "ms", "time", "quartiles", ""]
            .map(str::to_owned)
            .to_vec(),
    ];
    for way in &report.ways {
        rows.push(vec![
            way.title(),
            format!("{:.1e}", way.error.max_abs),
            format!("{:.1e}", way.error.rmse),
            format!("{:.1e}", way.rounding.max_abs),
            way.fragments.map_or_else(|| "-".into(), |count| count.to_string()),
            format!("{:.3}", way.milliseconds),
            format!("{:.2}", way.ratio.median),
            format!("{:.2}-{:.2}", way.ratio.low, way.ratio.high),
            if way.pareto { "*".into() } else { String::new() },
        ]);
    }
    let mut text = right_aligned(&rows);
    let timing = &report.timing;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\ntime: ratios to `{}` ({:.3} ms), median of {} rounds in turns; the same again: {:.2} ({:.2}-{:.2})\n\
         *: no way of the model is both faster and nearer to the truth",
        timing.baseline,
        timing.baseline_ms,
        timing.rounds,
        timing.same_again.median,
        timing.same_again.low,
        timing.same_again.high
    );
    for truth in &report.truths {
        let mesh = truth.tessellation.map(|[s, r]| format!(" at {s}x{r}")).unwrap_or_default();
        let _ = writeln!(text, "truth of {}: {}{mesh} on the CPU in {}", truth.model, truth.way, truth.precision);
    }
    let mismatches: u64 = report.ways.iter().map(|way| way.error.coverage_mismatch).sum();
    let _ = writeln!(
        text,
        "errors are over pixels that both cover; silhouettes differ at {mismatches} pixels of all ways together"
    );
    text
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
