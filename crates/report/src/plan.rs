//! The variants that a scene file asks to compare, each as a scene of its own.
//!
//! *In:* the text of a scene file, with or without a `[report]` table, or the variants that were found by themselves. *Out:*
//! [`Plan`]: for every variant and tessellation a scene, or the text of one, which is drawn exactly as `glisten render` would
//! draw it.
//!
//! ```toml
//! [report]
//! draw = 0                                         # the draw whose keys the variants replace
//! tessellations = [[16, 8], [32, 16], [64, 32]]    # segments and rings of its mesh
//! truth_tessellation = [256, 128]                  # of the mesh of the reference
//! rounds = 40                                      # at most
//!
//! [[report.way]]
//! name = "Phong per fragment"
//! model = "Phong"                                  # variants of one model have one reference
//! truth = true                                     # the f64 picture of this variant is the reference of its model
//! set = { vertex = "phong.vert", fragment = "phong.frag" }    # replaces or adds keys of the draw
//! ```
//!
//! Without the table there is one variant: the scene as it is, with a quarter, a half and all of its mesh's segments and
//! rings. *Holds:* `set` merges tables (`set = { mesh = { radius = 2.0 } }` keeps the other keys of the mesh).

use super::ways::{AS_WRITTEN, FoundTruth, FoundWay};
use glisten_emit::FloatWidth;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{SCENE_SYNTAX, SCENE_WRONG_VALUE};
use glisten_front::hir::Stage;
use glisten_front::source::{SourceMap, Span};
use glisten_gpu::Via;
use glisten_scene::tables::{Reader, SCENE};
use glisten_scene::{Scene, default_tessellation};
use serde::Deserialize;
use std::ops::Range;
use toml::{Table, Value};

/// The variants and references to draw.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// The variants, in the order of the file, coarse to fine.
    pub(super) ways: Vec<PlannedWay>,
    /// The references, one per model, in the order in which models are first named.
    pub(super) truths: Vec<PlannedTruth>,
    /// How often all variants are timed, if the scene says so.
    pub(super) rounds: Option<u32>,
    /// Whether the scene's file declares variants.
    pub(super) declared: bool,
    /// The text of the scene's file without the report's table.
    pub(super) text: String,
}

/// A scene, loaded or not.
#[derive(Clone, Debug)]
pub(super) enum Drawn {
    /// The text of a scene file, at the place of the scene's own.
    Text(WayText),
    /// A scene that is loaded.
    Scene(Box<Scene>),
}

/// A scene's text with the keys of a variant.
#[derive(Clone, Debug)]
pub(super) struct WayText {
    pub(super) text: String,
    /// The name of the variant.
    pub(super) way: String,
    /// Where the scene's file has those keys.
    pub(super) set: Range<usize>,
}

/// A variant to draw.
#[derive(Clone, Debug)]
pub(super) struct PlannedWay {
    pub(super) name: String,
    /// The kind of the variant in a word: `declared` for those of the scene's file.
    pub(super) kind: &'static str,
    /// A sentence on what is done, if there is more to say than the name.
    pub(super) about: String,
    pub(super) model: String,
    pub(super) tessellation: Option<[u32; 2]>,
    pub(super) drawn: Drawn,
    /// The form of the code that this variant needs.
    pub(super) via: Option<Via>,
    /// The width of floats on the GPU.
    pub(super) floats: FloatWidth,
    /// The GLSL texts of each draw, if they are at hand.
    pub(super) programs: Option<Vec<Vec<(Stage, String)>>>,
}

/// The reference of a model.
#[derive(Clone, Debug)]
pub(super) struct PlannedTruth {
    pub(super) model: String,
    pub(super) way: String,
    pub(super) tessellation: Option<[u32; 2]>,
    pub(super) drawn: Drawn,
}

/// The kind of the variants that a scene's file declares.
pub(super) const DECLARED: &str = "declared";

/// The `[report]` table.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReportTable {
    #[serde(default)]
    draw: usize,
    tessellations: Option<Vec<[u32; 2]>>,
    truth_tessellation: Option<[u32; 2]>,
    rounds: Option<u32>,
    #[serde(default)]
    way: Vec<WayTable>,
}

/// A `[[report.way]]` table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WayTable {
    name: String,
    model: Option<String>,
    #[serde(default)]
    truth: bool,
    set: Option<toml::Spanned<Table>>,
}

impl WayTable {
    /// The variant as a text of a scene.
    fn text(&self, text: String) -> WayText {
        WayText { text, way: self.name.clone(), set: self.set.as_ref().map(toml::Spanned::span).unwrap_or_default() }
    }
}

