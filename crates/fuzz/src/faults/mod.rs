//! `--faults`: faults planted in a copy of glisten's sources, and which of them the generator finds.
//!
//! ```text
//!  crates/fuzz/faults.toml ──► copy of the sources with a switch at each ──► one build
//!                                                                              │ GLISTEN_FAULT=n
//!  table ◄── found or not, after how many programs, how many seconds ◄─────────┘ for each
//! ```
//!
//! *In:* the table. *Out:* a row for each fault. *Holds:* without a fault the same programs pass; a text that a file does not have once is an
//! error. The copy and its build are in `target/fuzz/faults`.

mod copy;
mod table;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;
pub use table::{Planted, read};

/// The runs that are asked for.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The first of the seeds.
    pub seed: u64,
    /// The threads of each run.
    pub jobs: u32,
    /// How long each fault is searched.
    pub seconds: f64,
    /// The root of the sources.
    pub root: &'a Path,
}

/// Whether every text of the table is once in its file.
///
/// # Errors
/// The first that is not, or what cannot be read.
pub fn check(root: &Path) -> Result<usize, String> {
    let faults = table_of(root)?;
    copy::sources(root, &faults)?;
    Ok(faults.len())
}

fn table_of(root: &Path) -> Result<Vec<Planted>, String> {
    let file = root.join("crates/fuzz/faults.toml");
    read(&std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?)
}

/// The environment variable that chooses a fault, by its number from 1.
const SWITCH: &str = "GLISTEN_FAULT";

/// Plants all faults, searches each, and returns the table.
///
/// # Errors
/// The table cannot be read, a text is not where it is looked for, the copy cannot be built, or it is faulty without a fault.
pub fn run(wanted: Wanted<'_>) -> Result<String, String> {
    let faults = table_of(wanted.root)?;
    let folder = wanted.root.join("target/fuzz/faults");
    let source = folder.join("source");
    copy::copy(wanted.root, &source)?;
    copy::plant(wanted.root, &source, &faults)?;
    let draws = faults.iter().any(|fault| fault.device);
    let program = built(&source, &folder.join("build"), draws)?;
    let without = search(&program, None, wanted)?;
    if let Some(kind) = without.found {
        return Err(format!("without a fault, the generator finds: {kind}"));
    }
    let mut text = "| fault | phase | found by | programs | seconds |\n| --- | --- | --- | --- | --- |\n".to_owned();
    let (mut found, start) = (0, Instant::now());
    for (number, fault) in faults.iter().enumerate() {
        let Search { found: by, programs, seconds } = search(&program, Some((number + 1, fault)), wanted)?;
        found += usize::from(by.is_some());
        let by = by.map_or("not found".to_owned(), |kind| kind.replace('|', "\\|"));
        let _ = writeln!(text, "| {} | {} | {by} | {programs} | {seconds:.1} |", fault.name, fault.phase);
    }
    let _ = writeln!(text, "\n{found} of {} faults are found, in {:.0} s", faults.len(), start.elapsed().as_secs_f64());
    Ok(text)
}

/// Builds the copy, with what draws on a GPU if a fault needs one; returns its program.
fn built(source: &Path, build: &Path, draws: bool) -> Result<PathBuf, String> {
    let mut cargo = Command::new("cargo");
    cargo.args(["build", "--release", "-p", "glisten-fuzz", "--manifest-path"]).arg(source.join("Cargo.toml"));
    cargo.args(["--no-default-features", "--features", if draws { "draw" } else { "checks" }]);
    cargo.arg("--target-dir").arg(build).env_remove(SWITCH);
    // What the planted expressions do not use is no matter.
    cargo.env("RUSTFLAGS", "--cap-lints=allow");
    let status = cargo.status().map_err(|error| format!("cargo: {error}"))?;
    if status.success() { Ok(build.join("release/fuzz")) } else { Err("the copy cannot be built".to_owned()) }
}

/// The result of a search.
struct Search {
    /// The kind of fault that was found.
    found: Option<String>,
    programs: u64,
    seconds: f64,
}

/// Generates programs until one shows the fault and is sound without it, or the time is over.
fn search(program: &Path, fault: Option<(usize, &Planted)>, wanted: Wanted<'_>) -> Result<Search, String> {
    let start = Instant::now();
    let (mut seed, mut programs) = (wanted.seed, 0);
    loop {
        let seconds = wanted.seconds - start.elapsed().as_secs_f64();
        let run = generated(program, fault, fault.map(|(number, _)| number), (seed, 1_000_000, seconds), wanted.jobs)?;
        programs += run.programs;
        let seconds = start.elapsed().as_secs_f64();
        let Some((kind, its_seed)) = run.found else { return Ok(Search { found: None, programs, seconds }) };
        // A driver may be wrong without a fault of glisten's.
        let is_sound =
            fault.is_none() || { generated(program, fault, None, (its_seed, 1, wanted.seconds), 1)?.found.is_none() };
        if is_sound {
            return Ok(Search { found: Some(kind), programs, seconds: start.elapsed().as_secs_f64() });
        }
        if seconds >= wanted.seconds {
            return Ok(Search { found: None, programs, seconds });
        }
        seed = its_seed.max(seed) + 1;
    }
}

/// A run of the generator.
struct Run {
    programs: u64,
    /// The kind of the first fault, and the seed of its program.
    found: Option<(String, u64)>,
}

/// Runs the generator with the checks that a fault needs: from a seed, so many programs at most, so many seconds at most.
fn generated(
    program: &Path,
    fault: Option<(usize, &Planted)>,
    switch: Option<usize>,
    (seed, count, seconds): (u64, u64, f64),
    jobs: u32,
) -> Result<Run, String> {
    let mut command = Command::new(program);
    command.args(["--first", "--generate", &count.to_string(), "--seed", &seed.to_string()]);
    command.args(["--jobs", &jobs.to_string(), "--seconds", &seconds.max(1.0).to_string()]);
    command.env_remove(SWITCH).stderr(Stdio::null());
    if let Some(number) = switch {
        command.env(SWITCH, number.to_string());
    }
    if fault.is_some_and(|(_, fault)| fault.device) {
        command.args(["--draw", "--check", "device"]);
    }
    let output = command.output().map_err(|error| format!("{}: {error}", program.display()))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut words = text.lines().next().unwrap_or_default().split_whitespace();
    let programs = words.next().and_then(|word| word.parse().ok()).unwrap_or(0);
    let kind = |line: &str| {
        let (head, kind) = line.strip_prefix("- ")?.split_once(": ")?;
        Some((kind.trim().to_owned(), head.rsplit(' ').next()?.parse().ok()?))
    };
    let found = text.lines().find_map(kind);
    // A process that ends by itself, such as by a stack that is too small, has found something, too.
    let found = found.or_else(|| output.status.code().is_none().then(|| ("the process was ended".to_owned(), seed)));
    Ok(Run { programs, found })
}
