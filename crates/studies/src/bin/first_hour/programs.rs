//! [`find`]: the programs of repositories, each with its kind and the flags that its sources need.
//!
//! *In:* a folder of repositories. *Out:* [`Found`] programs, a sample of each repository, evenly chosen. *Holds:* programs with the same
//! texts count once; sources that do not compile are left out, as the study of repositories is about them.

use crate::list::{List, Repository};
use glisten::{Program, Stage};
use glisten_cli::survey::{Survey, Surveyed};
use glisten_scene::ColorDependence;
use glisten_scene::fixed::has_fixed_function;
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// A program.
pub(crate) struct Found {
    /// The folder of its repository.
    pub(crate) repository: String,
    /// The version, and whether it is of the fixed-function pipeline; or the engine.
    pub(crate) kind: String,
    /// Its files, without repetition.
    pub(crate) files: Vec<String>,
    pub(crate) flags: Vec<String>,
    /// Whether its text lets colors differ from pixel to pixel.
    pub(crate) dependence: ColorDependence,
}

/// Both lists: that of the study of repositories, and what it does not have.
const LISTS: [&str; 2] = [include_str!("../repositories/repositories.toml"), include_str!("repositories.toml")];
/// How many programs are looked at for each of the sample.
const SPARE: usize = 4;
/// Flags that take a value of their own.
const WITH_VALUE: [&str; 5] = ["--engine", "--assume-version", "--include-style", "-I", "-D"];

/// The programs of the repositories in a folder.
pub(crate) fn find(folder: &Path, only: Option<&str>, sample: usize) -> Result<Vec<Found>, String> {
    let list = known()?.repository;
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut names: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names.retain(|name| only.is_none_or(|only| name.contains(only)));
    let mut found = Vec::new();
    for name in names {
        let rows: Vec<&Repository> = list.iter().filter(|row| row.folder() == name).collect();
        if rows.is_empty() {
            found.extend(of_repository(&folder.join(&name), &name, (Vec::new(), &[], &[]), sample)?);
        }
        for row in rows.into_iter().filter(|row| row.prelude.is_none() && row.scripts.is_empty()) {
            let placed = |flag: &String| {
                flag.replace("{all}", &folder.to_string_lossy()).replace("{}", &folder.join(&name).to_string_lossy())
            };
            let flags = row.flags.iter().map(placed).collect();
            found.extend(of_repository(&folder.join(&name), &name, (flags, &row.folders, &row.without), sample)?);
        }
    }
    Ok(found)
}

/// The repositories of both lists, and the notes of the second one.
pub(crate) fn known() -> Result<List, String> {
    let [mut list, own] = [parsed(LISTS[0])?, parsed(LISTS[1])?];
    list.repository.extend(own.repository);
    list.note = own.note;
    Ok(list)
}

fn parsed(text: &str) -> Result<List, String> {
    toml::from_str(text).map_err(|error| error.to_string())
}

/// A sample of the programs of one repository.
fn of_repository(
    root: &Path,
    name: &str,
    (flags, folders, without): (Vec<String>, &[String], &[String]),
    sample: usize,
) -> Result<Vec<Found>, String> {
    let mut arguments = flags.clone();
    match folders {
        [] => arguments.push(root.to_string_lossy().into_owned()),
        folders => arguments.extend(folders.iter().map(|inner| root.join(inner).to_string_lossy().into_owned())),
    }
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    // Some do not compile, and some are there several times.
    for surveyed in Survey::new(&arguments)?.sampled(sample * SPARE).programs() {
        let Ok(compilation) = &surveyed.compiled else { continue };
        let Some(program) = &compilation.program else { continue };
        let is_left_out =
            surveyed.files.iter().any(|(file, _)| without.iter().any(|part| file.contains(part.as_str())));
        // A vertex shader alone is a program with the fixed-function pipeline's fragment stage.
        let is_fixed =
            program.stages.first().is_some_and(|shader| shader.stage == Stage::Vertex && has_fixed_function(shader));
        let is_whole = program.stage(Stage::Fragment).is_some() || is_fixed;
        let mut hasher = DefaultHasher::new();
        compilation.texts.hash(&mut hasher);
        if is_left_out || !is_whole || !seen.insert(hasher.finish()) {
            continue;
        }
        all.push(Found {
            repository: name.to_owned(),
            kind: kind(program, &flags),
            files: files(&surveyed),
            flags: flags.clone(),
            dependence: ColorDependence::of(program),
        });
    }
    let count = all.len();
    let kept = count.min(sample).max(1);
    // Evenly: the index enters a new one of `kept` parts.
    let is_kept = |index: usize| index == 0 || index * kept / count != (index - 1) * kept / count;
    Ok(all.into_iter().enumerate().filter(|(index, _)| is_kept(*index)).map(|(_, found)| found).collect())
}

fn files(surveyed: &Surveyed) -> Vec<String> {
    let mut files: Vec<String> = Vec::new();
    for (file, _) in &surveyed.files {
        if !files.contains(file) {
            files.push(file.clone());
        }
    }
    files
}

fn kind(program: &Program, flags: &[String]) -> String {
    let engine = flags.iter().position(|flag| flag == "--engine").and_then(|place| flags.get(place + 1));
    if let Some(engine) = engine {
        return engine.clone();
    }
    let version = program.stages.first().map_or(110, |shader| shader.version.number);
    let is_es = program.stages.first().is_some_and(|shader| shader.version.is_es());
    let is_fixed =
        program.stages.iter().any(|shader| shader.globals.iter().any(|global| global.used && global.is_fixed()));
    let words = [if is_es { " es" } else { "" }, if is_fixed { ", fixed function" } else { "" }].concat();
    format!("{version}{words}")
}

/// The flags about sources, for commands that take no folders.
pub(crate) fn of_sources(flags: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut words = flags.iter();
    while let Some(word) = words.next() {
        if WITH_VALUE.contains(&word.as_str()) {
            kept.push(word.clone());
            kept.extend(words.next().cloned());
        }
    }
    kept
}
