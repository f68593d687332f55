//! `glisten fmt`: brings sources into one style.
//!
//! *In:* files, folders, or standard input. *Out:* the files, rewritten; or which ones would change, or how. *Holds:* a file is
//! replaced at once or not at all; a file whose bytes are not UTF-8 keeps them, and what is no text, or text of another kind, is an error. In a file of another
//! language, only strings change that are shaders.

use crate::arguments::config::{self, Configs};
use crate::batch::Batch;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::{self, ReadError};
use crate::process::guard;
use crate::search;
use crate::strings;
use crate::texts::{Text, diff};
use crate::threads::Threads;
use clap::Args;
use glisten_format::{Formatted, Options};
use glisten_front::Stage;
use glisten_front::compiler::{Compiler, Options as CompilerOptions, Source};
use glisten_front::diagnostic::codes::preprocess;
use glisten_front::diagnostic::{Area, Code, Levels, write};
use glisten_sources::embedded::{self, Host};
use glisten_sources::engines::code::without_comments;
use glisten_sources::stages;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten fmt", "all sources of this folder"),
    ("glisten fmt --check shaders", "which files would change, in CI"),
    ("glisten fmt --diff a.frag", "what would change"),
    ("glisten fmt --stdin-filename a.frag -", "for editors"),
];

/// Format shaders and includes
#[derive(Args, Debug)]
pub(crate) struct FmtArgs {
    /// Sources, folders to search for them, or `-` for standard input (default: the current folder)
    #[arg(value_name = "FILE|DIR")]
    files: Vec<PathBuf>,
    /// Write nothing; name the files that would change, and exit with 1 if there are any
    #[arg(long)]
    check: bool,
    /// Write nothing; print what would change
    #[arg(long)]
    diff: bool,
    /// Format the shaders in the strings of JavaScript, TypeScript, Rust, Python, C and C++, too
    #[arg(long)]
    embedded: bool,
    /// The name of standard input, whose folder tells the style
    #[arg(long, value_name = "NAME")]
    stdin_filename: Option<PathBuf>,
}

/// A file and its new text.
struct Done {
    path: PathBuf,
    text: Text,
    formatted: Formatted,
}

/// Why a file is not formatted.
enum Undone {
    /// It cannot be read, or is no source.
    Unread(Batch),
    /// It is of another kind, or cannot be written.
    Refused(Failure),
}

impl Done {
    fn changes(&self) -> bool {
        self.text.text != self.formatted.text
    }
}

/// Runs the command.
pub(crate) fn run(args: &FmtArgs, console: &Console) -> Outcome {
    if args.files.iter().any(|file| file.as_os_str() == crate::inputs::STDIN) {
        return standard_input(args, console);
    }
    if let Some(name) = &args.stdin_filename {
        let text = format!("`--stdin-filename {}` names standard input, which is not formatted", name.display());
        return Err(Failure::usage(text).help("write `-` for standard input, or leave `--stdin-filename` out"));
    }
    let paths = paths(&args.files, args.embedded)?;
    let folders = paths.iter().map(|path| folder_of(path));
    if let Some(exit) = wrong_configuration(folders, console) {
        return Ok(exit);
    }
    let mut styles: BTreeMap<PathBuf, Options> = BTreeMap::new();
    for path in &paths {
        let folder = folder_of(path);
        styles.entry(folder.to_owned()).or_insert_with(|| config::style_of(folder));
    }
    let one = |path: &PathBuf| {
        let name = path.to_string_lossy().into_owned();
        let bytes = match files::read(&name, path) {
            Ok(bytes) => bytes,
            Err(error) => return Err(Undone::Unread(as_batch(error, &name))),
        };
        if let Err(error) = refuse_no_text(&name, path, &bytes) {
            return Err(Undone::Unread(as_batch(error, &name)));
        }
        let text = Text::new(bytes);
        refuse_other_kinds(path, &text.text).map_err(Undone::Refused)?;
        let options = styles.get(folder_of(path)).cloned().unwrap_or_default();
        let formatted = any_formatted(&text.text, path, &options);
        let done = Done { path: path.clone(), text, formatted };
        if done.changes() && !args.check && !args.diff {
            files::replace(path, &done.text.bytes(&done.formatted.text)).map_err(Undone::Refused)?;
        }
        Ok(done)
    };
    let results = Threads::new(0).map(paths.iter().collect(), one);
    let (mut all, mut exit) = (Vec::new(), Exit::Ok);
    for result in results {
        match result {
            Ok(done) => all.push(done),
            Err(Undone::Unread(batch)) => exit = exit.max(refused(&batch, console)),
            Err(Undone::Refused(failure)) => exit = exit.max(console.tell(failure)),
        }
    }
    for done in all.iter().filter(|done| done.changes()) {
        told(args, console, done)?;
    }
    console.remark(&summary(&all, args.check || args.diff));
    let changes = all.iter().any(Done::changes);
    Ok(if args.check && changes { exit.max(Exit::Content) } else { exit })
}

