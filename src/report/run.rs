//! Draws and times every way of a plan.
//!
//! *Holds:* all ways, and the baseline a second time, are timed in turns in one run. The order rotates from round to
//! round, so that no way always follows the same other way.

use super::figures::{compare, mark_pareto, spread};
use super::model::{Adapter, Report, Timing, Truth, Way};
use super::plan::{Drawn, Plan, PlannedWay, base_of, plan};
use super::ways::{self, Origin};
use crate::scene::{self, FileError, FileSource, Loaded, Scene};
use crate::specialize::{Contract, specialize_scene_by};
use glisten_front::compiler::Compiler;
use glisten_front::diagnostic::{Diagnostic, Diagnostics};
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Prepared, Via};
use glisten_reference::{Precision, RenderOptions};
use glisten_scene::picture::Picture;

/// Why a report could not be made.
#[derive(Debug)]
pub enum Error {
    /// The scene, or something that it names, has errors; the diagnostics belong to these sources.
    Scene {
        /// The texts.
        sources: Box<SourceMap>,
        /// The diagnostics.
        diagnostics: Diagnostics,
        /// Whether a file that it names cannot be read.
        io_error: bool,
    },
    /// The reference cannot draw a way.
    Reference {
        /// The way.
        way: String,
        /// The diagnostics.
        diagnostics: Vec<Diagnostic>,
    },
    /// The GPU cannot draw a way.
    Gpu {
        /// The way.
        way: String,
        /// The reason.
        error: glisten_gpu::Error,
    },
}

/// Follows the progress of the work: the number of steps, then each step.
pub trait Watcher {
    /// Announces the number of steps.
    fn steps(&mut self, count: usize);
    /// Announces a step.
    fn step(&mut self, what: &str);
}

/// Ignores progress.
impl Watcher for () {
    fn steps(&mut self, _count: usize) {}
    fn step(&mut self, _what: &str) {}
}

/// Which ways to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ways {
    /// Those that the scene's file declares, or the scene alone.
    #[default]
    Declared,
    /// Those that are found by themselves as well.
    Auto,
}

/// What to compare, and how.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The form of the emitted code that the GPU runs.
    pub via: Via,
    /// Adds each way with residual programs of this contract.
    pub specialized: Option<Contract>,
    /// Which ways to compare.
    pub ways: Ways,
}

/// A way on the device.
struct Candidate {
    prepared: Prepared,
    frames: u32,
    times: Vec<f64>,
}

/// How often all ways are timed, unless the scene says.
const ROUNDS: u32 = 15;

/// Compares the ways of the scene at `path`.
///
/// # Errors
/// [`Error`]; the first way that cannot be drawn ends the report.
pub fn run(
    path: &str,
    files: &dyn FileSource,
    compiler: &Compiler,
    gpu: &Gpu,
    options: &Options,
    watcher: &mut dyn Watcher,
) -> Result<Report, Error> {
    let Options { via, specialized, .. } = *options;
    let whole = load(path, files, compiler)?;
    let mut plan = read_plan(path, files, &whole)?;
    if let (Ways::Auto, Some(scene)) = (options.ways, &whole.scene) {
        find(path, (files, compiler), (scene, &whole.sources), &mut plan);
    }
    let rounds = plan.rounds.unwrap_or(ROUNDS);
    let drawn = if specialized.is_some() { 2 * plan.ways.len() } else { plan.ways.len() };
    watcher.steps(plan.truths.len() + 2 * drawn + rounds as usize);
    let mut truths = Vec::new();
    for truth in &plan.truths {
        watcher.step(&format!("the truth of {}", truth.model));
        let scene = scene_of(path, &truth.drawn, files, compiler)?;
        truths.push(Truth {
            model: truth.model.clone(),
            way: truth.way.clone(),
            tessellation: truth.tessellation,
            precision: "f64",
            picture: reference(&truth.way, &scene)?,
        });
    }
    let mut ways = Vec::new();
    let mut candidates = Vec::new();
    for planned in &plan.ways {
        let scene = scene_of(path, &planned.drawn, files, compiler)?;
        let truth = truths.iter().find(|truth| truth.model == planned.model);
        let (way, candidate) = draw(planned, &scene, truth, gpu, planned.via.unwrap_or(via), watcher)?;
        ways.push(way);
        candidates.push(candidate);
        if let Some(contract) = specialized {
            let planned = PlannedWay { name: format!("{}, specialized", planned.name), ..planned.clone() };
            let scene = specialize_scene_by(contract, &scene, &SourceMap::default(), &[]).scene;
            let (way, candidate) = draw(&planned, &scene, truth, gpu, via, watcher)?;
            ways.push(way);
            candidates.push(candidate);
        }
    }
    let timing = time(gpu, rounds, &mut ways, &mut candidates, watcher)?;
    mark_pareto(&mut ways);
    let adapter = Adapter { name: gpu.adapter().name.clone(), driver: gpu.adapter().driver.clone() };
    let framebuffer = whole.scene.map(|scene| scene.framebuffer);
    let size = framebuffer.map_or([0, 0], |framebuffer| [framebuffer.width, framebuffer.height]);
    let encode = framebuffer.map_or_else(Default::default, |framebuffer| framebuffer.encode);
    Ok(Report { scene: stem(path), size, encode, adapter, via: via.name(), truths, timing, ways })
}

