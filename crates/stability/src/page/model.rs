//! The values of the page's template.
//!
//! *In:* a [`SceneOnPage`]. *Out:* its values. *Holds:* identifiers are made of the numbers of scene, cause, file and line, never
//! of names.

use super::super::heat::{self, DECADES, NOT_FINITE};
use super::super::{CauseFound, Pair, SpanError, Stability, inputs_at};
use super::SceneOnPage;
use super::chart::{self, chart};
use super::listing::{Loss, Row, Text, listing};
use super::series::{Point, Series};
use super::words::{self, channels, number};
use glisten_page::raster::color_uri;
use glisten_page::{Place, View, viewer};
use glisten_scene::picture::Transfer;
use minijinja::{Value, context};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;

/// The number of pixels whose inputs are read for the causes: each takes a drawing.
const MOST_READ: usize = 8;

/// The number of points in a table.
const MOST_POINTS: usize = 200;

/// The values of a scene.
pub(super) fn scene(number: usize, one: &SceneOnPage<'_>) -> Value {
    let SceneOnPage { findings, examined, bound, .. } = one;
    let (bound, errors) = (*bound, &examined.errors);
    let picture = &findings.picture;
    let id = format!("s{number}");
    let (folder, short) = one.name.rsplit_once('/').map_or((None, one.name), |(folder, short)| (Some(folder), short));
    let texts = listing(one.scene, one.sources, &examined.spans, findings);
    let anchors = anchors(&texts);
    let causes = causes(one, &anchors);
    let files: Vec<Value> = texts.iter().enumerate().map(|(index, text)| file(index + 1, text)).collect();
    let worst = picture.worst.as_ref().map(|worst| {
        let inputs: Vec<Value> = worst.inputs.iter().map(|(name, values)| input(name, values)).collect();
        context! { x => worst.x, y => worst.y, f32 => channels(&worst.f32), exact => channels(&worst.exact), inputs }
    });
    let shown = viewer(None, &views(one, &id));
    context! {
        id,
        name => one.name,
        short,
        folder,
        title => Value::from_safe_string(words::path(one.name)),
        command => &one.command,
        verdict => findings.verdict,
        pill => pill(examined.verdict),
        sentence => words::verdict(findings, examined.verdict, bound, errors.not_finite()),
        largest => words::number(picture.max_abs),
        rmse => words::number(picture.rmse),
        bound => words::number(bound),
        pixels => errors.not_finite(),
        births => findings.non_finite,
        worst,
        reference => findings.exact.as_ref().map(|exact| exact.sentence()),
        viewer => shown,
        is_stable => examined.verdict == Stability::Stable,
        causes,
        files,
        series => one.series.as_ref().map(|series| self::series(series, bound)),
    }
}

type Picture = glisten_scene::picture::Picture;

fn pictures(single: &Picture, exact: &Picture, heat: &Picture) -> Value {
    let uri = |picture| Value::from_safe_string(color_uri(picture, Transfer::Linear));
    context! { width => exact.width, height => exact.height, single => uri(single), exact => uri(exact), heat => uri(heat) }
}

/// The color of a verdict.
pub(super) fn pill(verdict: Stability) -> &'static str {
    match verdict {
        Stability::Stable => "good",
        Stability::Degraded => "fair",
        Stability::Broken => "bad",
    }
}

