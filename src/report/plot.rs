//! The plot of error against time. Both axes are logarithmic; each way is a line through its tessellations; the Pareto
//! front of each model is ringed and joined.
//!
//! *Holds:* lines stretch with the page, texts and marks keep their size. No color is written here; the page's style sheet
//! sets those of `.model-0`, `.model-1`, ... so that the plot follows its light and dark themes. Every point is a button:
//! pointer, keyboard and touch show its figures. Labels never collide, because they have room on the narrowest page.

use super::axis::{Axis, parts};
use super::model::{Report, Way};
use std::fmt::Write as _;

/// The value plotted for an error of 0, which a logarithmic axis cannot show.
const LEAST_ERROR: f64 = 1e-9;

/// A way with its place in the plot and the parts of its row that a label or a bar needs.
struct Point<'a> {
    way: &'a Way,
    /// The number of the way in the report.
    number: usize,
    model: usize,
    shape: usize,
    /// In percent of the plot, from the left and from the top.
    at: (f64, f64),
    spread: [f64; 2],
}

/// The whole plot as HTML: lines in an SVG that stretches, and texts and marks in boxes that do not.
pub(super) fn html(report: &Report) -> String {
    let error = |way: &Way| way.error.rmse.max(LEAST_ERROR);
    let times = report.ways.iter().flat_map(|way| [way.ratio.interval[0], way.ratio.interval[1], way.ratio.median]);
    let x = Axis::over(times, 0.06, 0.0, 100.0);
    let y = Axis::over(report.ways.iter().map(error), 0.2, 100.0, 0.0);
    let mut points = Vec::new();
    for (model, truth) in report.truths.iter().enumerate() {
        let ways: Vec<(usize, &Way)> =
            report.ways.iter().enumerate().filter(|(_, way)| way.model == truth.model && is_timed(way)).collect();
        let names = names(&ways.iter().map(|(_, way)| *way).collect::<Vec<_>>());
        points.extend(ways.into_iter().map(|(number, way)| Point {
            way,
            number,
            model,
            shape: names.iter().position(|name| *name == way.name).unwrap_or(0),
            at: (x.place(way.ratio.median), y.place(error(way))),
            spread: way.ratio.interval.map(|end| x.place(if end.is_finite() { end } else { way.ratio.median })),
        }));
    }
    let mut page = String::from("<div class=\"plot\"><div class=\"field\">\n");
    lines(&mut page, &x, &y, &points);
    ticks(&mut page, &x, &y);
    let labels = labels(&points);
    for (point, label) in points.iter().zip(labels) {
        mark(&mut page, point, label);
    }
    page.push_str("</div>\n<p class=\"axis-y\">RMSE \u{2192} worse</p>\n");
    page.push_str("<p class=\"axis-x\">GPU time / baseline \u{2192} slower</p></div>\n");
    page
}

