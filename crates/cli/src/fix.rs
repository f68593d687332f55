//! `glisten lint --fix`: applies the fixes of findings until nothing changes.
//!
//! *In:* the checked units of a round. *Out:* texts in place of the files ([`crate::buffers`]), and in the end the files themselves,
//! or what would change in them. *Holds:* each fix is applied whole or not at all, and only where the text on the disk is the one
//! that was checked; a round after which a program has more errors than before is taken back, and its fixes are tried in smaller
//! groups; a file is replaced at once or not at all, and one that somebody else changed meanwhile is left.

use crate::buffers;
use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::session::Unit;
use crate::texts::{Text, diff};
use clap::Args;
use glisten_front::diagnostic::write::{Finding, FindingEdit, FindingFix};
use glisten_front::diagnostic::{Applicability, Patch};
use glisten_front::source::{SourceFile, SourceMap};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// How often the sources are checked again: a fix may bring another finding to light.
const MAX_ROUNDS: usize = 100;
/// In how many rounds a fix of one name is applied: a finding that comes back after that is not mended by it. Findings with equal lines
/// share a name, and edits that touch each other wait for the next round.
const MAX_AGAIN: usize = 4;

/// Which fixes to apply, and where to.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Fixes")]
pub(crate) struct FixArgs {
    /// Apply the safe fixes until nothing changes: they keep what is drawn, or are the only reading of a wrong text
    #[arg(long)]
    fix: bool,
    /// Apply the unsafe fixes, too: they may change what is drawn, or guess
    #[arg(long)]
    unsafe_fixes: bool,
    /// Write nothing; print what the fixes would change
    #[arg(long)]
    diff: bool,
}

impl FixArgs {
    /// Whether fixes are applied.
    pub(crate) fn any(self) -> bool {
        self.fix || self.unsafe_fixes || self.diff
    }

    /// Whether standard output is for what would change.
    pub(crate) fn prints(self) -> bool {
        self.diff
    }
}

/// A file that fixes change.
struct Changed {
    name: String,
    /// Its bytes when they were read first.
    original: Vec<u8>,
    text: Text,
    /// The text of each round that still counts, the last one at the end.
    rounds: Vec<(usize, String)>,
}

impl Changed {
    fn current(&self) -> &str {
        self.rounds.last().map_or(&self.text.text, |(_, text)| text)
    }
}

/// A fix, and what tells it from others across rounds.
struct Offer {
    fix: FindingFix,
    key: String,
}

/// A text that was checked, and the one on the disk or in place of it.
struct Pair<'u> {
    checked: &'u SourceFile,
    now: SourceMap,
    is_same: bool,
}

impl Pair<'_> {
    /// Whether the lines that an edit changes are the same in both, as far as the change reaches: an engine may have put a text
    /// together from several files, and comments may be in another encoding.
    fn is_as_checked(&self, edit: &FindingEdit) -> bool {
        let Some((_, now)) = self.now.files().next() else { return false };
        let at = &edit.region;
        let is_same = |number: u32| {
            let kept = if number == at.end_line { (at.end_column as usize).saturating_sub(1) } else { usize::MAX };
            let line = |file: &SourceFile| file.line(number).map(|line| line.chars().take(kept).collect::<String>());
            line(self.checked) == line(now)
        };
        self.is_same || (at.line..=at.end_line).all(is_same)
    }
}

/// Applies fixes round by round.
pub(crate) struct Fixer {
    args: FixArgs,
    files: BTreeMap<PathBuf, Changed>,
    /// The fixes of the last round.
    last: Vec<String>,
    /// Fixes that brought errors.
    refused: BTreeSet<String>,
    /// In how many rounds each fix was applied.
    again: BTreeMap<String, usize>,
    /// How many fixes a round applies at most.
    at_once: usize,
    /// The number of errors of each unit.
    errors: Vec<usize>,
    round: usize,
    /// The number of fixes that count, by round.
    applied: BTreeMap<usize, usize>,
}