/// Reports bytes that are no source. An include and a file of another language may be empty.
fn refuse_no_text(name: &str, path: &Path, bytes: &[u8]) -> Result<(), ReadError> {
    if Host::of(path).is_none() && !stages::may_be_included(path) {
        files::refuse_empty(name, bytes)?;
    }
    files::refuse_binary(name, bytes)
}

/// The error about a file, with its name.
fn as_batch(error: ReadError, name: &str) -> Batch {
    let mut batch = Batch::default();
    let diagnostic = error.diagnostic(&mut batch.sources, name);
    batch.diagnostics.push(diagnostic);
    batch
}

/// Tells why nothing is formatted. Returns the exit code.
fn refused(batch: &Batch, console: &Console) -> Exit {
    console.message(&write::human(&batch.sources, &batch.diagnostics, console.colors_messages()));
    Exit::of(&batch.diagnostics)
}

/// Reports what is wrong in the configurations of folders: a style that is half understood is not applied.
fn wrong_configuration<'p>(folders: impl Iterator<Item = &'p Path>, console: &Console) -> Option<Exit> {
    let mut configs = Configs::new(Levels::default());
    for folder in folders {
        configs.levels(&folder.join("source").to_string_lossy());
    }
    configs.errors.iter().map(|batch| refused(batch, console)).max()
}

/// Formats standard input onto standard output.
fn standard_input(args: &FmtArgs, console: &Console) -> Outcome {
    if args.files.len() > 1 {
        return Err(Failure::usage("standard input cannot be formatted together with files"));
    }
    let named = args.stdin_filename.as_deref().map(folder_of).unwrap_or(Path::new("."));
    if let Some(exit) = wrong_configuration([named].into_iter(), console) {
        return Ok(exit);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|error| Failure::usage(format!("cannot read standard input: {error}")))?;
    let path = args.stdin_filename.clone().unwrap_or_else(|| "standard input".into());
    refuse_host(&path, args.embedded)?;
    let name = path.display().to_string();
    if let Err(error) = refuse_no_text(&name, &path, &bytes) {
        return Ok(refused(&as_batch(error, &name), console));
    }
    let text = Text::new(bytes);
    if args.stdin_filename.is_some() {
        refuse_other_kinds(&path, &text.text)?;
    }
    let formatted = any_formatted(&text.text, &path, &config::style_of(folder_of(&path)));
    let done = Done { path, text, formatted };
    if args.check || args.diff {
        if done.changes() {
            told(args, console, &done)?;
        }
        return Ok(if args.check && done.changes() { Exit::Content } else { Exit::Ok });
    }
    console.output_bytes(&done.text.bytes(&done.formatted.text))?;
    Ok(Exit::Ok)
}

/// Says that a file changes, or how.
fn told(args: &FmtArgs, console: &Console, done: &Done) -> Result<(), Failure> {
    let name = done.path.display().to_string();
    if args.diff {
        return console.output(&diff(&name, &done.text.text, &done.formatted.text));
    }
    if args.check { console.output(&format!("would reformat {name}\n")) } else { Ok(()) }
}

