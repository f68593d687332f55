//! The first hour of a new user, over repositories: `new-scene`, then `render`, then `verify`, for program after program.
//!
//! ```sh
//! cargo run -p glisten-studies --bin first_hour -- FOLDER [--sample N] [--only NAME] [--jobs N] [--seconds N] [--keep DIR] [--list]
//! ```
//!
//! `FOLDER` contains a folder for each repository. Those of `crates/studies/src/bin/repositories/repositories.toml` and of the
//! list next to this file have its flags. With `--sample`, at
//! most so many programs of each repository, evenly chosen (default: 20); with `--only`, repositories whose names contain the text; with
//! `--seconds`, each command may take so long (default: 60); with `--keep`, scenes and pictures stay in a folder for each program; with
//! `--list`, a line for each program is printed. The table says how many programs of each kind draw, cover pixels, are not of one color,
//! and what `verify` says; then each failure has a row with its reason. It needs a Vulkan adapter, and the program built next to it.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

#[path = "../repositories/list.rs"]
#[expect(dead_code, reason = "shared with the study of repositories, which reads more of it")]
mod list;
mod programs;
mod steps;
mod table;

use programs::{Found, find};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;
use steps::{Steps, Taken};

/// The requests of the command line.
struct Arguments {
    folder: PathBuf,
    sample: usize,
    only: Option<String>,
    jobs: usize,
    seconds: u64,
    keep: Option<PathBuf>,
    list: bool,
}

fn arguments(mut words: impl Iterator<Item = String>) -> Option<Arguments> {
    let folder = words.next()?.into();
    let mut found = Arguments { folder, sample: 20, only: None, jobs: 2, seconds: 60, keep: None, list: false };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--sample" => found.sample = words.next()?.parse().ok()?,
            "--only" => found.only = Some(words.next()?),
            "--jobs" => found.jobs = words.next()?.parse().ok()?,
            "--seconds" => found.seconds = words.next()?.parse().ok()?,
            "--keep" => found.keep = Some(words.next()?.into()),
            "--list" => found.list = true,
            _ => return None,
        }
    }
    Some(found)
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [task, scene] = &words[..]
        && task == "--show"
    {
        return steps::show(scene);
    }
    let Some(arguments) = arguments(words.into_iter()) else {
        eprintln!("usage: first_hour FOLDER [--sample N] [--only NAME] [--jobs N] [--seconds N] [--keep DIR] [--list]");
        return ExitCode::from(2);
    };
    match measure(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn measure(arguments: &Arguments) -> Result<(), String> {
    let found = find(&arguments.folder, arguments.only.as_deref(), arguments.sample)?;
    let work = tempfile::tempdir().map_err(|error| error.to_string())?;
    let base = arguments.keep.clone().unwrap_or_else(|| work.path().to_owned());
    let steps = Steps::new(Duration::from_secs(arguments.seconds))?;
    let queue = Mutex::new(found.into_iter().enumerate());
    let results: Mutex<Vec<(usize, Found, Taken)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..arguments.jobs.max(1) {
            scope.spawn(|| {
                while let Some((index, program)) = queue.lock().ok().and_then(|mut queue| queue.next()) {
                    let folder = base.join(&program.repository).join(format!("{index:04}"));
                    let taken = steps.take(&program, &folder);
                    if arguments.list {
                        println!("{}", table::line(&program, &taken));
                    }
                    if let Ok(mut results) = results.lock() {
                        results.push((index, program, taken));
                    }
                }
            });
        }
    });
    let mut results = results.into_inner().map_err(|error| error.to_string())?;
    results.sort_by_key(|(index, ..)| *index);
    let folder = arguments.folder.to_string_lossy();
    println!("{}", table::tables(&results, &programs::known()?, &folder));
    Ok(())
}