impl Fixer {
    /// Nothing is applied yet.
    pub(crate) fn new(args: FixArgs) -> Self {
        let (files, applied) = (BTreeMap::new(), BTreeMap::new());
        let (last, refused, again) = (Vec::new(), BTreeSet::new(), BTreeMap::new());
        Self { args, files, last, refused, again, at_once: usize::MAX, errors: Vec::new(), round: 0, applied }
    }

    /// Applies the fixes of findings to the texts; returns whether the sources are to be checked again.
    pub(crate) fn advance(&mut self, units: &[Unit]) -> bool {
        let errors = n_errors(units);
        if is_worse(&errors, &self.errors) {
            self.take_back();
            return true;
        }
        self.errors = errors;
        if self.round >= MAX_ROUNDS {
            return false;
        }
        // After a round that counts, more may be tried at once.
        if !self.last.is_empty() {
            self.at_once = self.at_once.saturating_mul(2);
        }
        self.round += 1;
        let (mut patch, mut taken) = (Patch::default(), Vec::new());
        for offer in self.offers(units) {
            let is_spent = self.again.get(&offer.key).is_some_and(|rounds| *rounds >= MAX_AGAIN);
            let is_open = !is_spent && !self.refused.contains(&offer.key);
            if taken.len() < self.at_once && is_open && patch.add(&offer.fix) {
                taken.push(offer.key);
            }
        }
        let texts: Option<Vec<(PathBuf, String)>> = patch
            .files()
            .map(|name| {
                let path = PathBuf::from(name);
                let text = patch.applied(name, self.files.get(&path)?.current())?;
                Some((path, text))
            })
            .collect();
        let texts = texts.unwrap_or_default();
        if texts.is_empty() {
            return false;
        }
        for (path, text) in texts {
            if let Some(file) = self.files.get_mut(&path) {
                buffers::put(&path, file.text.bytes(&text));
                file.rounds.push((self.round, text));
            }
        }
        self.applied.insert(self.round, taken.len());
        for name in taken.iter().collect::<BTreeSet<_>>() {
            *self.again.entry(name.clone()).or_default() += 1;
        }
        self.last = taken;
        true
    }

    /// Undoes the last round. A single fix is refused for good; of several, half are tried next.
    fn take_back(&mut self) {
        for (path, file) in &mut self.files {
            if file.rounds.pop_if(|(round, _)| *round == self.round).is_some() {
                buffers::put(path, file.text.bytes(file.current()));
            }
        }
        self.applied.remove(&self.round);
        if let [only] = self.last.as_slice() {
            self.refused.insert(only.clone());
        }
        self.at_once = (self.last.len() / 2).max(1);
        self.last.clear();
    }

    /// The fixes that may be applied, in the order of the findings.
    fn offers(&mut self, units: &[Unit]) -> Vec<Offer> {
        let mut offers = Vec::new();
        for unit in units {
            let mut pairs: BTreeMap<String, Option<Pair<'_>>> = BTreeMap::new();
            for diagnostic in &unit.batch.diagnostics {
                let finding = Finding::new(&unit.batch.sources, diagnostic);
                let mut fixes = finding.fixes.iter();
                let allowed = |fix: &&FindingFix| self.args.unsafe_fixes || fix.applicability == Applicability::Safe;
                // Several fixes of a finding are alternatives.
                let Some(fix) = fixes.find(allowed) else { continue };
                let is_as_checked = |edit: &FindingEdit| {
                    let name = &edit.region.file;
                    let pair = pairs.entry(name.clone()).or_insert_with(|| self.pair(&unit.batch.sources, name));
                    pair.as_ref().is_some_and(|pair| pair.is_as_checked(edit))
                };
                if fix.edits.iter().all(is_as_checked) {
                    offers.push(Offer { key: key(&finding, fix), fix: fix.clone() });
                }
            }
        }
        offers
    }

