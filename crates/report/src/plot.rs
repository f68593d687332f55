//! The plot of error against work for a reader without the page's script, which draws a better one in its place.
//!
//! *In:* a report. *Out:* an SVG. *Holds:* both axes are logarithmic; a point is labeled by the number of its variant in the
//! table; the front of each model is joined, its points are filled, and all others are hollow. No color is written here: the
//! page's style sheet sets those of `.model-0`, `.model-1`, ... so that the plot follows its light and dark themes.

use super::model::{Report, Way};
use glisten_page::axis::{Axis, power};
use glisten_page::escape;
use std::fmt::Write as _;

/// The value plotted for an error of 0, which a logarithmic axis cannot show.
const LEAST_ERROR: f64 = 1e-9;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 460.0;
const LEFT: f64 = 76.0;
const FOOT: f64 = HEIGHT - 58.0;

/// The number of model colors in the style sheet.
pub(super) const COLORS: usize = 12;

/// The two axes of the plot.
struct Axes {
    x: Axis,
    y: Axis,
}

impl Axes {
    fn of(ways: &[Way]) -> Self {
        let work = ways.iter().map(|way| way.work.operations as f64);
        let errors = ways.iter().map(|way| way.error.rmse.max(LEAST_ERROR));
        Self { x: Axis::over(work, 0.06, LEFT, WIDTH - 24.0), y: Axis::over(errors, 0.2, FOOT, 16.0) }
    }

    fn place(&self, way: &Way) -> (f64, f64) {
        (self.x.place((way.work.operations as f64).max(1.0)), self.y.place(way.error.rmse.max(LEAST_ERROR)))
    }
}

/// The plot.
pub(super) fn svg(report: &Report) -> String {
    let axes = Axes::of(&report.ways);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"RMSE over operations; the table has the figures\">\n"
    );
    grid(&mut svg, &axes);
    for (model, truth) in report.truths.iter().enumerate() {
        let members: Vec<(usize, &Way)> =
            report.ways.iter().enumerate().filter(|(_, way)| way.model == truth.model).collect();
        ways(&mut svg, &axes, model % COLORS, &members);
    }
    svg.push_str("</svg>\n");
    svg
}

fn grid(svg: &mut String, Axes { x, y }: &Axes) {
    let right = WIDTH - 24.0;
    for tick in x.ticks() {
        let (place, label, text) = (x.place(tick), FOOT + 22.0, power(tick));
        let _ = writeln!(
            svg,
            "<path class=\"grid\" d=\"M{place:.1} 16V{FOOT}\"/><text x=\"{place:.1}\" y=\"{label}\" text-anchor=\"middle\">{text}</text>"
        );
    }
    for tick in y.ticks() {
        let (place, text) = (y.place(tick), power(tick));
        let _ = writeln!(
            svg,
            "<path class=\"grid\" d=\"M{LEFT} {place:.1}H{right}\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
            LEFT - 8.0,
            place + 4.0,
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{right}\" y=\"{}\" text-anchor=\"end\">operations \u{2192} more work</text><text x=\"4\" y=\"12\">RMSE</text>",
        HEIGHT - 8.0
    );
}

/// The front of a model and its variants.
fn ways(svg: &mut String, axes: &Axes, model: usize, members: &[(usize, &Way)]) {
    let mut front: Vec<(f64, f64)> =
        members.iter().filter(|(_, way)| way.pareto).map(|(_, way)| axes.place(way)).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let path: Vec<String> = front.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<g class=\"model-{model}\"><polyline class=\"front\" points=\"{}\"/>", path.join(" "));
    for (number, way) in members {
        let (x, y) = axes.place(way);
        let class = if way.pareto { "mark" } else { "mark hollow" };
        let _ = writeln!(
            svg,
            "<a href=\"#way-{number}\"><title>{}</title><circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{}</text></a>",
            escape(&way.title()),
            x + 9.0,
            y + 4.0,
            number + 1,
        );
    }
    svg.push_str("</g>\n");
}

#[cfg(test)]
mod tests {
    use super::super::page::tests::example;
    use super::*;

    #[test]
    fn every_way_is_in_the_plot() {
        let report = example();
        let svg = svg(&report);
        assert_eq!(svg.matches("<circle").count(), report.ways.len());
        assert_eq!(svg.matches("class=\"front\"").count(), 2);
        let hollow = report.ways.iter().filter(|way| !way.pareto).count();
        assert_eq!(svg.matches("mark hollow").count(), hollow);
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn a_plot_of_nothing_is_a_plot() {
        let mut report = example();
        report.ways.clear();
        assert!(svg(&report).ends_with("</svg>\n"));
    }
}