/// The figures of a run.
fn summary(all: &[Done], is_trial: bool) -> String {
    let changed = all.iter().filter(|done| done.changes()).count();
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let verb = if is_trial { "would change" } else { "changed" };
    let mut text = format!("{} of {} {verb}", changed, count(all.len(), "file"));
    let kept: usize = all.iter().map(|done| done.formatted.kept).sum();
    let lines: usize = all.iter().map(|done| done.formatted.lines).sum();
    if lines > 0 {
        let share = 100.0 * (lines - kept) as f64 / lines as f64;
        text.push_str(&format!("; {} of {} formatted ({share:.1} %)", lines - kept, count(lines, "line")));
    }
    if kept > 0 {
        text.push_str(&format!(", {kept} kept: brackets do not match there, or the text does not parse"));
    }
    text
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The files that the command line names: files as they are, folders searched.
fn paths(named: &[PathBuf], embedded: bool) -> Result<Vec<PathBuf>, Failure> {
    let here = [PathBuf::from(".")];
    let named = if named.is_empty() { &here[..] } else { named };
    let mut paths = Vec::new();
    for path in named {
        if path.is_dir() {
            paths.extend(search::texts(path)?);
            if embedded {
                paths.extend(strings::hosts_in(path)?);
            }
        } else {
            refuse_host(path, embedded)?;
            paths.push(path.clone());
        }
    }
    // A file that is named twice is written once.
    paths.sort();
    paths.dedup();
    Ok(paths)
}

/// A file of another language is no shader.
fn refuse_host(path: &Path, embedded: bool) -> Result<(), Failure> {
    if embedded || Host::of(path).is_none() {
        return Ok(());
    }
    let message = format!("`{}` is no shader", path.display());
    Err(Failure::usage(message).help("`--embedded` formats the shaders in its strings"))
}

/// Refuses a text of another kind, whose blanks may matter: one that neither its name nor its first line calls a shader, and that does
/// not parse.
fn refuse_other_kinds(path: &Path, text: &str) -> Result<(), Failure> {
    let is_named = stages::by_name(path).is_some()
        || stages::unread(path).is_some()
        || stages::may_be_included(path)
        || stages::may_be_combined(path)
        || Host::of(path).is_some();
    if is_named || begins_as_a_shader(text) || parses(text) {
        return Ok(());
    }
    let message = format!("`{}` is no shader by its name, and its text does not parse as one", path.display());
    Err(Failure::usage(message).help("standard input has no name: `glisten fmt - < FILE`"))
}

/// The words of directives that a source may begin with, and the declaration that Godot's do.
const BEGINNINGS: [&str; 10] =
    ["#version", "#extension", "#pragma", "#include", "#define", "#ifdef", "#ifndef", "#if", "#line", "shader_type"];

fn begins_as_a_shader(text: &str) -> bool {
    let code = without_comments(text);
    let word = code.split_whitespace().next().unwrap_or_default();
    BEGINNINGS.contains(&word)
}

/// The errors of directives and signs that a text of another kind has.
const NO_SOURCE: [&Code; 3] =
    [&preprocess::ILLEGAL_CHARACTER, &preprocess::UNKNOWN_DIRECTIVE, &preprocess::MALFORMED_DIRECTIVE];

/// Whether a text has no errors of grammar.
fn parses(text: &str) -> bool {
    let source = Source { name: "source".into(), text: text.into(), stage: Stage::Fragment };
    let compiled = guard::guarded(|| Compiler::new(CompilerOptions::default()).compile(&[source]));
    compiled.is_ok_and(|compiled| {
        let is_wrong = |code: &Code| code.area() == Area::Syntax || NO_SOURCE.contains(&code);
        !compiled.diagnostics.iter().any(|found| found.is_error() && is_wrong(found.code))
    })
}

/// Formats a shader, or the shaders in the strings of a file.
fn any_formatted(text: &str, path: &Path, options: &Options) -> Formatted {
    let Some(host) = Host::of(path) else { return formatted(text, path, options) };
    let programs = embedded::programs(host, text);
    let (mut lines, mut kept) = (0, 0);
    let mut one = |text: &str| {
        let done = formatted(text, Path::new("string.glsl"), options);
        lines += done.lines;
        kept += done.kept;
        done.text
    };
    let text = embedded::styled(text, &programs, &mut one);
    Formatted { text, lines, kept }
}

/// A text in the style of the options.
pub(crate) fn formatted(text: &str, path: &Path, options: &Options) -> Formatted {
    let stage = stages::by_name(path).unwrap_or(Stage::Fragment);
    let formatted = guard::guarded(|| glisten_format::formatted(text, stage, options));
    formatted.unwrap_or_else(|_| glisten_format::format(text, &[], options))
}
