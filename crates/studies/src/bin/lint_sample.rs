//! Draws findings of `glisten lint` at random from a folder of repositories, to be read by hand ([docs/lint.md]).
//!
//! ```sh
//! cargo run -p glisten-studies --bin lint_sample -- FOLDER --count 100 --seed 1
//! ```
//!
//! *In:* a folder whose folders are repositories. *Out:* a table of rules with the number of their findings and of those drawn, then each
//! that was drawn with its lines of text. *Holds:* a repository is drawn first, each with the same chance, then one of its findings
//! that is left; the same folder and seed give the same findings.
//!
//! [docs/lint.md]: ../docs/lint.md

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use glisten_scene::random::SplitMix64;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

/// Lines of text before and after a finding.
const AROUND: usize = 3;

/// A finding of a rule.
struct Found {
    repository: String,
    path: PathBuf,
    line: usize,
    code: String,
    message: String,
    notes: String,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let number = |flag: &str, default: u64| {
        let at = arguments.iter().position(|argument| argument == flag);
        at.and_then(|at| arguments.get(at + 1)?.parse().ok()).unwrap_or(default)
    };
    let Some(folder) = arguments.first().filter(|first| !first.starts_with("--")) else {
        eprintln!("usage: lint_sample FOLDER [--count N] [--seed N]");
        return ExitCode::from(2);
    };
    match sample(Path::new(folder), number("--count", 100) as usize, number("--seed", 1)) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn sample(folder: &Path, count: usize, seed: u64) -> Result<String, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut repositories: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    repositories.retain(|path| path.is_dir());
    repositories.sort();
    let mut left: Vec<Vec<Found>> = Vec::new();
    for repository in repositories {
        left.push(findings(&repository)?);
    }
    let mut table: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for found in left.iter().flatten() {
        table.entry(found.code.clone()).or_default()[0] += 1;
    }
    let all: usize = left.iter().map(Vec::len).sum();
    let mut random = SplitMix64::new(seed);
    let mut drawn = Vec::new();
    while drawn.len() < count {
        left.retain(|findings| !findings.is_empty());
        if left.is_empty() {
            break;
        }
        let at = (random.unit() * left.len() as f64) as usize;
        let Some(findings) = left.get_mut(at) else { break };
        let index = (random.unit() * findings.len() as f64) as usize;
        let found = findings.swap_remove(index.min(findings.len() - 1));
        table.entry(found.code.clone()).or_default()[1] += 1;
        drawn.push(found);
    }
    let mut text =
        format!("{all} findings, {} drawn\n\n| code | all findings | drawn |\n| --- | --: | --: |\n", drawn.len());
    for (code, [all, drawn]) in &table {
        text += &format!("| `{code}` | {all} | {drawn} |\n");
    }
    for (number, found) in drawn.iter().enumerate() {
        text += &shown(number + 1, found);
    }
    Ok(text)
}

/// The findings of lint rules in a repository.
fn findings(repository: &Path) -> Result<Vec<Found>, String> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    let folder = program.parent().and_then(Path::parent).ok_or("this program is not in a target folder")?;
    let glisten = folder.join(format!("glisten{}", env::consts::EXE_SUFFIX));
    let name = repository.file_name().unwrap_or_default().to_string_lossy().replace('+', "/");
    let output = Command::new(&glisten).args(["lint", ".", "--format", "json"]).current_dir(repository).output();
    let output = output.map_err(|error| format!("{}: {error}", glisten.display()))?;
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).map_err(|error| format!("{name}: {error}"))?;
    let text = |row: &Value, key: &str| row[key].as_str().unwrap_or_default().to_owned();
    let of = |row: &Value| {
        let code = text(row, "code");
        code.starts_with('L').then(|| Found {
            repository: name.clone(),
            path: repository.join(text(row, "file")),
            line: row["line"].as_u64().unwrap_or(0) as usize,
            code,
            message: text(row, "message"),
            notes: if row["notes"].is_array() { row["notes"].to_string() } else { String::new() },
        })
    };
    Ok(rows.iter().filter_map(of).collect())
}

/// A finding with its lines of text.
fn shown(number: usize, found: &Found) -> String {
    let Found { repository, path, line, code, message, notes } = found;
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let mut text = format!("\n{number}. {code} {repository} {file}:{line}: {message} {notes}\n");
    let source = fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default();
    let first = line.saturating_sub(AROUND + 1);
    for (index, source) in source.lines().enumerate().skip(first).take(2 * AROUND + 1) {
        let mark = if index + 1 == *line { ">" } else { " " };
        text += &format!("   {mark} {:4} {source}\n", index + 1);
    }
    text
}
