//! The report as one HTML page that needs no other file.
//!
//! ```text
//!  report ──► facts    the head: adapter, rounds, control, margin
//!         ──► columns  the table of figures, with the help of each column
//!         ──► album    the pictures, each embedded once ◄── differences, bands
//!         ──► data     all figures, profiles and programs as JSON for the script
//! ```
//!
//! *Holds:* everything from a scene or a shader is escaped. Without the script there are all pictures, the table, a plot and
//! the facts; the script adds the choice of axes, of a variant, of views, and the order of the table.

mod album;
mod bands;
mod columns;
mod data;
mod differences;
mod facts;

use super::model::{Report, Truth, Way};
use super::plot::{self, COLORS};
use album::Album;
use differences::Scale;
use glisten_page::made::Made;
use glisten_page::words::{fixed, grouped, interval, mesh, percent, scientific};
use glisten_page::{Page, Place, View, escape, raster, viewer};
use minijinja::{Value, context};
use std::collections::BTreeSet;
use std::fmt::Write as _;

const PAGE: Page = Page {
    templates: &[("report.html", include_str!("page.html"))],
    styles: &[include_str!("page.css"), include_str!("plot.css"), include_str!("stage.css")],
    scripts: &[
        include_str!("script/data.js"),
        include_str!("script/axes.js"),
        include_str!("script/labels.js"),
        include_str!("script/plot.js"),
        include_str!("script/panel.js"),
        include_str!("script/stage.js"),
        include_str!("script/profile.js"),
        include_str!("script/table.js"),
    ],
};

/// The page.
///
/// # Errors
/// The error of the template engine, which only a broken template causes.
pub(super) fn page(report: &Report, made: &Made) -> Result<String, minijinja::Error> {
    let scale = Scale::of(report.ways.iter().flat_map(|way| way.difference.iter().flatten().copied()));
    let album = Album::of(report, scale);
    let size = report.size.map(|side| side.div_ceil(album.factor.max(1)));
    let mut images = Images { album: &album, size, seen: BTreeSet::new() };
    let models: Vec<Value> =
        report.truths.iter().enumerate().map(|(index, truth)| model(report, (index, truth), &mut images)).collect();
    let [low, high] = scale.seen();
    let stops: Vec<String> = raster::SCALE.iter().map(|[r, g, b]| format!("rgb({r} {g} {b})")).collect();
    let timing = &report.timing;
    PAGE.render(context! {
        data => Value::from_safe_string(data::data(report, &album, scale)),
        title => report.title.as_ref().unwrap_or(&report.scene),
        viewer => viewer(Some("views"), &stage()),
        common_reference => super::table::common_reference(&report.truths),
        factor => album.factor,
        complete => report.complete,
        facts => facts::facts(report),
        plot => Value::from_safe_string(plot::svg(report)),
        scale => Value::from_safe_string(stops.join(", ")),
        ticks => (low..=high).map(decade).collect::<Vec<_>>(),
        models,
        heads => columns::heads(),
        skipped => columns::skipped(report),
        made => context! { command => &made.command, version => &made.version, date => &made.date },
        baseline => &timing.baseline,
        baseline_ms => fixed(timing.baseline_ms, 3),
        rounds => timing.rounds,
        same_again => fixed(timing.same_again.median, 2),
        same_interval => interval(timing.same_again.interval),
        margin => percent(timing.margin),
        weights => &report.weights,
    })
}

/// The places of the stage, which the script fills.
fn stage() -> [View; 3] {
    let empty = |(place, name)| View::new(place, name, "", None);
    [(Place::First, "variant"), (Place::Second, "reference"), (Place::Third, "difference")].map(empty)
}

/// Gives each picture its data where it is first on the page.
struct Images<'a> {
    album: &'a Album,
    size: [u32; 2],
    seen: BTreeSet<usize>,
}

impl Images<'_> {
    /// Elements for pictures, by their numbers and what they show.
    fn html(&mut self, pictures: &[(usize, String)]) -> Value {
        let mut html = String::new();
        for (index, alt) in pictures {
            let alt = escape(alt);
            let first = self.seen.insert(*index).then(|| self.album.uris.get(*index)).flatten();
            let [width, height] = self.size;
            // Writing to a String cannot fail.
            let _ = match first {
                Some(uri) => write!(
                    html,
                    "<img data-picture=\"{index}\" src=\"{uri}\" width=\"{width}\" height=\"{height}\" loading=\"lazy\" \
                     decoding=\"async\" alt=\"{alt}\">"
                ),
                None => write!(
                    html,
                    "<span class=\"same\" data-picture=\"{index}\" data-alt=\"{alt}\">{alt}: equal to a picture above</span>"
                ),
            };
        }
        Value::from_safe_string(html)
    }
}

fn model(report: &Report, (index, truth): (usize, &Truth), images: &mut Images<'_>) -> Value {
    let members = || report.ways.iter().enumerate().filter(|(_, way)| way.model == truth.model);
    let of_truth = &images.album.truths[index];
    let (picture, bands) = (of_truth.picture, of_truth.bands);
    context! {
        color => index % COLORS,
        name => &truth.model,
        truth => &truth.way,
        truth_mesh => mesh(truth.tessellation),
        pictures => images.html(&[(picture, format!("The reference of {}", truth.model)), (bands, "Its Mach bands".into())]),
        ways => members().map(|(number, way)| self::way((number, way), images)).collect::<Vec<_>>(),
        front => front(&members().map(|(_, way)| way).collect::<Vec<_>>()),
    }
}