/// A scene file, of which the report itself reads only its own table.
#[derive(Deserialize)]
struct SceneFile {
    report: Option<toml::Spanned<ReportTable>>,
}

/// The keys of the tables.
const KEYS: &[&str] = &["draw", "tessellations", "truth_tessellation", "rounds", "way"];
const WAY_KEYS: &[&str] = &["name", "model", "truth", "set"];
const MOST_ROUNDS: u32 = 1000;
/// How much finer the reference's mesh is than the finest variant's, unless `truth_tessellation` is given.
const TRUTH_FACTOR: u32 = 4;
/// The coarsest mesh that is compared, in segments and rings, of shapes that have as many by default.
const COARSEST: [u32; 2] = [3, 2];

/// The first key of the tables that they do not have.
fn check_keys(text: &str, base: u32) -> Result<(), Box<Diagnostic>> {
    let mut reader = Reader::new(&SCENE, base, text.into());
    let document = reader.document(text);
    if let Some(report) = document.as_ref().and_then(|document| reader.table_at(document, "report")) {
        reader.check_keys(report, "`[report]`", KEYS);
        for (way, _) in reader.tables_at(report, "way") {
            reader.check_keys(way, "`[[report.way]]`", WAY_KEYS);
        }
    }
    reader.diagnostics.into_iter().next().map_or(Ok(()), |first| Err(Box::new(first)))
}

/// Reads the plan of the scene file `name`.
///
/// # Errors
/// One diagnostic at a position in `text`, which `sources` contains from `base` on.
pub(super) fn plan(scene_name: &str, text: &str, base: u32) -> Result<Plan, Box<Diagnostic>> {
    let at = |range: Option<Range<usize>>| {
        range.map_or_else(Span::default, |range| Span::new(base + range.start as u32, base + range.end as u32))
    };
    let syntax = |error: toml::de::Error| {
        let message = error.message().trim().replace('\n', ", ");
        Box::new(Diagnostic::new(&SCENE_SYNTAX, at(error.span()), message).here("here"))
    };
    check_keys(text, base)?;
    let file: SceneFile = toml::from_str(text).map_err(syntax)?;
    let mut scene: Table = toml::from_str(text).map_err(syntax)?;
    scene.remove("report");
    let (span, table) = match file.report {
        Some(report) => (at(Some(report.span())), report.into_inner()),
        None => (Span::default(), ReportTable::default()),
    };
    let wrong = |message: String| Box::new(Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here("in this table"));
    build(scene_name, &scene, table).map_err(wrong)
}

impl Plan {
    /// Adds the variants that were found by themselves, after those that the scene's file declares.
    pub(super) fn add(&mut self, scene: &Scene, found: Vec<FoundWay>) {
        if !self.declared {
            self.ways.clear();
            self.truths.clear();
        }
        for way in found {
            if !self.truths.iter().any(|truth| truth.model == way.model) {
                let truth = way.truth.unwrap_or_else(|| FoundTruth {
                    way: AS_WRITTEN.into(),
                    scene: scene.clone(),
                    tessellation: None,
                });
                self.truths.push(PlannedTruth {
                    model: way.model.clone(),
                    way: truth.way,
                    tessellation: truth.tessellation,
                    drawn: Drawn::Scene(Box::new(truth.scene)),
                });
            }
            self.ways.push(PlannedWay {
                name: way.name,
                kind: way.kind,
                about: way.about,
                model: way.model,
                tessellation: way.tessellation,
                drawn: Drawn::Scene(Box::new(way.scene)),
                via: way.via,
                floats: way.floats,
                programs: way.programs,
            });
        }
    }
}

