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
    let program = built(&source, &folder.join("build"))?;
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

/// Builds the copy; returns its program.
fn built(source: &Path, build: &Path) -> Result<PathBuf, String> {
    let mut cargo = Command::new("cargo");
    cargo.args(["build", "-p", "glisten-fuzz", "--manifest-path"]).arg(source.join("Cargo.toml"));
    cargo.arg("--target-dir").arg(build).env_remove(SWITCH);
    // What the planted expressions do not use is no matter.
    cargo.env("RUSTFLAGS", "--cap-lints=allow");
    let status = cargo.status().map_err(|error| format!("cargo: {error}"))?;
    if status.success() { Ok(build.join("debug/fuzz")) } else { Err("the copy cannot be built".to_owned()) }
}

/// The result of a search.
struct Search {
    /// The kind of fault that was found.
    found: Option<String>,
    programs: u64,
    seconds: f64,
}

/// Generates programs until one shows the fault, or the time is over.
fn search(program: &Path, fault: Option<(usize, &Planted)>, wanted: Wanted<'_>) -> Result<Search, String> {
    let mut command = Command::new(program);
    command.args(["--generate", "1000000", "--first"]).args(["--seed", &wanted.seed.to_string()]);
    command.args(["--jobs", &wanted.jobs.to_string()]).args(["--seconds", &wanted.seconds.to_string()]);
    command.env_remove(SWITCH).stderr(Stdio::null());
    if let Some((number, fault)) = fault {
        command.env(SWITCH, number.to_string());
        if fault.device {
            command.args(["--draw", "--check", "device"]);
        }
    }
    let output = command.output().map_err(|error| format!("{}: {error}", program.display()))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut words = text.lines().next().unwrap_or_default().split_whitespace();
    let programs = words.next().and_then(|word| word.parse().ok()).unwrap_or(0);
    let seconds = words.nth(2).and_then(|word| word.parse().ok()).unwrap_or(0.0);
    let found =
        text.lines().find_map(|line| line.strip_prefix("- ")?.split_once(": ").map(|(_, kind)| kind.to_owned()));
    // A process that ends by itself, such as by a stack that is too small, has found something, too.
    let found = found.or_else(|| output.status.code().is_none().then(|| "the process was ended".to_owned()));
    Ok(Search { found, programs, seconds })
}
