//! [`chart`]: the largest error over the values of the only parameter, as SVG.
//!
//! *In:* the points of a series, the bound, the width. *Out:* SVG. *Holds:* the error's axis is logarithmic, the value's is so if
//! the values span three decades; an error of 0 is drawn at the foot, hollow, a picture that is not finite at the top, as a
//! cross. No color is written here.

use super::series::{Point, Series};
use super::words::number;
use glisten_page::axis::{Axis, power};
use glisten_page::escape;
use std::fmt::Write as _;

/// The least error that the axis shows.
const LEAST: f64 = 1e-9;

/// The size and margins of a chart.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    width: f64,
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// For windows of some width: wide ones, tablets, telephones. Text is drawn at about its size.
pub(super) const FRAMES: [(&str, Frame); 3] = [
    ("wide", Frame { width: 860.0, height: 320.0, left: 72.0, right: 20.0, top: 22.0, bottom: 54.0 }),
    ("middle", Frame { width: 540.0, height: 300.0, left: 58.0, right: 16.0, top: 22.0, bottom: 54.0 }),
    ("narrow", Frame { width: 300.0, height: 260.0, left: 46.0, right: 12.0, top: 22.0, bottom: 52.0 }),
];

/// The axis of the values.
enum Values {
    Logarithmic(Axis),
    Even { low: f64, high: f64, from: f64, to: f64 },
}

impl Values {
    fn over(values: &[f64], from: f64, to: f64) -> Self {
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(*value), high.max(*value)));
        if low > 0.0 && high / low >= 1e3 {
            return Self::Logarithmic(Axis::over(values.iter().copied(), 0.0, from, to));
        }
        let margin = ((high / 2.0 - low / 2.0) * 0.06).max(f64::MIN_POSITIVE);
        Self::Even { low: (low - margin).max(f64::MIN), high: (high + margin).min(f64::MAX), from, to }
    }

    fn place(&self, value: f64) -> f64 {
        match self {
            Self::Logarithmic(axis) => axis.place(value),
            Self::Even { low, high, from, to } => {
                // Halves, because the difference may overflow.
                let share = (value / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0);
                from + if share.is_finite() { share } else { 0.5 } * (to - from)
            }
        }
    }

    fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match self {
            Self::Logarithmic(axis) => {
                thinned(axis.ticks(), most).into_iter().map(|tick| (tick, power(tick))).collect()
            }
            Self::Even { low, high, .. } => {
                even(*low, *high, most).into_iter().map(|tick| (tick, number(tick))).collect()
            }
        }
    }
}

/// At most `most` of the ticks, evenly.
fn thinned(ticks: Vec<f64>, most: usize) -> Vec<f64> {
    let step = ticks.len().div_ceil(most.max(1)).max(1);
    ticks.into_iter().step_by(step).collect()
}

/// Multiples of 1, 2 or 5 times a power of ten between the ends.
fn even(low: f64, high: f64, most: usize) -> Vec<f64> {
    let rough = (high / most as f64) - (low / most as f64);
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= rough);
    let Some(step) = step.filter(|step| step.is_finite() && *step > 0.0) else { return Vec::new() };
    let first = (low / step).ceil();
    // Zero has no sign.
    (0..=most).map(|index| (first + index as f64) * step + 0.0).take_while(|tick| *tick <= high).collect()
}

/// The chart, if the series has one parameter.
pub(super) fn chart(series: &Series, bound: f64, frame: Frame) -> Option<String> {
    let points: Vec<(usize, &Point, f64)> = series
        .points
        .iter()
        .enumerate()
        .map(|(index, point)| Some((index, point, point.at?)))
        .collect::<Option<_>>()?;
    if points.len() < 2 {
        return None;
    }
    let name = series.points.first()?.inputs.first()?.0.as_str();
    let values: Vec<f64> = points.iter().map(|(_, _, at)| *at).collect();
    let x = Values::over(&values, frame.left, frame.width - frame.right);
    let errors = points.iter().map(|(_, point, _)| point.max_abs.max(LEAST)).chain([bound]);
    let y = Axis::over(errors, 0.2, frame.height - frame.bottom, frame.top + 12.0);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"The largest error over {}\" class=\"plot\">\n",
        frame.width,
        frame.height,
        escape(name)
    );
    axes(&mut svg, &x, &y, name, frame);
    accepted(&mut svg, &y, bound, frame);
    let places: Vec<(f64, f64)> =
        points.iter().map(|(_, point, at)| (x.place(*at), y.place(point.max_abs.max(LEAST)))).collect();
    let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<polyline class=\"curve\" points=\"{}\"/>", path.join(" "));
    for ((index, point, _), place) in points.iter().zip(&places) {
        mark(&mut svg, series, (*index, point), *place, frame);
    }
    svg.push_str("</svg>\n");
    Some(svg)
}

