//! The plot of error against time as SVG. Both axes are logarithmic; each way is a line through its tessellations;
//! the Pareto front of each model is ringed and joined.
//!
//! *Holds:* no color is written here; the page's style sheet sets those of `.model-0`, `.model-1`, ... so that the
//! plot follows its light and dark themes. Points have a `<title>` for the pointer and for assistive tools.

use super::axis::{Axis, power};
use super::model::{Report, Way};
use std::fmt::Write as _;

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 460.0;
const LEFT: f64 = 76.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 18.0;
const BOTTOM: f64 = 58.0;
/// The value plotted for an error of 0, which a logarithmic axis cannot show.
const LEAST_ERROR: f64 = 1e-9;

/// The position of a way in the plot.
type Projection<'a> = &'a dyn Fn(&Way) -> (f64, f64);

/// The whole plot.
pub(super) fn svg(report: &Report) -> String {
    let error = |way: &Way| way.error.rmse.max(LEAST_ERROR);
    let times = report.ways.iter().flat_map(|way| [way.ratio.low, way.ratio.high, way.ratio.median]);
    let x = Axis::over(times, 0.06, LEFT, WIDTH - RIGHT);
    let y = Axis::over(report.ways.iter().map(error), 0.2, HEIGHT - BOTTOM, TOP);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"Error against run time\" class=\"plot\">\n"
    );
    axes(&mut svg, &x, &y);
    for (index, truth) in report.truths.iter().enumerate() {
        let ways: Vec<&Way> = report.ways.iter().filter(|way| way.model == truth.model).collect();
        let point = |way: &Way| (x.place(way.ratio.median), y.place(error(way)));
        let _ = writeln!(svg, "<g class=\"model-{index}\">");
        front(&mut svg, &ways, &point);
        let names = names(&ways);
        for (shape, name) in names.iter().enumerate() {
            series(&mut svg, &ways, name, [index, shape], (&x, &point));
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

/// The names of ways in order, without repetitions.
pub(super) fn names<'a>(ways: &[&'a Way]) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for way in ways {
        if !names.contains(&way.name.as_str()) {
            names.push(&way.name);
        }
    }
    names
}

fn axes(svg: &mut String, x: &Axis, y: &Axis) {
    for tick in x.ticks() {
        let place = x.place(tick);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{place:.1}\" y1=\"{TOP}\" x2=\"{place:.1}\" y2=\"{bottom}\"/>\
             <text class=\"tick\" x=\"{place:.1}\" y=\"{label}\" text-anchor=\"middle\">{tick}</text>",
            bottom = HEIGHT - BOTTOM,
            label = HEIGHT - BOTTOM + 20.0,
        );
    }
    for tick in y.ticks() {
        let place = y.place(tick);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{place:.1}\" x2=\"{right}\" y2=\"{place:.1}\"/>\
             <text class=\"tick\" x=\"{label}\" y=\"{baseline:.1}\" text-anchor=\"end\">{tick}</text>",
            right = WIDTH - RIGHT,
            label = LEFT - 10.0,
            baseline = place + 4.0,
            tick = power(tick),
        );
    }
    let _ = writeln!(
        svg,
        "<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">GPU time, ratio to the baseline \u{2192} slower</text>\n\
         <text class=\"axis\" transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">RMSE against the truth \u{2192} worse</text>",
        (LEFT + WIDTH - RIGHT) / 2.0,
        HEIGHT - 12.0,
        (TOP + HEIGHT - BOTTOM) / 2.0,
    );
}

/// The Pareto front from the fastest way to the most exact.
fn front(svg: &mut String, ways: &[&Way], point: Projection<'_>) {
    let mut best: Vec<(f64, f64)> = ways.iter().filter(|way| way.pareto).map(|way| point(way)).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let path: Vec<String> = best.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<polyline class=\"front\" points=\"{}\"/>", path.join(" "));
    for (x, y) in best {
        let _ = writeln!(svg, "<circle class=\"ring\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"11\"/>");
    }
}

fn series(
    svg: &mut String,
    ways: &[&Way],
    name: &str,
    [model, shape]: [usize; 2],
    (axis, point): (&Axis, Projection<'_>),
) {
    let members: Vec<&&Way> = ways.iter().filter(|way| way.name == name).collect();
    let path: Vec<String> = members.iter().map(|way| point(way)).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<polyline class=\"way shape-{shape}\" points=\"{}\"/>", path.join(" "));
    for way in members {
        let (x, y) = point(way);
        let [low, high] = [axis.place(way.ratio.low), axis.place(way.ratio.high)];
        let _ = writeln!(
            svg,
            "<g><title>{}: {:.2} times the baseline, RMSE {:.1e}</title>\
             <line class=\"spread\" x1=\"{low:.1}\" y1=\"{y:.1}\" x2=\"{high:.1}\" y2=\"{y:.1}\"/>{}{}</g>",
            escape(&way.title()),
            way.ratio.median,
            way.error.rmse,
            marker(shape, x, y),
            label(way, x, if model % 2 == 0 { y - 9.0 } else { y + 18.0 }),
        );
    }
}

/// The tessellation next to a point, above it for one model and below it for the next, since models lie close
/// together.
fn label(way: &Way, x: f64, y: f64) -> String {
    let Some([segments, rings]) = way.tessellation else { return String::new() };
    format!("<text class=\"label\" x=\"{:.1}\" y=\"{y:.1}\">{segments}\u{d7}{rings}</text>", x + 10.0)
}

/// The marker of a way, filled: circle, square, diamond, triangle, and again from the start.
pub(super) fn marker(shape: usize, x: f64, y: f64) -> String {
    match shape % 4 {
        0 => format!("<circle class=\"mark\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5.5\"/>"),
        1 => format!("<rect class=\"mark\" x=\"{:.1}\" y=\"{:.1}\" width=\"10\" height=\"10\"/>", x - 5.0, y - 5.0),
        2 => polygon(x, y, &[(0.0, -7.0), (7.0, 0.0), (0.0, 7.0), (-7.0, 0.0)]),
        _ => polygon(x, y, &[(0.0, -7.0), (6.5, 5.0), (-6.5, 5.0)]),
    }
}

fn polygon(x: f64, y: f64, corners: &[(f64, f64)]) -> String {
    let points: Vec<String> = corners.iter().map(|(dx, dy)| format!("{:.1},{:.1}", x + dx, y + dy)).collect();
    format!("<polygon class=\"mark\" points=\"{}\"/>", points.join(" "))
}

pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
