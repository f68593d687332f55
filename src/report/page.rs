//! The report as one HTML page that needs no other file.

use super::model::{Figures, Report, Truth, Way};
use super::raster::Decades;
use super::{plot, raster};
use crate::made::Made;
use minijinja::{Environment, Value, context};

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// The page.
///
/// # Errors
/// The error of the template engine, which only a broken template causes.
pub(super) fn page(report: &Report, made: &Made) -> Result<String, minijinja::Error> {
    let scale = scale(report);
    let mut environment = Environment::new();
    environment.add_template("page.html", TEMPLATE)?;
    let models: Vec<Value> =
        report.truths.iter().enumerate().map(|(index, truth)| model(report, index, truth, scale)).collect();
    let stops: Vec<String> = raster::SCALE.iter().map(|[r, g, b]| format!("rgb({r} {g} {b})")).collect();
    environment.get_template("page.html")?.render(context! {
        style => Value::from_safe_string(STYLE.into()),
        scene => &report.scene,
        width => report.size[0],
        height => report.size[1],
        adapter => &report.adapter.name,
        driver => &report.adapter.driver,
        via => report.via,
        plot => Value::from_safe_string(plot::html(report)),
        scale => Value::from_safe_string(stops.join(", ")),
        ticks => (scale.low..=scale.high).map(decade).collect::<Vec<_>>(),
        made => context! { command => &made.command, version => &made.version, date => &made.date },
        models,
        baseline => &report.timing.baseline,
        baseline_ms => figure(report.timing.baseline_ms, 3),
        rounds => report.timing.rounds,
        same_again => ratio(report.timing.same_again.median),
        same_low => ratio(report.timing.same_again.interval[0]),
        same_high => ratio(report.timing.same_again.interval[1]),
        complete => report.complete,
        weights => &report.weights,
        margin => format!("{:.0}", report.timing.margin * 100.0),
        cpu => report.machine.cpu.as_deref().unwrap_or("unknown CPU"),
        threads => report.machine.threads,
        load => report.machine.load,
    })
}

fn model(report: &Report, index: usize, truth: &Truth, scale: Decades) -> Value {
    let numbered = || report.ways.iter().enumerate().filter(|(_, way)| way.model == truth.model);
    let members: Vec<&Way> = numbered().map(|(_, way)| way).collect();
    let names = plot::names(&members);
    let ways: Vec<Value> = numbered()
        .map(|(number, way)| {
            let shape = names.iter().position(|name| *name == way.name).unwrap_or(0);
            row(report, (number, way), shape, scale)
        })
        .collect();
    let front: Vec<Value> = front(&members);
    // One row per way, if every way is drawn at the same number of tessellations.
    let columns = (ways.len() / names.len().max(1)).clamp(1, 4);
    context! {
        index,
        columns,
        name => &truth.model,
        truth => &truth.way,
        truth_mesh => mesh(truth.tessellation),
        truth_picture => Value::from_safe_string(raster::color_uri(&truth.picture, report.encode)),
        ways,
        front,
    }
}

fn row(report: &Report, (number, way): (usize, &Way), shape: usize, scale: Decades) -> Value {
    let [width, height] = report.size;
    let mark = format!("<svg viewBox=\"-9 -9 18 18\" class=\"key\">{}</svg>", plot::marker(shape, 0.0, 0.0));
    context! {
        number,
        mark => Value::from_safe_string(mark),
        name => &way.name,
        mesh => mesh(way.tessellation),
        max_abs => scientific(way.error.max_abs),
        rmse => scientific(way.error.rmse),
        psnr => decibels(&way.error),
        rounding => scientific(way.rounding.max_abs),
        silhouette => way.error.coverage_mismatch,
        non_finite => way.error.non_finite,
        vertices => grouped(way.vertices),
        fragments => way.fragments.map_or_else(|| "\u{2013}".to_owned(), grouped),
        milliseconds => figure(way.milliseconds, 3),
        ratio => ratio(way.ratio.median),
        low => ratio(way.ratio.interval[0]),
        high => ratio(way.ratio.interval[1]),
        operations => grouped(way.work.operations),
        lookups => grouped(way.work.texture_lookups),
        max_ulp => scientific(way.error.max_ulp),
        flip => way.error.flip.map_or_else(|| "\u{2013}".to_owned(), scientific),
        pareto => way.pareto,
        pareto_time => way.pareto_time.name(),
        picture => Value::from_safe_string(raster::color_uri(&way.picture, report.encode)),
        difference => Value::from_safe_string(raster::difference_uri(&way.difference, width, height, scale)),
    }
}