fn way((number, way): (usize, &Way), images: &mut Images<'_>) -> Value {
    let of_way = &images.album.ways[number];
    let title = full_title(way);
    let pictures = [
        (of_way.picture, title.clone()),
        (of_way.difference, "Its difference from the reference".into()),
        (of_way.bands, "Its Mach bands".into()),
    ];
    context! {
        number,
        title,
        about => &way.about,
        pareto => way.pareto,
        rmse => scientific(way.error.rmse),
        operations => grouped(way.work.operations),
        ratio => fixed(way.ratio.median, 2),
        pictures => images.html(&pictures),
        cells => columns::cells(way),
    }
}

/// The name, and the mesh if it was tessellated.
fn full_title(way: &Way) -> String {
    match mesh(way.tessellation) {
        Some(mesh) => format!("{}, {mesh}", way.name),
        None => way.name.clone(),
    }
}

/// `10^-3`; 0 as 1.
fn decade(exponent: i32) -> String {
    if exponent == 0 {
        "1".to_owned()
    } else {
        scientific(10f64.powi(exponent)).split('\u{d7}').next_back().unwrap_or("").trim().to_owned()
    }
}

/// The variants of the front by work from the cheapest to the most exact.
fn front(ways: &[&Way]) -> Vec<Value> {
    let mut best: Vec<&&Way> = ways.iter().filter(|way| way.pareto).collect();
    best.sort_by_key(|way| way.work.operations);
    let one = |way: &&Way| {
        context! {
            name => &way.name,
            mesh => mesh(way.tessellation),
            rmse => scientific(way.error.rmse),
            operations => grouped(way.work.operations),
        }
    };
    best.into_iter().map(one).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::figures::compare;
    use super::super::front::mark;
    use super::super::model::{Adapter, Ended, Figures, Machine, OnFront, Spread, Timing, Work};
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
            encode: Transfer::Linear.into(),
        };
        Arc::new(Scene { name: "none".into(), framebuffer, draws: Vec::new() })
    }

    /// A variant with this error and this number of operations.
    pub(crate) fn way(model: &str, rmse: f64, operations: u64) -> Way {
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
            floats: glisten_emit::FloatWidth::Single,
            times: Vec::new(),
            scene: no_scene(),
            programs: None,
            picture: picture(1.0),
            difference,
        }
    }

    pub(crate) fn example() -> Report {
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
            title: None,
            size: [64, 64],
            encode: Transfer::Linear.into(),
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
                empty_ms: 0.1,
                rounds: 15,
                seed: 1,
                ended: Ended::Narrow,
                same_again: Spread { median: 1.01, low: 0.99, high: 1.02, interval: [0.995, 1.015] },
                margin: 0.1,
            },
            ways,
        }
    }

    fn example_page() -> (Report, String) {
        let report = example();
        let made = Made::new(&["report".to_owned(), "<a>.toml".to_owned()], 86_400);
        let page = page(&report, &made).expect("the template is good");
        (report, page)
    }

    #[test]
    fn the_page_is_whole_and_alone() {
        let (report, page) = example_page();
        for told in [
            "glisten report &#x27;&lt;a&gt;.toml&#x27;",
            "1970-01-02",
            env!("CARGO_PKG_VERSION"),
            "A&#x2f;A control",
            "Mesa",
        ] {
            assert!(page.contains(told), "{told}");
        }
        // Every variant has a card, a row, and a point in the plot.
        for number in 0..report.ways.len() {
            for part in
                [format!("href=\"#way-{number}\""), format!("id=\"way-{number}\""), format!("id=\"row-{number}\"")]
            {
                assert_eq!(page.matches(&part).count().min(1), 1, "{part}");
            }
        }
        assert!(page.contains("sphere &lt;&amp;&gt;: error"), "the scene's name is escaped");
        for outside in ["http://", "https://", "src=\"/", "<link", "@import", "fetch(", "XMLHttpRequest"] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn every_picture_is_embedded_once() {
        let (report, page) = example_page();
        let uris: Vec<&str> = page.split("src=\"data:").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let different: BTreeSet<&&str> = uris.iter().collect();
        assert_eq!(different.len(), uris.len());
        assert_eq!(page.matches("data:image/png;base64,").count(), uris.len());
        // Three pictures a variant, and two a reference, some of them equal.
        assert_eq!(page.matches("data-picture=\"").count(), 3 * report.ways.len() + 2 * report.truths.len());
    }

    #[test]
    fn an_ended_report_says_so() {
        let (_, page) = example_page();
        assert!(!page.contains("class=\"banner\""));
        let mut report = example();
        report.complete = false;
        let page = super::page(&report, &Made::default()).expect("the template is good");
        assert!(page.contains("class=\"banner\""));
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
    fn decades_for_people() {
        assert_eq!([decade(-3), decade(0), decade(-7)], ["10\u{207b}\u{b3}", "1", "10\u{207b}\u{2077}"]);
    }
}
