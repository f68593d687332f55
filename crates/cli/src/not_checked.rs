//! Which of the files that a search found are not checked, and why.
//!
//! *In:* the compiled units, and what a search found and left. *Out:* the files that are not checked, with their reasons; the units
//! without them and without what was reported about them alone. *Holds:* a file leaves only if its first error shows that its
//! version is missing (`E0120`), or if a file that stays includes it, so that its errors are found there. A file without an error
//! stays, as does every file that the command line names.

use crate::console::painted;
use crate::inputs::{Inputs, SAY_STAGE, identity};
use crate::search::Why;
use crate::session::{Session, Unit};
use glisten_front::diagnostic::codes::general::NOT_CHECKED;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::codes::preprocess::MISSING_VERSION;
use glisten_front::diagnostic::write::{Finding, NotChecked, Region, Scope};
use glisten_front::diagnostic::{Diagnostic, Level};
use glisten_front::source::FileId;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The reason for a file whose name does not tell its stage.
const WITHOUT_STAGE: &str = "its name does not tell its stage";

/// How many files are shown to people.
const SHOWN: usize = 20;

/// Takes the files that are not checked out of the units, and lets the session tell what was checked and what was not.
pub(crate) fn settle(session: &mut Session<'_>, units: &mut Vec<Unit>, inputs: &Inputs) {
    let mut not_checked = pass_over(units, inputs);
    not_checked.retain_mut(|one| {
        let level = session.level(&one.region.file, &NOT_CHECKED);
        one.is_denied = level == Some(Level::Deny);
        level != Some(Level::Allow)
    });
    let mut files: Vec<&str> =
        units.iter().flat_map(|unit| &unit.group.inputs).map(|input| input.name.as_str()).collect();
    files.sort_unstable();
    files.dedup();
    let files = files.len();
    let programs = units.iter().filter(|unit| !unit.group.is_lone()).count();
    session.set_scope(Scope { files, programs, not_checked });
}

/// Takes the files that are not checked out of the units.
fn pass_over(units: &mut Vec<Unit>, inputs: &Inputs) -> Vec<NotChecked> {
    let mut passed = Vec::new();
    for unit in units.iter_mut() {
        let other: Vec<NotChecked> = indices(unit).filter_map(|index| of_other_version(unit, index, inputs)).collect();
        let names: BTreeSet<String> = other.iter().map(|one| one.region.file.clone()).collect();
        take_out(unit, &names);
        passed.extend(other);
    }
    passed.extend(included(units, inputs));
    units.retain(|unit| !unit.group.inputs.is_empty());
    let includers = includers(units);
    for left in &inputs.left {
        if includers.is_empty() || !includers.contains_key(&identity(&left.path)) {
            passed.push(whole(&left.path, because(left.why)));
        }
    }
    passed.sort_by(|a, b| a.region.cmp(&b.region));
    passed.dedup_by(|a, b| a.region.file == b.region.file);
    passed
}

fn indices(unit: &Unit) -> std::ops::Range<usize> {
    0..unit.group.inputs.len()
}

/// The file that a diagnostic is in.
fn file_of(unit: &Unit, diagnostic: &Diagnostic) -> Option<FileId> {
    let sources = &unit.batch.sources;
    sources.file_of(sources.call_site(diagnostic.primary.span))
}

fn is_found(unit: &Unit, index: usize, inputs: &Inputs) -> bool {
    let path = unit.group.inputs.get(index).and_then(|input| input.path.as_ref());
    path.is_some_and(|path| inputs.found.contains(path))
}

/// The first error of an input, in its own text or in what it includes.
fn first_error(unit: &Unit, index: usize) -> Option<&Diagnostic> {
    let read = unit.read.get(index)?;
    let is_own = |found: &&Diagnostic| file_of(unit, found).is_some_and(|file| read.contains(&file));
    let errors = unit.batch.diagnostics.iter().filter(|found| found.is_error()).filter(is_own);
    errors.min_by_key(|found| unit.batch.sources.call_site(found.primary.span).start)
}

