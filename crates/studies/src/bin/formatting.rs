//! `glisten fmt` over public repositories: how much it formats, whether the tokens stay, whether a second run changes anything.
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin formatting -- FOLDER
//! ```
//!
//! `FOLDER` contains a folder `owner+name` for each repository; nothing in it is written. The table, in Markdown, has a row
//! for each: sources, lines, the share of them that was kept as it was (brackets that do not match, text that does not
//! parse), sources whose characters other than white space differ afterwards, and sources that a second run changes. It
//! needs the program built next to it.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

use std::ops::AddAssign;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fs, io};

/// The figures of a repository.
#[derive(Clone, Copy, Default)]
struct Row {
    sources: usize,
    lines: usize,
    kept: usize,
    differ: usize,
    again: usize,
    seconds: f64,
}

impl AddAssign for Row {
    fn add_assign(&mut self, other: Self) {
        self.sources += other.sources;
        self.lines += other.lines;
        self.kept += other.kept;
        self.differ += other.differ;
        self.again += other.again;
        self.seconds += other.seconds;
    }
}

impl Row {
    fn line(&self, name: &str) -> String {
        let Self { sources, lines, kept, differ, again, seconds } = self;
        let share = 100.0 * *kept as f64 / (*lines).max(1) as f64;
        format!("| {name} | {sources} | {lines} | {share:.2} % | {differ} | {again} | {seconds:.2} s |")
    }
}

/// The output of a run of `glisten fmt`: the files that change, and the numbers of its last line.
struct Said {
    changes: Vec<PathBuf>,
    numbers: Vec<usize>,
}

fn fmt(program: &Path, arguments: &[&str], folder: &Path) -> io::Result<Said> {
    let output = Command::new(program).arg("fmt").args(arguments).arg(folder).output()?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.code().is_none_or(|code| code > 1) {
        return Err(io::Error::other(err.into_owned()));
    }
    let changes = out.lines().filter_map(|line| line.strip_prefix("would reformat ")).map(PathBuf::from).collect();
    let last = err.lines().last().unwrap_or_default();
    Ok(Said { changes, numbers: last.split(' ').filter_map(|word| word.parse().ok()).collect() })
}

/// The characters of a file that are no white space.
fn characters(path: &Path) -> io::Result<Vec<u8>> {
    Ok(fs::read(path)?.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect())
}

fn study(program: &Path, folder: &Path) -> io::Result<Row> {
    let started = Instant::now();
    let first = fmt(program, &["--check"], folder)?;
    let seconds = started.elapsed().as_secs_f64();
    let [_, sources, formatted, lines, ..] = first.numbers[..] else { return Ok(Row::default()) };
    let copies = tempfile::tempdir()?;
    let mut pairs = Vec::new();
    for path in &first.changes {
        let copy = copies.path().join(path.strip_prefix(folder).unwrap_or(path));
        fs::create_dir_all(copy.parent().unwrap_or(copies.path()))?;
        fs::copy(path, &copy)?;
        pairs.push((path, copy));
    }
    let mut row = Row { sources, lines, kept: lines - formatted, seconds, ..Row::default() };
    if !pairs.is_empty() {
        fmt(program, &[], copies.path())?;
        row.again = fmt(program, &["--check"], copies.path())?.changes.len();
    }
    for (path, copy) in pairs {
        row.differ += usize::from(characters(path)? != characters(&copy)?);
    }
    Ok(row)
}

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1) else {
        eprintln!("usage: formatting FOLDER");
        return ExitCode::from(2);
    };
    match run(Path::new(&folder)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints the table; whether all sources keep their tokens and stay as they are in a second run.
fn run(folder: &Path) -> io::Result<bool> {
    let own = env::current_exe()?;
    let program = own.parent().and_then(Path::parent).unwrap_or(Path::new(".")).join("glisten");
    let mut folders: Vec<PathBuf> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    folders.sort();
    println!("| repository | sources | lines | kept | other characters | changed again | time |");
    println!("| --- | --: | --: | --: | --: | --: | --: |");
    let mut all = Row::default();
    for folder in folders.iter().filter(|folder| folder.is_dir()) {
        let row = study(&program, folder)?;
        if row.sources > 0 {
            println!("{}", row.line(&folder.file_name().unwrap_or_default().to_string_lossy().replace('+', "/")));
        }
        all += row;
    }
    println!("{}", all.line("all"));
    Ok(all.differ == 0 && all.again == 0)
}
