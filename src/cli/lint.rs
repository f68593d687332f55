//! `glisten lint`: validates each file, then links the programs, and reports everything that is wrong.

use super::args::{BindingArgs, DiagnosticFormat, LevelArgs, ProgramArgs, SourceArgs};
use super::console::Console;
use super::exit::Outcome;
use super::inputs;
use super::session::{Session, Unit};
use clap::Args;

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
    let inputs = inputs::collect(&args.files, &args.programs, true)?;
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
    if !units.is_empty() {
        session.set_clean(format!("{}: nothing found", counted(&units)));
    }
    session.tell_units(&units, true)
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