/// An input whose version is missing.
fn of_other_version(unit: &Unit, index: usize, inputs: &Inputs) -> Option<NotChecked> {
    let first = first_error(unit, index).filter(|first| *first.code == MISSING_VERSION)?;
    if !is_found(unit, index, inputs) {
        return None;
    }
    let region = Finding::new(&unit.batch.sources, first).region;
    let shown = match first.primary.message.as_str() {
        "" => "it is not GLSL 1.10".to_owned(),
        message => message.to_owned(),
    };
    let name = unit.group.inputs.get(index)?.name.clone();
    // What shows it may be in a file that it includes.
    let (region, shown) = if region.file == name {
        (region, shown)
    } else {
        let place = format!("{shown} ({}:{})", region.file, region.line);
        (Region { file: name, line: 1, column: 1, end_line: 1, end_column: 1 }, place)
    };
    let because = format!("it has no `#version` line, and {shown}");
    Some(NotChecked { region, because, is_denied: false })
}

/// Takes files out of a unit, with what was reported about them alone.
fn take_out(unit: &mut Unit, names: &BTreeSet<String>) {
    if names.is_empty() {
        return;
    }
    let is_out = |index: usize| unit.group.inputs.get(index).is_some_and(|input| names.contains(&input.name));
    let kept: Vec<bool> = indices(unit).map(|index| !is_out(index)).collect();
    let read = |stays: bool| {
        let rows = unit.read.iter().zip(&kept).filter(move |(_, kept)| **kept == stays);
        rows.flat_map(|(files, _)| files.iter().copied()).collect::<BTreeSet<FileId>>()
    };
    let (staying, leaving) = (read(true), read(false));
    let sources = &unit.batch.sources;
    let leaves = |file: Option<FileId>| file.is_some_and(|file| leaving.contains(&file) && !staying.contains(&file));
    unit.batch.diagnostics.retain(|found| {
        let spans = found.secondary.iter().map(|label| label.span).chain([found.primary.span]);
        let mut files = spans.map(|span| sources.file_of(sources.call_site(span)));
        !staying.is_empty() && !files.any(leaves)
    });
    let mut flags = kept.iter();
    unit.group.inputs.retain(|_| *flags.next().unwrap_or(&true));
    let mut flags = kept.iter();
    unit.read.retain(|_| *flags.next().unwrap_or(&true));
}

/// For each included file, the names and identities of the files that include it.
fn includers(units: &[Unit]) -> BTreeMap<PathBuf, Vec<(String, PathBuf)>> {
    let mut includers: BTreeMap<PathBuf, Vec<(String, PathBuf)>> = BTreeMap::new();
    let mut known: BTreeMap<String, PathBuf> = BTreeMap::new();
    let mut identify = |name: &str| known.entry(name.to_owned()).or_insert_with(|| identity(Path::new(name))).clone();
    for unit in units {
        for (input, files) in unit.group.inputs.iter().zip(&unit.read) {
            for file in files.iter().skip(1) {
                let own = identify(&input.name);
                let file = identify(unit.batch.sources.file(*file).name());
                includers.entry(file).or_default().push((input.name.clone(), own.clone()));
            }
        }
    }
    includers
}