/// The pictures in f32 and exact, and the map of the errors, on which the causes are marked.
fn views(one: &SceneOnPage<'_>, id: &str) -> [View; 3] {
    let (examined, causes) = (one.examined, &one.findings.causes);
    let size = [examined.exact.width, examined.exact.height];
    let picture = |picture: &Picture| Some((color_uri(picture, Transfer::Linear), size));
    let clipped = if is_clipped(&examined.exact) { ". Colors beyond 0 and 1 are clipped for the screen." } else { "" };
    let mut pins = String::new();
    for (index, cause) in causes.iter().enumerate() {
        let [left, top] = place([cause.at.x, cause.at.y], size);
        let number = index + 1;
        // Writing to a String cannot fail.
        let _ = write!(
            pins,
            "<span class=\"pin\" data-cause=\"{id}-c{number}\" style=\"left:{left}%;top:{top}%\"><b>{number}</b></span>"
        );
    }
    let mut views = [
        View::new(Place::First, "f32", "<strong>f32</strong>, as GPUs compute", picture(&examined.single)),
        View::new(
            Place::Second,
            "exact",
            format!("<strong>Exact</strong>, as the program says{clipped}"),
            picture(&examined.exact),
        ),
        View::new(Place::Third, "error", legend(one.bound), picture(&heat::heat(examined, one.bound))),
    ];
    let parts = [
        ("f32", "The picture in f32"),
        ("exact", "The exact picture"),
        ("heat", "The map of the errors over the exact picture"),
    ];
    for (view, (part, alt)) in views.iter_mut().zip(parts) {
        (view.id, view.alt) = (Some(format!("{id}-{part}")), alt.to_owned());
    }
    views[2].over = pins;
    views
}

/// The place of the middle of a pixel, in percent of width and height.
fn place([x, y]: [u32; 2], [width, height]: [u32; 2]) -> [String; 2] {
    [(x, width), (y, height)].map(|(at, size)| format!("{:.2}", (f64::from(at) + 0.5) / f64::from(size.max(1)) * 100.0))
}

/// Whether the page shows less than the picture has: a screen ends at 1.
fn is_clipped(picture: &Picture) -> bool {
    let pixels = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    pixels.iter().any(|[r, g, b, _]| [r, g, b].into_iter().any(|channel| *channel > 1.0 || *channel < 0.0))
}

/// Where each line is on the page.
type Anchors<'a> = BTreeMap<(&'a str, u32), usize>;

fn anchors(texts: &[Text]) -> Anchors<'_> {
    let files = texts.iter().enumerate();
    files
        .flat_map(|(index, text)| text.rows.iter().map(move |row| ((text.name.as_str(), row.number), index + 1)))
        .collect()
}

fn input(name: &str, values: &[Option<f64>]) -> Value {
    context! { name, values => channels(values) }
}

/// The inputs of a pixel, as values of the template.
type Inputs = BTreeMap<[u32; 2], Vec<Value>>;

fn causes(one: &SceneOnPage<'_>, anchors: &Anchors<'_>) -> Vec<Value> {
    let mut inputs = Inputs::new();
    let causes = one.findings.causes.iter();
    causes
        .map(|cause| {
            let pixel = [cause.at.x, cause.at.y];
            if inputs.len() < MOST_READ {
                inputs.entry(pixel).or_insert_with(|| inputs_of(one, pixel));
            }
            self::cause(one, cause, anchors, inputs.get(&pixel).cloned().unwrap_or_default())
        })
        .collect()
}

/// The values that reach the fragment stage at a pixel. The picture was drawn before, so that drawing cannot fail here.
fn inputs_of(one: &SceneOnPage<'_>, pixel: [u32; 2]) -> Vec<Value> {
    let finite = |value: f64| value.is_finite().then_some(value);
    let found = inputs_at(one.scene, pixel).unwrap_or_default();
    found.iter().map(|(name, values)| input(name, &values.iter().copied().map(finite).collect::<Vec<_>>())).collect()
}

