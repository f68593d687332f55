//! Measures `glisten lint` over a folder: against `glslangValidator` on the same files, and over ten thousand files, without a cache, while
//! one is filled, and from it.
//!
//! `cargo bench --bench lint -- [FOLDER]` takes the shaders of the folder (default: `fixtures`) that `glslangValidator` accepts without
//! another file, or all if it is not installed. Each figure is the median of its rounds, in seconds on the clock and of all processors.
//! A cache of findings has to read each file and what was found, and to hash both; the last row is that, and nothing else.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod spent;

use sha2::{Digest, Sha256};
use spent::{Spent, median, spent};
use std::cell::Cell;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const ROUNDS: usize = 5;
/// The files of the large folder.
const MANY: usize = 10_000;
/// The files of a folder.
const TOGETHER: usize = 20;
/// The bytes of findings that a cache keeps for a file, at least.
const ENTRY: usize = 512;

fn main() {
    let folder = std::env::args().skip(1).find(|word| !word.starts_with("--"));
    let folder = PathBuf::from(folder.unwrap_or_else(|| format!("{}/fixtures", env!("CARGO_MANIFEST_DIR"))));
    let has_glslang = Command::new("glslangValidator").arg("--version").stdout(Stdio::null()).status().is_ok();
    let mut files = Vec::new();
    shaders(&folder, &mut files);
    files.retain(|file| !has_glslang || glslang(file));
    assert!(!files.is_empty(), "no shader in {}", folder.display());
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let [small, large] = ["small", "large"].map(|name| temporary.path().join(name));
    let few = copied(&files, files.len(), &small);
    let many = copied(&files, MANY, &large);
    println!("| run | files | seconds | CPU seconds |\n| --- | --- | --- | --- |");
    let own = row("glisten lint", few.len(), &|| lint(&small, None));
    let kept = temporary.path().join("kept-of-few");
    lint(&small, Some(&kept));
    row("glisten lint, all from the cache", few.len(), &|| lint(&small, Some(&kept)));
    if has_glslang {
        let each = row("glslangValidator, a process for each file", few.len(), &|| {
            few.iter().for_each(|file| {
                black_box(glslang(file));
            });
        });
        let at_once = row("glslangValidator, one process", few.len(), &|| {
            black_box(glslang_of(&few));
        });
        println!(
            "\nof its CPU time, lint takes {:.2}; of that of one process, {:.2}\n",
            own.cpu / each.cpu,
            own.cpu / at_once.cpu
        );
        println!("| run | files | seconds | CPU seconds |\n| --- | --- | --- | --- |");
    }
    let plain = row("glisten lint", many.len(), &|| lint(&large, None));
    // A folder for each round: file systems are slow to make files where many were removed just before.
    let round = Cell::new(0);
    row("glisten lint, nothing in the cache", many.len(), &|| {
        round.set(round.get() + 1);
        lint(&large, Some(&temporary.path().join(format!("kept-{}", round.get()))));
    });
    let kept = temporary.path().join(format!("kept-{}", round.get()));
    let recalled = row("glisten lint, all from the cache", many.len(), &|| lint(&large, Some(&kept)));
    with_entries(&many);
    row("reading and hashing files and findings, one thread", many.len(), &|| {
        black_box(cached(&many));
    });
    println!("\nfrom the cache, lint takes {:.2} of its CPU time", recalled.cpu / plain.cpu);
}

/// Measures work, and prints the median of its rounds.
fn row(name: &str, files: usize, work: &dyn Fn()) -> Spent {
    let rounds: Vec<Spent> = (0..ROUNDS).map(|_| spent(work)).collect();
    let time = median(rounds.into_iter());
    println!("| {name} | {files} | {:.2} | {:.2} |", time.seconds, time.cpu);
    time
}

/// The shaders in a folder whose names tell the stage to both.
fn shaders(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            shaders(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "vert" || extension == "frag") {
            found.push(path);
        }
    }
}

/// Copies of files under names of their own, some in each folder, until there are so many.
fn copied(files: &[PathBuf], count: usize, to: &Path) -> Vec<PathBuf> {
    let copy = |(index, file): (usize, &PathBuf)| {
        let folder = to.join(format!("{}", index / TOGETHER));
        fs::create_dir_all(&folder).expect("a folder");
        let name = file.file_name().expect("a file").to_string_lossy();
        let path = folder.join(format!("{index}-{name}"));
        fs::copy(file, &path).expect("copied");
        path
    };
    files.iter().cycle().take(count).enumerate().map(copy).collect()
}

fn lint(folder: &Path, cache: Option<&Path>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.args(["lint", "--quiet", "--format", "json"]).arg(folder).stdout(Stdio::null());
    match cache {
        Some(cache) => command.arg("--cache").arg(cache),
        None => command.arg("--no-cache"),
    };
    let status = command.status().expect("glisten runs");
    assert!(status.code().is_some_and(|code| code < 2), "{status}");
}

fn glslang(file: &Path) -> bool {
    glslang_of(std::slice::from_ref(&file.to_path_buf()))
}

fn glslang_of(files: &[PathBuf]) -> bool {
    let mut command = Command::new("glslangValidator");
    let status = command.args(files).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Makes an entry of a cache for each file.
fn with_entries(files: &[PathBuf]) {
    for file in files {
        fs::write(file.with_extension("found"), [b'x'; ENTRY]).expect("written");
    }
}

/// The work of a cache of findings that knows everything: each file and its entry are read and hashed.
fn cached(files: &[PathBuf]) -> usize {
    let hash = |path: &Path| usize::from(Sha256::digest(fs::read(path).expect("a file"))[0]);
    files.iter().map(|file| hash(file) + hash(&file.with_extension("found"))).sum()
}