fn stem(path: &str) -> String {
    std::path::Path::new(path).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Result<Loaded, Error> {
    let loaded = scene::load(path, files, compiler);
    if loaded.scene.is_some() {
        return Ok(loaded);
    }
    let Loaded { sources, diagnostics, io_error, .. } = loaded;
    Err(Error::Scene { sources: Box::new(sources), diagnostics, io_error })
}

fn read_plan(path: &str, files: &dyn FileSource, whole: &Loaded) -> Result<Plan, Error> {
    let text = files.read(path).unwrap_or_default();
    plan(&stem(path), &String::from_utf8_lossy(&text), base_of(&whole.sources, path)).map_err(|diagnostic| {
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(*diagnostic);
        Error::Scene { sources: Box::new(whole.sources.clone()), diagnostics, io_error: false }
    })
}

/// The files of another source, except that the scene's own text replaces its file.
struct Replaced<'a> {
    path: &'a str,
    text: &'a str,
    files: &'a dyn FileSource,
}

impl FileSource for Replaced<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == self.path { Ok(self.text.as_bytes().to_vec()) } else { self.files.read(path) }
    }
}

/// Adds the ways that are found by themselves.
fn find(
    path: &str,
    (files, compiler): (&dyn FileSource, &Compiler),
    (scene, sources): (&Scene, &SourceMap),
    plan: &mut Plan,
) {
    let text = plan.text.clone();
    let name = stem(path);
    let load = |text: &str| scene_of(path, &Drawn::Text(text.to_owned()), files, compiler).ok();
    let origin = Origin { name: &name, scene, sources, text: &text, compiler, load: &load };
    plan.add(scene, ways::found(&origin));
}

fn scene_of(path: &str, drawn: &Drawn, files: &dyn FileSource, compiler: &Compiler) -> Result<Scene, Error> {
    let text = match drawn {
        Drawn::Scene(scene) => return Ok((**scene).clone()),
        Drawn::Text(text) => text,
    };
    let loaded = load(path, &Replaced { path, text, files }, compiler)?;
    // `load` reports an error if there is no scene.
    loaded.scene.ok_or(Error::Scene { sources: Box::default(), diagnostics: Diagnostics::default(), io_error: false })
}

fn reference(way: &str, scene: &Scene) -> Result<Picture, Error> {
    let options = RenderOptions { precision: Precision::F64, mark_edges: false, ..RenderOptions::default() };
    glisten_reference::render(scene, &options).map_err(|diagnostics| Error::Reference { way: way.into(), diagnostics })
}

fn draw(
    planned: &PlannedWay,
    scene: &Scene,
    truth: Option<&Truth>,
    gpu: &Gpu,
    via: Via,
    watcher: &mut dyn Watcher,
) -> Result<(Way, Candidate), Error> {
    let failed = |error| Error::Gpu { way: planned.name.clone(), error };
    watcher.step(&format!("{} on the CPU", planned.name));
    let exact = reference(&planned.name, scene)?;
    watcher.step(&format!("{} on the GPU", planned.name));
    let prepared = gpu.prepare(scene, via).map_err(failed)?;
    let picture = gpu.draw(&prepared).map_err(failed)?.picture;
    let fragments = gpu.fragments_shaded(&prepared).map_err(failed)?;
    let frames = gpu.frames_for_a_stretch(&prepared).map_err(failed)?;
    let (error, difference) = compare(&picture, truth.map_or(&exact, |truth| &truth.picture));
    let (rounding, _) = compare(&picture, &exact);
    let vertices = scene.draws.iter().map(|draw| u64::from(draw.vertex_count) * u64::from(draw.instances)).sum();
    let way = Way {
        name: planned.name.clone(),
        kind: planned.kind,
        about: planned.about.clone(),
        model: planned.model.clone(),
        tessellation: planned.tessellation,
        vertices,
        fragments,
        error,
        rounding,
        milliseconds: 0.0,
        ratio: spread(&[]),
        pareto: false,
        picture,
        difference,
    };
    Ok((way, Candidate { prepared, frames, times: Vec::new() }))
}

/// Times all candidates in turns, the first of them twice in each round.
fn time(
    gpu: &Gpu,
    rounds: u32,
    ways: &mut [Way],
    candidates: &mut [Candidate],
    watcher: &mut dyn Watcher,
) -> Result<Timing, Error> {
    let count = candidates.len();
    let mut again = Vec::new();
    for round in 0..rounds as usize {
        watcher.step(&format!("round {} of {}", round + 1, rounds));
        for turn in 0..=count {
            let index = (turn + round) % (count + 1);
            // The index after the last one is the second copy of the baseline.
            let Some(candidate) = candidates.get_mut(if index == count { 0 } else { index }) else { continue };
            let measured = gpu.measure(&candidate.prepared, candidate.frames);
            let way = ways.first().map(|way| way.name.clone()).unwrap_or_default();
            let milliseconds = measured.map_err(|error| Error::Gpu { way, error })?;
            if index == count { again.push(milliseconds) } else { candidate.times.push(milliseconds) }
        }
    }
    let baseline = candidates.first().map(|candidate| candidate.times.clone()).unwrap_or_default();
    let ratios = |times: &[f64]| -> Vec<f64> { times.iter().zip(&baseline).map(|(time, base)| time / base).collect() };
    for (way, candidate) in ways.iter_mut().zip(candidates.iter()) {
        way.milliseconds = spread(&candidate.times).median;
        way.ratio = spread(&ratios(&candidate.times));
    }
    Ok(Timing {
        baseline: ways.first().map(Way::title).unwrap_or_default(),
        baseline_ms: spread(&baseline).median,
        rounds,
        same_again: spread(&ratios(&again)),
    })
}