/// The scale for the differences of all ways, so that their colors mean the same.
fn scale(report: &Report) -> Decades {
    Decades::of(report.ways.iter().flat_map(|way| way.difference.iter().flatten().copied()))
}

/// `10^-3`; 0 as 1.
fn decade(exponent: i32) -> String {
    if exponent == 0 {
        "1".to_owned()
    } else {
        scientific(10f64.powi(exponent)).split('\u{d7}').next_back().unwrap_or("").trim().to_owned()
    }
}

/// The ways of the front by work from the cheapest to the most exact, for the sentence above the pictures.
fn front(ways: &[&Way]) -> Vec<Value> {
    let mut best: Vec<&&Way> = ways.iter().filter(|way| way.pareto).collect();
    best.sort_by_key(|way| way.work.operations);
    best.into_iter()
        .map(|way| {
            context! {
                name => &way.name,
                mesh => mesh(way.tessellation),
                rmse => scientific(way.error.rmse),
                ratio => ratio(way.ratio.median),
            }
        })
        .collect()
}

fn mesh(tessellation: Option<[u32; 2]>) -> Option<String> {
    tessellation.map(|[segments, rings]| format!("{segments} \u{d7} {rings}"))
}

fn ratio(value: f64) -> String {
    figure(value, 2)
}

/// A figure, if it was measured.
fn figure(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { "\u{2013}".into() }
}

fn decibels(figures: &Figures) -> String {
    figures.psnr.map_or_else(|| "\u{221e}".into(), |psnr| format!("{psnr:.1}"))
}

/// `1.2e-3` as `1.2 x 10^-3` in typographic characters; 0 as 0.
pub(crate) fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let text = format!("{value:.1e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let raised: String = exponent
        .chars()
        .filter_map(|sign| match sign {
            '-' => Some('\u{207b}'),
            '1' => Some('\u{b9}'),
            '2' => Some('\u{b2}'),
            '3' => Some('\u{b3}'),
            digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)),
        })
        .collect();
    format!("{mantissa}\u{202f}\u{d7}\u{202f}10{raised}")
}

/// The digits in groups of three.
pub(crate) fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
pub(in crate::report) mod tests {
    use super::super::figures::compare;
    use super::super::front::mark;
    use super::super::model::{Adapter, Ended, Machine, OnFront, Spread, Timing, Work};
    use super::*;
    use glisten_scene::picture::{Picture, Transfer};
    use glisten_scene::{Format, Framebuffer, Scene};
    use std::sync::Arc;

    fn picture(level: f64) -> Picture {
        let side = 64;
        let inside = |i: usize| ((i % side) as f64 - 32.0).hypot((i / side) as f64 - 32.0) < 26.0;
        let shade = |i: usize| if inside(i) { [level * (i % side) as f64 / 64.0, level, 0.3, 1.0] } else { [0.0; 4] };
        Picture {
            covered: (0..side * side).map(inside).collect(),
            ..Picture::of_colors(64, 64, (0..side * side).map(shade).collect())
        }
    }

    fn no_scene() -> Arc<Scene> {
        let framebuffer = Framebuffer {
            width: 64,
            height: 64,
            clear: [0.0; 4],
            format: Format::Rgba32Float,
            attachments: 1,
            encode: Transfer::Linear,
        };
        Arc::new(Scene { name: "none".into(), framebuffer, draws: Vec::new() })
    }

    /// A way with this error and this number of operations.
    pub(in crate::report) fn way(model: &str, rmse: f64, operations: u64) -> Way {
        let (error, difference) = compare(&picture(1.0), &picture(1.0));
        Way {
            name: model.into(),
            kind: "declared",
            about: String::new(),
            model: model.into(),
            tessellation: None,
            vertices: 3,
            fragments: Some(2124),
            work: Work { vertices: 3, fragments: 2124, operations, texture_lookups: 0 },
            rounding: Figures { max_abs: 3e-6, ..error },
            error: Figures { rmse, flip: Some(rmse / 2.0), ..error },
            milliseconds: 1.0,
            ratio: Spread { median: 1.0, low: 0.97, high: 1.05, interval: [0.98, 1.02] },
            pareto: false,
            pareto_time: OnFront::Open,
            via: "spirv",
            times: Vec::new(),
            scene: no_scene(),
            programs: None,
            picture: picture(1.0),
            difference,
        }
    }

