//! `glisten lint --baseline`: findings that an old tree may keep.
//!
//! *In:* checked units and a file of findings. *Out:* the units without those findings; or the file, written again. *Holds:* a
//! finding is known by its file, code, message and line of text, so it stays known when lines above it come and go. Of several
//! equal ones in a file, as many are left out as the file counts. Files are named from the folder of the baseline, so the current
//! folder does not matter.

use crate::batch::Batch;
use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::session::Unit;
use clap::Args;
use glisten_front::diagnostic::write::{Finding, Region, fingerprints};
use glisten_front::source::SourceMap;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The version of the file's form.
const VERSION: u32 = 1;

/// Where the known findings are.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Baseline")]
pub(crate) struct BaselineArgs {
    /// Leave out the findings that this file lists (default: `baseline` in `[lint]` of `glisten.toml`)
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Write all findings of this run into the baseline instead of telling them
    #[arg(long, conflicts_with_all = ["fix", "unsafe_fixes", "diff"])]
    update_baseline: bool,
}

impl BaselineArgs {
    /// The arguments that name a baseline, and do not write it.
    #[cfg(feature = "lsp")]
    pub(crate) fn of(baseline: Option<PathBuf>) -> Self {
        Self { baseline, update_baseline: false }
    }

    /// The same arguments for another file.
    pub(crate) fn at(&self, path: PathBuf) -> Self {
        Self { baseline: Some(path), ..self.clone() }
    }

    /// Whether the file is written.
    pub(crate) fn updates(&self) -> bool {
        self.update_baseline
    }
}

/// A known finding. Code and message are for readers; the file and the fingerprint decide.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// Relative to the folder of the baseline, with `/`, and with `..` where it is not below that.
    file: String,
    code: String,
    message: String,
    fingerprint: String,
}

/// The file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    version: u32,
    findings: Vec<Entry>,
}

/// The identity of a diagnostic that several programs may have.
type Told = (Region, &'static str, String);

/// The known findings.
pub(crate) struct Baseline {
    path: PathBuf,
    folder: Folder,
    known: Vec<Entry>,
}

/// The folder of a baseline, without links.
struct Folder(PathBuf);

impl Baseline {
    /// Reads the baseline, if there is one. One that is going to be written need not exist.
    ///
    /// # Errors
    /// The file cannot be read or is none.
    pub(crate) fn new(args: &BaselineArgs) -> Result<Option<Self>, Failure> {
        let Some(path) = args.baseline.clone() else { return Ok(None) };
        let folder = Folder::of(&path);
        if args.update_baseline && !path.exists() {
            return Ok(Some(Self { path, folder, known: Vec::new() }));
        }
        let name = path.to_string_lossy().into_owned();
        let bytes = files::read(&name, &path).map_err(|error| {
            Failure::usage(error.message).help("`--update-baseline` writes it from the findings of the run")
        })?;
        let refused = |why: String| {
            let help = match args.update_baseline {
                true => "delete it if it may be replaced, or name another file",
                false => "`--update-baseline` writes one to another file",
            };
            Failure::new(Exit::Content, format!("`{name}` is no baseline: {why}")).help(help)
        };
        let document: Document = serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string()))?;
        if document.version != VERSION {
            return Err(refused(format!("its version is {}, not {VERSION}", document.version)));
        }
        let named = |entry: Entry| Entry { file: folder.read_name(entry.file), ..entry };
        let known = document.findings.into_iter().map(named).collect();
        Ok(Some(Self { path, folder, known }))
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the known findings from the units. Tells how many there were, and how many are gone from the files of the run.
    pub(crate) fn apply(&self, units: &mut [Unit], console: Option<&Console>) {
        let found = self.entries(units.iter().flat_map(judged));
        let known: BTreeSet<(&str, &str)> = self.known.iter().map(Entry::key).collect();
        let mut left_out = 0;
        for batch in units.iter_mut().flat_map(|unit| unit.unread.iter_mut().chain([&mut unit.batch])) {
            keep_new(batch, &found, &known);
        }
        let present: BTreeSet<(&str, &str)> = found.values().map(Entry::key).collect();
        left_out += known.intersection(&present).count();
        let checked = self.checked(&units.iter().collect::<Vec<_>>());
        let gone = self.known.iter().filter(|entry| checked.contains(&entry.file) && !present.contains(&entry.key()));
        let Some(console) = console else { return };
        if left_out > 0 {
            console.remark(&format!("{} of the baseline left out", counted(left_out)));
        }
        match gone.count() {
            0 => {}
            count => {
                console.remark(&format!("{} of the baseline gone: --update-baseline removes them", counted(count)))
            }
        }
    }

    /// Removes the known findings of one program.
    #[cfg(feature = "lsp")]
    pub(crate) fn keep_new(&self, batch: &mut Batch) {
        let found = self.entries([&*batch]);
        let known: BTreeSet<(&str, &str)> = self.known.iter().map(Entry::key).collect();
        keep_new(batch, &found, &known);
    }

    /// Writes the findings of the units. What is known of other files stays, if they are still there.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn update(&self, units: &[&Unit], console: &Console) -> Result<(), Failure> {
        let checked = self.checked(units);
        let elsewhere = |entry: &&Entry| !checked.contains(&entry.file) && self.folder.0.join(&entry.file).exists();
        let mut findings: Vec<Entry> = self.known.iter().filter(elsewhere).cloned().collect();
        findings.extend(self.entries(units.iter().copied().flat_map(judged)).into_values());
        findings.sort();
        let count = findings.len();
        let document = Document { version: VERSION, findings };
        let mut text = serde_json::to_string_pretty(&document).unwrap_or_default();
        text.push('\n');
        // `watch` sees each write: it would never come to rest if a file that has all of it already were written again.
        if std::fs::read(&self.path).map_or(true, |old| old != text.as_bytes()) {
            files::replace(&self.path, text.as_bytes())?;
        }
        console.remark(&format!("wrote {} to {}", counted(count), self.path.display()));
        Ok(())
    }

    /// The finding of each diagnostic, each once though programs share files.
    fn entries<'b>(&self, batches: impl IntoIterator<Item = &'b Batch>) -> BTreeMap<Told, Entry> {
        let mut seen = BTreeSet::new();
        let mut findings = Vec::new();
        for batch in batches {
            let found = batch.diagnostics.iter().map(|diagnostic| Finding::new(&batch.sources, diagnostic));
            findings.extend(found.filter(|finding| seen.insert(told(finding))));
        }
        findings.sort_by(|a, b| a.region.cmp(&b.region));
        let prints = fingerprints(&findings);
        let entry = |(finding, fingerprint): (&Finding, String)| {
            let file = self.folder.name_of(&finding.region.file);
            let (code, message) = (finding.code.id.to_owned(), finding.message.clone());
            (told(finding), Entry { file, code, message, fingerprint })
        };
        findings.iter().zip(prints).map(entry).collect()
    }

    /// The files of the units.
    fn checked(&self, units: &[&Unit]) -> BTreeSet<String> {
        let names = |sources: &SourceMap| -> Vec<String> {
            sources.files().map(|(_, file)| self.folder.name_of(file.name())).collect()
        };
        units.iter().flat_map(|unit| unit.batches()).flat_map(|batch| names(&batch.sources)).collect()
    }
}

