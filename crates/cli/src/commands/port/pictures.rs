//! The two pictures of a ported program: that of the original by OpenGL, that of the new texts by Vulkan.
//!
//! *In:* a program, its old and its new texts. *Out:* the conclusion, and the figures of both pictures. *Holds:* both are judged by the
//! envelope of the original; the new program gets every value that the original has.

use super::programs::{Done, Ported};
use crate::arguments::args::{LevelArgs, SourceArgs};
use crate::commands::new_scene;
use crate::commands::upgrade::NewFiles;
use crate::console::{ColorChoice, Console};
use glisten_emit::{Conventions, reflect};
use glisten_front::compiler::{Compiler, Source};
use glisten_front::diagnostic::codes::scenes::{SCENE_UNSET_ATTRIBUTE, SCENE_UNSET_TEXTURE, SCENE_UNSET_UNIFORM};
use glisten_front::hir::{PrimitiveOut, Stage};
use glisten_front::language::Profile;
use glisten_front::link::UniformLeaf;
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::FileSource;
use glisten_scene::compare::Verdict;
use glisten_scene::values::{LeafShape, UniformValues, of_leaf};
use glisten_sources::stages;
use glisten_upgrade::{Dialect, Target, upgrade};
use glisten_verify::scene::{self, DiskFiles, Primitive, Scene};
use glisten_verify::verify::{Conclusion, Drawn, Failure as DrawFailure, OnGpu, Options, Runner, verify};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// The width and height of the pictures.
const SIDE: u32 = 64;
/// Of so many pixels of points and lines, which overlap, one may have another fragment.
const POINTS_OFF: u64 = 50;
/// Of fewer pixels, one at an edge is too large a part.
const FEWEST: u64 = 8;

/// The conclusion for a ported program, and the figures: the scene is made at `path`.
pub(super) fn judged(
    one: &Done,
    ported: &Ported,
    dialect: Option<&Dialect>,
    path: &std::path::Path,
    (sources, levels): (&SourceArgs, &LevelArgs),
    gpu: &Gpu,
) -> Result<(Conclusion, String), String> {
    let index = one.index.ok_or("it is not in the tree")?;
    let unit = ported.units.get(index).ok_or("it is not in the tree")?;
    if ported.plain.refused.get(index).is_none_or(Option::is_some) {
        return Err("the new texts cannot be read with OpenGL's coordinates".to_owned());
    }
    let files: Vec<String> = one.files.iter().map(|path| absolute(path)).collect();
    let quiet = Console::new(true, ColorChoice::Never);
    let args = new_scene::NewSceneArgs::of(files, path.to_owned(), SIDE, sources, levels);
    new_scene::run(&args, &quiet).map_err(|failure| format!("no scene can be made: {}", failure.message))?;
    let name = path.to_string_lossy();
    let old = if one.is_older { &ported.older } else { &ported.old };
    let (mut before, _) = load(&name, &DiskFiles, old)?;
    let (new_compiler, new_sources) = match dialect {
        Some(dialect) => unit.read_back(index, &ported.plain, dialect),
        None => (unit.compiler.clone(), unit.sources.clone()),
    };
    let made = made_stages(path, old, &before, &new_sources);
    let own = new_sources.iter().map(|source| (NewFiles::key(&source.name), &*source.text));
    let texts: BTreeMap<PathBuf, &str> =
        made.iter().map(|(path, text)| (path.clone(), text.as_str())).chain(own).collect();
    let is_alone = |source: &&Source| !one.report.files.contains(&source.name);
    let alone = new_sources.iter().filter(is_alone);
    let renamed = |word: &str| {
        let by_plan = one.plan.as_ref().and_then(|plan| plan.renamed(word)).filter(|_| word.starts_with("gl_"));
        let by_host = dialect.and_then(|dialect| dialect.renamed.get(word)).map(String::as_str);
        by_plan.or(by_host).map(str::to_owned)
    };
    let sources = alone.map(|source| (source.stage.name(), source.name.clone())).collect();
    let new_files = NewFiles { scene: &name, files: texts, renamed: &renamed, sources };
    let (mut after, unset) = load(&name, &new_files, &new_compiler)?;
    keep_initial_values(&before, &mut after, &renamed);
    clip_by_all_distances(&mut before, &mut after);
    // A member that the old program does not have is not read.
    let provided: Vec<&str> = one.plan.iter().flat_map(|plan| plan.provided()).collect();
    let is_read = |message: &&String| provided.iter().any(|name| message.contains(&format!("`{name}`")));
    if let Some(message) = unset.iter().find(is_read) {
        return Err(format!("the scene of the original does not say all that the new program reads: {message}"));
    }
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    let drawn = |scene: &Scene| {
        let told =
            |found: Vec<glisten_front::Diagnostic>| found.first().map_or_else(String::new, |one| one.message.clone());
        glisten_reference::render(scene, &options).map_err(told)
    };
    let differing = drawn(&before)?.bit_unequal(&drawn(&after)?);
    let mut new = on(&before, &Instead { scene: &after, gpu }, LineRule::Vulkan)?;
    if new.is_only_unlikely() && on(&before, &OnGpu::new(gpu, Via::Spirv), LineRule::Vulkan)?.is_only_unlikely() {
        new.excuse("the original's is as unlike what simulated GPUs draw");
    }
    let mut old = by_opengl(&before)?;
    if new.conclusion != Conclusion::Fails
        && let Some(reason) = reason(&before, &old)
    {
        old.excuse(reason);
    }
    let same = match differing {
        0 => "the reference draws the same bytes".to_owned(),
        n => format!("the reference draws {n} values with other roundings"),
    };
    Ok((new.conclusion.max(old.conclusion), format!("{same}; OpenGL: {}; Vulkan: {}", old.figures, new.figures)))
}

