//! Measures glisten on public repositories: who accepts which programs, whether the code is valid, whether the pictures agree.
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin repositories -- FOLDER [--only NAME] [--pictures N] [--list] [--keep DIR] [-o FILE]
//! ```
//!
//! `FOLDER` contains a folder `owner+name` for each repository of `repositories.toml`. Those that are missing are left out. With
//! `--only`, repositories whose names contain the text; with `--pictures`, at most so many programs of each are drawn, evenly
//! chosen (default: 40); with `--list`, everything that was found is printed; with `--keep`, the files of each program stay in a
//! folder of their own below `DIR`; with `-o`, the tables go to a file.
//! It needs `glslangValidator`, `tint`, `spirv-val`, a Vulkan software adapter and Mesa.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a report")]

mod checks;
mod list;
mod scenery;
mod scripts;
mod table;
mod tasks;
mod tools;

use checks::Checked;
use glisten::Stage;
use glisten_cli::survey::{Survey, Surveyed};
use list::{List, Repository};
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use table::{HEAD, Row};

/// The stack of the thread that compiles.
const STACK_BYTES: usize = 64 << 20;

/// The requests of the command line.
struct Arguments {
    folder: PathBuf,
    only: Option<String>,
    pictures: usize,
    list: bool,
    keep: Option<PathBuf>,
    output: Option<PathBuf>,
}

fn arguments(mut words: impl Iterator<Item = String>) -> Option<Arguments> {
    let mut found =
        Arguments { folder: words.next()?.into(), only: None, pictures: 40, list: false, keep: None, output: None };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--only" => found.only = Some(words.next()?),
            "--pictures" => found.pictures = words.next()?.parse().ok()?,
            "--list" => found.list = true,
            "--keep" => found.keep = Some(words.next()?.into()),
            "-o" => found.output = Some(words.next()?.into()),
            _ => return None,
        }
    }
    Some(found)
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.split_first() {
        Some((task, files)) if task == "--accept" => return tasks::accept(files),
        Some((task, [scene])) if task == "--draw" => return tasks::draw(scene),
        _ => {}
    }
    let Some(arguments) = arguments(words.into_iter()) else {
        eprintln!("usage: repositories FOLDER [--only NAME] [--pictures N] [--list] [--keep DIR] [-o FILE]");
        return ExitCode::from(2);
    };
    let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn(move || measure(&arguments));
    match thread.map(std::thread::JoinHandle::join) {
        Ok(Ok(Ok(()))) => ExitCode::SUCCESS,
        Ok(Ok(Err(why))) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
        _ => ExitCode::FAILURE,
    }
}

fn measure(arguments: &Arguments) -> Result<(), String> {
    let list: List = toml::from_str(include_str!("repositories.toml")).map_err(|error| error.to_string())?;
    let wanted = |repository: &&Repository| {
        let fits = arguments.only.as_ref().is_none_or(|only| repository.name.contains(only.as_str()));
        fits && arguments.folder.join(repository.folder()).is_dir()
    };
    let (mut lines, mut disagreements, mut all) = (vec![HEAD.to_owned()], Vec::new(), Row::default());
    let (mut kind, mut of_kind) = ("", 0);
    for repository in list.repository.iter().filter(wanted) {
        if kind != repository.kind {
            kind = &repository.kind;
            of_kind += 1;
            lines.push(format!("| **{kind}** | | | | | | | | | | | | | | |"));
        }
        let row = one(repository, arguments)?;
        let line = row.line(&repository.shown(), &repository.commit);
        println!("{line}");
        if arguments.list {
            row.found.iter().for_each(|(class, file, message)| println!("  {class}\t{file}\t{message}"));
        }
        lines.push(line);
        disagreements.extend(row.disagreements(repository, &list));
        all.plus(&row);
    }
    lines.push(all.line(&format!("all, {of_kind} kinds"), ""));
    lines.push(String::new());
    lines.push("| repository | who | file | what | because |\n| --- | --- | --- | --- | --- |".to_owned());
    lines.extend(disagreements);
    // Where the repositories are does not matter.
    let folder = arguments.folder.join("").to_string_lossy().into_owned();
    let text = (lines.join("\n") + "\n").replace(&folder, "");
    match &arguments.output {
        Some(path) => std::fs::write(path, text).map_err(|error| error.to_string()),
        None => {
            println!("\n{text}");
            Ok(())
        }
    }
}