impl Folder {
    fn of(baseline: &Path) -> Self {
        let folder = baseline.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self(std::fs::canonicalize(folder).unwrap_or_else(|_| files::real(folder)))
    }

    /// A file's name relative to the folder. What is no file on disk keeps its name.
    fn name_of(&self, file: &str) -> String {
        let relative = std::fs::canonicalize(file).ok().and_then(|file| files::from_folder(&file, &self.0));
        relative.unwrap_or_else(|| PathBuf::from(file)).to_string_lossy().replace('\\', "/")
    }

    /// The name of a file in a baseline. Old ones name a file that is not below the folder from the folder that was the current one.
    fn read_name(&self, file: String) -> String {
        if !Path::new(&file).is_absolute() && self.0.join(&file).exists() {
            return file;
        }
        let named = self.name_of(&file);
        if Path::new(&named).starts_with("..") { named } else { file }
    }
}

impl Entry {
    fn key(&self) -> (&str, &str) {
        (&self.file, &self.fingerprint)
    }
}

/// The diagnostics that a baseline may have: that a file cannot be read is no finding in it.
fn judged(unit: &Unit) -> impl Iterator<Item = &Batch> {
    unit.unread.iter().filter(|batch| !is_unreadable(batch)).chain([&unit.batch])
}

/// Whether a file could not be read at all.
pub(crate) fn is_unreadable(batch: &Batch) -> bool {
    Exit::of(&batch.diagnostics) == Exit::Usage
}

/// Removes the findings of a batch that are known.
fn keep_new(batch: &mut Batch, found: &BTreeMap<Told, Entry>, known: &BTreeSet<(&str, &str)>) {
    let sources = &batch.sources;
    batch.diagnostics.retain(|diagnostic| {
        let told = told(&Finding::new(sources, diagnostic));
        !found.get(&told).is_some_and(|entry| known.contains(&entry.key()))
    });
}

fn told(finding: &Finding) -> Told {
    (finding.region.clone(), finding.code.id, finding.message.clone())
}

fn counted(count: usize) -> String {
    format!("{count} finding{}", if count == 1 { "" } else { "s" })
}
