//! Many mutants at once: how often glisten and glslang agree, how near the error is to the change, how long it takes.
//!
//! *In:* folders of sources, a number of mutants, a number from which chance follows. *Out:* a table, and the mutants on which both
//! disagree as files, each kind with its first one. *Holds:* without glslangValidator there is no comparison, and the table says so.

use glisten_fuzz::mutants::{Chance, Mutant, Verdict, mutant, sources, verdict};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// A mutant that takes longer is a finding.
const LIMIT: Duration = Duration::from_secs(10);
/// The files that one process of glslang checks.
const BATCH: usize = 50;
/// An error so many lines from the change is near it.
const NEAR: usize = 1;

/// A mutant with its file and the verdicts.
struct Judged {
    file: PathBuf,
    mutant: Mutant,
    verdict: Verdict,
    took: Duration,
    /// The first error of glslang; none if it accepts it, nothing if it is not known.
    other: Option<Option<String>>,
}

impl Judged {
    /// The error of the one compiler that refuses it; none if both say the same, or one says nothing.
    fn disagreement(&self) -> Option<String> {
        match (&self.verdict, self.other.as_ref()?) {
            (Verdict::Accepted, Some(says)) => Some(format!("glslang alone: {says}")),
            (Verdict::Refused { says, .. }, None) => Some(format!("glisten alone: {says}")),
            _ => None,
        }
    }
}

/// Makes mutants. Returns the table, and the number of mutants without an end.
///
/// # Errors
/// There are no sources, or files cannot be written.
pub(crate) fn survey(folders: &[PathBuf], count: usize, seed: u64, out: &Path) -> Result<(String, usize), String> {
    let sources = sources(folders);
    if sources.is_empty() {
        return Err("the folders have no sources whose versions both compilers read".to_owned());
    }
    std::fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    let mut chance = Chance::new(seed);
    let mut all = Vec::new();
    while all.len() < count {
        let Some(source) = chance.one(&sources) else { break };
        let Some(mutant) = mutant(&source.text, &mut chance) else { continue };
        let file = out.join(format!("{seed}-{:06}.{}", all.len(), source.ending()));
        std::fs::write(&file, &mutant.text).map_err(|error| format!("{}: {error}", file.display()))?;
        let (verdict, took) = verdict(&mutant.text, source.stage, LIMIT);
        all.push(Judged { file, mutant, verdict, took, other: None });
    }
    for batch in all.chunks_mut(BATCH) {
        ask_glslang(batch);
    }
    clean(&all);
    let bad = all.iter().filter(|one| matches!(one.verdict, Verdict::Endless | Verdict::Panicked)).count();
    Ok((table(&all, sources.len()), bad))
}

/// Asks glslang about several mutants; alone about each if it does not come to an end with all of them.
fn ask_glslang(batch: &mut [Judged]) {
    let asked = |files: &[&Path]| Command::new("glslangValidator").args(files).output().ok();
    let files: Vec<PathBuf> = batch.iter().map(|one| one.file.clone()).collect();
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let Some(output) = asked(&paths) else { return };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let is_whole =
        output.status.code().is_some() && files.last().is_none_or(|last| text.contains(&*last.to_string_lossy()));
    if is_whole {
        let errors = errors_of(&text, &files);
        for one in batch {
            one.other = Some(errors.get(&one.file).cloned().flatten());
        }
        return;
    }
    for one in batch {
        if let Some(output) = asked(&[&one.file]).filter(|output| output.status.code().is_some()) {
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            one.other = Some(text.lines().find_map(error));
        }
    }
}

/// The first error of each file in glslang's output, which names a file before its errors.
fn errors_of(text: &str, files: &[PathBuf]) -> BTreeMap<PathBuf, Option<String>> {
    let mut found: BTreeMap<PathBuf, Option<String>> = BTreeMap::new();
    let mut current = None;
    for line in text.lines() {
        if let Some(file) = files.iter().find(|file| *file.to_string_lossy() == *line.trim()) {
            current = Some(file.clone());
            found.entry(file.clone()).or_default();
        } else if let (Some(file), Some(error)) = (&current, error(line)) {
            found.entry(file.clone()).or_default().get_or_insert(error);
        }
    }
    found
}

/// The message of an error of glslang, without places and names.
fn error(line: &str) -> Option<String> {
    let says = line.strip_prefix("ERROR: ")?;
    if says.contains("compilation errors") {
        return None;
    }
    let says = says.splitn(3, ':').last().unwrap_or(says).trim();
    Some(says.split('\'').enumerate().map(|(number, part)| if number % 2 == 0 { part } else { "'_'" }).collect())
}

fn table(all: &[Judged], sources: usize) -> String {
    let mut lines = Vec::new();
    let slowest = all.iter().map(|one| one.took).max().unwrap_or_default();
    lines.push(format!(
        "{} mutants of {sources} sources; the slowest took {:.1} ms",
        all.len(),
        slowest.as_secs_f64() * 1e3
    ));
    for one in all.iter().filter(|one| matches!(one.verdict, Verdict::Endless | Verdict::Panicked)) {
        lines.push(format!("{:?} ({}): {}", one.verdict, one.mutant.change, one.file.display()));
    }
    let refused: Vec<(&Judged, usize)> = all
        .iter()
        .filter_map(|one| match one.verdict {
            Verdict::Refused { line, .. } => Some((one, line)),
            _ => None,
        })
        .collect();
    let near = refused.iter().filter(|(one, line)| line.abs_diff(one.mutant.line) <= NEAR).count();
    let share = 100.0 * near as f64 / refused.len().max(1) as f64;
    lines.push(format!("{} are refused, {share:.1} % of them within {NEAR} line of the change", refused.len()));
    let known = all.iter().filter(|one| one.other.is_some()).count();
    let mut kinds: BTreeMap<String, Vec<&Judged>> = BTreeMap::new();
    for one in all {
        if let Some(kind) = one.disagreement() {
            kinds.entry(kind).or_default().push(one);
        }
    }
    let agreed = known - kinds.values().map(Vec::len).sum::<usize>();
    if known == 0 {
        lines.push("glslangValidator is not there: nothing was compared".to_owned());
        return lines.join("\n");
    }
    let share = 100.0 * agreed as f64 / known as f64;
    lines.push(format!("glslang agrees on {agreed} of {known} ({share:.1} %); it crashed on {}", all.len() - known));
    let mut kinds: Vec<_> = kinds.into_iter().collect();
    kinds.sort_by_key(|(_, mutants)| std::cmp::Reverse(mutants.len()));
    for (kind, mutants) in kinds {
        let first = mutants.first().map(|one| one.file.display().to_string()).unwrap_or_default();
        lines.push(format!("{:5}  {kind}\n       {first}", mutants.len()));
    }
    lines.join("\n")
}

/// Removes the files that show nothing.
fn clean(all: &[Judged]) {
    let is_bad = |one: &Judged| matches!(one.verdict, Verdict::Endless | Verdict::Panicked);
    for one in all.iter().filter(|one| !is_bad(one) && one.disagreement().is_none()) {
        // What stays only takes room.
        let _ = std::fs::remove_file(&one.file);
    }
}
