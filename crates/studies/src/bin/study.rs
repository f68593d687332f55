//! Draws scenes with legal rewritings and planted mistakes from a folder, and counts what `verify` says about each.
//!
//! ```text
//! cargo run --release -p glisten-studies --bin study -- fixtures/study/verify [--margins 0,1,2,4,8,16] [--only TEXT] [--list]
//! ```
//!
//! Each folder with a `cases.toml` is a scene: `scene.toml` with its shaders, and edits of them. `[[legal]]` edits are what a
//! conforming translator or driver may do, `[[fault]]` edits are mistakes. The edited program is drawn on the first software
//! adapter, and judged by the original. It prints a table by kind, and each scene, rewriting and mistake with another verdict
//! than it should have. `--margins` prints the same counts for other margins of what is likely.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

use glisten::scene::{DiskFiles, Scene, load};
use glisten::verify::{Conclusion, Options};
use glisten::{Compiler, Gpu};
use glisten_gpu::Via;
use glisten_scene::compare::{Comparison, Criterion, Verdict};
use glisten_scene::{FileError, FileSource};
use glisten_verify::verify::Expected;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The tolerance that `verify` is compared with.
const PLAIN: f64 = 1.0 / 255.0;

struct Arguments {
    folder: PathBuf,
    margins: Vec<f64>,
    only: String,
    list: bool,
}

fn arguments() -> Option<Arguments> {
    let mut found = Arguments { folder: PathBuf::new(), margins: Vec::new(), only: String::new(), list: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--margins" => found.margins = words.next()?.split(',').map(|n| n.parse().ok()).collect::<Option<_>>()?,
            "--only" => found.only = words.next()?,
            "--list" => found.list = true,
            _ => found.folder = word.into(),
        }
    }
    (!found.folder.as_os_str().is_empty()).then_some(found)
}

/// An edit of a file: text that occurs once, and what takes its place.
struct Edit {
    file: String,
    find: String,
    replace: String,
}

/// The verdict that an edited program should get.
#[derive(Clone, Copy, PartialEq, Eq)]
enum CaseKind {
    /// The scene as it is.
    Sound,
    /// A rewriting that is legal.
    Legal,
    /// A mistake.
    Fault,
    /// A mistake that does not show in this scene.
    Subtle,
}

impl CaseKind {
    fn wanted(self, scenes: &str) -> Conclusion {
        match (self, scenes) {
            (Self::Sound, "undefined" | "empty") => Conclusion::Inconclusive,
            (Self::Fault, _) => Conclusion::Fails,
            _ => Conclusion::Holds,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Legal => "legal",
            Self::Fault => "fault",
            Self::Subtle => "fault that does not show",
        }
    }
}

/// A rewriting or a mistake.
struct Case {
    what: String,
    kind: CaseKind,
    edits: Vec<Edit>,
}

fn cases(path: &Path) -> Result<(String, Vec<Case>), String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let table: toml::Table = text.parse().map_err(|error: toml::de::Error| error.to_string())?;
    let of =
        |table: &toml::Table, key: &str| table.get(key).and_then(|value| value.as_str()).unwrap_or_default().to_owned();
    let mut found = Vec::new();
    for (key, kind) in [("legal", CaseKind::Legal), ("fault", CaseKind::Fault)] {
        for case in
            table.get(key).and_then(|list| list.as_array()).into_iter().flatten().filter_map(|case| case.as_table())
        {
            let edits = case.get("edits").and_then(|edits| edits.as_array()).into_iter().flatten();
            let edit = |edit: &toml::Table| Edit {
                file: of(edit, "file"),
                find: of(edit, "find"),
                replace: of(edit, "replace"),
            };
            let edits = edits.filter_map(|one| one.as_table()).map(edit).collect();
            let is_subtle = case.get("subtle").and_then(|subtle| subtle.as_bool()) == Some(true);
            let kind = if is_subtle { CaseKind::Subtle } else { kind };
            found.push(Case { what: of(case, "what"), kind, edits });
        }
    }
    Ok((of(&table, "kind"), found))
}

/// The files of the disk with edits.
struct Edited<'a>(&'a [Edit]);

impl FileSource for Edited<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let bytes = DiskFiles.read(path)?;
        let name = Path::new(path).file_name().unwrap_or_default();
        let mut text = String::from_utf8_lossy(&bytes).into_owned();
        for edit in self.0.iter().filter(|edit| name == edit.file.as_str()) {
            text = text.replacen(&edit.find, &edit.replace, 1);
        }
        Ok(text.into_bytes())
    }
}

fn scene(path: &Path, edits: &[Edit]) -> Result<Scene, String> {
    let loaded = load(&path.to_string_lossy(), &Edited(edits), &Compiler::new(Default::default()));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    loaded.scene.ok_or_else(|| told.join("; "))
}

/// The counts of a kind of scenes.
#[derive(Default)]
struct Counts {
    sound: [u32; 3],
    legal: [u32; 3],
    faults: [u32; 3],
    plain: u32,
    plain_of: u32,
}

