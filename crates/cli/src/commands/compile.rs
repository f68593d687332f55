//! `glisten compile`: translates programs to target languages and writes their reflection.
//!
//! *Holds:* nothing is written for a program with errors. What a cache holds is written like what is compiled.

use crate::arguments::args::{BindingArgs, LevelArgs, ProgramArgs, SourceArgs};
use crate::cache::CacheArgs;
use crate::commands::examples::Examples;
use crate::commands::permutations::{self, Job};
use crate::console::Console;
use crate::depfile::{self, Made};
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs::{self, Group};
use crate::lone;
use crate::not_checked;
use crate::optimize;
use crate::outputs::{Output, OutputArgs, OutputPlan};
use crate::overwrite;
use crate::recall::Recall;
use crate::session::{Session, Unit};
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir;
use std::path::{Path, PathBuf};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten compile a.vert a.frag -o out", "WGSL, SPIR-V and reflection of a program"),
    ("glisten compile a.vert a.frag -o out --target wgsl", "WGSL alone"),
];

/// Translate programs to WGSL, SPIR-V and other targets, and write their reflection
#[derive(Args, Debug)]
pub(crate) struct CompileArgs {
    /// Shaders, folders to search for shaders, or `-` for standard input
    #[arg(required_unless_present_any = ["programs", "permutations"], value_name = "FILE|DIR")]
    files: Vec<PathBuf>,
    /// The output folder; `-` writes the code of one stage for one target to standard output
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["check", "emit"])]
    output: Option<PathBuf>,
    /// Compile all variants that this TOML file asks for; equal outputs are one file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["files", "programs", "emit"])]
    permutations: Option<PathBuf>,
    /// Remove outputs of earlier runs that no variant has any more
    #[arg(long, conflicts_with_all = ["files", "programs", "emit"])]
    prune: bool,
    /// Check everything, but write nothing, neither a depfile nor a manifest
    #[arg(long)]
    check: bool,
    /// Print the typed program (HIR) instead of writing files
    #[arg(long, value_enum, conflicts_with_all = ["output", "depfile", "manifest", "check"])]
    emit: Option<EmitArg>,
    /// Write a Make rule with all outputs, inputs and includes
    #[arg(long, value_name = "FILE")]
    depfile: Option<PathBuf>,
    /// Write what each output was made from, with SHA-256 digests, as JSON
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// The number of threads (0: one per core)
    #[arg(short, long, default_value_t = 0, value_name = "N")]
    jobs: usize,
    #[command(flatten)]
    outputs: OutputArgs,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    #[command(flatten)]
    cache: CacheArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The intermediate form that `--emit` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum EmitArg {
    /// The typed program as GLSL, with explicit conversions and folded constants
    Hir,
}

impl CompileArgs {
    /// The files that tell what was read and written.
    fn accounts(&self) -> impl Iterator<Item = &Path> {
        self.depfile.iter().chain(&self.manifest).map(PathBuf::as_path)
    }
}

/// Runs the command.
pub(crate) fn run(args: &CompileArgs, console: &Console) -> Outcome {
    if let Some(file) = &args.permutations {
        return permute(args, file, console);
    }
    let mut inputs = inputs::collect(&args.files, &args.programs, &args.sources, true)?;
    inputs.tell_without_stage(console);
    if let (Some(folder), true) = (inputs.empty_folders.first(), inputs.groups.is_empty()) {
        return Err(Failure::usage(format!("no shader was found in `{folder}`")));
    }
    inputs.tell_empty_folders(console);
    let plan = OutputPlan::new(&args.outputs)?;
    let folder = args.output.clone().unwrap_or_default();
    if is_standard_output(&folder) {
        refuse_several(args, &plan, &inputs.groups)?;
    }
    let below = inputs.below();
    let accounts: Vec<&Path> = args.accounts().collect();
    plan.refuse_collisions(&folder, &below, &inputs.groups, &accounts)?;
    accounts.iter().try_for_each(|path| overwrite::refuse(path))?;
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, args.jobs)?;
    if let Some(EmitArg::Hir) = args.emit {
        let units = session.compile(std::mem::take(&mut inputs.groups));
        let exit = session.tell_units(&units, false)?;
        console.output(&typed_programs(&units, args.outputs.optimize.is_given()))?;
        return Ok(exit);
    }
    let recall = Recall::new(&args.cache, session.engines(), &args.sources, &args.bindings, &plan)?;
    let groups = std::mem::take(&mut inputs.groups);
    let mut units = session.compile_by(groups, |compiler, group| recall.compile(compiler, group, ""));
    for unit in &mut units {
        let warning = lone::warning(unit, session.engines());
        session.add(&mut unit.batch, warning);
        lone::refuse_what_is_no_program(unit);
    }
    if inputs.has_search() {
        not_checked::settle(&mut session, &mut units, &inputs);
    }
    let outputs_of = |unit: &Unit| emit(&plan, &recall, unit).below(&below(&unit.group));
    let emitted: Vec<Emitted> = session.threads().map(units.iter().collect(), outputs_of);
    let mut outputs = Vec::new();
    let mut made = Vec::new();
    for (unit, emitted) in units.iter_mut().zip(emitted) {
        session.add(&mut unit.batch, emitted.diagnostics);
        made.push(Made::new(&unit.group, &folder, &emitted.outputs, &unit.batch.sources));
        outputs.extend(emitted.outputs);
    }
    let exit = session.tell_units(&units, false)?;
    if is_standard_output(&folder) && !args.check {
        if let Some((_, code)) = outputs.first() {
            console.output_bytes(code)?;
        }
    } else if !args.check {
        write(&folder, &outputs)?;
    }
    recall.close(console);
    if exit == Exit::Ok && !args.check {
        write_accounts(args, &plan, &folder, &below, &units, &made)?;
    }
    Ok(exit)
}

