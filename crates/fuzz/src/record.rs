//! The record of what was fuzzed: a row for each run of a target.
//!
//! *In:* runs. *Out:* rows in `crates/fuzz/record.csv`, and the sums of them for each target. *Holds:* a row names its commit, so that a run
//! can be made again.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The head of the file.
const HEAD: &str = "date,commit,target,minutes,jobs,executions,broken,cpu_seconds";

/// A run of a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its name.
    pub target: String,
    /// How long it ran.
    pub minutes: f64,
    /// In how many processes at once.
    pub jobs: u32,
    /// How many inputs it took.
    pub executions: u64,
    /// How many inputs broke the promise.
    pub broken: usize,
    /// The CPU time that its processes used, in seconds. The first rows have none, nor have those of systems that do not tell it.
    pub cpu: Option<f64>,
}

/// The CPU time of the processes that this one has started and waited for, with theirs, in seconds.
pub fn cpu_of_children() -> Option<f64> {
    cpu_in(&std::fs::read_to_string(STAT).ok()?, 13)
}

/// The CPU time of this process without others, in seconds.
pub fn cpu_of_process() -> Option<f64> {
    cpu_in(&std::fs::read_to_string(STAT).ok()?, 11)
}

/// The file in which Linux describes this process.
const STAT: &str = "/proc/self/stat";

/// Two fields behind the name of the program, which may have blanks and ends with the last parenthesis: hundredths of a second.
fn cpu_in(stat: &str, first: usize) -> Option<f64> {
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(first);
    let mut field = || fields.next()?.parse::<f64>().ok();
    Some((field()? + field()?) / 100.0)
}

impl Run {
    /// The row of a run today, of the commit that is checked out.
    fn row(&self, root: &Path) -> String {
        let told = |program: &str, arguments: &[&str]| {
            let output = Command::new(program).current_dir(root).args(arguments).output();
            output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
        };
        let (date, commit) = (told("date", &["-u", "+%F"]), told("git", &["rev-parse", "--short=8", "HEAD"]));
        let Self { target, minutes, jobs, executions, broken, cpu } = self;
        let cpu = cpu.map_or_else(String::new, |seconds| format!("{seconds:.1}"));
        format!("{date},{commit},{target},{minutes:.1},{jobs},{executions},{broken},{cpu}")
    }

    /// Reads a row; `None` for the head and for other lines.
    fn read(row: &str) -> Option<Self> {
        let (fields, cpu) = match row.split(',').collect::<Vec<_>>() {
            fields if fields.len() == 8 => (fields.get(..7)?.to_vec(), fields.last()?.trim().parse().ok()),
            fields => (fields, None),
        };
        let [_, _, target, minutes, jobs, executions, broken] = fields.try_into().ok()?;
        Some(Self {
            target: target.to_owned(),
            minutes: minutes.parse().ok()?,
            jobs: jobs.parse().ok()?,
            executions: executions.parse().ok()?,
            broken: broken.trim().parse().ok()?,
            cpu,
        })
    }
}

/// The number of executions in libFuzzer's last line of progress, such as `#2048: cov: 812`.
pub fn executions(line: &str) -> u64 {
    let digits = line.trim_start_matches('#').split(|sign: char| !sign.is_ascii_digit()).next();
    digits.and_then(|digits| digits.parse().ok()).unwrap_or(0)
}

/// Adds a run to the record.
///
/// # Errors
/// The file cannot be read or written.
pub fn add(file: &Path, root: &Path, run: &Run) -> Result<(), String> {
    let wrong = |error: std::io::Error| format!("{}: {error}", file.display());
    let text = if file.exists() { std::fs::read_to_string(file).map_err(wrong)? } else { String::new() };
    // The head of an older record names fewer columns.
    let rows = text.split_once('\n').map_or("", |(_, rows)| rows);
    let mut text = format!("{HEAD}\n{rows}");
    text.push_str(&run.row(root));
    text.push('\n');
    std::fs::write(file, text).map_err(wrong)
}

/// Sums of runs.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    minutes: f64,
    cpu: f64,
    executions: u64,
    broken: usize,
}

impl Sum {
    fn add(&mut self, run: &Run) {
        self.minutes += run.minutes * f64::from(run.jobs);
        self.cpu += run.cpu.unwrap_or(0.0);
        self.executions += run.executions;
        self.broken += run.broken;
    }

    fn row(&self, name: &str) -> String {
        let Self { minutes, cpu, executions, broken } = self;
        format!("| {name} | {:.2} | {:.2} | {executions} | {broken} |\n", minutes / 60.0, cpu / 3600.0)
    }
}

/// The sums of a record, as a table. The hours of jobs are those of a clock, times the processes; those of the CPU are what the rows
/// recorded.
pub fn sums(text: &str) -> String {
    let mut targets: BTreeMap<String, Sum> = BTreeMap::new();
    let mut all = Sum::default();
    for run in text.lines().filter_map(Run::read) {
        targets.entry(run.target.clone()).or_default().add(&run);
        all.add(&run);
    }
    let mut table = "| target | hours of jobs | hours of CPU | executions | inputs that broke it |\n\
                     | --- | --- | --- | --- | --- |\n"
        .to_owned();
    for (target, sum) in targets {
        table += &sum.row(&format!("`{target}`"));
    }
    table + &all.row("all")
}

#[cfg(test)]
mod tests {
    use super::{HEAD, cpu_in, executions, sums};

    #[test]
    fn runs_are_summed_by_target() {
        let rows = "2026-01-02,0123abcd,emit,30.0,2,1000,1\n2026-01-03,0123abcd,emit,15.0,1,500,0,900.0\n2026-01-03,0123abcd,lint,6.0,1,10,0\n";
        let table = sums(&format!("{HEAD}\n{rows}"));
        for row in [
            "| `emit` | 1.25 | 0.25 | 1500 | 1 |",
            "| `lint` | 0.10 | 0.00 | 10 | 0 |",
            "| all | 1.35 | 0.25 | 1510 | 1 |",
        ] {
            assert!(table.contains(row), "{row} in {table}");
        }
    }

    #[test]
    fn times_of_the_processor_are_in_the_fields_behind_the_name() {
        let stat = "17 (a (b) c) S 1 17 17 0 -1 4194560 10 20 30 40 150 50 1200 34 20 0 1 0 5 6 7";
        assert_eq!(cpu_in(stat, 11), Some(2.0));
        assert_eq!(cpu_in(stat, 13), Some(12.34));
    }

    #[test]
    fn executions_are_in_the_last_line() {
        assert_eq!(executions("#20480: cov: 812 ft: 911 corp: 12"), 20480);
        assert_eq!(executions("nothing was executed"), 0);
    }
}