impl Counts {
    fn row(&self, name: &str) -> String {
        let all = |counts: [u32; 3]| counts.iter().sum::<u32>();
        let [sound, legal, faults] = [self.sound, self.legal, self.faults];
        let share = 100.0 * f64::from(faults[2]) / f64::from(all(faults).max(1));
        format!(
            "| {name} | {} of {} | {} of {} | {} of {} ({share:.1} %) | {} | {} of {} |",
            sound[0],
            all(sound),
            legal[0],
            all(legal),
            faults[2],
            all(faults),
            faults[0],
            self.plain,
            self.plain_of,
        )
    }
}

const HEAD: &str = "| scenes | sound that hold | legal that hold | faults that fail | faults that hold | 1/255 catches |\n\
                    | --- | --- | --- | --- | --- | --- |";

fn place(conclusion: Conclusion) -> usize {
    match conclusion {
        Conclusion::Holds => 0,
        Conclusion::Inconclusive => 1,
        Conclusion::Fails => 2,
    }
}

/// The verdict in a few words.
fn words(verdict: &Verdict) -> String {
    let Verdict { covered, outside, outside_likely, coverage_mismatch, finiteness_mismatch, max_abs, .. } = verdict;
    let share = 100.0 * verdict.share_judged(&Default::default());
    format!(
        "{:?}; {share:.1} % of {covered} judged, {outside} outside, {outside_likely} outside likely, {} suspect, {coverage_mismatch} \
         with other coverage, {finiteness_mismatch} not finite on one side, largest error {max_abs:.1e}; {:?}",
        verdict.conclusion(&Default::default()),
        verdict.suspect.unwrap_or(0),
        verdict.evidence,
    )
}

type Table = BTreeMap<String, Counts>;

/// Adds the verdicts on a scene and all of its cases to the tables: one for each margin.
fn study(path: &Path, gpu: &Gpu, arguments: &Arguments, margins: &[f64], tables: &mut [Table]) -> Result<(), String> {
    let (kind, cases) = cases(path)?;
    let folder = path.parent().unwrap_or(path);
    let name = folder.strip_prefix(&arguments.folder).unwrap_or(folder).display().to_string();
    let file = folder.join("scene.toml");
    let original = scene(&file, &[])?;
    let options = Options::default();
    let mut expected = Expected::new(&original, &options).map_err(|failure| failure.to_string())?;
    let draw =
        |scene: &Scene| gpu.render(scene, Via::Spirv).map(|drawn| drawn.picture).map_err(|error| error.to_string());
    let sound = draw(&original)?;
    let tolerance = Comparison { criterion: Criterion::Tolerance(PLAIN), ..Comparison::default() };
    let is_plain = !tolerance.compare(&sound, expected.picture()).verdict.needs_excuse();
    let mut judge = |picture: &_, what: &str, case: CaseKind| -> Result<(), String> {
        let is_caught = tolerance.compare(picture, expected.picture()).verdict.needs_excuse();
        for (index, (margin, table)) in margins.iter().zip(tables.iter_mut()).enumerate() {
            expected.set_likely_margin(*margin);
            let verdict = expected.compare(picture).map_err(|failure| failure.to_string())?;
            let conclusion = verdict.conclusion(&options.demands);
            let counts = table.entry(kind.clone()).or_default();
            match case {
                CaseKind::Sound => counts.sound[place(conclusion)] += 1,
                CaseKind::Legal => counts.legal[place(conclusion)] += 1,
                CaseKind::Fault => counts.faults[place(conclusion)] += 1,
                CaseKind::Subtle => {}
            }
            if case == CaseKind::Fault && is_plain {
                counts.plain += u32::from(is_caught);
                counts.plain_of += 1;
            }
            if index == 0 && (arguments.list || conclusion != case.wanted(&kind)) {
                let plain = if is_caught { "; 1/255 fails" } else { "" };
                println!("{name}: {}: {what}: {}{plain}", case.name(), words(&verdict));
            }
        }
        Ok(())
    };
    judge(&sound, "as it is", CaseKind::Sound)?;
    for case in &cases {
        let edited = scene(&file, &case.edits).map_err(|why| format!("{}: {why}", case.what))?;
        judge(&draw(&edited)?, &case.what, case.kind)?;
    }
    Ok(())
}

fn folders(path: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            folders(&path, found);
        } else if path.file_name().is_some_and(|name| name == "cases.toml") {
            found.push(path);
        }
    }
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!("usage: study FOLDER [--margins LIST] [--only TEXT] [--list]");
        return ExitCode::from(2);
    };
    let gpu = match Gpu::new(Some("software")) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(3);
        }
    };
    let mut files = Vec::new();
    folders(&arguments.folder, &mut files);
    files.retain(|file| file.to_string_lossy().contains(&arguments.only));
    files.sort();
    let margins: Vec<f64> =
        [Options::default().likely_margin].into_iter().chain(arguments.margins.iter().copied()).collect();
    let mut tables: Vec<Table> = margins.iter().map(|_| Table::new()).collect();
    for file in &files {
        let start = Instant::now();
        let told = study(file, &gpu, &arguments, &margins, &mut tables);
        if let Err(why) = told {
            println!("{}: {why}", file.display());
        }
        eprintln!("{}: {:.1} s", file.display(), start.elapsed().as_secs_f64());
    }
    for (margin, table) in margins.iter().zip(&tables) {
        println!("\nmargin {margin}\n\n{HEAD}");
        table.iter().for_each(|(kind, counts)| println!("{}", counts.row(kind)));
    }
    ExitCode::SUCCESS
}