fn build(scene_name: &str, scene: &Table, report: ReportTable) -> Result<Plan, String> {
    if report.rounds.is_some_and(|rounds| !(3..=MOST_ROUNDS).contains(&rounds)) {
        return Err(format!("`rounds` is 3 to {MOST_ROUNDS}"));
    }
    let draw = scene.get("draw").and_then(Value::as_array).and_then(|draws| draws.get(report.draw));
    let Some(draw) = draw.and_then(Value::as_table) else {
        return Err(format!("the scene has no draw {}; draws count from 0", report.draw));
    };
    let tessellations = tessellations(&report, draw)?;
    let ways = if report.way.is_empty() {
        vec![WayTable { name: scene_name.into(), model: None, truth: true, set: None }]
    } else {
        report.way.clone()
    };
    let text = |way: &WayTable, tessellation| {
        scene_text(scene, report.draw, way, tessellation).map(|text| Drawn::Text(way.text(text)))
    };
    let mut planned = Vec::new();
    for way in &ways {
        for &tessellation in &tessellations {
            planned.push(PlannedWay {
                name: way.name.clone(),
                kind: DECLARED,
                about: String::new(),
                model: model(way),
                tessellation,
                drawn: text(way, tessellation)?,
                via: None,
                floats: FloatWidth::Single,
                programs: None,
            });
        }
    }
    let mut truths: Vec<PlannedTruth> = Vec::new();
    for way in &ways {
        let model = model(way);
        if truths.iter().any(|truth| truth.model == model) {
            continue;
        }
        let truth_way = truth_way(&ways, &model)?;
        let tessellation = finest(&tessellations, report.truth_tessellation);
        truths.push(PlannedTruth {
            model,
            way: truth_way.name.clone(),
            tessellation,
            drawn: text(truth_way, tessellation)?,
        });
    }
    let text = toml::to_string(scene).map_err(|error| format!("the scene cannot be written again: {error}"))?;
    Ok(Plan { ways: planned, truths, rounds: report.rounds, declared: !report.way.is_empty(), text })
}

fn model(way: &WayTable) -> String {
    way.model.clone().unwrap_or_else(|| way.name.clone())
}

/// The variant that is the reference of its model: the one that says so, or the only one.
fn truth_way<'a>(ways: &'a [WayTable], model_name: &str) -> Result<&'a WayTable, String> {
    let members: Vec<&WayTable> = ways.iter().filter(|way| model(way) == model_name).collect();
    let marked: Vec<&WayTable> = members.iter().copied().filter(|way| way.truth).collect();
    match (&members[..], &marked[..]) {
        (_, [truth_way]) => Ok(truth_way),
        ([only], []) => Ok(only),
        (_, []) => Err(format!("no `[[report.way]]` of the model `{model_name}` has `truth = true`")),
        _ => Err(format!("several `[[report.way]]` of the model `{model_name}` have `truth = true`")),
    }
}

/// The tessellations at which every variant is drawn; only `None` if the draw's mesh cannot be tessellated.
fn tessellations(report: &ReportTable, draw: &Table) -> Result<Vec<Option<[u32; 2]>>, String> {
    let shape = draw.get("mesh").and_then(Value::as_table).filter(|mesh| mesh.contains_key("shape"));
    match (&report.tessellations, shape) {
        (Some(list), Some(_)) if !list.is_empty() => Ok(list.iter().copied().map(Some).collect()),
        (Some(_), Some(_)) => Err("`tessellations` is a list of at least one pair of segments and rings".into()),
        (Some(_), None) => Err("`tessellations` needs a draw with a mesh by `shape`".into()),
        (None, None) => Ok(vec![None]),
        (None, Some(mesh)) => Ok(levels(mesh)),
    }
}

/// The mesh of the scene at a quarter, at half and at all of its segments and rings, where that makes a difference.
fn levels(mesh: &Table) -> Vec<Option<[u32; 2]>> {
    let shape = mesh.get("shape").and_then(Value::as_str).unwrap_or("");
    // The scene's loader says what is wrong with a shape that there is not.
    let Some(default) = default_tessellation(shape) else { return vec![None] };
    let counts = [("segments", 0), ("rings", 1)].map(|(key, index): (&str, usize)| {
        let written = mesh.get(key).and_then(Value::as_integer).and_then(|count| u32::try_from(count).ok());
        (written.unwrap_or(default[index]), default[index].min(COARSEST[index]))
    });
    let mut levels: Vec<_> = [4, 2, 1].map(|part| Some(counts.map(|(count, least)| (count / part).max(least)))).into();
    levels.dedup();
    levels
}

/// The mesh of the reference: as asked for, or finer than the finest.
fn finest(tessellations: &[Option<[u32; 2]>], asked: Option<[u32; 2]>) -> Option<[u32; 2]> {
    let finest =
        tessellations.iter().flatten().max_by_key(|[segments, rings]| u64::from(*segments) * u64::from(*rings))?;
    Some(asked.unwrap_or_else(|| finest.map(|n| n.saturating_mul(TRUTH_FACTOR).min(1024))))
}

/// The scene with the keys of a variant and of a tessellation.
fn scene_text(scene: &Table, draw: usize, way: &WayTable, tessellation: Option<[u32; 2]>) -> Result<String, String> {
    let mut scene = scene.clone();
    let table = scene
        .get_mut("draw")
        .and_then(Value::as_array_mut)
        .and_then(|draws| draws.get_mut(draw))
        .and_then(Value::as_table_mut)
        .ok_or("the draw is not a table")?;
    if let Some(set) = &way.set {
        merge(table, set.get_ref());
    }
    if let Some([segments, rings]) = tessellation
        && let Some(mesh) = table.get_mut("mesh").and_then(Value::as_table_mut)
    {
        mesh.insert("segments".into(), Value::Integer(i64::from(segments)));
        mesh.insert("rings".into(), Value::Integer(i64::from(rings)));
    }
    toml::to_string(&scene).map_err(|error| format!("the scene cannot be written again: {error}"))
}