fn cause(one: &SceneOnPage<'_>, cause: &CauseFound, anchors: &Anchors<'_>, inputs: Vec<Value>) -> Value {
    let picture = &one.examined.exact;
    let [left, top] = place([cause.at.x, cause.at.y], [picture.width, picture.height]);
    let index = cause.at.y as usize * picture.width as usize + cause.at.x as usize;
    let color = |picture: &Picture| {
        let pixel = picture.attachments.first().and_then(|pixels| pixels.get(index));
        pixel.map(|color| channels(&color.map(|value| value.is_finite().then_some(value))))
    };
    let short = cause.file.rsplit('/').next().unwrap_or(&cause.file);
    let harm = cause.harm.map(|harm| (harm / one.bound).log10());
    context! {
        kind => cause.kind,
        file => &cause.file,
        short,
        line => cause.line,
        column => cause.column,
        anchor => anchors.get(&(cause.file.as_str(), cause.line)),
        stage => cause.stage,
        message => sentence(&cause.diagnostic.message),
        harm => cause.harm.map(number),
        share => cause.harm.filter(|_| cause.undefined.is_none()).map(|harm| share(harm, one.findings.picture.max_abs)),
        color => harm.map_or_else(|| css(NOT_FINITE), |harm| css(heat::scale(harm))),
        bits => number(cause.lost_bits),
        condition => number(cause.condition),
        non_finite => cause.non_finite,
        disagreements => cause.disagreements,
        ill_posed => cause.ill_posed,
        also => cause.also.iter().map(|start| format!("{}:{}", start.line, start.column)).collect::<Vec<_>>().join(", "),
        x => cause.at.x,
        y => cause.at.y,
        left,
        top,
        single => color(&one.examined.single),
        exact => color(picture),
        inputs,
        help => Value::from_safe_string(words::help(&cause.help)),
    }
}

/// A message as a sentence. The name of the arithmetic stays as it is.
fn sentence(message: &str) -> String {
    let mut rest = message.chars();
    match rest.next() {
        Some(first) if !message.starts_with("f32") => format!("{}{}", first.to_uppercase(), rest.as_str()),
        _ => message.to_owned(),
    }
}

/// How much of the largest error a harm is, in percent.
fn share(harm: f64, error: f64) -> Option<String> {
    (error > 0.0).then(|| format!("{:.0}", (harm / error * 100.0).clamp(0.0, 100.0)))
}

fn css(color: [f64; 3]) -> String {
    let [r, g, b] = color.map(|channel| (channel * 255.0).round() as u8);
    format!("rgb({r} {g} {b})")
}

/// The caption of the map: its colors, and the errors that they stand for.
fn legend(bound: f64) -> String {
    let steps = |count: usize| (0..=count).map(move |step| DECADES * (2.0 * step as f64 / count as f64 - 1.0));
    let stops: Vec<String> = steps(8).map(|decades| css(heat::scale(decades))).collect();
    let error = |decades: f64| number(bound * 10f64.powf(decades));
    let tick = |(index, decades): (usize, f64)| {
        let place = (decades / DECADES + 1.0) * 50.0;
        let (class, remark) = match index {
            2 => (" is-bound", "<br>accepted"),
            1 | 3 => (" inner", ""),
            _ => ("", ""),
        };
        format!("<span class=\"tick{class}\" style=\"--at:{place:.0}%\">{}{remark}</span>", error(decades))
    };
    let ticks: String = steps(4).enumerate().map(tick).collect();
    format!(
        "<strong>Error</strong> over the picture in gray\n<span class=\"legend\" role=\"img\" aria-label=\"Colors from an error of {} \
         (blue) over the accepted {} (yellow) to {} (red)\"><span class=\"ramp\" style=\"background:linear-gradient(to right, {})\"></span>{ticks}\
         </span>\n<span class=\"swatches\"><span><i style=\"background:#3a3a3a\"></i>less, or an edge</span> <span><i style=\"background:{}\">\
         </i>not finite</span></span>",
        error(-DECADES),
        number(bound),
        error(DECADES),
        stops.join(", "),
        css(NOT_FINITE),
    )
}

