//! Draws and times every variant of a plan.
//!
//! *In:* a scene file, or what is found for it. *Out:* a [`Report`]. *Holds:* a user who ends it gets the variants that are drawn,
//! and the rounds that are complete, as a report that says so; [`Error::Stopped`] if there is none yet.

use super::clock::{Candidate, Limits, SEED, Times, time};
use super::draw::{Draw, Drawing};
use super::figures::spread;
use super::front::{margin, mark};
use super::model::{Adapter, Ended, Report, Timing, Truth, Way};
use super::options::{Error, Options, Watcher, Ways};
use super::plan::{DECLARED, Drawn, Plan, PlannedWay, WayText, base_of, plan};
use super::ways::{self, Origin};
use glisten_front::compiler::Compiler;
use glisten_front::diagnostic::Diagnostics;
use glisten_front::source::{SourceMap, Span};
use glisten_gpu::Gpu;
use glisten_verify::scene::{self, FileError, FileSource, Loaded, Scene};
use glisten_verify::specialize::{Contract, specialize_scene_by};
use std::ops::Range;

/// Compares the variants of the scene at `path`.
///
/// # Errors
/// [`Error`]; the first variant of the scene's file that cannot be drawn ends the report.
pub fn run(
    path: &str,
    files: &dyn FileSource,
    compiler: &Compiler,
    gpu: &Gpu,
    options: &Options,
    watcher: &mut dyn Watcher,
) -> Result<Report, Error> {
    let files = Files { path, files, compiler };
    let whole = files.load(files.files)?;
    let mut plan = files.plan(&whole)?;
    if let (Ways::Auto, Some(scene)) = (options.ways, &whole.scene) {
        watcher.step("looking for variants");
        files.find(scene, &mut plan);
    }
    if let Some(contract) = options.specialized {
        files.specialize(contract, &mut plan)?;
    }
    let mut drawing = Drawing { gpu, options, truths: Vec::new(), done: Vec::new(), skipped: Vec::new(), steps: 0 };
    watcher.steps(plan.truths.len() + 2 * plan.ways.len() + Limits::default().rounds as usize / 4);
    for truth in &plan.truths {
        if !watcher.is_stopped() {
            drawing.truth(truth, &files.scene_of(&truth.drawn)?, watcher)?;
        }
    }
    draw_ways(&files, &plan, &mut drawing, watcher)?;
    if drawing.done.is_empty() && watcher.is_stopped() {
        return Err(Error::Stopped);
    }
    let limits = Limits {
        rounds: options.rounds.or(plan.rounds).unwrap_or(Limits::default().rounds),
        time: options.time.unwrap_or(Limits::default().time),
    };
    let all = drawing.done.len() + drawing.skipped.len() == plan.ways.len();
    let (steps, empty) = (drawing.steps, drawing.empty());
    let Drawing { truths, done, skipped, .. } = drawing;
    let (mut ways, candidates): (Vec<Way>, Vec<Candidate>) =
        done.into_iter().map(|Draw { way, candidate }| (way, candidate)).unzip();
    let times = time(gpu, (&candidates, empty.as_ref()), limits, (steps, watcher))
        .map_err(|(number, error)| Error::Gpu { way: ways.get(number).map(Way::title).unwrap_or_default(), error })?;
    let timing = settle(&mut ways, &truths, times);
    let framebuffer = whole.scene.map(|scene| scene.framebuffer);
    Ok(Report {
        scene: stem(path),
        title: None,
        size: framebuffer.map_or([0, 0], |framebuffer| [framebuffer.width, framebuffer.height]),
        encode: framebuffer.map_or_else(Default::default, |framebuffer| framebuffer.encode),
        complete: all && timing.ended != Ended::Stopped,
        version: env!("CARGO_PKG_VERSION"),
        adapter: Adapter { name: gpu.adapter().name.clone(), driver: gpu.adapter().driver.clone() },
        machine: options.machine.clone(),
        via: options.via.name(),
        weights: options.weights.name().to_owned(),
        truths,
        timing,
        ways,
        skipped,
    })
}

/// Draws all variants.
fn draw_ways(
    files: &Files<'_>,
    plan: &Plan,
    drawing: &mut Drawing<'_>,
    watcher: &mut dyn Watcher,
) -> Result<(), Error> {
    for planned in &plan.ways {
        if watcher.is_stopped() {
            return Ok(());
        }
        let scene = files.scene_of(&planned.drawn)?;
        drawing.way(planned, &scene, watcher)?;
    }
    Ok(())
}

/// Enters the times into the variants, and marks the fronts.
fn settle(ways: &mut [Way], truths: &[Truth], times: Times) -> Timing {
    let same_again = times.ratio(&times.again);
    for (way, series) in ways.iter_mut().zip(&times.ways) {
        way.milliseconds = spread(series).median;
        way.ratio = times.ratio(series);
        way.times = series.clone();
    }
    let margin = margin(&same_again);
    mark(ways, truths, margin);
    Timing {
        baseline: ways.first().map(Way::title).unwrap_or_default(),
        baseline_ms: ways.first().map_or(f64::NAN, |way| way.milliseconds),
        empty_ms: spread(&times.empty).median,
        rounds: times.rounds(),
        seed: SEED,
        ended: times.ended,
        same_again,
        margin,
    }
}

fn stem(path: &str) -> String {
    std::path::Path::new(path).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// The scene's file, and how to read it.
struct Files<'a> {
    path: &'a str,
    files: &'a dyn FileSource,
    compiler: &'a Compiler,
}

