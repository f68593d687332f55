//! The worker: a process that answers the jobs of the server, one after the other.
//!
//! *In:* a job on each line of standard input, with its bounds. *Out:* an answer on each line of standard output: `{"ok": ...}` or
//! `{"error": "..."}`. *Holds:* it ends when its input ends, whatever it is doing, so that it never outlives the server. The texts of
//! a page read no file outside of the folders but those that files on disk name: such a job has `"is_outside": true` and nothing else.

use super::PlayArgs;
use super::driver::{Driver, timed};
use super::variants::variants;
use crate::buffers;
use crate::commands::new_scene::{self, Missing, NewSceneArgs};
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::SceneFiles;
use crate::gate;
use crate::process::guard;
use crate::scenes::SceneArgs;
use crate::session::Session;
use glisten_play::{Job, Pictures, Wish, drawable};
use glisten_verify::scene;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::mpsc;

/// Runs the worker.
pub(super) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    let mut kept = Kept::default();
    for line in lines()? {
        let answer = match guard::guarded(|| answer(args, console, &line, &mut kept)) {
            Ok(Ok(answer)) => json!({ "ok": answer }),
            Ok(Err(NoAnswer::Error(error))) => json!({ "error": error }),
            Ok(Err(NoAnswer::Outside(path))) => json!({ "is_outside": true, "error": outside(&path) }),
            Err(panic) => json!({ "error": format!("internal error: {panic}; please report it with the scene") }),
        };
        console.output(&format!("{answer}\n"))?;
    }
    Ok(Exit::Ok)
}

/// The lines of standard input, read by a thread that ends the process with the last one.
fn lines() -> Result<mpsc::Receiver<String>, Failure> {
    let (sender, lines) = mpsc::channel();
    let read = move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
        end();
    };
    let spawned = std::thread::Builder::new().spawn(read);
    spawned.map_err(|error| Failure::new(Exit::Machine, format!("the system gives no thread: {error}")))?;
    Ok(lines)
}

#[expect(clippy::exit, reason = "nobody waits for the answer to the job that may be running")]
fn end() {
    std::process::exit(0);
}

/// The state of a worker from job to job.
#[derive(Default)]
struct Kept {
    driver: Driver,
    pictures: Pictures,
    programs: glisten_play::Kept,
    /// The files outside of the folders that files on disk name.
    outside: gate::Files,
}

/// The files that a job may read.
#[derive(Deserialize)]
struct Bounds {
    folders: Vec<PathBuf>,
    /// The text of a scene that is not on disk, as the server made it.
    made: Option<String>,
}

/// A job and its bounds.
#[derive(Deserialize)]
struct Bounded {
    bounds: Option<Bounds>,
}

/// The reason why a job has no answer.
enum NoAnswer {
    Error(String),
    /// A text of the page names this file, which is outside.
    Outside(PathBuf),
}

fn outside(path: &Path) -> String {
    format!("`{}` is in none of the folders of `glisten play`", path.display())
}

fn answer(args: &PlayArgs, console: &Console, line: &str, kept: &mut Kept) -> Result<Value, NoAnswer> {
    let error = |error: serde_json::Error| NoAnswer::Error(format!("the job is not understood: {error}"));
    let job: Job = serde_json::from_str(line).map_err(error)?;
    let Bounded { bounds } = serde_json::from_str(line).map_err(error)?;
    if let Wish::Pixel { x, y } = job.wish {
        return Ok(kept.pictures.pixel(x, y));
    }
    let mut work = |kept: &mut Kept| {
        put_texts(&job);
        answer_of(args, console, &job, kept)
    };
    match bounds.filter(|_| !job.texts.is_empty()) {
        Some(bounds) => {
            within(&bounds, kept, &mut work, || read_from_disk(args, console, &job, bounds.made.as_deref()))
        }
        None => work(kept).map_err(NoAnswer::Error),
    }
}

