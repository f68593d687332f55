//! The record of what was fuzzed: a row for each run of a target.
//!
//! *In:* runs. *Out:* rows in `crates/fuzz/record.csv`, and the sums of them for each target. *Holds:* a row names its commit, so that a run
//! can be made again.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// The head of the file.
const HEAD: &str = "date,commit,target,minutes,jobs,executions,broken";

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
}

impl Run {
    /// The row of a run today, of the commit that is checked out.
    fn row(&self, root: &Path) -> String {
        let told = |program: &str, arguments: &[&str]| {
            let output = Command::new(program).current_dir(root).args(arguments).output();
            output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
        };
        let (date, commit) = (told("date", &["-u", "+%F"]), told("git", &["rev-parse", "--short=8", "HEAD"]));
        let Self { target, minutes, jobs, executions, broken } = self;
        format!("{date},{commit},{target},{minutes:.1},{jobs},{executions},{broken}")
    }

    /// Reads a row; `None` for the head and for other lines.
    fn read(row: &str) -> Option<Self> {
        let [_, _, target, minutes, jobs, executions, broken] = row.split(',').collect::<Vec<_>>().try_into().ok()?;
        Some(Self {
            target: target.to_owned(),
            minutes: minutes.parse().ok()?,
            jobs: jobs.parse().ok()?,
            executions: executions.parse().ok()?,
            broken: broken.trim().parse().ok()?,
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
    let mut text = if file.exists() { std::fs::read_to_string(file).map_err(wrong)? } else { format!("{HEAD}\n") };
    text.push_str(&run.row(root));
    text.push('\n');
    std::fs::write(file, text).map_err(wrong)
}

/// The sums of a record, as a table.
pub fn sums(text: &str) -> String {
    let mut targets: BTreeMap<String, (f64, u64, usize)> = BTreeMap::new();
    for run in text.lines().filter_map(Run::read) {
        let (minutes, executions, broken) = targets.entry(run.target).or_default();
        *minutes += run.minutes * f64::from(run.jobs);
        *executions += run.executions;
        *broken += run.broken;
    }
    let mut table =
        "| target | CPU hours | executions | inputs that broke it |\n| --- | --- | --- | --- |\n".to_owned();
    let mut all = (0.0, 0, 0);
    for (target, (minutes, executions, broken)) in targets {
        let _ = writeln!(table, "| `{target}` | {:.2} | {executions} | {broken} |", minutes / 60.0);
        all = (all.0 + minutes, all.1 + executions, all.2 + broken);
    }
    let _ = writeln!(table, "| all | {:.2} | {} | {} |", all.0 / 60.0, all.1, all.2);
    table
}

#[cfg(test)]
mod tests {
    use super::{HEAD, executions, sums};

    #[test]
    fn runs_are_summed_by_target() {
        let rows = "2026-01-02,0123abcd,emit,30.0,2,1000,1\n2026-01-03,0123abcd,emit,15.0,1,500,0\n2026-01-03,0123abcd,lint,6.0,1,10,0\n";
        let table = sums(&format!("{HEAD}\n{rows}"));
        for row in ["| `emit` | 1.25 | 1500 | 1 |", "| `lint` | 0.10 | 10 | 0 |", "| all | 1.35 | 1510 | 1 |"] {
            assert!(table.contains(row), "{row} in {table}");
        }
    }

    #[test]
    fn executions_are_in_the_last_line() {
        assert_eq!(executions("#20480: cov: 812 ft: 911 corp: 12"), 20480);
        assert_eq!(executions("nothing was executed"), 0);
    }
}
