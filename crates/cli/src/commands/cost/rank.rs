//! `glisten cost --measure`: how well costs rank the times of draws.
//!
//! *In:* scenes. *Out:* for each, what its draws cost and how long a frame takes, and Spearman's coefficient of both. *Holds:* a draw costs
//! the longest paths of its stages, once for each vertex and each fragment that the reference counts, with the values of its
//! uniforms for the rounds of loops; two operations for each component that is interpolated; the fragment stage for the pixels that a
//! triangle does not cover, but that are shaded with those that it covers; and a fixed weight for each entry of the draw and each
//! fragment, for what is done besides the stages. The time is the shortest of several rounds, without that of an empty frame.

use crate::arguments::args::ResultFormat;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::progress::Progress;
use crate::scenes::{gpu_failure, open_gpu};
use glisten_cost::{Assumptions, cost, ranks, spearman};
use glisten_front::Compiler;
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Prepared, Via};
use glisten_reference::{Counts, RenderOptions, Step, counts};
use glisten_specialize::optimize;
use glisten_verify::scene::{self, DiskFiles, Draw, FileSource, Scene};
use glisten_verify::verify::as_compiled;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

/// The weight of a component that is interpolated.
const INTERPOLATED: u64 = 2;
/// The weight of what a GPU does with each vertex besides its stage, for each entry of the draw: fetching, clipping, setting up edges.
const ENTRY: u64 = 1000;
/// The weight of what it does with each fragment besides its stage: coverage, depth, writing.
const FRAGMENT: u64 = 20;
/// How many pixels beyond its own a triangle shades, because whole blocks are shaded: those of llvmpipe have 4 by 4 pixels.
const BEYOND: u64 = 16;

/// The cost of a draw.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Spent {
    /// Entries of the draw: vertices, each as often as primitives name it.
    entries: u64,
    vertices: u64,
    fragments: u64,
    /// The longest paths of all vertices.
    vertex_weight: u64,
    /// The longest paths of all fragments and of the pixels that are shaded with them, and their interpolation.
    fragment_weight: u64,
}

impl Spent {
    fn plus(self, other: Self) -> Self {
        Self {
            entries: self.entries.saturating_add(other.entries),
            vertices: self.vertices.saturating_add(other.vertices),
            fragments: self.fragments.saturating_add(other.fragments),
            vertex_weight: self.vertex_weight.saturating_add(other.vertex_weight),
            fragment_weight: self.fragment_weight.saturating_add(other.fragment_weight),
        }
    }

    fn weight(self) -> u64 {
        let fixed = self.entries.saturating_mul(ENTRY).saturating_add(self.fragments.saturating_mul(FRAGMENT));
        self.vertex_weight.saturating_add(self.fragment_weight).saturating_add(fixed)
    }
}

/// A scene with what it costs.
struct Row {
    name: String,
    spent: Spent,
    prepared: Prepared,
    frames: u32,
    milliseconds: f64,
}

/// How to measure.
pub(crate) struct Measuring<'a> {
    pub(crate) adapter: Option<&'a str>,
    pub(crate) format: ResultFormat,
    /// The rounds of loops that nothing limits.
    pub(crate) iterations: u64,
    /// The rounds of measurements.
    pub(crate) rounds: u32,
}

/// Runs the command on scenes, or on those of the library.
pub(crate) fn run(args: &Measuring<'_>, files: &[PathBuf], compiler: &Compiler, console: &Console) -> Outcome {
    let gpu = open_gpu(args.adapter).map_err(gpu_failure)?;
    let named = files.iter().map(|file| file.to_string_lossy().into_owned());
    let of_library = glisten_library::scenes().iter().map(|scene| format!("{}.toml", scene.name));
    let names: Vec<String> = if files.is_empty() { of_library.collect() } else { named.collect() };
    let progress = Progress::new(console, names.len());
    let mut rows = Vec::new();
    for name in names {
        progress.say(&name);
        let source: &dyn FileSource = if files.is_empty() { &glisten_library::SceneFiles } else { &DiskFiles };
        let loaded = scene::load(&name, source, compiler);
        let Some(scene) = loaded.scene else {
            let first = loaded.diagnostics.iter().find(|found| found.is_error()).map(|found| found.message.clone());
            let exit = if loaded.io_error { Exit::Usage } else { Exit::Content };
            return Err(Failure::new(exit, format!("`{name}`: {}", first.unwrap_or_default())));
        };
        rows.push(row(&gpu, scene, args.iterations).map_err(|error| Failure::new(Exit::Content, error))?);
        progress.step();
    }
    measure(&gpu, &mut rows, args.rounds).map_err(|error| Failure::new(Exit::Machine, error))?;
    drop(progress);
    let pairs: Vec<(f64, f64)> = rows.iter().map(|row| (row.spent.weight() as f64, row.milliseconds)).collect();
    let text = match args.format {
        ResultFormat::Human => table(&rows, &pairs, &gpu.adapter().name),
        ResultFormat::Json => {
            let scenes: Vec<_> = rows
                .iter()
                .map(|row| {
                    let (weight, spent) = (row.spent.weight(), &row.spent);
                    json!({"scene": row.name, "weight": weight, "spent": spent, "milliseconds": row.milliseconds})
                })
                .collect();
            let adapter = &gpu.adapter().name;
            format!("{:#}\n", json!({"adapter": adapter, "spearman": spearman(&pairs), "scenes": scenes}))
        }
    };
    console.output(&text)?;
    Ok(Exit::Ok)
}

