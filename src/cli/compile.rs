//! `glisten compile`: translates programs to target languages and writes their reflection.
//!
//! *Holds:* nothing is written for a program with errors. The names of all outputs are known before any work begins,
//! so two programs that would write the same file are rejected at once.

use super::args::{BindingArgs, ConventionArgs, LevelArgs, ProgramArgs, SourceArgs};
use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use super::guard;
use super::inputs::{self, Group};
use super::optimize::{self, OptimizeArgs};
use super::session::{Session, Unit};
use crate::library;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use glisten_emit::reflection::StageFiles;
use glisten_emit::{self as emit, Conventions, Emitted, Target};
use glisten_front::diagnostic::codes::general::LONE_STAGE;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::{Diagnostic, Severity};
use glisten_front::hir::{self, Stage};
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

/// Translate programs to WGSL, SPIR-V and other targets, and write their reflection
#[derive(Args, Debug)]
pub(super) struct CompileArgs {
    /// Shaders, or `-` for standard input
    #[arg(required_unless_present = "programs", value_name = "FILE")]
    files: Vec<String>,
    /// The output folder; `-` writes the code of one stage for one target to standard output
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["check", "emit"])]
    output: Option<PathBuf>,
    /// The target to write (repeatable; default: wgsl and spirv)
    #[arg(long = "target", value_parser = target_words())]
    targets: Vec<Target>,
    /// Check everything, but write nothing
    #[arg(long)]
    check: bool,
    /// Print the typed program (HIR) instead of writing files
    #[arg(long, value_enum, conflicts_with_all = ["output", "depfile", "check"])]
    emit: Option<EmitArg>,
    /// Write a Make rule with all outputs, inputs and includes
    #[arg(long, value_name = "FILE")]
    depfile: Option<PathBuf>,
    /// Write source lines into SPIR-V
    #[arg(short = 'g')]
    debug_lines: bool,
    /// The number of threads (0: one per core)
    #[arg(short, long, default_value_t = 0, value_name = "N")]
    jobs: usize,
    /// Report what -O leaves out
    #[arg(long)]
    left_out: bool,
    /// List each element of large arrays of structs in the reflection
    #[arg(long)]
    flat: bool,
    #[command(flatten)]
    optimize: OptimizeArgs,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    #[command(flatten)]
    conventions: ConventionArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The intermediate form that `--emit` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum EmitArg {
    /// The typed program as GLSL, with explicit conversions and folded constants
    Hir,
}

/// Reads the word of a target.
pub(super) fn target_words() -> impl TypedValueParser<Value = Target> {
    let words = Target::ALL.iter().map(|target| target.word());
    PossibleValuesParser::new(words).try_map(|word| Target::from_word(&word).ok_or("no such target"))
}

/// A file to write.
type Output = (PathBuf, Vec<u8>);

/// Runs the command.
pub(super) fn run(args: &CompileArgs, console: &Console) -> Outcome {
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, false)?;
    let plan = OutputPlan::new(args, &inputs.groups)?;
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, args.jobs)?;
    let mut units = session.compile(inputs.groups);
    if let Some(EmitArg::Hir) = args.emit {
        let exit = session.tell_units(&units, false)?;
        console.output(&typed_programs(&units, args.optimize.is_given()))?;
        return Ok(exit);
    }
    for unit in &mut units {
        let warning = lone_stage(unit);
        session.add(&mut unit.batch, warning);
        refuse_what_is_no_program(unit);
    }
    let emitted: Vec<Result<Vec<Output>, Vec<Diagnostic>>> =
        session.pool().install(|| units.par_iter().map(|unit| plan.emit(unit)).collect());
    let mut outputs = Vec::new();
    for (unit, result) in units.iter_mut().zip(emitted) {
        match result {
            Ok(files) => outputs.extend(files),
            Err(diagnostics) => session.add(&mut unit.batch, diagnostics),
        }
        let notes = unit.sound_program().map_or_else(Vec::new, |program| plan.notes(program, &unit.batch.sources));
        session.add(&mut unit.batch, notes);
    }
    let exit = session.tell_units(&units, false)?;
    if plan.is_standard_output() && !args.check {
        if let Some((_, code)) = outputs.first() {
            console.output_bytes(code)?;
        }
    } else if !args.check {
        plan.write(&outputs)?;
    }
    if let Some(depfile) = &args.depfile
        && exit == Exit::Ok
    {
        files::write(depfile, plan.make_rule(&units).as_bytes())?;
    }
    Ok(exit)
}

/// The outputs and where to write them.
struct OutputPlan {
    folder: PathBuf,
    targets: BTreeSet<Target>,
    conventions: Conventions,
    optimize: OptimizeArgs,
    left_out: bool,
    flat: bool,
}

