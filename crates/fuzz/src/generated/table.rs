//! [`Sums`]: what was generated and found, as tables.
//!
//! *In:* programs and faults. *Out:* Markdown. *Holds:* rows are in the order of versions, and of names.

use super::{Found, kind};
use glisten_fuzz::checks::Tally;
use glisten_fuzz::generate::{Language, Program};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The sums of programs and faults.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    pub(crate) programs: u64,
    /// By their `#version` lines.
    versions: BTreeMap<String, u64>,
    constructs: BTreeMap<&'static str, u64>,
    /// The faults of each kind so far.
    pub(crate) kinds: BTreeMap<String, usize>,
    pub(crate) found: Vec<Found>,
    pub(crate) seconds: f64,
    /// The work of the checks, in all threads.
    pub(crate) tally: Tally,
}

impl Sums {
    /// Counts a program.
    pub(crate) fn count(&mut self, program: &Program) {
        self.programs += 1;
        *self.versions.entry(program.language.line()).or_default() += 1;
        for construct in &program.constructs {
            *self.constructs.entry(construct).or_default() += 1;
        }
    }

    /// Adds those of another thread.
    pub(crate) fn add(&mut self, other: Self) {
        self.programs += other.programs;
        for (name, count) in other.versions {
            *self.versions.entry(name).or_default() += count;
        }
        for (name, count) in other.constructs {
            *self.constructs.entry(name).or_default() += count;
        }
        self.found.extend(other.found);
        self.tally.add(other.tally);
    }

    /// The tables.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        let rate = self.programs as f64 / self.seconds.max(0.001);
        let _ = writeln!(text, "{} programs in {:.1} s, {rate:.1} a second", self.programs, self.seconds);
        let _ = writeln!(text, "\n| version | programs |\n| --- | --- |");
        for language in Language::all() {
            let line = language.line();
            let _ = writeln!(text, "| `{line}` | {} |", self.versions.get(&line).copied().unwrap_or(0));
        }
        let _ = writeln!(text, "\n| construct | programs |\n| --- | --- |");
        for (name, count) in &self.constructs {
            let _ = writeln!(text, "| {} | {count} |", name.replace('|', "\\|"));
        }
        let _ = writeln!(text, "\n| check | programs | milliseconds each |\n| --- | --- | --- |");
        for (name, time) in &self.tally.times {
            let count = self.tally.checked.get(name).copied().unwrap_or(0);
            let each = time.as_secs_f64() * 1000.0 / count.max(1) as f64;
            let _ = writeln!(text, "| {name} | {count} | {each:.2} |");
        }
        let _ =
            writeln!(text, "\n| check | the picture of emitted code was compared by | programs |\n| --- | --- | --- |");
        for ((check, way), count) in &self.tally.compared {
            let _ = writeln!(text, "| {check} | {way} | {count} |");
        }
        let _ = writeln!(text, "\n| check | left out, wholly or in part | programs |\n| --- | --- | --- |");
        for ((check, why), count) in &self.tally.left_out {
            let _ = writeln!(text, "| {check} | {why} | {count} |");
        }
        let mut kinds: BTreeMap<String, Vec<&Found>> = BTreeMap::new();
        for found in &self.found {
            kinds.entry(kind(&found.fault)).or_default().push(found);
        }
        let _ = writeln!(text, "\n{} faults of {} kinds", self.found.len(), kinds.len());
        for (name, all) in kinds {
            let file =
                all.iter().find_map(|one| one.file.as_ref()).map_or(String::new(), |file| file.display().to_string());
            let seed = all.first().map_or(0, |one| one.seed);
            let _ = writeln!(text, "- {} times, first by seed {seed}: {name} {file}", all.len());
        }
        text
    }
}