/// Whether the way was timed before the report was ended.
fn is_timed(way: &Way) -> bool {
    way.ratio.median.is_finite()
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

/// The grid, the ways through their tessellations, and the Pareto fronts.
fn lines(page: &mut String, x: &Axis, y: &Axis, points: &[Point<'_>]) {
    page.push_str("<svg viewBox=\"0 0 100 100\" preserveAspectRatio=\"none\" aria-hidden=\"true\">\n");
    for place in x.ticks().into_iter().map(|tick| x.place(tick)) {
        let _ = writeln!(page, "<path class=\"grid\" d=\"M{place:.2} 0V100\"/>");
    }
    for place in y.ticks().into_iter().map(|tick| y.place(tick)) {
        let _ = writeln!(page, "<path class=\"grid\" d=\"M0 {place:.2}H100\"/>");
    }
    let models = points.iter().map(|point| point.model + 1).max().unwrap_or(0);
    for model in 0..models {
        let members: Vec<&Point<'_>> = points.iter().filter(|point| point.model == model).collect();
        let mut best: Vec<(f64, f64)> = members.iter().filter(|point| point.way.pareto).map(|point| point.at).collect();
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        let _ = writeln!(page, "<polyline class=\"front model-{model}\" points=\"{}\"/>", path(&best));
        let shapes = members.iter().map(|point| point.shape + 1).max().unwrap_or(0);
        for shape in 0..shapes {
            let series: Vec<(f64, f64)> =
                members.iter().filter(|point| point.shape == shape).map(|point| point.at).collect();
            let _ =
                writeln!(page, "<polyline class=\"way model-{model} shape-{shape}\" points=\"{}\"/>", path(&series));
        }
    }
    page.push_str("</svg>\n");
}

fn path(points: &[(f64, f64)]) -> String {
    let places: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
    places.join(" ")
}

fn ticks(page: &mut String, x: &Axis, y: &Axis) {
    for tick in x.ticks() {
        let _ = writeln!(page, "<span class=\"tick-x\" style=\"left:{:.2}%\">{tick}</span>", x.place(tick));
    }
    for tick in y.ticks() {
        let _ = writeln!(page, "<span class=\"tick-y\" style=\"top:{:.2}%\">{}</span>", y.place(tick), raised(tick));
    }
}

/// A power of `10` with its exponent raised, as [`power`](super::axis::power) has it for SVG.
fn raised(tick: f64) -> String {
    let (factor, exponent) = parts(tick);
    let raised = format!("10<sup>{}</sup>", exponent.to_string().replace('-', "\u{2212}"));
    if factor == 1.0 { raised } else { format!("{factor}\u{b7}{raised}") }
}

/// The marker of a way with its bar, its ring, its label, and what a pointer or the keyboard shows of it.
fn mark(page: &mut String, point: &Point<'_>, label: Option<usize>) {
    let Point { way, number, model, shape, at: (x, y), spread: [low, high] } = point;
    let west = if *x > 45.0 { " west" } else { "" };
    let north = if *y > 50.0 { " north" } else { "" };
    let ring = if way.pareto { " ring" } else { "" };
    let shift = if model % 2 == 0 { -3 } else { 3 };
    let title = escape(&way.title());
    let _ = writeln!(
        page,
        "<span class=\"spread model-{model}\" style=\"left:{low:.2}%;width:{:.2}%;top:calc({y:.2}% + {shift}px)\"></span>\
         <div class=\"point model-{model}{west}{north}\" style=\"left:{x:.2}%;top:{y:.2}%\">\
         <button type=\"button\" class=\"dot{ring}\" aria-describedby=\"tip-{number}\" aria-label=\"{title}\">\
         <svg viewBox=\"-9 -9 18 18\" aria-hidden=\"true\">{}</svg></button>{}\
         <div class=\"tip\" role=\"tooltip\" id=\"tip-{number}\"><strong>{title}</strong><br>time {:.2} ({:.2}\u{2013}{:.2})<br>\
         RMSE {:.1e}, max {:.1e}<br><a href=\"#way-{number}\">its picture</a></div></div>",
        high - low,
        marker(*shape, 0.0, 0.0),
        label.and_then(|side| way.tessellation.map(|mesh| label_at(side, mesh))).unwrap_or_default(),
        way.ratio.median,
        way.ratio.interval[0],
        way.ratio.interval[1],
        way.error.rmse,
        way.error.max_abs,
    );
}

/// The size of the plot on the narrowest page, and the height and the width of a letter of a label, in pixels.
const NARROW: (f64, f64) = (250.0, 380.0);
const LETTER: (f64, f64) = (7.4, 15.0);

/// A place or a size, in pixels.
type Pair = (f64, f64);

/// The sides of a point on which its label may be: the offset of its center, in label sizes, and the gap in pixels.
const SIDES: [(Pair, Pair, &str); 6] = [
    ((0.5, 0.0), (13.0, 0.0), "e"),
    ((-0.5, 0.0), (-13.0, 0.0), "w"),
    ((0.0, -0.5), (0.0, -13.0), "n"),
    ((0.0, 0.5), (0.0, 13.0), "s"),
    ((0.5, -0.5), (10.0, -8.0), "ne"),
    ((0.5, 0.5), (10.0, 8.0), "se"),
];

/// The side of the label of each point, so that no label covers a mark or another label, even on the narrowest page. A
/// point without room has none: its tooltip and the table say the same.
fn labels(points: &[Point<'_>]) -> Vec<Option<usize>> {
    let place = |point: &Point<'_>| (point.at.0 / 100.0 * NARROW.0, point.at.1 / 100.0 * NARROW.1);
    // Boxes: center, half of the size.
    let mut taken: Vec<(Pair, Pair)> = points.iter().map(|point| (place(point), (11.0, 11.0))).collect();
    let mut found = Vec::with_capacity(points.len());
    for (index, point) in points.iter().enumerate() {
        let Some([segments, rings]) = point.way.tessellation else {
            found.push(None);
            continue;
        };
        let letters = format!("{segments}x{rings}").len() as f64;
        let half = (0.5 * letters * LETTER.0, 0.5 * LETTER.1);
        let (x, y) = place(point);
        let free = SIDES.iter().position(|((dx, dy), (gap_x, gap_y), _)| {
            let center = (x + gap_x + dx * 2.0 * half.0, y + gap_y + dy * 2.0 * half.1);
            let inside = center.0 - half.0 >= 0.0
                && center.0 + half.0 <= NARROW.0
                && center.1 - half.1 >= 0.0
                && center.1 + half.1 <= NARROW.1;
            let clear = |(number, (other, size)): (usize, &(Pair, Pair))| {
                number == index
                    || (center.0 - other.0).abs() >= half.0 + size.0
                    || (center.1 - other.1).abs() >= half.1 + size.1
            };
            let is_free = inside && taken.iter().enumerate().all(clear);
            if is_free {
                taken.push((center, half));
            }
            is_free
        });
        found.push(free);
    }
    found
}

fn label_at(side: usize, [segments, rings]: [u32; 2]) -> String {
    let name = SIDES.get(side).map_or("e", |side| side.2);
    format!("<span class=\"label at-{name}\">{segments}\u{d7}{rings}</span>")
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

#[cfg(test)]
mod tests {
    use super::*;

    fn point(way: &Way, at: (f64, f64)) -> Point<'_> {
        Point { way, number: 0, model: 0, shape: 0, at, spread: [at.0, at.0] }
    }

    #[test]
    fn labels_take_different_sides_or_none() {
        let report = super::super::page::tests::example();
        let way = &report.ways[0];
        assert!(way.tessellation.is_some());
        // Alone, on the right edge, and in a crowd.
        assert_eq!(labels(&[point(way, (50.0, 50.0))]), [Some(0)]);
        assert_eq!(labels(&[point(way, (99.0, 50.0))]), [Some(1)]);
        let crowd: Vec<Point<'_>> = (0..30).map(|_| point(way, (50.0, 50.0))).collect();
        assert!(labels(&crowd).iter().flatten().count() <= SIDES.len());
        let row = labels(&[point(way, (50.0, 50.0)), point(way, (60.0, 50.0))]);
        assert_eq!(row, [Some(1), Some(0)], "the second mark is where the first label would be");
    }
}