    pub(in crate::report) fn example() -> Report {
        let mut ways = Vec::new();
        for model in ["Phong", "Blinn-Phong"] {
            for (stage, base_error, base_time) in [("per fragment", 2e-3, 1.4), ("per vertex", 0.2, 1.0)] {
                for (level, factor) in [(16, 1.0), (32, 4.0), (64, 16.0)] {
                    let error = base_error / factor;
                    let median = base_time + factor / 10.0;
                    let picture = picture(1.0 - error);
                    let (error, difference) = compare(&picture, &self::picture(1.0));
                    let interval = [median * 0.98, median * 1.02];
                    ways.push(Way {
                        name: format!("{model} {stage}"),
                        tessellation: Some([level, level / 2]),
                        vertices: u64::from(level * level * 3),
                        error,
                        milliseconds: median * 0.7,
                        ratio: Spread { median, low: median * 0.97, high: median * 1.05, interval },
                        times: vec![median; 40],
                        picture,
                        difference,
                        ..way(model, 0.0, u64::from(level) * 1000)
                    });
                }
            }
        }
        mark(&mut ways, &[], 0.1);
        let truth = |model: &str| Truth {
            model: model.into(),
            way: format!("{model} per fragment"),
            tessellation: Some([256, 128]),
            precision: "f64",
            picture: picture(1.0),
        };
        Report {
            scene: "sphere <&>".into(),
            size: [64, 64],
            encode: Transfer::Linear,
            complete: true,
            version: env!("CARGO_PKG_VERSION"),
            machine: Machine { cpu: Some("a CPU".into()), threads: 2, load: Some(0.5) },
            weights: "operations".into(),
            skipped: Vec::new(),
            adapter: Adapter { name: "llvmpipe".into(), driver: "Mesa".into() },
            via: "spirv",
            truths: vec![truth("Phong"), truth("Blinn-Phong")],
            timing: Timing {
                baseline: ways[0].title(),
                baseline_ms: 1.05,
                rounds: 15,
                seed: 1,
                ended: Ended::Narrow,
                same_again: Spread { median: 1.01, low: 0.99, high: 1.02, interval: [0.995, 1.015] },
                margin: 0.1,
            },
            ways,
        }
    }

    #[test]
    fn the_page_is_whole_and_alone() {
        let report = example();
        let made = Made::new(&["report".to_owned(), "<a>.toml".to_owned()], 86_400);
        let page = page(&report, &made).expect("the template is good");
        for told in
            ["glisten report &#x27;&lt;a&gt;.toml&#x27;", "1970-01-02", env!("CARGO_PKG_VERSION"), "driver Mesa"]
        {
            assert!(page.contains(told), "{told}");
        }
        // Every point of the plot leads to a card.
        for number in 0..report.ways.len() {
            assert!(
                page.contains(&format!("href=\"#way-{number}\"")) && page.contains(&format!("id=\"way-{number}\""))
            );
        }
        assert!(page.contains("sphere &lt;&amp;&gt;: error against run time"), "the scene's name is escaped");
        // One truth per model; a picture and its difference per way.
        assert_eq!(page.matches("<img src=\"data:image/png;base64,").count(), 2 + 2 * report.ways.len());
        assert_eq!(page.matches("<tr class=\"model-").count(), report.ways.len());
        for outside in ["http://", "https://", "src=\"/", "<link", "@import"] {
            assert!(!page.contains(outside), "{outside}");
        }
        let rings = page.matches("class=\"dot ring\"").count();
        assert_eq!(rings, report.ways.iter().filter(|way| way.pareto).count());
    }

    #[test]
    fn the_table_has_a_line_a_way() {
        let report = example();
        let table = super::super::table::table(&report);
        for way in &report.ways {
            assert!(table.contains(&way.title()), "{table}");
        }
    }

    #[test]
    fn numbers_for_people() {
        assert_eq!(scientific(1.25e-13), "1.2\u{202f}\u{d7}\u{202f}10\u{207b}\u{b9}\u{b3}");
        assert_eq!(scientific(0.0), "0");
        assert_eq!([decade(-3), decade(0), decade(-7)], ["10\u{207b}\u{b3}", "1", "10\u{207b}\u{2077}"]);
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(grouped(12), "12");
    }
}