/// Checks a repository.
fn one(repository: &Repository, arguments: &Arguments) -> Result<Row, String> {
    let root = arguments.folder.join(repository.folder());
    let work = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut flags = flags(repository, arguments, &root, work.path())?;
    for ending in &repository.scripts {
        flags.push(scripts::extract(&root, ending, &work.path().join("scripts"))?);
    }
    let mut seen = BTreeSet::new();
    let is_new = |surveyed: &Surveyed| {
        let name = surveyed.files.first().map_or("", |(name, _)| name.as_str());
        let left_out = repository.without.iter().any(|part| name.contains(part.as_str()));
        let texts = texts(surveyed);
        let is_whole = surveyed.compiled.is_err() || !texts.is_empty() && texts.iter().all(|(_, text)| has_main(text));
        let mut hasher = DefaultHasher::new();
        texts.hash(&mut hasher);
        !left_out && is_whole && seen.insert(hasher.finish())
    };
    let programs: Vec<Surveyed> = Survey::new(&flags)?.programs().filter(is_new).collect();
    let drawn = programs.len().min(arguments.pictures).max(1);
    let mut row = Row::default();
    for (index, program) in programs.iter().enumerate() {
        // Evenly: the index enters a new one of `drawn` parts.
        let draws = arguments.pictures > 0
            && (index == 0 || index * drawn / programs.len() != (index - 1) * drawn / programs.len());
        let own = arguments.keep.as_ref().map(|keep| keep.join(repository.folder()).join(format!("{index:04}")));
        let folder = own.as_deref().unwrap_or(work.path());
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
        let mut checked = Checked::new(program, &texts(program), folder, draws);
        for (name, _) in &mut checked.files {
            for prefix in [root.as_path(), work.path()] {
                if let Ok(inside) = Path::new(name.as_str()).strip_prefix(prefix) {
                    *name = inside.display().to_string();
                }
            }
        }
        row.add(&checked);
    }
    Ok(row)
}

/// The arguments that find the programs of a repository.
fn flags(repository: &Repository, arguments: &Arguments, root: &Path, work: &Path) -> Result<Vec<String>, String> {
    let (own, all) = (root.to_string_lossy(), arguments.folder.to_string_lossy());
    let placed = |word: &String| word.replace("{all}", &all).replace("{}", &own);
    let mut flags: Vec<String> = repository.flags.iter().map(placed).collect();
    if let Some(prelude) = &repository.prelude {
        let file = work.join("prelude.glsl");
        std::fs::write(&file, prelude).map_err(|error| error.to_string())?;
        flags.extend(["--prelude".to_owned(), file.to_string_lossy().into_owned()]);
    }
    let folder = |inside: &String| root.join(inside).to_string_lossy().into_owned();
    flags.extend(repository.folders.iter().map(folder));
    if repository.folders.is_empty() && repository.scripts.is_empty() {
        flags.push(own.into_owned());
    }
    Ok(flags)
}

/// The text of each stage as a driver gets it.
fn texts(surveyed: &Surveyed) -> Vec<(Stage, &str)> {
    let Ok(compilation) = &surveyed.compiled else { return Vec::new() };
    let texts = surveyed.files.iter().zip(&compilation.texts);
    texts.map(|((_, stage), text)| (*stage, text.as_ref())).collect()
}

fn has_main(text: &str) -> bool {
    text.match_indices("main").any(|(place, word)| text[place + word.len()..].trim_start().starts_with('('))
}
