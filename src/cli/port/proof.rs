//! The proof: each program in a scene that is made for it, the original drawn by OpenGL, the new one by Vulkan.
//!
//! *In:* ported programs. *Out:* for each `proved`, `inconclusive` or `failed`, with what was found. *Holds:* proved means:
//! OpenGL's picture of the original and Vulkan's of the new program are within the envelope of the original. The new texts are read with OpenGL's
//! coordinates, since glisten's own code for Vulkan turns them. A driver that crashes leaves its program inconclusive, and the rest goes on.

use super::super::args::{LevelArgs, SourceArgs};
use super::super::console::{ColorChoice, Console};
use super::super::exit::{Exit, Failure};
use super::super::journal::{self, Note};
use super::super::new_scene;
use super::super::upgrade::NewFiles;
use super::programs::{Done, Ported};
use crate::port::Host;
use crate::scene::{self, DiskFiles, Primitive, Scene};
use crate::sources::stages;
use crate::upgrade::{Dialect, Target, upgrade};
use crate::verify::{Conclusion, Drawn, Failure as DrawFailure, OnGpu, Options, Runner, verify};
use glisten_front::compiler::{Compiler, Source};
use glisten_front::diagnostic::codes::scenes::{SCENE_UNSET_ATTRIBUTE, SCENE_UNSET_TEXTURE, SCENE_UNSET_UNIFORM};
use glisten_front::language::Profile;
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::FileSource;
use glisten_scene::compare::Verdict;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// The width and height of the pictures.
const SIDE: u32 = 64;
/// Of so many pixels of points and lines, which overlap, one may have another fragment.
const POINTS_OFF: u64 = 100;
const PROVED: &str = "proved";
const INCONCLUSIVE: &str = "inconclusive";
const FAILED: &str = "failed";

/// Proves the programs that are ported.
pub(super) fn prove(
    ported: &mut Ported,
    host: &Host,
    sources: &SourceArgs,
    levels: &LevelArgs,
    console: &Console,
) -> Result<(), Failure> {
    let machine = |error: &dyn std::fmt::Display| Failure::new(Exit::Machine, error.to_string());
    let gpu = Gpu::new(None).map_err(|error| machine(&error))?;
    journal::note(&Note::Driver(gpu.adapter().driver.clone()));
    let known = Known::read();
    let folder = tempfile::tempdir().map_err(|error| Failure::usage(format!("no temporary folder: {error}")))?;
    for index in 0..ported.programs.len() {
        let Some(one) = ported.programs.get(index).filter(|one| one.index.is_some()) else { continue };
        let work = journal::drawing(&one.report.files.join("`, `"));
        let (proof, evidence) = match known.told(index) {
            Some(told) => told,
            None => {
                let found = known.crash(&work).map(|what| (INCONCLUSIVE, what)).unwrap_or_else(|| {
                    let scene = folder.path().join(format!("{index}")).join("scene.toml");
                    let _work = journal::at_work(&work);
                    let judged = fs::create_dir_all(scene.parent().unwrap_or(folder.path()))
                        .map_err(|error| error.to_string())
                        .and_then(|()| judged(one, ported, host.dialect.as_ref(), &scene, (sources, levels), &gpu));
                    worded(judged)
                });
                journal::note(&Note::Result(json!([index, found.0, found.1])));
                console.remark(&format!("{}: {}: {}", one.report.name, found.0, found.1));
                found
            }
        };
        if let Some(one) = ported.programs.get_mut(index) {
            one.report.proof = Some(proof.to_owned());
            one.report.evidence = Some(evidence);
        }
    }
    Ok(())
}

/// The results of earlier processes, before a driver crashed.
struct Known(Vec<Note>);

impl Known {
    fn read() -> Self {
        Self(journal::notes())
    }

    /// The result for a program that an earlier process told.
    fn told(&self, index: usize) -> Option<(&'static str, String)> {
        self.0.iter().find_map(|note| {
            let Note::Result(row) = note else { return None };
            let (known, proof, evidence): (usize, String, String) = serde_json::from_value(row.clone()).ok()?;
            let proof = [PROVED, INCONCLUSIVE, FAILED].into_iter().find(|word| *word == proof)?;
            (known == index).then_some((proof, evidence))
        })
    }

    /// The sentence about a crash in a piece of work.
    fn crash(&self, at_work: &str) -> Option<String> {
        self.0.iter().find_map(|note| match note {
            Note::Crash { work, what } if work == at_work => Some(what.clone()),
            _ => None,
        })
    }
}

/// The words of a verdict, and the evidence.
fn worded(judged: Result<(Conclusion, String), String>) -> (&'static str, String) {
    match judged {
        Ok((Conclusion::Holds, evidence)) => (PROVED, evidence),
        Ok((Conclusion::Inconclusive, evidence)) => (INCONCLUSIVE, evidence),
        Ok((Conclusion::Fails, evidence)) => (FAILED, evidence),
        Err(reason) => (INCONCLUSIVE, reason),
    }
}