    /// A text that was checked with the one that is there now, if there is one.
    fn pair<'u>(&mut self, sources: &'u SourceMap, name: &str) -> Option<Pair<'u>> {
        let (_, checked) = sources.files().find(|(_, file)| file.name() == name)?;
        let mut now = SourceMap::default();
        now.add(name, self.file(name)?.current())?;
        let is_same = now.files().next().is_some_and(|(_, file)| file.text() == checked.shown());
        Some(Pair { checked, now, is_same })
    }

    /// The file of this name, read when it is needed first.
    fn file(&mut self, name: &str) -> Option<&Changed> {
        let path = PathBuf::from(name);
        if !self.files.contains_key(&path) {
            let original = files::read(name, &path).ok()?;
            let text = Text::new(original.clone());
            let changed = Changed { name: name.to_owned(), original, text, rounds: Vec::new() };
            self.files.insert(path.clone(), changed);
        }
        self.files.get(&path)
    }

    /// Writes the files, or prints what would change in them, to standard output if it `has_output` for that, and tells how much
    /// that is. Each file that cannot be written is told, and the others are; the exit code says it. The second value is whether a file has
    /// another text than the one that was checked last.
    ///
    /// # Errors
    /// Standard output cannot be written.
    pub(crate) fn finish(self, has_output: bool, console: &Console) -> Result<(Exit, bool), Failure> {
        let changed: Vec<(&PathBuf, &Changed)> =
            self.files.iter().filter(|(_, file)| file.current() != file.text.text).collect();
        let (mut n_written, mut exit) = (0, Exit::Ok);
        for (path, file) in &changed {
            if self.args.diff {
                let diff = diff(&file.name, &file.text.text, file.current());
                if has_output {
                    console.output(&diff)?
                } else {
                    console.message(&diff)
                }
                n_written += 1;
            } else if is_unchanged(path, &file.original) {
                match files::replace(path, &file.text.bytes(file.current())) {
                    Ok(()) => n_written += 1,
                    Err(failure) => {
                        exit = exit.max(console.tell(failure));
                        buffers::put(path, file.original.clone());
                    }
                }
            } else {
                console.message(&format!(
                    "warning: `{}` changed while it was being fixed; it is left as it is\n",
                    file.name
                ));
            }
        }
        let count = |n: usize, what: &str, many: &str| format!("{n} {}", if n == 1 { what } else { many });
        let n_fixes: usize = if n_written == 0 { 0 } else { self.applied.values().sum() };
        let verb = if self.args.diff { "would change" } else { "changed" };
        let fixes = count(n_fixes, "fix", "fixes");
        console.remark(&format!("{fixes} {verb} {}", count(n_written, "file", "files")));
        Ok((exit, exit != Exit::Ok))
    }
}

/// The number of errors of each unit.
fn n_errors(units: &[Unit]) -> Vec<usize> {
    let of = |unit: &Unit| unit.batches().flat_map(|batch| &batch.diagnostics).filter(|one| one.is_error()).count();
    units.iter().map(of).collect()
}

/// Whether a unit has more errors than before: what a fix mends in one does not make up for what it breaks in another.
fn is_worse(now: &[usize], before: &[usize]) -> bool {
    if now.len() == before.len() {
        return now.iter().zip(before).any(|(now, before)| now > before);
    }
    !before.is_empty() && now.iter().sum::<usize>() > before.iter().sum()
}

/// The name of a fix, which stays the same when lines above it come or go.
fn key(finding: &Finding, fix: &FindingFix) -> String {
    format!(
        "{} {} {:x} {} {}",
        finding.region.file, finding.code.id, finding.fingerprint, finding.region.column, fix.title
    )
}

/// Whether a file still has the bytes that were read.
fn is_unchanged(path: &Path, original: &[u8]) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes == original)
}

#[cfg(test)]
mod tests {
    use super::is_worse;

    #[test]
    fn errors_of_one_program_do_not_make_up_for_those_of_another() {
        assert!(!is_worse(&[2, 3], &[]));
        assert!(!is_worse(&[2, 0], &[2, 3]));
        assert!(is_worse(&[3, 0], &[2, 3]));
        // The units are others than before.
        assert!(!is_worse(&[3], &[2, 3]));
        assert!(is_worse(&[6], &[2, 3]));
    }
}
