//! [`OutputPlan`]: the files that a program becomes.
//!
//! *In:* the targets and conventions, groups of files, linked programs. *Out:* the code for each stage and target, and the
//! reflection, as bytes with names. *Holds:* the names of all outputs are known before any work begins, so two programs that
//! would write the same file are rejected at once. Nothing is written here.

use crate::arguments::args::ConventionArgs;
use crate::digest::Content;
use crate::exit::Failure;
use crate::inputs::Group;
use crate::memo::{Memo, code};
use crate::optimize::{self, OptimizeArgs};
use crate::overwrite;
use crate::process::guard;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glisten_emit::reflection::StageFiles;
use glisten_emit::{self as emit, Conventions, Emitted, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use glisten_sources::stages;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The parts of a program to write.
#[derive(Args, Clone, Debug)]
pub(crate) struct OutputArgs {
    /// The target to write (repeatable; default: wgsl and spirv)
    #[arg(long = "target", value_parser = target_words())]
    pub(crate) targets: Vec<Target>,
    /// Write one file for each target, with the entry points `vs_main` and `fs_main` (wgsl, msl, hlsl; default: wgsl)
    #[arg(long)]
    pub(crate) single_file: bool,
    /// Write source lines into SPIR-V
    #[arg(short = 'g')]
    pub(crate) debug_lines: bool,
    /// Report what -O leaves out
    #[arg(long)]
    left_out: bool,
    /// List each element of large arrays of structs in the reflection
    #[arg(long)]
    flat: bool,
    #[command(flatten)]
    pub(crate) optimize: OptimizeArgs,
    #[command(flatten)]
    conventions: ConventionArgs,
}

/// Reads the word of a target.
pub(crate) fn target_words() -> impl TypedValueParser<Value = Target> {
    let words = Target::ALL.iter().map(|target| target.word());
    PossibleValuesParser::new(words).try_map(|word| Target::from_word(&word).ok_or("no such target"))
}

/// A file to write: its name and its bytes.
pub(crate) type Output = (String, Content);

/// The parts of a program to write, in full.
#[derive(Clone, Debug)]
pub(crate) struct OutputPlan {
    pub(crate) targets: BTreeSet<Target>,
    conventions: Conventions,
    optimize: OptimizeArgs,
    left_out: bool,
    flat: bool,
    /// Whether all stages of a program are in one file.
    pub(crate) single_file: bool,
    /// Whether outputs have names that the reflection can tell.
    named: bool,
}

impl OutputPlan {
    /// The plan that the arguments ask for.
    ///
    /// # Errors
    /// `--single-file` for a target that has one file for each stage.
    pub(crate) fn new(args: &OutputArgs) -> Result<Self, Failure> {
        let mut targets: BTreeSet<Target> = args.targets.iter().copied().collect();
        if targets.is_empty() {
            targets.insert(Target::Wgsl);
            targets.extend((!args.single_file).then_some(Target::Spirv));
        }
        if let Some(target) = targets.iter().find(|target| args.single_file && !target.has_single_file()) {
            let message =
                format!("`--single-file` does not write {}, which has one file for each stage", target.name());
            return Err(Failure::usage(message).help("choose among `--target wgsl`, `msl` and `hlsl`"));
        }
        let conventions = args.conventions.conventions(args.debug_lines);
        let (optimize, left_out, flat) = (args.optimize, args.left_out, args.flat);
        let single_file = args.single_file;
        Ok(Self { targets, conventions, optimize, left_out, flat, single_file, named: true })
    }

    /// The plan for outputs whose names depend on their bytes: the reflection does not tell them.
    pub(crate) fn unnamed(self) -> Self {
        Self { named: false, ..self }
    }

    /// Whether source lines are in the outputs.
    pub(crate) fn has_lines(&self) -> bool {
        self.conventions.debug_lines
    }

    /// The names of a program's outputs, the reflection last.
    pub(crate) fn names(&self, group: &Group) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        if self.single_file {
            names.extend(self.targets.iter().map(|target| single_name(group, *target)));
        }
        for stage in Stage::ALL.into_iter().filter(|_| !self.single_file) {
            // Several files of one stage have one output, which is named after the first.
            if let Some(input) = group.inputs.iter().find(|input| input.stage == stage) {
                let file = input.file_name();
                names.extend(self.targets.iter().map(|target| format!("{file}.{}", target.extension())));
            }
        }
        names.push(format!("{}.json", group.name));
        names
    }

    /// The stages and the target of each of a program's outputs but the reflection, by their names.
    pub(crate) fn kinds(&self, group: &Group) -> BTreeMap<String, (Vec<Stage>, Target)> {
        let mut kinds: BTreeMap<String, (Vec<Stage>, Target)> = BTreeMap::new();
        for stage in Stage::ALL {
            let Some(input) = group.inputs.iter().find(|input| input.stage == stage) else { continue };
            for target in &self.targets {
                let name = match self.single_file {
                    true => single_name(group, *target),
                    false => format!("{}.{}", input.file_name(), target.extension()),
                };
                kinds.entry(name).or_insert((Vec::new(), *target)).0.push(stage);
            }
        }
        kinds
    }

    /// Two programs must not write the same file, nor one of the sources, nor one of the `accounts` of the run. `below` is where a
    /// program's outputs are in the folder.
    ///
    /// # Errors
    /// They would, in this folder.
    pub(crate) fn refuse_collisions(
        &self,
        folder: &Path,
        below: impl Fn(&Group) -> PathBuf,
        groups: &[Group],
        accounts: &[&Path],
    ) -> Result<(), Failure> {
        let mut writers: BTreeMap<PathBuf, &Group> = BTreeMap::new();
        groups
            .iter()
            .flat_map(|group| &group.inputs)
            .filter_map(|input| input.path.as_deref())
            .for_each(overwrite::note);
        for group in groups {
            for name in self.names(group) {
                let path = folder.join(below(group)).join(&name);
                overwrite::refuse(&path)?;
                if let Some(other) = writers.insert(path.clone(), group) {
                    let message = format!(
                        "the programs of {} and of {} would both write `{}`",
                        files_of(other),
                        files_of(group),
                        path.display()
                    );
                    return Err(Failure::usage(message).help(apart(group)));
                }
            }
        }
        if accounts.is_empty() {
            return Ok(());
        }
        overwrite::refuse_equal(writers.keys().map(PathBuf::as_path).chain(accounts.iter().copied()))
    }

    /// Whether the code for a target is without what reaches no output.
    fn optimizes(&self, target: Target) -> bool {
        self.optimize.applies(target, self.conventions.debug_lines)
    }

    /// Notes on what is not in the outputs.
    pub(crate) fn notes(&self, program: &Program, sources: &SourceMap) -> Vec<Diagnostic> {
        let mut notes = emit::notes(program, &self.conventions);
        if self.left_out && self.targets.iter().any(|target| self.optimizes(*target)) {
            notes.extend(optimize::notes(program, sources));
        }
        notes
    }

    /// The outputs of one program. An internal error is a diagnostic of its first text.
    pub(crate) fn emit(
        &self,
        group: &Group,
        program: &Program,
        sources: &SourceMap,
    ) -> Result<Vec<Output>, Vec<Diagnostic>> {
        self.emit_by(group, program, sources, None)
    }

    /// The same, with what is known of the stages of other programs of this plan.
    pub(crate) fn emit_by(
        &self,
        group: &Group,
        program: &Program,
        sources: &SourceMap,
        memo: Option<&Memo>,
    ) -> Result<Vec<Output>, Vec<Diagnostic>> {
        guard::guarded(|| self.emit_program(group, program, sources, memo)).unwrap_or_else(|panic| {
            let span = sources.files().next().map_or(0, |(_, file)| file.base());
            Err(vec![guard::diagnostic(&panic, Span::new(span, span))])
        })
    }

    fn emit_program(
        &self,
        group: &Group,
        program: &Program,
        sources: &SourceMap,
        memo: Option<&Memo>,
    ) -> Result<Vec<Output>, Vec<Diagnostic>> {
        let mut outputs = Vec::new();
        let mut diagnostics = Vec::new();
        let mut texts = Vec::new();
        let applies = self.targets.iter().any(|target| self.optimizes(*target));
        let optimized = match memo.filter(|_| applies) {
            Some(memo) => Cow::Owned(memo.optimized(program)),
            None => optimize::optimized(program, applies),
        };
        for target in self.targets.iter().filter(|_| self.single_file) {
            let emitted = if self.optimizes(*target) { &optimized } else { program };
            match emit::emit_single_file(emitted, *target, &self.conventions, Some(sources)) {
                Ok(emitted) => {
                    if let (Target::Wgsl, Emitted::Text(text)) = (target, &emitted) {
                        texts.push(text.clone());
                    }
                    outputs.push((single_name(group, *target), code(emitted)));
                }
                Err(errors) => diagnostics.extend(errors),
            }
        }
        for shader in program.stages.iter().filter(|_| !self.single_file) {
            let Some(input) = group.inputs.iter().find(|input| input.stage == shader.stage) else { continue };
            for target in &self.targets {
                let emitted = if self.optimizes(*target) { &optimized } else { program };
                let (stage, conventions) = (shader.stage, &self.conventions);
                let made = match memo {
                    Some(memo) => memo.code(emitted, stage, *target, conventions, sources),
                    None => emit::emit_traced(emitted, stage, *target, conventions, Some(sources))
                        .map(|traced| code(traced.emitted)),
                };
                match made {
                    Ok(made) => {
                        let name = format!("{}.{}", input.file_name(), target.extension());
                        if *target == Target::Wgsl {
                            texts.push(String::from_utf8_lossy(&made).into_owned());
                        }
                        outputs.push((name, made));
                    }
                    Err(errors) => diagnostics.extend(errors),
                }
            }
        }
        // What one of the outputs has is active.
        let all = self.targets.iter().all(|target| self.optimizes(*target));
        let mut reflection = emit::reflect(if all { &optimized } else { program }, &self.conventions);
        texts.iter().for_each(|text| reflection.name_in_wgsl(text));
        if self.single_file {
            reflection.name_single_file();
        }
        let no_targets = BTreeSet::new();
        let named = if self.named { &self.targets } else { &no_targets };
        reflection.files = files_of_stages(group, named, self.single_file);
        if !self.flat {
            reflection.compact();
        }
        let mut json = serde_json::to_vec_pretty(&reflection).expect("a reflection is always JSON");
        json.push(b'\n');
        outputs.push((format!("{}.json", group.name), json.into()));
        if diagnostics.is_empty() { Ok(outputs) } else { Err(diagnostics) }
    }
}

