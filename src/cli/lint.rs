//! `glisten lint`: validates each file, then links the programs, and reports everything that is wrong.

use super::args::{BindingArgs, DiagnosticFormat, LevelArgs, ProgramArgs, SourceArgs};
use super::console::Console;
use super::exit::Outcome;
use super::inputs;
use super::session::{Session, Unit};
use clap::Args;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::preprocess::MISSING_VERSION;
use glisten_front::source::FileId;
use std::collections::BTreeSet;

/// Check shaders and the programs that they form
#[derive(Args, Debug)]
pub(super) struct LintArgs {
    /// Shaders, folders to search for shaders, or `-` for standard input
    #[arg(required_unless_present = "programs", value_name = "FILE|DIR")]
    files: Vec<String>,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
    /// Another name for --diagnostics
    #[arg(long, value_enum, conflicts_with = "diagnostics")]
    format: Option<DiagnosticFormat>,
    #[command(flatten)]
    bindings: BindingArgs,
    /// The number of threads (0: one per core)
    #[arg(short, long, default_value_t = 0, value_name = "N")]
    jobs: usize,
}

/// Runs the command.
pub(super) fn run(args: &LintArgs, console: &Console) -> Outcome {
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, true)?;
    for folder in &inputs.empty_folders {
        console.remark(&format!("no shader was found in `{folder}`"));
    }
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, args.jobs)?;
    session.set_format(args.format.unwrap_or(args.levels.diagnostics));
    let mut units = session.compile(inputs.groups);
    for unit in &mut units {
        if let Some(program) = &unit.program {
            session.add(&mut unit.batch, glisten_front::lint::check(program));
        }
    }
    let n_others: usize = units.iter_mut().map(|unit| pass_over_versions(unit, &inputs.found)).sum();
    units.retain(|unit| !unit.group.inputs.is_empty());
    if !units.is_empty() {
        session.set_clean(format!("{}: nothing found", counted(&units)));
    }
    let exit = session.tell_units(&units, true)?;
    if n_others > 0 && session.is_human() {
        let them = if n_others == 1 { "file of another version was" } else { "files of other versions were" };
        console.remark(&format!("{n_others} {them} not checked (name a file to see its version)"));
    }
    Ok(exit)
}

/// Takes the files out of a unit that a search found and that are of a GLSL version that is not supported, with all that was
/// reported about them. Returns their number.
fn pass_over_versions(unit: &mut Unit, found: &BTreeSet<String>) -> usize {
    let sources = &unit.batch.sources;
    let file = |diagnostic: &Diagnostic| sources.file_of(sources.call_site(diagnostic.primary.span));
    let other = |diagnostic: &&Diagnostic| *diagnostic.code == MISSING_VERSION;
    // A text without a version that is not of 1.10 gets one from its engine.
    let is_input = |name: &str| unit.group.inputs.iter().any(|input| input.name == name);
    let has_version = |file: FileId| sources.file(file).text().contains("#version");
    let given = sources.files().any(|(id, file)| !is_input(file.name()) && has_version(id));
    let unversioned = |file: &FileId| !given && !has_version(*file);
    let errors = unit.batch.diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
    let files = errors.clone().filter_map(file).filter(unversioned);
    let files: Vec<FileId> = files.chain(errors.filter(other).filter_map(file)).collect();
    let names: BTreeSet<&str> =
        files.iter().map(|file| sources.file(*file).name()).filter(|name| found.contains(*name)).collect();
    if names.is_empty() {
        return 0;
    }
    let n_inputs = unit.group.inputs.len();
    unit.group.inputs.retain(|input| !names.contains(input.name.as_str()));
    let is_kept =
        |diagnostic: &Diagnostic| file(diagnostic).is_none_or(|file| !names.contains(sources.file(file).name()));
    let kept: Vec<bool> = unit.batch.diagnostics.iter().map(is_kept).collect();
    let none_left = unit.group.inputs.is_empty();
    let mut kept = kept.into_iter();
    unit.batch.diagnostics.retain(|_| kept.next().unwrap_or(true) && !none_left);
    n_inputs - unit.group.inputs.len()
}

/// How many files and programs there are.
fn counted(units: &[Unit]) -> String {
    let n_files = units.iter().map(|unit| unit.group.inputs.len()).sum();
    let n_programs = units.iter().filter(|unit| !unit.group.is_lone()).count();
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    match n_programs {
        0 => count(n_files, "file"),
        _ => format!("{}, {}", count(n_files, "file"), count(n_programs, "program")),
    }
}
