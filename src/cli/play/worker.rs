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
use super::super::session::Session;
use super::PlayArgs;
use super::driver::{Driver, timed};
use super::variants::variants;
use crate::play::{self, Job, Pictures, Wish, drawable};
use serde_json::{Value, json};
use std::io::BufRead;
use std::path::Path;
use std::sync::mpsc;

/// Runs the worker.
pub(super) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    let mut kept = Kept::default();
    for line in lines()? {
        let answer = match guard::guarded(|| answer(args, console, &line, &mut kept)) {
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

/// The state of a worker from job to job.
#[derive(Default)]
struct Kept {
    driver: Driver,
    pictures: Pictures,
    programs: play::Kept,
}

fn answer(args: &PlayArgs, console: &Console, line: &str, kept: &mut Kept) -> Result<Value, String> {
    let job: Job = serde_json::from_str(line).map_err(|error| format!("the job is not understood: {error}"))?;
    let Kept { driver, pictures, programs } = kept;
    if let Wish::Pixel { x, y } = job.wish {
        return Ok(pictures.pixel(x, y));
    }
    buffers::clear();
    for (name, text) in &job.texts {
        buffers::put(Path::new(name), text.clone().into_bytes());
    }
    let of = SceneArgs::of(&job.scene, &args.machine, &args.sources, &args.levels);
    let failed = |failure| match failure {
        Failure::Told { message, .. } => message,
        Failure::OutputClosed => String::new(),
    };
    let mut session = of.session(console).map_err(failed)?;
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
        Wish::Draw { gpu: false, .. } => timed(|| play::answer(&job, &mut session, pictures, load)),
        _ => play::answer(&job, &mut session, pictures, load),
    }
}