/// The answer to a job that reads only what it may. `read` reads what is on disk.
fn within(
    bounds: &Bounds,
    kept: &mut Kept,
    work: &mut impl FnMut(&mut Kept) -> Result<Value, String>,
    read: impl FnOnce(),
) -> Result<Value, NoAnswer> {
    let known = kept.outside.clone();
    let (mut answer, mut refused) = gate::held(&bounds.folders, &known, || work(kept));
    if !refused.is_empty() {
        kept.outside.extend(gate::learned(&bounds.folders, read).1);
        let known = kept.outside.clone();
        (answer, refused) = gate::held(&bounds.folders, &known, || work(kept));
    }
    match refused.pop_first() {
        Some(path) => Err(NoAnswer::Outside(path)),
        None => answer.map_err(NoAnswer::Error),
    }
}

fn put_texts(job: &Job) {
    buffers::clear();
    for (name, text) in &job.texts {
        buffers::put(Path::new(name), text.clone().into_bytes());
    }
}

/// Reads a scene as it is on disk, or as the server made it.
fn read_from_disk(args: &PlayArgs, console: &Console, job: &Job, made: Option<&str>) {
    let of = SceneArgs::of(&job.scene, &args.machine, &args.sources, &args.levels);
    buffers::clear();
    if let Some(text) = made.filter(|_| !Path::new(&job.scene).exists()) {
        buffers::put(Path::new(&job.scene), text.as_bytes().to_vec());
    }
    match &job.wish {
        // What the shaders read counts, not whether a scene can be made.
        Wish::NewScene { files } => drop(new_scene::make(&scene_args(args, job, files), console)),
        _ => {
            if let Ok(session) = of.session(console) {
                scene::load(&job.scene, &SceneFiles, session.compiler());
            }
        }
    }
}

fn scene_args(args: &PlayArgs, job: &Job, files: &[String]) -> NewSceneArgs {
    NewSceneArgs::of_page(files.to_vec(), PathBuf::from(&job.scene), &args.sources, &args.levels)
}

/// A scene for some shaders, with the texts of the files that it takes, or a draft of one while they have errors.
fn new_scene(args: &PlayArgs, console: &Console, job: &Job, files: &[String]) -> Result<Value, String> {
    let of = scene_args(args, job, files);
    let (text, shader, is_draft) = match new_scene::make(&of, console).map_err(told)? {
        Ok(made) => (made.scene, made.shader, false),
        Err(_) => (new_scene::draft(&of), None, true),
    };
    let others: BTreeMap<_, _> = shader.into_iter().map(|Missing { path, text }| (path, text)).collect();
    Ok(json!({ "name": job.scene, "text": text, "others": others, "is_draft": is_draft }))
}

fn told(failure: Failure) -> String {
    match failure.help {
        Some(help) => format!("{}; {help}", failure.message),
        None => failure.message,
    }
}

fn answer_of(args: &PlayArgs, console: &Console, job: &Job, kept: &mut Kept) -> Result<Value, String> {
    if let Wish::NewScene { files } = &job.wish {
        return new_scene(args, console, job, files);
    }
    let Kept { driver, pictures, programs, .. } = kept;
    let of = SceneArgs::of(&job.scene, &args.machine, &args.sources, &args.levels);
    let mut session = of.session(console).map_err(told)?;
    let mut load = |session: &mut Session<'_>| programs.load(&job.scene, &SceneFiles, session.compiler());
    match job.wish {
        Wish::Draw { gpu: true, .. } => {
            let (scene, _) = drawable(load(&mut session))?;
            timed(|| driver.draw(&scene, &args.machine, pictures))
        }
        Wish::Judge => {
            let (scene, sources) = drawable(load(&mut session))?;
            driver.compare(&scene, &sources, &args.machine, pictures)
        }
        Wish::Variants => variants(&job.scene, session.compiler(), driver.gpu(&args.machine)?),
        Wish::Draw { gpu: false, .. } => timed(|| glisten_play::answer(job, &mut session, pictures, load)),
        _ => glisten_play::answer(job, &mut session, pictures, load),
    }
}