impl Files<'_> {
    fn load(&self, files: &dyn FileSource) -> Result<Loaded, Error> {
        let loaded = scene::load(self.path, files, self.compiler);
        if loaded.scene.is_some() {
            return Ok(loaded);
        }
        let Loaded { sources, diagnostics, io_error, .. } = loaded;
        Err(Error::Scene { sources: Box::new(sources), diagnostics, io_error })
    }

    fn plan(&self, whole: &Loaded) -> Result<Plan, Error> {
        let text = self.files.read(self.path).unwrap_or_default();
        let base = base_of(&whole.sources, self.path);
        plan(&stem(self.path), &String::from_utf8_lossy(&text), base).map_err(|diagnostic| {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(*diagnostic);
            Error::Scene { sources: Box::new(whole.sources.clone()), diagnostics, io_error: false }
        })
    }

    /// Adds the variants that are found by themselves.
    fn find(&self, scene: &Scene, plan: &mut Plan) {
        let text = plan.text.clone();
        let name = stem(self.path);
        let load = |text: &str| self.scene_from(text).ok();
        let origin = Origin { name: &name, scene, text: &text, load: &load };
        plan.add(scene, ways::found(&origin));
    }

    /// Adds each variant specialized. Of a variant that was found by itself none is added that draws as another one.
    fn specialize(&self, contract: Contract, plan: &mut Plan) -> Result<(), Error> {
        let planned = std::mem::take(&mut plan.ways);
        for (index, way) in planned.iter().enumerate() {
            let scene = self.scene_of(&way.drawn)?;
            plan.ways.push(way.clone());
            let specialized = specialize_scene_by(contract, &scene, &SourceMap::default(), &[]);
            let others = plan.ways.iter().chain(planned.iter().skip(index + 1));
            let same = |other: &PlannedWay| match &other.drawn {
                Drawn::Scene(scene) => other.floats == way.floats && !ways::differs(scene, &specialized.scene),
                Drawn::Text(_) => false,
            };
            if way.kind != DECLARED && others.into_iter().any(same) {
                continue;
            }
            let name = format!("{}, specialized", way.name);
            let programs = Some(specialized.draws.into_iter().map(|draw| draw.texts).collect());
            let drawn = Drawn::Scene(Box::new(specialized.scene));
            plan.ways.push(PlannedWay { name, kind: "specialized", programs, drawn, ..way.clone() });
        }
        Ok(())
    }

    fn scene_of(&self, drawn: &Drawn) -> Result<Scene, Error> {
        match drawn {
            Drawn::Scene(scene) => Ok((**scene).clone()),
            Drawn::Text(way) => self.scene_from(&way.text).map_err(|error| {
                let text = self.files.read(self.path).unwrap_or_default();
                placed(error, way, (self.path, &String::from_utf8_lossy(&text)))
            }),
        }
    }

    fn scene_from(&self, text: &str) -> Result<Scene, Error> {
        let loaded = self.load(&Replaced { path: self.path, text, files: self.files })?;
        // `load` reports an error if there is no scene.
        let none = || Error::Scene { sources: Box::default(), diagnostics: Diagnostics::default(), io_error: false };
        loaded.scene.ok_or_else(none)
    }
}

/// An error in a variant's text, at the place of the scene's file that it comes from: the same word in the keys of the variant, or else
/// all of these keys, since the scene without them has no error. Where another file is wrong, the error stays.
fn placed(error: Error, way: &WayText, (path, text): (&str, &str)) -> Error {
    let Error::Scene { sources, diagnostics, io_error } = error else { return error };
    let in_scene = |span: Span| sources.file_of(span).filter(|file| sources.file(*file).name() == path);
    let mut map = SourceMap::default();
    let added = map.add(path, text);
    let Some(file) = added.filter(|_| diagnostics.iter().all(|found| in_scene(found.primary.span).is_some())) else {
        return Error::Scene { sources, diagnostics, io_error };
    };
    let base = map.file(file).base();
    let whole = |range: Range<usize>| Span::new(base + range.start as u32, base + range.end as u32);
    let place = |span: Span| {
        let file = sources.file(in_scene(span)?);
        let range = (span.start.checked_sub(file.base())?) as usize..(span.end.checked_sub(file.base())?) as usize;
        let word = file.text().get(range)?.trim_matches('"');
        let keys = text.get(way.set.clone()).filter(|_| !word.is_empty())?;
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let is_whole = |at: usize| {
            let (before, after) = (keys.get(..at).unwrap_or(""), keys.get(at + word.len()..).unwrap_or(""));
            !before.ends_with(is_part) && !after.starts_with(is_part)
        };
        let at = way.set.start + keys.match_indices(word).map(|(at, _)| at).find(|at| is_whole(*at))?;
        Some(whole(at..at + word.len()))
    };
    let mut told = Diagnostics::default();
    for mut found in diagnostics {
        found.primary.span = place(found.primary.span).unwrap_or_else(|| whole(way.set.clone()));
        found.secondary.retain_mut(|label| place(label.span).map(|span| label.span = span).is_some());
        found.fixes.clear();
        if !way.set.is_empty() {
            found = found.label(whole(way.set.clone()), format!("of the way `{}`", way.way));
        }
        told.push(found);
    }
    Error::Scene { sources: Box::new(map), diagnostics: told, io_error }
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