/// Replaces and adds keys; tables are merged, all other values are replaced.
fn merge(into: &mut Table, from: &Table) {
    // TOML's parser limits the nesting, so the recursion is limited as well.
    for (key, value) in from {
        match (into.get_mut(key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => merge(old, new),
            _ => {
                into.insert(key.clone(), value.clone());
            }
        }
    }
}

/// The start of the scene's text among the sources of a loaded scene.
pub(super) fn base_of(sources: &SourceMap, path: &str) -> u32 {
    sources.files().find(|(_, file)| file.name() == path).map_or(0, |(_, file)| file.base())
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: &str = r#"
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
mesh = { shape = "sphere", position = "p", radius = 0.1 }
"#;

    fn planned(report: &str) -> Result<Plan, Box<Diagnostic>> {
        plan("ball", &format!("{BALL}\n{report}"), 0)
    }

    fn text(way: &PlannedWay) -> &str {
        match &way.drawn {
            Drawn::Text(text) => &text.text,
            Drawn::Scene(_) => "",
        }
    }

    #[test]
    fn without_a_table_the_scene_at_three_levels() {
        let plan = planned("").expect("a plan");
        let levels: Vec<_> = plan.ways.iter().map(|way| way.tessellation).collect();
        assert_eq!(levels, [Some([16, 8]), Some([32, 16]), Some([64, 32])]);
        assert_eq!((plan.truths.len(), plan.truths[0].tessellation), (1, Some([256, 128])));
        let text = text(&plan.ways[0]);
        assert!(text.contains("radius = 0.1") && !text.contains("report"));
    }

    #[test]
    fn each_shape_has_levels_of_its_own() {
        let levels = |mesh: &str| {
            let scene = BALL.replace("shape = \"sphere\"", mesh);
            let plan = plan("ball", &scene, 0).expect("a plan");
            plan.ways.iter().filter_map(|way| way.tessellation).collect::<Vec<_>>()
        };
        assert_eq!(levels(r#"shape = "torus_knot""#), [[48, 6], [96, 12], [192, 24]]);
        assert_eq!(levels(r#"shape = "cone""#), [[16, 1], [32, 1], [64, 1]]);
        assert_eq!(levels(r#"shape = "cone", rings = 8"#), [[16, 2], [32, 4], [64, 8]]);
        for flat in ["quad", "plane", "cube"] {
            assert_eq!(levels(&format!("shape = \"{flat}\"")), [[1, 1]], "{flat}");
        }
        assert_eq!(levels(r#"shape = "plane", segments = 64, rings = 2"#), [[16, 1], [32, 1], [64, 2]]);
        assert_eq!(levels(r#"shape = "saddle""#), [[0; 2]; 0]);
    }

    #[test]
    fn ways_set_keys_and_keep_the_rest() {
        let plan = planned(
            r#"
[report]
tessellations = [[8, 4]]
[[report.way]]
name = "one"
model = "m"
truth = true
[[report.way]]
name = "two"
model = "m"
set = { fragment = "b.frag", mesh = { radius = 2.0 } }
"#,
        )
        .expect("a plan");
        let two = &plan.ways[1];
        assert_eq!((two.name.as_str(), two.tessellation), ("two", Some([8, 4])));
        for part in ["b.frag", "a.vert", "radius = 2.0", "segments = 8", "shape = \"sphere\""] {
            assert!(text(two).contains(part), "{part} in {}", text(two));
        }
        assert_eq!(plan.truths[0].way, "one");
    }

    #[test]
    fn mistakes_say_what_and_where() {
        let cases = [
            ("[report]\nround = 3", "has no key `round`"),
            ("[report]\nrounds = 1", "`rounds` is 3 to"),
            ("[report]\ndraw = 4", "no draw 4"),
            (
                "[[report.way]]\nname = \"a\"\nmodel = \"m\"\n[[report.way]]\nname = \"b\"\nmodel = \"m\"",
                "`truth = true`",
            ),
            ("[report]\ntessellations = []", "at least one pair"),
        ];
        for (report, message) in cases {
            let error = planned(report).expect_err(report);
            assert!(error.message.contains(message), "{}", error.message);
        }
    }
}