/// The name of the file that all stages of a program share.
fn single_name(group: &Group, target: Target) -> String {
    format!("{}.{}", group.name, target.extension())
}

/// The files of each stage for the reflection, with the outputs for these targets.
pub(crate) fn files_of_stages(
    group: &Group,
    targets: &BTreeSet<Target>,
    single_file: bool,
) -> BTreeMap<String, StageFiles> {
    let mut files: BTreeMap<String, StageFiles> = BTreeMap::new();
    for input in &group.inputs {
        let own = files.entry(input.stage.name().to_owned()).or_default();
        own.sources.push(input.file_name());
        // Several files of one stage have one output, which is named after the first.
        for target in targets {
            let name = || match single_file {
                true => single_name(group, *target),
                false => format!("{}.{}", input.file_name(), target.extension()),
            };
            own.outputs.entry(target.word().to_owned()).or_insert_with(name);
        }
    }
    files
}

/// How two programs that would write one file are kept apart. Stages are no program where others stand between them that are not read.
fn apart(group: &Group) -> &'static str {
    let path = group.inputs.first().and_then(|input| input.path.as_deref());
    let folder = path.and_then(Path::parent).unwrap_or(Path::new(""));
    if stages::is_tessellated(folder, &group.name) {
        "their program has tessellation stages, which glisten does not read, so its other stages are not linked: compile each of them \
         alone, into a folder of its own"
    } else {
        "compile them into different folders"
    }
}

fn files_of(group: &Group) -> String {
    group.inputs.iter().map(|input| format!("`{}`", input.name)).collect::<Vec<_>>().join(", ")
}