fn axes(svg: &mut String, x: &Values, y: &Axis, name: &str, frame: Frame) {
    let (foot, right) = (frame.height - frame.bottom, frame.width - frame.right);
    for (tick, text) in x.ticks(((right - frame.left) / 76.0) as usize) {
        let place = x.place(tick);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{place:.1}\" y1=\"{top}\" x2=\"{place:.1}\" y2=\"{foot}\"/>\
             <text x=\"{place:.1}\" y=\"{label}\" text-anchor=\"middle\">{text}</text>",
            top = frame.top + 6.0,
            label = foot + 19.0,
        );
    }
    for tick in thinned(y.ticks(), 6) {
        let place = y.place(tick);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{left}\" y1=\"{place:.1}\" x2=\"{right}\" y2=\"{place:.1}\"/>\
             <text x=\"{label}\" y=\"{baseline:.1}\" text-anchor=\"end\">{text}</text>",
            left = frame.left,
            label = frame.left - 8.0,
            baseline = place + 4.0,
            text = power(tick),
        );
    }
    let shown: String = name.chars().take(36).collect();
    let _ = writeln!(
        svg,
        "<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{} \u{2192}</text>\
         <text class=\"axis\" x=\"{}\" y=\"12\">\u{2191} largest error</text>",
        right,
        frame.height - 8.0,
        escape(&shown),
        8.0,
    );
}

/// The line of the bound, with its name where the curve is not.
fn accepted(svg: &mut String, y: &Axis, bound: f64, frame: Frame) {
    let place = y.place(bound);
    let _ = writeln!(
        svg,
        "<line class=\"bound\" x1=\"{}\" y1=\"{place:.1}\" x2=\"{}\" y2=\"{place:.1}\"/>\
         <text class=\"bound\" x=\"{}\" y=\"12\" text-anchor=\"end\">- - accepted: {}</text>",
        frame.left,
        frame.width - frame.right,
        frame.width - frame.right,
        number(bound),
    );
}

fn mark(svg: &mut String, series: &Series, (index, point): (usize, &Point), (x, y): (f64, f64), frame: Frame) {
    let class = match () {
        () if index == series.worst => "mark worst",
        () if point.max_abs == 0.0 => "mark none",
        () => "mark",
    };
    let title = title(point);
    let shown = if point.pictures.is_some() { format!(" data-point=\"{index}\"") } else { String::new() };
    let _ = writeln!(
        svg,
        "<g class=\"at\"{shown}><title>{}</title><circle class=\"halo\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\"/>\
         <circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{}\"/></g>",
        escape(&title),
        if series.points.len() > 64 { 2.5 } else { 4.0 },
    );
    if point.non_finite_pixels > 0 {
        let (left, right, top, foot) = (x - 4.0, x + 4.0, frame.top + 2.0, frame.top + 10.0);
        let _ = writeln!(
            svg,
            "<path class=\"lost\" d=\"M{left:.1} {top:.1}L{right:.1} {foot:.1}M{left:.1} {foot:.1}L{right:.1} {top:.1}\"/>"
        );
    }
}

/// A point in words.
pub(super) fn title(point: &Point) -> String {
    let inputs: Vec<String> = point.inputs.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let lost = match point.non_finite_pixels {
        0 => String::new(),
        count => format!(", {}", super::words::count(count, "pixel not finite", "pixels not finite")),
    };
    let inputs = if inputs.is_empty() { "as it is".to_owned() } else { inputs.join(", ") };
    format!("{inputs}: largest error {}{lost}", number(point.max_abs))
}

#[cfg(test)]
mod tests {
    use super::{Values, even};

    #[test]
    fn even_ticks_are_round() {
        assert_eq!(even(-0.03, 1.03, 7), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert!(even(0.0, 0.0, 7).is_empty());
        assert!(even(-f64::MAX, f64::MAX, 7).len() <= 8);
    }

    #[test]
    fn every_value_has_a_place() {
        for values in [[0.0, 0.0], [-f64::MAX, f64::MAX], [1e-300, 1e300], [5.0, 5.0], [0.0, 1e-320]] {
            let axis = Values::over(&values, 0.0, 100.0);
            for value in values {
                assert!(axis.place(value).is_finite(), "{values:?}");
            }
        }
    }
}