/// Takes out the files with errors that others include, which are checked there. That such a file lacks a function is no finding.
fn included(units: &mut [Unit], inputs: &Inputs) -> Vec<NotChecked> {
    let includers = includers(units);
    let (mut passed, mut gone) = (Vec::new(), BTreeSet::new());
    if includers.is_empty() {
        return passed;
    }
    for unit in units.iter_mut() {
        let (mut names, mut partial) = (BTreeSet::new(), BTreeSet::new());
        for index in indices(unit).filter(|index| is_found(unit, *index, inputs)) {
            let has_error = || {
                let own = unit.read.get(index).and_then(|files| files.first().copied());
                let errors = unit.batch.diagnostics.iter().filter(|found| found.is_error());
                first_error(unit, index).is_some() || errors.map(|found| file_of(unit, found)).any(|file| file == own)
            };
            let Some(input) = unit.group.inputs.get(index) else { continue };
            let own = identity(Path::new(&input.name));
            let stays = |(_, other): &&(String, PathBuf)| *other != own && !gone.contains(other);
            if includers.contains_key(&own) {
                partial.insert(index);
            }
            let Some((includer, _)) = includers.get(&own).and_then(|all| all.iter().find(stays)) else { continue };
            if has_error() {
                let because = format!("`{includer}` includes it: it is checked there");
                passed.push(whole(Path::new(&input.name), because));
                names.insert(input.name.clone());
                gone.insert(own);
            }
        }
        drop_what_is_elsewhere(unit, &partial);
        take_out(unit, &names);
    }
    passed
}

/// Drops the warnings that inputs which others include lack a function.
fn drop_what_is_elsewhere(unit: &mut Unit, partial: &BTreeSet<usize>) {
    let own = partial.iter().filter_map(|index| unit.read.get(*index)?.first().copied());
    let own: BTreeSet<FileId> = own.collect();
    let sources = &unit.batch.sources;
    unit.batch.diagnostics.retain(|found| {
        let is_lacking = [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION].contains(&found.code);
        let file = sources.file_of(sources.call_site(found.primary.span));
        !is_lacking || found.is_error() || file.is_none_or(|file| !own.contains(&file))
    });
}

fn whole(path: &Path, because: String) -> NotChecked {
    let file = path.to_string_lossy().into_owned();
    NotChecked { region: Region { file, line: 1, column: 1, end_line: 1, end_column: 1 }, because, is_denied: false }
}

/// How the reason begins for a stage that no command reads.
const UNREAD: &str = "glisten does not read";

fn because(why: Why) -> String {
    match why {
        Why::NoMain => "it has no `main`, and no file that is checked includes it".to_owned(),
        Why::Assembly => "it is in the assembly language of ARB_vertex_program".to_owned(),
        Why::NoStage => WITHOUT_STAGE.to_owned(),
        Why::Macros => "it has macros that make strings of shaders by `#`, which are not read".to_owned(),
        Why::Stage(stage) => format!("{UNREAD} {stage} shaders"),
    }
}

/// The files for people.
pub(crate) fn told(scope: &Scope, color: bool) -> String {
    let files = &scope.not_checked;
    let is_denied = files.iter().any(|one| one.is_denied);
    let count = if files.len() == 1 { "1 file was".to_owned() } else { format!("{} files were", files.len()) };
    let severity = if is_denied { "error" } else { "note" };
    let mut text = painted(severity, &format!("[{}]", NOT_CHECKED.id), &format!("{count} not checked"), color);
    for one in files.iter().take(SHOWN) {
        text.push_str(&format!("  {}:{}: {}\n", one.region.file, one.region.line, one.because));
    }
    if files.len() > SHOWN {
        text.push_str(&format!("  and {} more (all of them: `--format json`)\n", files.len() - SHOWN));
    }
    if files.iter().any(|one| one.because.contains("#version")) {
        text.push_str("  = help: say their version: `--assume-version 150`, or `version` in a `[[source]]` table of glisten.toml\n");
    }
    if files.iter().any(|one| one.because == WITHOUT_STAGE) {
        text.push_str(&format!("  = help: {SAY_STAGE}\n"));
    }
    let may_be_read = files.iter().any(|one| !one.because.starts_with(UNREAD));
    let how = if may_be_read { "name a file to see its errors; " } else { "" };
    text.push_str(&format!("  = help: {how}`--deny not-checked` makes this an error\n\n"));
    text
}