/// Enables all clip distances that the original writes, in both scenes. Mesa's OpenGL clips by them even where they are not enabled.
fn clip_by_all_distances(before: &mut Scene, after: &mut Scene) {
    for (old, new) in before.draws.iter_mut().zip(&mut after.draws) {
        let written = reflect(&old.program, &Conventions::default()).conventions.clip_distances;
        for draw in [old, new] {
            draw.state.clip_distances = written;
        }
    }
}

/// Gives the new program the values that uniforms of the original begin with. Blocks have none, so that a host has to fill them.
fn keep_initial_values(before: &Scene, after: &mut Scene, renamed: &dyn Fn(&str) -> Option<String>) {
    for (old, new) in before.draws.iter().zip(&mut after.draws) {
        let program = Arc::clone(&new.program);
        let mut values = UniformValues { roots: std::mem::take(&mut new.uniforms) };
        let begins = |leaf: &&UniformLeaf| {
            let root = old.program.interface.roots.get(leaf.root.0 as usize);
            root.is_some_and(|root| root.default.is_some())
        };
        for from in old.program.interface.uniforms.iter().filter(begins) {
            let Some(shape) = LeafShape::of(&old.program.types, from) else { continue };
            let name = renamed(&from.name).unwrap_or_else(|| from.name.clone());
            for leaf in program.interface.uniforms.iter().filter(|leaf| leaf.name == name) {
                values.set(leaf, 0, of_leaf(&old.uniforms, from, shape));
            }
        }
        new.uniforms = values.roots;
    }
}

/// The judgement of a picture.
struct Judged {
    conclusion: Conclusion,
    verdict: Verdict,
    figures: String,
}

impl Judged {
    /// Lets a picture that is not what was expected say nothing, for a reason.
    fn excuse(&mut self, reason: &str) {
        self.conclusion = Conclusion::Inconclusive;
        self.figures.push_str(&format!(", since {reason}"));
    }

    /// Whether it fails though no pixel is outside of the envelope.
    fn is_only_unlikely(&self) -> bool {
        self.conclusion == Conclusion::Fails && !self.verdict.needs_excuse()
    }
}

/// Why the original's picture by OpenGL says nothing, though it is not what was expected.
fn reason(scene: &Scene, old: &Judged) -> Option<&'static str> {
    let verdict = &old.verdict;
    if old.conclusion != Conclusion::Fails {
        return None;
    }
    if verdict.covered < FEWEST {
        return Some("so few pixels say nothing");
    }
    if is_es(scene) && verdict.coverage_mismatch == 0 {
        // ES 1.00 §4.5.2: what is `mediump` may have 10 bits of a fraction.
        return Some("OpenGL ES computes `mediump` with fewer bits than the envelope has");
    }
    let n_off = verdict.outside + verdict.coverage_mismatch;
    if has_points_or_lines(scene) && n_off * POINTS_OFF <= verdict.covered {
        return Some("OpenGL rounds the places of points and lines in its own way (docs/rasterization.md)");
    }
    old.is_only_unlikely().then_some("all of it is within the envelope, and unlike what simulated GPUs draw")
}

/// Draws the new program by Vulkan where the original is judged.
struct Instead<'a> {
    scene: &'a Scene,
    gpu: &'a Gpu,
}

impl Runner for Instead<'_> {
    fn name(&self) -> &'static str {
        "vulkan"
    }

    fn draw(&self, _: &Scene) -> Result<Drawn, DrawFailure> {
        OnGpu::new(self.gpu, Via::Spirv).draw(self.scene)
    }
}

#[cfg(feature = "gl")]
fn by_opengl(scene: &Scene) -> Result<Judged, String> {
    let gl = glisten_gl::Gl::new().map_err(|error| error.to_string())?;
    on(scene, &glisten_verify::verify::OnOpenGl(&gl), LineRule::OpenGl)
}

#[cfg(not(feature = "gl"))]
fn by_opengl(_: &Scene) -> Result<Judged, String> {
    Err("this glisten was built without OpenGL".to_owned())
}