impl OutputPlan {
    fn new(args: &CompileArgs, groups: &[Group]) -> Result<Self, Failure> {
        let mut targets: BTreeSet<Target> = args.targets.iter().copied().collect();
        if targets.is_empty() {
            targets.extend([Target::Wgsl, Target::Spirv]);
        }
        let folder = args.output.clone().unwrap_or_default();
        let conventions = args.conventions.conventions(args.debug_lines);
        let (optimize, left_out, flat) = (args.optimize, args.left_out, args.flat);
        let plan = Self { folder, targets, conventions, optimize, left_out, flat };
        if plan.is_standard_output() {
            plan.refuse_several(args, groups)?;
        }
        plan.refuse_collisions(groups)?;
        Ok(plan)
    }

    /// Whether the code goes to standard output.
    fn is_standard_output(&self) -> bool {
        self.folder.as_os_str() == "-"
    }

    /// Only one text fits into standard output.
    fn refuse_several(&self, args: &CompileArgs, groups: &[Group]) -> Result<(), Failure> {
        let lone = match groups {
            [one] => one.is_lone(),
            _ => false,
        };
        let (problem, help) = if args.depfile.is_some() {
            ("a depfile names no file", "leave `--depfile` out, or name a folder")
        } else if !lone {
            ("there are several stages", "name one file, or a folder with `-o DIR`")
        } else if args.targets.is_empty() {
            ("no target is given", "add `--target wgsl`, or name a folder with `-o DIR`")
        } else if self.targets.len() > 1 {
            ("there are several targets", "name one target, or a folder with `-o DIR`")
        } else {
            return Ok(());
        };
        let message = format!("`-o -` writes one stage for one target to standard output: {problem}");
        Err(Failure::usage(message).help(help))
    }

    /// The names of a program's outputs, the reflection last.
    fn names(&self, group: &Group) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for stage in Stage::ALL {
            // Several files of one stage have one output, which is named after the first.
            if let Some(input) = group.inputs.iter().find(|input| input.stage == stage) {
                let file = input.file_name();
                names.extend(self.targets.iter().map(|target| format!("{file}.{}", target.extension())));
            }
        }
        names.push(format!("{}.json", group.name));
        names
    }

    fn refuse_collisions(&self, groups: &[Group]) -> Result<(), Failure> {
        let mut writers: BTreeMap<String, &Group> = BTreeMap::new();
        let sources: BTreeSet<PathBuf> = groups
            .iter()
            .flat_map(|group| &group.inputs)
            .filter_map(|input| fs::canonicalize(input.path.as_ref()?).ok())
            .collect();
        for group in groups {
            for name in self.names(group) {
                let path = self.folder.join(&name);
                if fs::canonicalize(&path).is_ok_and(|path| sources.contains(&path)) {
                    let message = format!("the output `{}` is one of the inputs", path.display());
                    return Err(Failure::usage(message).help("choose another folder with `-o`"));
                }
                if let Some(other) = writers.insert(name, group) {
                    let message = format!(
                        "the programs of {} and of {} would both write `{}`",
                        files_of(other),
                        files_of(group),
                        path.display()
                    );
                    return Err(Failure::usage(message).help("compile them into different folders"));
                }
            }
        }
        Ok(())
    }

    /// Whether the code for a target is without what reaches no output.
    fn optimizes(&self, target: Target) -> bool {
        self.optimize.applies(target, self.conventions.debug_lines)
    }

    /// Notes on what is not in the outputs.
    fn notes(&self, program: &Program, sources: &SourceMap) -> Vec<Diagnostic> {
        let mut notes = emit::notes(program, &self.conventions);
        if self.left_out && self.targets.iter().any(|target| self.optimizes(*target)) {
            notes.extend(optimize::notes(program, sources));
        }
        notes
    }

    /// The outputs of one program; none if there are errors.
    fn emit(&self, unit: &Unit) -> Result<Vec<Output>, Vec<Diagnostic>> {
        let Some(program) = unit.sound_program() else { return Ok(Vec::new()) };
        guard::guarded(|| self.emit_program(&unit.group, program, &unit.batch.sources)).unwrap_or_else(|panic| {
            let span = unit.batch.sources.files().next().map_or(0, |(_, file)| file.base());
            Err(vec![guard::diagnostic(&panic, Span::new(span, span))])
        })
    }

    fn emit_program(
        &self,
        group: &Group,
        program: &Program,
        sources: &SourceMap,
    ) -> Result<Vec<Output>, Vec<Diagnostic>> {
        let mut outputs = Vec::new();
        let mut diagnostics = Vec::new();
        let mut texts = Vec::new();
        let sources = Some(sources);
        let optimized = optimize::optimized(program, self.targets.iter().any(|target| self.optimizes(*target)));
        for shader in &program.stages {
            let Some(input) = group.inputs.iter().find(|input| input.stage == shader.stage) else { continue };
            for target in &self.targets {
                let emitted = if self.optimizes(*target) { &optimized } else { program };
                match emit::emit_with_sources(emitted, shader.stage, *target, &self.conventions, sources) {
                    Ok(emitted) => {
                        let name = format!("{}.{}", input.file_name(), target.extension());
                        if let (Target::Wgsl, Emitted::Text(text)) = (target, &emitted) {
                            texts.push(text.clone());
                        }
                        outputs.push((self.folder.join(name), emitted.into_bytes()));
                    }
                    Err(errors) => diagnostics.extend(errors),
                }
            }
        }
        // What one of the outputs has is active.
        let all = self.targets.iter().all(|target| self.optimizes(*target));
        let mut reflection = emit::reflect(if all { &optimized } else { program }, &self.conventions);
        texts.iter().for_each(|text| reflection.name_in_wgsl(text));
        reflection.files = files_of_stages(group, &self.targets);
        if !self.flat {
            reflection.compact();
        }
        let mut json = serde_json::to_vec_pretty(&reflection).expect("a reflection is always JSON");
        json.push(b'\n');
        outputs.push((self.folder.join(format!("{}.json", group.name)), json));
        if diagnostics.is_empty() { Ok(outputs) } else { Err(diagnostics) }
    }

    fn write(&self, outputs: &[Output]) -> Result<(), Failure> {
        if outputs.is_empty() {
            return Ok(());
        }
        files::make_folder(&self.folder)?;
        outputs.iter().try_for_each(|(path, bytes)| files::write(path, bytes))
    }

    /// One rule: all outputs, then all inputs and includes without repetitions.
    fn make_rule(&self, units: &[Unit]) -> String {
        let targets: Vec<String> = units
            .iter()
            .flat_map(|unit| self.names(&unit.group))
            .map(|name| make_word(&self.folder.join(name).to_string_lossy()))
            .collect();
        let mut seen = BTreeSet::new();
        let standard_input = |name: &str| {
            units.iter().any(|unit| unit.group.inputs.iter().any(|input| input.path.is_none() && input.name == name))
        };
        let sources: Vec<String> = units
            .iter()
            .flat_map(|unit| unit.batch.sources.files())
            .map(|(_, file)| file.name())
            .filter(|name| *name != SourceMap::COMMAND_LINE)
            .filter(|name| !standard_input(name) && !library::is_embedded(name) && seen.insert(name.to_string()))
            .map(make_word)
            .collect();
        format!("{}: {}\n", targets.join(" "), sources.join(" "))
    }
}