/// Compiles all variants of a file.
fn permute(args: &CompileArgs, file: &Path, console: &Console) -> Outcome {
    overwrite::note(file);
    args.accounts().try_for_each(overwrite::refuse)?;
    let folder = args.output.clone().unwrap_or_default();
    if is_standard_output(&folder) {
        return Err(Failure::usage("`-o -` writes one stage for one target to standard output: there are variants")
            .help("name a folder with `-o DIR`"));
    }
    let job = Job {
        file,
        folder: &folder,
        check: args.check,
        prune: args.prune,
        depfile: args.depfile.as_deref(),
        manifest: args.manifest.as_deref(),
        jobs: args.jobs,
        programs: &args.programs,
        outputs: &args.outputs,
        sources: &args.sources,
        bindings: &args.bindings,
        levels: &args.levels,
        cache: &args.cache,
    };
    permutations::run(&job, console)
}

/// The outputs of a program: none if there are errors.
#[derive(Default)]
struct Emitted {
    outputs: Vec<Output>,
    diagnostics: Vec<Diagnostic>,
}

impl Emitted {
    /// The same, in a folder below that of all outputs.
    fn below(mut self, folder: &Path) -> Self {
        if folder != Path::new("") {
            for (name, _) in &mut self.outputs {
                *name = folder.join(&*name).to_string_lossy().replace('\\', "/");
            }
        }
        self
    }
}

/// Emits a program, unless its outputs come from a cache.
fn emit(plan: &OutputPlan, recall: &Recall, unit: &Unit) -> Emitted {
    if unit.exit() != Exit::Ok {
        return Emitted::default();
    }
    if let Some(kept) = &unit.kept {
        return Emitted { outputs: kept.outputs.clone(), diagnostics: kept.notes.clone() };
    }
    let Some(program) = unit.sound_program() else { return Emitted::default() };
    let sources = &unit.batch.sources;
    match plan.emit(&unit.group, program, sources) {
        Ok(outputs) => {
            let diagnostics = plan.notes(program, sources);
            recall.keep(unit, &outputs, &diagnostics);
            Emitted { outputs, diagnostics }
        }
        Err(diagnostics) => Emitted { outputs: Vec::new(), diagnostics },
    }
}

/// Writes the depfile and the manifest.
fn write_accounts(
    args: &CompileArgs,
    plan: &OutputPlan,
    folder: &Path,
    below: &impl Fn(&Group) -> PathBuf,
    units: &[Unit],
    made: &[Made],
) -> Result<(), Failure> {
    if let Some(path) = &args.depfile {
        let paths = |unit: &Unit| {
            let folder = folder.join(below(&unit.group));
            plan.names(&unit.group).into_iter().map(move |name| folder.join(name))
        };
        let outputs = units.iter().flat_map(paths).map(|path| files::shown(&path));
        let sources = units.iter().flat_map(|unit| depfile::files_read(&unit.group, &unit.batch.sources));
        files::write(path, &depfile::make_rule(outputs, sources))?;
    }
    if let Some(path) = &args.manifest {
        files::write(path, depfile::manifest(made).as_bytes())?;
    }
    Ok(())
}

/// Whether the code goes to standard output.
fn is_standard_output(folder: &Path) -> bool {
    folder.as_os_str() == "-"
}

/// Only one text fits into standard output.
fn refuse_several(args: &CompileArgs, plan: &OutputPlan, groups: &[Group]) -> Result<(), Failure> {
    let lone = match groups {
        [one] => one.is_lone(),
        _ => false,
    };
    let (problem, help) = if args.depfile.is_some() {
        ("a depfile names no file", "leave `--depfile` out, or name a folder")
    } else if args.manifest.is_some() {
        ("a manifest names no file", "leave `--manifest` out, or name a folder")
    } else if groups.len() > 1 || !(lone || plan.single_file) {
        ("there are several stages", "name one file, write all stages as one with `--single-file`, or name a folder")
    } else if args.outputs.targets.is_empty() && !plan.single_file {
        ("no target is given", "add `--target wgsl`, or name a folder with `-o DIR`")
    } else if plan.targets.len() > 1 {
        ("there are several targets", "name one target, or a folder with `-o DIR`")
    } else {
        return Ok(());
    };
    let message = format!("`-o -` writes one stage for one target to standard output: {problem}");
    Err(Failure::usage(message).help(help))
}

/// Writes the outputs.
fn write(folder: &Path, outputs: &[Output]) -> Result<(), Failure> {
    if outputs.is_empty() {
        return Ok(());
    }
    files::make_folder(folder)?;
    outputs.iter().try_for_each(|(name, bytes)| {
        let path = folder.join(name);
        if let Some(folder) = path.parent().filter(|folder| !folder.exists()) {
            files::make_folder(folder)?;
        }
        files::write(&path, bytes)
    })
}

/// All stages of all programs, each under the name of its file.
fn typed_programs(units: &[Unit], optimized: bool) -> String {
    let mut text = String::new();
    for unit in units {
        let Some(program) = unit.sound_program() else { continue };
        let program = optimize::optimized(program, optimized);
        for shader in &program.stages {
            let input = unit.group.inputs.iter().find(|input| input.stage == shader.stage);
            let name = input.map_or("", |input| &input.name);
            text.push_str(&format!("// {name}\n{}\n", hir::print(&program.types, shader)));
        }
    }
    text
}
