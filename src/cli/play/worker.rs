//! The worker: a process that answers the jobs of the server, one after the other.
//!
//! *In:* a job on each line of standard input. *Out:* an answer on each line of standard output: `{"ok": ...}` or
//! `{"error": "..."}`. *Holds:* it ends when its input ends, whatever it is doing, so that it never outlives the server.

use super::super::buffers;
use super::super::console::Console;
use super::super::exit::{Exit, Failure, Outcome};
use super::super::files::SceneFiles;
use super::super::guard;
use super::super::scenes::SceneArgs;
use super::PlayArgs;
use super::pictures::Pictures;
use crate::play::{Job, Shown, Wish, look, told};
use crate::scene::{self, Loaded};
use glisten_emit::Target;
use glisten_front::source::SourceMap;
use glisten_reference::trace::{Place, trace};
use serde_json::{Value, json};
use std::io::BufRead;
use std::path::Path;
use std::sync::mpsc;

/// Runs the worker.
pub(super) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    let mut pictures = Pictures::default();
    for line in lines()? {
        let answer = match guard::guarded(|| answer(args, console, &line, &mut pictures)) {
            Ok(Ok(answer)) => json!({ "ok": answer }),
            Ok(Err(error)) => json!({ "error": error }),
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

fn answer(args: &PlayArgs, console: &Console, line: &str, pictures: &mut Pictures) -> Result<Value, String> {
    let job: Job = serde_json::from_str(line).map_err(|error| format!("the job is not understood: {error}"))?;
    if let Wish::Pixel { x, y } = job.wish {
        return Ok(pictures.pixel(x, y));
    }
    buffers::clear();
    for (name, text) in job.texts {
        buffers::put(Path::new(&name), text.into_bytes());
    }
    let of = SceneArgs::of(&job.scene, &args.machine, &args.sources, &args.levels);
    let failed = |failure| match failure {
        Failure::Told { message, .. } => message,
        Failure::OutputClosed => String::new(),
    };
    let mut session = of.session(console).map_err(failed)?;
    let loaded = scene::load(&job.scene, &SceneFiles, session.compiler());
    match job.wish {
        Wish::Look { target, leaves_out } => {
            let target = Target::from_word(&target).ok_or_else(|| format!("`{target}` is no language"))?;
            Ok(look(&mut session, &job.scene, loaded, Shown { target, leaves_out }).0)
        }
        Wish::Draw { gpu } => {
            let (scene, _) = drawable(loaded)?;
            if gpu { pictures.driver(&scene, &args.machine) } else { pictures.reference(&scene) }
        }
        Wish::Judge => {
            let (scene, sources) = drawable(loaded)?;
            pictures.compare(&scene, &sources, &args.machine)
        }
        Wish::Trace { x, y } => {
            let (scene, sources) = drawable(loaded)?;
            followed(&job.scene, &scene, &sources, [x, y])
        }
        Wish::Pixel { .. } => Ok(Value::Null),
    }
}

/// The values that the fragments of a pixel computed, as `glisten trace` tells them.
fn followed(name: &str, scene: &scene::Scene, sources: &SourceMap, pixel: [u32; 2]) -> Result<Value, String> {
    let place = Place::Pixel(pixel);
    let found = trace(scene, place).map_err(|errors| told(errors.iter().take(1)))?;
    serde_json::to_value(crate::trace::told(name, scene, sources, place, &found)).map_err(|error| error.to_string())
}

fn drawable(loaded: Loaded) -> Result<(scene::Scene, SourceMap), String> {
    let Loaded { scene, sources, diagnostics, .. } = loaded;
    match scene {
        Some(scene) => Ok((scene, sources)),
        None => {
            let diagnostics: Vec<_> = diagnostics.into_iter().filter(|diagnostic| diagnostic.is_error()).collect();
            Err(told(diagnostics.iter().take(1)))
        }
    }
}
