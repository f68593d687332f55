//! `glisten lint`: validates each file, then links the programs, and reports everything that is wrong.

use super::args::{BindingArgs, DiagnosticFormat, LevelArgs, ProgramArgs, SourceArgs};
use super::baseline::{Baseline, BaselineArgs};
use super::configurations::{Extent, Listed, explored};
use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use super::fix::{FixArgs, Fixer};
use super::guard;
use super::inputs::{self, Group, Inputs};
use super::not_checked;
use super::permutations;
use super::session::{Session, Unit, compile_anywhere};
use super::strings;
use clap::Args;
use glisten_front::diagnostic::{Code, Diagnostic, Levels};
use glisten_front::lint::check_some;
use glisten_front::source::Span;
use rayon::prelude::*;
use std::path::PathBuf;

/// Check shaders and the programs that they form
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(super) struct LintArgs {
    /// Shaders, folders to search for shaders, or `-` for standard input (default: the current folder)
    #[arg(value_name = "FILE|DIR")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
    /// The format of findings (`--diagnostics` of other commands)
    #[arg(long, value_enum, conflicts_with = "diagnostics")]
    format: Option<DiagnosticFormat>,
    /// Check each program as each of the macros that its conditions ask for would have it
    #[arg(long, conflicts_with_all = ["fix", "unsafe_fixes"])]
    configurations: bool,
    /// Check the variants of the programs in this file, in the format of `compile --permutations`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["fix", "unsafe_fixes", "files", "configurations"])]
    permutations: Option<PathBuf>,
    /// Check the shaders in the strings of JavaScript, TypeScript, Rust, Python, C and C++, too
    #[arg(long)]
    embedded: bool,
    #[command(flatten)]
    fixes: FixArgs,
    #[command(flatten)]
    baseline: BaselineArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    /// The number of threads (0: one per core)
    #[arg(short, long, default_value_t = 0, value_name = "N")]
    jobs: usize,
}

/// Runs the command.
pub(super) fn run(args: &LintArgs, console: &Console) -> Outcome {
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, args.jobs)?;
    session.set_format(args.format.unwrap_or(args.levels.diagnostics));
    let mut listed = Listed::new();
    let mut inputs = match &args.permutations {
        None => {
            let named = inputs::named_or_here(&args.files, &args.programs);
            let (hosts, named) = if args.embedded { strings::split(named) } else { (Vec::new(), named) };
            let mut inputs = inputs::collect(&named, &args.programs, &args.sources, true)?;
            if args.embedded {
                strings::add(&mut inputs, &hosts, &named)?;
            }
            inputs
        }
        Some(file) => {
            let programs = match permutations::programs(file) {
                Ok(programs) => programs,
                Err(batch) => return session.tell(&[&batch], true),
            };
            let mut inputs = Inputs::default();
            for program in programs {
                let group = inputs::program(&program.files, &args.programs, &args.sources)?;
                inputs.groups.push(Group { name: program.name.clone(), ..group });
                listed.insert(program.name, program.variants);
            }
            inputs
        }
    };
    inputs.tell_empty_folders(console);
    let baseline = Baseline::new(&args.baseline)?;
    let groups = std::mem::take(&mut inputs.groups);
    let mut units = checked(&mut session, groups.clone(), &inputs);
    if args.configurations || args.permutations.is_some() {
        let (all, extent) = explored(&mut session, units, &listed, &inputs.found, lints);
        units = all;
        if session.is_human() {
            console.remark(&told(&extent));
        }
    }
    if let Some(baseline) = baseline.as_ref().filter(|_| args.baseline.updates()) {
        baseline.update(&units, console)?;
        return Ok(Exit::Ok);
    }
    if let Some(baseline) = &baseline {
        baseline.apply(&mut units, Some(console).filter(|_| session.is_human()));
    }
    if !args.fixes.any() {
        return session.tell_units(&units, true);
    }
    if groups.iter().flat_map(|group| &group.inputs).any(|input| input.path.is_none()) {
        let message = "standard input cannot be fixed in its place";
        return Err(Failure::usage(message).help("name the file"));
    }
    let mut fixer = Fixer::new(args.fixes);
    while fixer.advance(&units) {
        units = checked(&mut session, groups.clone(), &inputs);
        if let Some(baseline) = &baseline {
            baseline.apply(&mut units, None);
        }
    }
    fixer.finish(console)?;
    session.tell_units(&units, !args.fixes.prints())
}

/// How many configurations were looked at, for people.
fn told(extent: &Extent) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let Extent { programs, configurations, compiled, branches, unreached } = *extent;
    let branches = match unreached {
        0 => format!("all of {} reached", count(branches, "branch").replace("branchs", "branches")),
        _ => format!("{} of {branches} branches reached", branches - unreached),
    };
    let programs = count(programs, "program");
    format!("{} of {programs}, {compiled} of them different; {branches}", count(configurations, "configuration"))
}

/// Compiles the groups, and adds the findings of the rules.
fn checked(session: &mut Session<'_>, groups: Vec<Group>, inputs: &Inputs) -> Vec<Unit> {
    let mut units = session.compile(groups);
    let found = lints(session, &units);
    for (unit, found) in units.iter_mut().zip(found) {
        session.add(&mut unit.batch, found);
    }
    certain(session, &mut units);
    not_checked::settle(session, &mut units, inputs);
    units
}

/// Drops the findings of units that depend on what their strings leave open.
fn certain(session: &Session<'_>, units: &mut [Unit]) {
    for unit in units {
        let Some(input) = unit.group.inputs.first().filter(|input| strings::is_in_string(input)) else { continue };
        let Ok(text) = files::read_source(&input.name, input.path.as_deref()) else { continue };
        let again = |group| Some(compile_anywhere(session.compiler(), session.engines(), group).0.batch);
        strings::keep_certain(&unit.group, &text, &mut unit.batch, again);
    }
}

/// The findings of the rules in each unit, in parallel. Rules that the levels of all its files turn off are not run.
fn lints(session: &mut Session<'_>, units: &[Unit]) -> Vec<Vec<Diagnostic>> {
    let mut levels_of = |unit: &Unit| -> Vec<Levels> {
        let files = unit.batch.sources.files().map(|(_, file)| file.name());
        files.map(|name| session.levels_of(name)).collect()
    };
    let levels: Vec<Vec<Levels>> = units.iter().map(&mut levels_of).collect();
    let found = |(unit, levels): (&Unit, Vec<Levels>)| {
        let wanted = |code: &Code| levels.iter().any(|levels| levels.may_report(code));
        let check = |program| guard::guarded(|| check_some(program, &unit.batch.sources, wanted));
        unit.program.as_ref().map_or_else(Vec::new, |program| {
            let first = unit.batch.sources.files().next().map_or(0, |(_, file)| file.base());
            check(program).unwrap_or_else(|panic| vec![guard::diagnostic(&panic, Span::new(first, first))])
        })
    };
    session.pool().install(|| units.par_iter().zip(levels).map(found).collect())
}
