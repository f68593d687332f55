//! `fuzz`: fuzzes targets by libFuzzer.
//!
//! ```text
//!  fixtures ──► target/fuzz/seeds/TARGET ──┐
//!  tables   ──► target/fuzz/words          ├──► the engine, built with counters for coverage ──► target/fuzz/crashes/TARGET
//!  target/fuzz/found/TARGET ◄──────────────┘
//! ```
//!
//! *In:* the names of targets and a time. *Out:* inputs that break a promise, as files; a line for each target with what was
//! executed. The exit code is 1 if there is such an input. *Holds:* a stable compiler is enough: the counters are a pass of LLVM.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for developers")]

mod generated;
mod survey;

use clap::Parser;
use glisten_fuzz::faults;
use glisten_fuzz::record::{self, Run};
use glisten_fuzz::{TARGETS, Target, dictionary, seeds, target};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// The flags by which rustc counts which edges of the program were taken, as libFuzzer reads it.
const COUNTERS: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=3 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares";

/// Fuzzes glisten's promises. Without targets, it lists them.
#[derive(Parser, Debug)]
struct Arguments {
    /// The targets, or `all`
    targets: Vec<String>,
    /// How long to fuzz each target
    #[arg(long, default_value_t = 1.0)]
    minutes: f64,
    /// More folders of sources, scenes and models to start from
    #[arg(long)]
    seeds: Vec<PathBuf>,
    /// How many processes to run at once
    #[arg(long, default_value_t = 1)]
    jobs: u32,
    /// Instead of fuzzing, make this input of the target smaller
    #[arg(long)]
    minimize: Option<PathBuf>,
    /// Instead of fuzzing, change sources in so many ways, and compare the verdicts of glisten and of glslang
    #[arg(long, value_name = "N")]
    mutants: Option<usize>,
    /// Instead of fuzzing, generate so many valid programs, and check what must hold for them
    #[arg(long, value_name = "N")]
    generate: Option<u64>,
    /// Draw generated programs on a GPU, too
    #[arg(long)]
    draw: bool,
    /// Make this check of generated programs alone
    #[arg(long, value_name = "CHECK")]
    check: Option<String>,
    /// Make each check of generated programs for one program in so many, as the seed chooses
    #[arg(long, value_name = "N", default_value_t = 1)]
    share: u32,
    /// Stop generating at the first fault, which is not made smaller
    #[arg(long)]
    first: bool,
    /// Stop generating after so many seconds
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Instead of fuzzing, plant the faults of a table in a copy of the sources, and see which the generator finds
    #[arg(long)]
    faults: bool,
    /// Print the program of this seed
    #[arg(long, value_name = "SEED")]
    program: Option<u64>,
    /// Add each run to this record, as rows of CSV
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Instead of fuzzing, print the sums of this record
    #[arg(long, value_name = "FILE")]
    recorded: Option<PathBuf>,
    /// The number from which the changes follow
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// An error, as a sentence.
type Result<T> = std::result::Result<T, String>;

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(found) => {
            eprintln!("{found} inputs break a promise");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<usize> {
    if let Some(count) = arguments.mutants {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folders: Vec<PathBuf> = match arguments.seeds.as_slice() {
            [] => ["fixtures/valid", "fixtures/programs"].map(|folder| root.join(folder)).to_vec(),
            named => named.to_vec(),
        };
        let (table, bad) = survey::survey(&folders, count, arguments.seed, &root.join("target/fuzz/mutants"))?;
        println!("{table}");
        return Ok(bad);
    }
    if let Some(seed) = arguments.program {
        print!("{}", glisten_fuzz::generate::Program::new(seed).text());
        return Ok(0);
    }
    if arguments.faults {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let (seed, jobs) = (arguments.seed, arguments.jobs);
        let wanted = faults::Wanted { seed, jobs, seconds: arguments.seconds.unwrap_or(60.0), root: &root };
        print!("{}", faults::run(wanted)?);
        return Ok(0);
    }
    if let Some(count) = arguments.generate {
        return generate(arguments, count);
    }
    if let Some(file) = &arguments.recorded {
        let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
        print!("{}", record::sums(&text));
        return Ok(0);
    }
    if arguments.targets.is_empty() {
        TARGETS.iter().for_each(|target| println!("{:12} {}", target.name, target.promise));
        return Ok(0);
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = root.join("target/fuzz");
    let engine = built(&root, &folder)?;
    let words = folder.join("words");
    write(&words, dictionary().as_bytes())?;
    let mut found = 0;
    for chosen in chosen(&arguments.targets)? {
        let place = Place { chosen, engine: &engine, words: &words, folder: &folder };
        match &arguments.minimize {
            Some(input) => place.minimize(input)?,
            None => found += place.fuzz(&root, arguments)?,
        }
    }
    Ok(found)
}

/// Generates programs and checks them; returns the number of faults.
fn generate(arguments: &Arguments, count: u64) -> Result<usize> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let start = record::cpu_of_process();
    let sums = generated::run(generated::Wanted {
        count,
        seed: arguments.seed,
        jobs: arguments.jobs,
        draws: arguments.draw,
        only: arguments.check.as_deref(),
        one_in: arguments.share as usize,
        first: arguments.first,
        seconds: arguments.seconds,
        folder: &root.join("target/fuzz/generated"),
    })?;
    print!("{}", sums.text());
    let broken = sums.found.len();
    if let Some(file) = &arguments.record {
        let cpu = record::cpu_of_process().zip(start).map(|(end, start)| end - start);
        let (jobs, executions) = (arguments.jobs, sums.programs);
        let run = Run { target: "generated".to_owned(), minutes: sums.seconds / 60.0, jobs, executions, broken, cpu };
        record::add(file, &root, &run)?;
    }
    Ok(broken)
}

fn chosen(names: &[String]) -> Result<Vec<&'static Target>> {
    if names.iter().any(|name| name == "all") {
        return Ok(TARGETS.iter().collect());
    }
    names.iter().map(|name| target(name).ok_or_else(|| format!("there is no target `{name}`"))).collect()
}

/// Builds the engine; returns its path.
fn built(root: &Path, folder: &Path) -> Result<PathBuf> {
    let version = Command::new("rustc").arg("-vV").output().map_err(|error| format!("rustc: {error}"))?;
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).ok_or("rustc names no host")?;
    let (manifest, build) = (root.join("crates/fuzz/engine/Cargo.toml"), folder.join("build"));
    let mut cargo = Command::new("cargo");
    // With a target, build scripts and derive macros have no counters.
    cargo.args(["build", "--target", host, "--manifest-path"]).arg(manifest).arg("--target-dir").arg(&build);
    let status = cargo.env("RUSTFLAGS", COUNTERS).status().map_err(|error| format!("cargo: {error}"))?;
    if !status.success() {
        return Err("the engine cannot be built; libFuzzer needs a compiler of C++".to_owned());
    }
    Ok(build.join(host).join("debug/glisten-fuzz-engine"))
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, bytes))
        .map_err(|error| format!("{}: {error}", path.display()))
}