fn judged(
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
    new_scene::run(&args, &quiet).map_err(|failure| format!("no scene can be made: {}", failure.message()))?;
    let name = path.to_string_lossy();
    let old = if one.is_older { &ported.older } else { &ported.old };
    let (before, _) = load(&name, &DiskFiles, old)?;
    let (new_compiler, new_sources) = match dialect {
        Some(dialect) => unit.read_back(index, &ported.plain, dialect),
        None => (unit.compiler.clone(), unit.sources.clone()),
    };
    let made = made_stages(path, old, &before);
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
    let (after, unset) = load(&name, &new_files, &new_compiler)?;
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
    let new = on(&before, &Instead { scene: &after, gpu }, LineRule::Vulkan)?;
    let old = by_opengl(&before)?;
    let excuse = excuse(&before, &old).filter(|_| new.conclusion == Conclusion::Holds);
    let of_old = if excuse.is_some() { Conclusion::Inconclusive } else { old.conclusion };
    let same = match differing {
        0 => "the reference draws the same bytes".to_owned(),
        n => format!("the reference draws {n} values with other roundings"),
    };
    let because = excuse.map_or_else(String::new, |excuse| format!(", since {excuse}"));
    let told = format!("{same}; OpenGL: {}{because}; Vulkan: {}", old.figures, new.figures);
    Ok((new.conclusion.max(of_old), told))
}

/// The judgement of a picture.
struct Judged {
    conclusion: Conclusion,
    verdict: Verdict,
    figures: String,
}

/// Why the original's picture by OpenGL says nothing, though it is not what was expected.
fn excuse(scene: &Scene, old: &Judged) -> Option<&'static str> {
    let Judged { conclusion, verdict, .. } = old;
    if *conclusion != Conclusion::Fails {
        return None;
    }
    if is_es(scene) {
        // ES 1.00 §4.5.2: what is `mediump` may have 10 bits of a fraction.
        return Some("OpenGL ES computes `mediump` with fewer bits than the envelope has");
    }
    let n_off = verdict.outside + verdict.coverage_mismatch;
    if has_points_or_lines(scene) && n_off * POINTS_OFF <= verdict.covered {
        return Some("OpenGL rounds the places of points and lines in its own way (docs/rasterization.md)");
    }
    let is_only_unlikely = verdict.outside + verdict.coverage_mismatch + verdict.finiteness_mismatch == 0;
    is_only_unlikely.then_some("all of it is within the envelope, and unlike what simulated GPUs draw")
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
    on(scene, &crate::verify::OnOpenGl(&gl), LineRule::OpenGl)
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
    let mut text = format!("{} pixels, {share:.0} % of them judged, {} outside", verdict.covered, verdict.outside);
    let rare = [
        (verdict.outside_likely, "outside of what simulated GPUs drew"),
        (verdict.coverage_mismatch, "with another coverage"),
        (verdict.finiteness_mismatch, "not finite on one side"),
    ];
    for (n, what) in rare.into_iter().filter(|(n, _)| *n > 0) {
        text.push_str(&format!(", {n} {what}"));
    }
    text
}

fn has_points_or_lines(scene: &Scene) -> bool {
    use Primitive::{LineLoop, LineStrip, Lines, Points};
    scene.draws.iter().any(|draw| matches!(draw.state.primitive, Points | Lines | LineStrip | LineLoop))
}

/// Whether a program of a scene is one of OpenGL ES.
fn is_es(scene: &Scene) -> bool {
    let mut stages = scene.draws.iter().flat_map(|draw| &draw.program.stages);
    stages.any(|shader| shader.version.profile == Profile::Es)
}

/// The stages that were made for a program that lacks them, in a language that goes with its new texts.
fn made_stages(scene: &std::path::Path, compiler: &Compiler, before: &Scene) -> Vec<(PathBuf, String)> {
    let files = scene.parent().and_then(|folder| fs::read_dir(folder).ok());
    let paths = files.into_iter().flatten().flatten().map(|entry| entry.path()).filter(|_| is_es(before));
    let new = |path: PathBuf| {
        let stage = stages::by_name(&path)?;
        let text = fs::read_to_string(&path).ok()?;
        let source = Source { name: path.to_string_lossy().into_owned(), text: text.into(), stage };
        let upgraded = upgrade(compiler, &[source], Target::Core450).ok()?;
        Some((NewFiles::key(&path.to_string_lossy()), upgraded.texts.into_iter().next()?))
    };
    paths.filter_map(new).collect()
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

#[cfg(test)]
mod tests {
    use super::{FAILED, Known, Note, PROVED};
    use serde_json::json;

    #[test]
    fn results_before_a_crash_are_known_and_the_crash_is_one_of_its_program() {
        let known = Known(vec![
            Note::Begin("drawing `a`".to_owned()),
            Note::Result(json!([0, PROVED, "4 pixels"])),
            Note::Result(json!([2, FAILED, "1 outside"])),
            Note::Result(json!([3, "a word of another command", ""])),
            Note::Crash { work: "drawing `b`".to_owned(), what: "the driver crashed".to_owned() },
        ]);
        assert_eq!(known.told(0), Some((PROVED, "4 pixels".to_owned())));
        assert_eq!(known.told(2), Some((FAILED, "1 outside".to_owned())));
        assert_eq!((known.told(1), known.told(3)), (None, None));
        assert_eq!(known.crash("drawing `b`").as_deref(), Some("the driver crashed"));
        assert_eq!(known.crash("drawing `a`"), None);
    }
}
