//! `soak`: keeps programs that people leave open busy for as long as you like, and says whether they grow.
//!
//! ```text
//!  folder of shaders ──► subjects: watch, play, lsp, two processes on one cache ──► answers, each checked
//!                            │
//!                            └──► process: memory, threads, handles, processes ──► a row for each subject
//! ```
//!
//! `cargo run --release -p glisten-studies --bin soak -- --minutes 60 [--program target/release/glisten]`
//!
//! *In:* a time, the program. *Out:* a table, and exit code 1 if a subject gave a wrong answer or grew. *Holds:* each edit has a mistake
//! with a name of its own, and the answer has to name it: an answer that is missing or old is found.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for developers")]

mod process;
mod subjects;

use process::Sample;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use subjects::Subject;

/// How much more memory than after the first tenth of the time is no growth: a share, and bytes.
const SLACK: (f64, u64) = (1.25, 16 << 20);
/// The time between two edits of a subject.
const PAUSE: Duration = Duration::from_millis(400);
/// The time between two samples.
const BETWEEN_SAMPLES: Duration = Duration::from_secs(5);

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// The value of an option on the command line.
fn option(name: &str) -> Option<String> {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.nth(1)
}

fn run() -> Result<bool, String> {
    let minutes: f64 =
        option("--minutes").map_or(Ok(60.0), |text| text.parse().map_err(|_| format!("`{text}` minutes")))?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let program = option("--program").map_or_else(|| root.join("target/release/glisten"), PathBuf::from);
    let program = program.canonicalize().map_err(|error| format!("{}: {error}", program.display()))?;
    let duration = Duration::from_secs_f64(minutes * 60.0);
    let rows: Vec<Result<Row, String>> = std::thread::scope(|scope| {
        let begin = |make: subjects::Make| {
            let program = &program;
            scope.spawn(move || make(program).and_then(|subject| soaked(subject, duration)))
        };
        let running: Vec<_> = subjects::ALL.map(begin).into_iter().collect();
        running.into_iter().map(|one| one.join().unwrap_or_else(|_| Err("it panicked".to_owned()))).collect()
    });
    println!(
        "| subject | edits | wrong | MiB after a tenth | MiB at the end | MiB at most | threads | handles | processes |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut is_good = true;
    for row in rows {
        match row {
            Ok(row) => {
                println!("{}", row.told());
                is_good &= row.is_good();
            }
            Err(error) => {
                eprintln!("error: {error}");
                is_good = false;
            }
        }
    }
    Ok(is_good)
}

/// The figures of a subject.
struct Row {
    name: &'static str,
    edits: u64,
    wrong: u64,
    /// After a tenth of the time.
    early: Sample,
    late: Sample,
    most: u64,
}

impl Row {
    fn told(&self) -> String {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let pair = |of: fn(&Sample) -> usize| format!("{}, then {}", of(&self.early), of(&self.late));
        format!(
            "| {} | {} | {} | {:.1} | {:.1} | {:.1} | {} | {} | {} |",
            self.name,
            self.edits,
            self.wrong,
            mib(self.early.bytes),
            mib(self.late.bytes),
            mib(self.most),
            pair(|sample| sample.threads),
            pair(|sample| sample.handles),
            pair(|sample| sample.processes),
        )
    }

    /// Whether all answers were right, and nothing grew.
    fn is_good(&self) -> bool {
        let Self { early, late, .. } = self;
        let limit = (early.bytes as f64 * SLACK.0) as u64 + SLACK.1;
        self.wrong == 0
            && self.edits > 0
            && late.bytes <= limit
            && late.threads <= early.threads
            && late.handles <= early.handles
            && late.processes <= early.processes
    }
}

/// Edits until the time is over.
fn soaked(mut subject: Box<dyn Subject>, duration: Duration) -> Result<Row, String> {
    let begun = Instant::now();
    let mut row =
        Row { name: subject.name(), edits: 0, wrong: 0, early: Sample::default(), late: Sample::default(), most: 0 };
    let mut sampled: Option<Instant> = None;
    while begun.elapsed() < duration {
        row.edits += 1;
        if let Err(error) = subject.edit(row.edits) {
            eprintln!("{}: edit {}: {error}", row.name, row.edits);
            row.wrong += 1;
        }
        std::thread::sleep(PAUSE);
        if sampled.is_none_or(|last| last.elapsed() >= BETWEEN_SAMPLES) {
            sampled = Some(Instant::now());
            row.late = subject.sample();
            row.most = row.most.max(row.late.bytes);
            if begun.elapsed() < duration / 10 || row.early.bytes == 0 {
                // The numbers go up and down with what is under way: the most of the first tenth counts.
                row.early = row.early.or_more(&row.late);
            }
        }
    }
    // Nothing is under way any more.
    std::thread::sleep(Duration::from_secs(2));
    row.late = subject.sample();
    Ok(row)
}