/// The verdict on a driver's picture, by the envelope.
fn on(scene: &Scene, runner: &dyn Runner, lines: LineRule) -> Result<Judged, String> {
    let options = Options { lines, as_device: true, ..Options::default() };
    let verification = verify(scene, &[runner], &options).map_err(|failure| failure.to_string())?;
    let conclusion = verification.conclusion();
    let Some(run) = verification.runs.into_iter().next() else { return Err("nothing was drawn".to_owned()) };
    let share = 100.0 * run.verdict.share_judged(&verification.demands);
    Ok(Judged { conclusion, figures: figures(&run.verdict, share), verdict: run.verdict })
}

/// The figures of a verdict; those that are rare only where there are any.
fn figures(verdict: &Verdict, share: f64) -> String {
    let word = verdict.judged_word();
    let mut text = format!("{} pixels, {share:.0} % of them {word}, {} outside", verdict.covered, verdict.outside);
    let rare = [
        (verdict.outside_likely + verdict.suspect.unwrap_or(0), "outside of what simulated GPUs drew"),
        (verdict.coverage_mismatch, "with another coverage"),
        (verdict.finiteness_mismatch, "not finite on one side"),
    ];
    for (n, what) in rare.into_iter().filter(|(n, _)| *n > 0) {
        text.push_str(&format!(", {n} {what}"));
    }
    text
}

/// Whether what is rasterized are points or lines: of the scene, or of a geometry shader.
fn has_points_or_lines(scene: &Scene) -> bool {
    use Primitive::{LineLoop, LineStrip, Lines, Points};
    scene.draws.iter().any(|draw| match draw.program.stage(Stage::Geometry) {
        Some(shader) => shader.geometry.output.is_some_and(|output| output != PrimitiveOut::TriangleStrip),
        None => matches!(draw.state.primitive, Points | Lines | LineStrip | LineLoop),
    })
}

/// Whether a program of a scene is one of OpenGL ES.
fn is_es(scene: &Scene) -> bool {
    let mut stages = scene.draws.iter().flat_map(|draw| &draw.program.stages);
    stages.any(|shader| shader.version.profile == Profile::Es)
}

/// The stages that were made for a program that lacks them, in a language and with locations that go with its new texts.
fn made_stages(
    scene: &std::path::Path,
    compiler: &Compiler,
    before: &Scene,
    new_sources: &[Source],
) -> Vec<(PathBuf, String)> {
    let files = scene.parent().and_then(|folder| fs::read_dir(folder).ok());
    let paths = files.into_iter().flatten().flatten().map(|entry| entry.path());
    let new = |path: PathBuf| {
        let stage = stages::by_name(&path)?;
        let text = fs::read_to_string(&path).ok()?;
        let text = if is_es(before) {
            let source = Source { name: path.to_string_lossy().into_owned(), text: text.into(), stage };
            upgrade(compiler, &[source], Target::Core450).ok()?.texts.into_iter().next()?
        } else {
            text
        };
        Some((NewFiles::key(&path.to_string_lossy()), located(&text, new_sources)))
    };
    paths.filter_map(new).collect()
}

/// A text whose varyings have the locations that those of the same name have in other stages.
fn located(text: &str, others: &[Source]) -> String {
    let mut is_located = false;
    let lines = text.lines().map(|line| {
        let name =
            line.strip_suffix(';').and_then(|line| line.rsplit(' ').next()).filter(|_| !line.contains("layout("));
        let is_varying = format!(" {line}").contains(" out ") || format!(" {line}").contains(" in ");
        match name.filter(|_| is_varying).and_then(|name| location(name, others)) {
            Some(location) => {
                is_located = true;
                format!("layout(location = {location}) {line}")
            }
            None => line.to_owned(),
        }
    });
    let text = lines.collect::<Vec<_>>().join("\n") + "\n";
    if is_located { text.replacen("#version 150\n", "#version 410\n", 1) } else { text }
}

/// The location that a varying of this name has in one of these texts.
fn location(name: &str, sources: &[Source]) -> Option<u32> {
    sources.iter().flat_map(|source| source.text.lines()).find_map(|line| {
        let declared = line.trim().strip_suffix(';')?;
        if declared.rsplit(' ').next() != Some(name) || !(declared.contains(" in ") || declared.contains(" out ")) {
            return None;
        }
        let (_, value) = declared.split_once("location = ")?;
        value.split([')', ',']).next()?.trim().parse().ok()
    })
}

fn absolute(path: &std::path::Path) -> String {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).to_string_lossy().into_owned()
}

/// A scene, and the warnings about what it does not set.
fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Result<(Scene, Vec<String>), String> {
    let loaded = scene::load(path, files, compiler);
    let is_unset =
        |code: &str| [SCENE_UNSET_UNIFORM.id, SCENE_UNSET_ATTRIBUTE.id, SCENE_UNSET_TEXTURE.id].contains(&code);
    let unset = loaded.diagnostics.iter().filter(|found| is_unset(found.code.id));
    let unset: Vec<String> = unset.map(|found| found.message.clone()).collect();
    let first = loaded.diagnostics.iter().find(|found| found.is_error()).map(|error| error.message.clone());
    let scene = loaded.scene.ok_or_else(|| first.unwrap_or_else(|| "the scene does not load".to_owned()))?;
    Ok((scene, unset))
}