fn row(gpu: &Gpu, scene: Scene, iterations: u64) -> Result<Row, String> {
    let told = |name: &str, message: &str| format!("`{name}`: {message}");
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    let counted = counts(&scene, &options)
        .map_err(|found| told(&scene.name, found.first().map_or("", |first| &first.message)))?;
    let draws = scene.draws.iter().zip(&counted).map(|(draw, counts)| of_draw(draw, counts, iterations));
    let spent = draws.fold(Spent::default(), Spent::plus);
    let compiled =
        as_compiled(&scene).map_err(|found| told(&scene.name, found.first().map_or("", |first| &first.message)))?;
    let prepared = gpu.prepare(&compiled, Via::Spirv).map_err(|error| told(&scene.name, &error.to_string()))?;
    let frames = gpu.frames_for_a_stretch(&prepared).map_err(|error| told(&scene.name, &error.to_string()))?;
    Ok(Row { name: scene.name, spent, prepared, frames, milliseconds: f64::INFINITY })
}

/// The cost of a draw.
fn of_draw(draw: &Draw, counts: &Counts, iterations: u64) -> Spent {
    let of = |name: &str| counts.iter().filter(|(step, _)| step.name == name).map(|(_, count)| *count).sum::<u64>();
    let program = optimize(&draw.program);
    let ranges = glisten_report::gallery::ranges(draw);
    let cost = cost(&program, &SourceMap::default(), &Assumptions { iterations, ranges });
    let interpolated = INTERPOLATED * u64::from(cost.varyings.components);
    let entries = u64::from(draw.vertex_count).saturating_mul(u64::from(draw.instances));
    let (vertices, fragments) = (of(Step::VERTEX), of(Step::FRAGMENT));
    let shaded = fragments.saturating_add(entries / 3 * BEYOND);
    let mut spent = Spent { entries, vertices, fragments, ..Spent::default() };
    for stage in &cost.stages {
        let weight = stage.longest.weight();
        if stage.stage == "fragment" {
            spent.fragment_weight = weight.saturating_add(interpolated).saturating_mul(shaded);
        } else {
            spent.vertex_weight = spent.vertex_weight.saturating_add(weight.saturating_mul(vertices));
        }
    }
    spent
}

/// Measures all scenes in rounds; the shortest time of each counts.
fn measure(gpu: &Gpu, rows: &mut [Row], rounds: u32) -> Result<(), String> {
    for _ in 0..rounds.max(1) {
        for row in rows.iter_mut() {
            let time = gpu.measure(&row.prepared, row.frames).map_err(|error| format!("`{}`: {error}", row.name))?;
            row.milliseconds = row.milliseconds.min(time);
        }
    }
    Ok(())
}

fn table(rows: &[Row], pairs: &[(f64, f64)], adapter: &str) -> String {
    let weights = ranks(&pairs.iter().map(|pair| pair.0).collect::<Vec<_>>());
    let times = ranks(&pairs.iter().map(|pair| pair.1).collect::<Vec<_>>());
    let width = rows.iter().map(|row| row.name.len()).max().unwrap_or(0).max(5);
    let mut text = format!("{:width$} {:>14} {:>6} {:>10} {:>6}\n", "scene", "weight", "rank", "ms", "rank");
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|index| rows.get(*index).map(|row| row.spent.weight()));
    for index in order {
        let (Some(row), Some(weight), Some(time)) = (rows.get(index), weights.get(index), times.get(index)) else {
            continue;
        };
        let Row { name, milliseconds, spent, .. } = row;
        text += &format!("{name:width$} {:>14} {weight:>6} {milliseconds:>10.3} {time:>6}\n", spent.weight());
    }
    let coefficient = spearman(pairs).map_or_else(|| "none".to_owned(), |rho| format!("{rho:.3}"));
    text + &format!("Spearman's coefficient of {} scenes on {adapter}: {coefficient}\n", rows.len())
}