/// A target with its files.
struct Place<'a> {
    chosen: &'static Target,
    engine: &'a Path,
    words: &'a Path,
    folder: &'a Path,
}

impl Place<'_> {
    /// The folder of this name for the target; it exists.
    fn folder(&self, name: &str) -> Result<PathBuf> {
        let folder = self.folder.join(name).join(self.chosen.name);
        std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(folder)
    }

    fn engine(&self) -> Result<Command> {
        let mut engine = Command::new(self.engine);
        engine.env("GLISTEN_FUZZ_TARGET", self.chosen.name).arg("-timeout=120").arg("-rss_limit_mb=3072");
        engine.arg(format!("-artifact_prefix={}/", self.folder("crashes")?.display()));
        Ok(engine)
    }

    /// Fuzzes; returns the number of inputs that break the promise.
    fn fuzz(&self, root: &Path, arguments: &Arguments) -> Result<usize> {
        let name = self.chosen.name;
        let (begin, found, crashes) = (self.folder("seeds")?, self.folder("found")?, self.folder("crashes")?);
        let mut folders =
            vec![root.join("fixtures"), root.join("shader_lib"), root.join("crates/fuzz/corpus").join(name)];
        folders.extend(arguments.seeds.iter().cloned());
        let seeds = seeds(self.chosen.begins, &folders);
        for seed in &seeds {
            write(&begin.join(&seed.name), &seed.bytes)?;
        }
        let count = || std::fs::read_dir(&crashes).map_or(0, |files| files.flatten().count());
        let before = count();
        println!("{name}: {} ({} seeds, {} minutes)", self.chosen.promise, seeds.len(), arguments.minutes);
        let mut engine = self.engine()?;
        engine.args([
            "-print_final_stats=1",
            "-max_len=12000",
            "-ignore_crashes=1",
            "-ignore_timeouts=1",
            "-ignore_ooms=1",
        ]);
        engine.arg(format!("-fork={}", arguments.jobs)).arg(format!("-dict={}", self.words.display()));
        engine.arg(format!("-max_total_time={}", (arguments.minutes * 60.0).ceil()));
        engine.args([found, begin]).stderr(Stdio::piped());
        let start = record::cpu_of_children();
        let output = engine.output().map_err(|error| format!("the engine: {error}"))?;
        let log = String::from_utf8_lossy(&output.stderr).into_owned();
        write(&self.folder.join("logs").join(name), log.as_bytes())?;
        let last = log.lines().rev().find(|line| line.starts_with('#')).unwrap_or("nothing was executed");
        println!("{name}: {last}");
        let executions = record::executions(last);
        let files = std::fs::read_dir(&crashes).map_err(|error| format!("{}: {error}", crashes.display()))?;
        let broken: Vec<PathBuf> = files.flatten().map(|entry| entry.path()).collect();
        broken.iter().for_each(|path| println!("{name}: {}", path.display()));
        if let Some(file) = &arguments.record {
            let (minutes, jobs) = (arguments.minutes, arguments.jobs);
            let broken = broken.len().saturating_sub(before);
            let cpu = record::cpu_of_children().zip(start).map(|(end, start)| end - start);
            let run = Run { target: name.to_owned(), minutes, jobs, executions, broken, cpu };
            record::add(file, root, &run)?;
        }
        Ok(broken.len())
    }

    fn minimize(&self, input: &Path) -> Result<()> {
        let mut engine = self.engine()?;
        engine.args(["-minimize_crash=1", "-max_total_time=120"]).arg(input);
        engine.status().map(|_| ()).map_err(|error| format!("the engine: {error}"))
    }
}