fn series(series: &Series, bound: f64) -> Value {
    let charts = chart::FRAMES.iter().filter_map(|(class, frame)| {
        let svg = Value::from_safe_string(chart(series, bound, *frame)?);
        Some(context! { class => *class, svg })
    });
    let charts: Vec<Value> = charts.collect();
    // The points of a sweep have the same inputs, the ends of a search have not.
    let names_of = |point: &Point| point.inputs.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let names = series.points.first().map(names_of).unwrap_or_default();
    let names = if series.points.iter().all(|point| names_of(point) == names) { names } else { Vec::new() };
    let points: Vec<Value> =
        series.points.iter().enumerate().map(|(index, point)| self::point(series, index, point, bound)).collect();
    let drawn: Vec<Value> =
        points.iter().zip(&series.points).filter(|(_, it)| it.pictures.is_some()).map(|(it, _)| it.clone()).collect();
    let position = |wanted: usize| {
        let drawn = series.points.iter().enumerate().filter(|(_, point)| point.pictures.is_some());
        drawn.map(|(index, _)| index).position(|index| index == wanted).unwrap_or(0)
    };
    context! {
        charts,
        names,
        rows => points.iter().take(MOST_POINTS).cloned().collect::<Vec<_>>(),
        more => points.len().saturating_sub(MOST_POINTS),
        count => points.len(),
        drawings => series.drawings,
        sound_name => series.sound_name,
        worst => position(series.worst),
        sound_point => points.get(series.soundest).filter(|_| series.worst != series.soundest),
        drawn,
    }
}

fn point(series: &Series, index: usize, point: &Point, bound: f64) -> Value {
    let map = |pair: &Pair| pictures(&pair.single, &pair.exact, &heat::map(&pair.exact, &pair.errors, bound));
    let inputs: Vec<Value> = point.inputs.iter().map(|(name, value)| context! { name, value }).collect();
    context! {
        index,
        inputs,
        title => chart::title(point),
        error => number(point.max_abs),
        pixels => point.non_finite_pixels,
        is_worst => index == series.worst,
        above => point.max_abs > bound || point.non_finite_pixels > 0,
        pictures => point.pictures.as_ref().map(map),
    }
}

fn file(number: usize, text: &Text) -> Value {
    let rows =
        |range: Range<usize>| -> Vec<Value> { text.rows.get(range).unwrap_or_default().iter().map(row).collect() };
    let mut parts: Vec<Value> = Vec::new();
    let mut at = 0;
    for fold in &text.folds {
        parts.push(context! { rows => rows(at..fold.start) });
        let [first, last] = [fold.start, fold.end.saturating_sub(1)].map(|at| text.rows.get(at).map(|row| row.number));
        parts.push(context! { rows => rows(fold.clone()), first, last });
        at = fold.end;
    }
    parts.push(context! { rows => rows(at..text.rows.len()) });
    let short = text.name.rsplit('/').next().unwrap_or(&text.name);
    context! { number, name => Value::from_safe_string(words::path(&text.name)), short, stages => &text.stages, has_causes => text.has_causes, parts }
}

fn row(row: &Row) -> Value {
    let causes: Vec<Value> =
        row.causes.iter().map(|(cause, begins)| context! { number => cause + 1, begins }).collect();
    context! {
        number => row.number,
        code => Value::from_safe_string(row.code.clone()),
        causes,
        loss => row.loss.as_ref().map(loss),
    }
}

/// The width of a bar: a share of 24 bits.
fn bar(bits: f64) -> String {
    format!("{:.3}", (bits / 24.0).clamp(0.0, 1.0))
}

/// How hot a number of lost bits is, from 0 to 4.
fn level(bits: f64) -> usize {
    [1.0, 3.0, 8.0, 16.0].into_iter().filter(|least| bits >= *least).count()
}

fn loss(loss: &Loss) -> Value {
    let expressions: Vec<Value> = loss
        .expressions
        .iter()
        .map(|one| {
            let SpanError {
                lost_bits, mean_lost_bits, error, condition, births, disagreements, kind, evaluations, ..
            } = one.figures;
            context! {
                text => &one.text,
                from_macro => one.from_macro,
                kind => kind.name(),
                bits => format!("{lost_bits:.1}"),
                mean => format!("{mean_lost_bits:.1}"),
                error => number(error),
                condition => if condition > 0.0 { number(condition) } else { String::from("\u{2013}") },
                births,
                disagreements,
                evaluations => glisten_page::words::grouped(evaluations),
            }
        })
        .collect();
    context! {
        bits => format!("{:.1}", loss.bits),
        level => level(loss.bits),
        most => bar(loss.bits),
        mean => bar(loss.mean_bits),
        births => loss.births,
        disagreements => loss.disagreements,
        more => loss.more,
        expressions,
    }
}
