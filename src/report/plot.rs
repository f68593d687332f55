//! The plot of error against time as SVG. Both axes are logarithmic; each way is a line through its tessellations;
//! the Pareto front of each model is ringed and joined.
//!
//! *Holds:* no color is written here; the page's style sheet sets those of `.model-0`, `.model-1`, ... so that the
//! plot follows its light and dark themes. Points have a `<title>` for the pointer and for assistive tools.

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

/// A logarithmic axis from one end of the plot to the other.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// An axis that covers all values, with a margin on both sides.
    fn over(values: impl Iterator<Item = f64>, margin: f64, from: f64, to: f64) -> Self {
        let logs = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| (low.min(log), high.max(log)));
        if low > high {
            return Self { low: -1.0, high: 1.0, from, to };
        }
        let margin = margin.max((high - low) * 0.08);
        Self { low: low - margin, high: high + margin, from, to }
    }

    fn place(&self, value: f64) -> f64 {
        self.from + (value.log10() - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// Round numbers within the axis: the decades alone if there are many, otherwise few steps in each decade, at
    /// least three ticks in all.
    fn ticks(&self) -> Vec<f64> {
        let decades: &[f64] = &[1.0];
        let finer: [&[f64]; 3] =
            [&[1.0, 2.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0], &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]];
        if self.high - self.low > 2.5 {
            return self.multiples(decades);
        }
        let all = finer.map(|steps| self.multiples(steps));
        let enough = all.iter().position(|ticks| ticks.len() >= 3).unwrap_or(all.len() - 1);
        all.into_iter().nth(enough).unwrap_or_default()
    }

    /// These steps in every decade, within the axis.
    fn multiples(&self, steps: &[f64]) -> Vec<f64> {
        // A division where they are fractions, so that they print exactly.
        let at = |step: f64, decade: i32| {
            if decade < 0 { step / 10f64.powi(-decade) } else { step * 10f64.powi(decade) }
        };
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        decades
            .flat_map(|decade| steps.iter().map(move |step| at(*step, decade)))
            .filter(|tick| (self.low..=self.high).contains(&tick.log10()))
            .collect()
    }
}

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

/// A power of `10` with its exponent raised, and a factor before it if that is not 1.
fn power(tick: f64) -> String {
    let exponent = tick.log10().floor();
    let factor = (tick / 10f64.powf(exponent) * 10.0).round() / 10.0;
    let exponent = exponent.to_string().replace('-', "\u{2212}");
    let raised = format!("10<tspan dy=\"-5\" font-size=\"9.5\">{exponent}</tspan>");
    if factor == 1.0 { raised } else { format!("{factor}\u{b7}{raised}") }
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

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let narrow = Axis::over([1.0, 7.0].into_iter(), 0.06, 0.0, 1.0);
        assert_eq!(narrow.ticks(), [1.0, 2.0, 5.0]);
        let wide = Axis::over([1e-5, 1e-1].into_iter(), 0.0, 0.0, 1.0);
        assert_eq!(wide.ticks().len(), 5);
        let close = Axis::over([0.75, 1.6].into_iter(), 0.0, 0.0, 1.0);
        assert_eq!(close.ticks(), [0.8, 1.0, 1.2, 1.5]);
        assert_eq!(Axis::over([0.55, 0.95].into_iter(), 0.0, 0.0, 1.0).ticks(), [0.6, 0.8]);
        assert_eq!(power(0.0015), power(0.001).replace("10<", "1.5\u{b7}10<"));
    }

    #[test]
    fn an_axis_over_nothing_is_still_an_axis() {
        assert!(Axis::over(std::iter::empty(), 0.1, 0.0, 1.0).place(1.0).is_finite());
        assert!(Axis::over([2.0].into_iter(), 0.1, 0.0, 1.0).place(2.0).is_finite());
    }
}