/// The files of each stage for the reflection, with the outputs for these targets.
pub(super) fn files_of_stages(group: &Group, targets: &BTreeSet<Target>) -> BTreeMap<String, StageFiles> {
    let mut files: BTreeMap<String, StageFiles> = BTreeMap::new();
    for input in &group.inputs {
        let own = files.entry(input.stage.name().to_owned()).or_default();
        own.sources.push(input.file_name());
        // Several files of one stage have one output, which is named after the first.
        for target in targets {
            let name = || format!("{}.{}", input.file_name(), target.extension());
            own.outputs.entry(target.word().to_owned()).or_insert_with(name);
        }
    }
    files
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

/// A file name as a word of a Make rule.
fn make_word(name: &str) -> String {
    name.replace('$', "$$").replace('#', "\\#").replace(' ', "\\ ")
}

fn files_of(group: &Group) -> String {
    group.inputs.iter().map(|input| format!("`{}`", input.name)).collect::<Vec<_>>().join(", ")
}

/// Turns the warnings of a single shader that lacks a function into errors. Such a shader is valid as part of a
/// program, which `lint` accepts, but nothing can be emitted for it.
fn refuse_what_is_no_program(unit: &mut Unit) {
    if unit.program.is_some() {
        return;
    }
    for diagnostic in &mut unit.batch.diagnostics {
        if [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION].contains(&diagnostic.code) {
            diagnostic.severity = Severity::Error;
        }
    }
}

/// The warning about a program of a single stage.
fn lone_stage(unit: &Unit) -> Option<Diagnostic> {
    if !unit.group.is_lone() || unit.program.is_none() {
        return None;
    }
    let (_, file) = unit.batch.sources.files().next()?;
    let stage = unit.group.inputs.first().map_or("", |input| input.stage.name());
    let message = format!("`{}` is compiled without its partner", file.name());
    let span = Span::new(file.base(), file.base());
    let warning = Diagnostic::new(&LONE_STAGE, span, message)
        .note(format!("locations of varyings and the uniform block are those of the {stage} stage alone"))
        .help("name all files of a program in one command, or say `--program a.vert,b.frag`");
    Some(warning)
}

#[cfg(test)]
mod tests {
    use super::make_word;

    #[test]
    fn make_words_are_escaped() {
        assert_eq!(make_word("a b$c#d"), "a\\ b$$c\\#d");
    }
}
