//! `glisten compile --permutations FILE`: all variants of programs in one run.
//!
//! *In:* a file that names programs, their choices, and scenes. *Out:* the outputs of all variants, each distinct one once, and
//! `index.json`, which tells each variant its files.
//!
//! A variant is compiled only if it can differ from those before it: the compiler tells which macros a result depends on, and
//! variants that agree on those share it. What is left is compiled in parallel, or comes from the cache.
//!
//! *Holds:* the outputs do not depend on the order of the work, nor on the number of threads. With an error in any variant,
//! nothing is written.

mod file;
mod index;
mod parts;
mod prune;
mod scenes;
mod shared;

use crate::arguments::args::{BindingArgs, LevelArgs, ProgramArgs, SourceArgs};
use crate::batch::Batch;
use crate::cache::{CacheArgs, Kept};
use crate::console::Console;
use crate::depfile::{self, Made};
use crate::digest::Content;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs::{self, Group};
use crate::lone;
use crate::memo::Memo;
use crate::outputs::{Output, OutputArgs, OutputPlan};
use crate::overwrite;
use crate::progress::Progress;
use crate::recall::Recall;
use crate::session::{self, Session, Unit, compile_group};
use crate::trace::{self, Trace};
use crate::variants::Variant;
pub(crate) use file::PermutedProgram;
use glisten_front::compiler::{Options, Source};
use glisten_front::diagnostic::Diagnostic;
use index::{Entry, INDEX, Index};
use parts::Parts;
use shared::Shared;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The arguments of a run.
pub(crate) struct Job<'a> {
    /// The file.
    pub(crate) file: &'a Path,
    /// The output folder.
    pub(crate) folder: &'a Path,
    /// Whether to write nothing.
    pub(crate) check: bool,
    /// Whether to remove outputs that no variant has.
    pub(crate) prune: bool,
    /// The depfile to write.
    pub(crate) depfile: Option<&'a Path>,
    /// The manifest to write.
    pub(crate) manifest: Option<&'a Path>,
    /// The number of threads.
    pub(crate) jobs: usize,
    /// How to read sources, and what to write.
    pub(crate) programs: &'a ProgramArgs,
    pub(crate) outputs: &'a OutputArgs,
    pub(crate) sources: &'a SourceArgs,
    pub(crate) bindings: &'a BindingArgs,
    pub(crate) levels: &'a LevelArgs,
    pub(crate) cache: &'a CacheArgs,
}

/// The result of a variant, and of all that share it.
struct Done {
    /// Taken by the first variant that has it.
    unit: Mutex<Option<(Unit, usize)>>,
    outputs: Vec<Output>,
    /// Errors and notes about the outputs.
    diagnostics: Vec<Diagnostic>,
}

/// The texts of a program, which all variants share.
struct Texts {
    /// None if one cannot be read.
    sources: Option<Vec<Source>>,
    trace: Trace,
}

impl Texts {
    /// Reads the files of a program.
    fn of(group: &Group) -> Self {
        let read = || group.inputs.iter().map(|input| session::read(input).ok()).collect();
        let (sources, trace) = trace::recorded(read);
        Self { sources, trace }
    }
}

/// The state of a run.
struct Run<'a> {
    job: &'a Job<'a>,
    plan: OutputPlan,
    session: Session<'a>,
    recall: Recall,
    memo: Memo,
    index: Index,
    /// The results that were reported, in order.
    units: Vec<Unit>,
    made: Vec<Made>,
    variants: usize,
    shaders: usize,
}

/// Runs the command.
pub(crate) fn run(job: &Job<'_>, console: &Console) -> Outcome {
    let plan = OutputPlan::new(job.outputs)?.unnamed();
    let session = Session::new(console, job.sources, job.bindings, job.levels, job.jobs)?;
    let permutations = match file::read(job.file) {
        Ok(permutations) => permutations,
        Err(batch) => return session.tell(&[&batch], false),
    };
    let recall = Recall::new(job.cache, session.engines(), job.sources, job.bindings, &plan)?;
    let (memo, index, units, made) = (Memo::default(), Index::new(), Vec::new(), Vec::new());
    let mut run = Run { job, plan, session, recall, memo, index, units, made, variants: 0, shaders: 0 };
    for program in &permutations.programs {
        run.program(program, console)?;
    }
    let mut exit = Exit::Ok;
    for scene in &permutations.scenes {
        exit = exit.max(run.scene(scene)?);
    }
    exit = exit.max(run.session.tell_units(&run.units, false)?);
    run.write()?;
    run.recall.close(console);
    if exit == Exit::Ok {
        if !job.check {
            run.write_accounts()?;
        }
        let end = if run.variants == 1 { "" } else { "s" };
        console.remark(&format!("{} variant{end}, {} distinct", run.variants, run.shaders));
    }
    Ok(exit)
}

/// The programs of a file, with their variants.
///
/// # Errors
/// Everything that is wrong in it.
pub(crate) fn programs(file: &Path) -> Result<Vec<PermutedProgram>, Batch> {
    file::read(file).map(|permutations| permutations.programs)
}

impl Run<'_> {
    /// Compiles the variants of a program.
    fn program(&mut self, program: &PermutedProgram, console: &Console) -> Result<(), Failure> {
        let group = inputs::program(&program.files, self.job.programs, self.job.sources)?;
        let group = Group { name: program.name.clone(), ..group };
        let progress = Progress::new(console, program.variants.len());
        progress.say(&program.name);
        let lines = self.plan.has_lines();
        let shared = Shared::new(&program.names, &program.variants, lines);
        let parts = Parts::new(&program.names, &program.variants, lines);
        let texts = Texts::of(&group);
        let one = |variant: &Variant| {
            let done = shared.find(variant).unwrap_or_else(|| {
                let (asked, done) = self.variant(program, &group, variant, (&texts, &parts));
                shared.keep(variant, &asked, done)
            });
            progress.step();
            done
        };
        let results: Vec<Arc<Done>> = self.session.threads().map(program.variants.iter().collect(), one);
        drop(progress);
        let is_sound = self.report(&group, &program.variants, &results);
        self.variants += program.variants.len();
        if is_sound {
            let entries = program.variants.iter().zip(&results).map(|(variant, done)| Entry {
                defines: variant.clone(),
                draw: None,
                group: &group,
                outputs: &done.outputs,
            });
            self.shaders += self.index.add(&program.name, &self.plan, entries);
        }
        Ok(())
    }

    /// Compiles a variant. The first value is what the result depends on.
    fn variant(
        &self,
        program: &PermutedProgram,
        group: &Group,
        variant: &Variant,
        (texts, parts): (&Texts, &Parts<'_>),
    ) -> (BTreeSet<String>, Done) {
        let compiler = self.session.compiler();
        let given = compiler.options().defines.iter().filter(|(name, _)| !variant.contains_key(name)).cloned();
        let own = variant.iter().map(|(name, value)| (name.clone(), value.clone()));
        let options = Options {
            defines: given.chain(own).collect(),
            watched: program.names.iter().cloned().collect(),
            ..compiler.options().clone()
        };
        let compiler = compiler.with_options(options);
        let by = |group: Group| match &texts.sources {
            Some(sources) => {
                trace::again(&texts.trace);
                session::compile_sources(group, sources, |sources| parts.compile(&compiler, sources, variant))
            }
            None => compile_group(&compiler, group),
        };
        let (unit, dropped) = self.recall.compile_by(group.clone(), &format!("{variant:?}"), by);
        let asked = unit.asked.clone();
        let (outputs, diagnostics) = match (&unit.kept, &unit.program) {
            (Some(kept), _) => (kept.outputs.clone(), kept.notes.clone()),
            (None, Some(linked)) => match self.plan.emit_by(group, linked, &unit.batch.sources, Some(&self.memo)) {
                Ok(outputs) => {
                    let notes = self.plan.notes(linked, &unit.batch.sources);
                    self.recall.keep(&unit, &outputs, &notes);
                    (outputs, notes)
                }
                Err(errors) => (Vec::new(), errors),
            },
            (None, None) => (Vec::new(), Vec::new()),
        };
        // The linked program is large, and has done its duty.
        let kept = unit.is_program().then(Kept::default);
        let unit = Unit { program: None, fresh: None, kept, ..unit };
        (asked, Done { unit: Mutex::new(Some((unit, dropped))), outputs, diagnostics })
    }

    /// Applies levels to the diagnostics of all results. Returns whether there is no error.
    fn report(&mut self, group: &Group, variants: &[Variant], results: &[Arc<Done>]) -> bool {
        let mut is_sound = true;
        for (variant, done) in variants.iter().zip(results) {
            let taken = done.unit.lock().unwrap_or_else(PoisonError::into_inner).take();
            let Some((mut unit, dropped)) = taken else { continue };
            let note = (variants.len() > 1).then(|| format!("in the variant {}", shown(variant)));
            let noted = |one: &Diagnostic| note.iter().fold(one.clone(), |one, note| one.note(note.clone()));
            unit.batch.diagnostics = unit.batch.diagnostics.iter().map(noted).collect();
            let mut adopted = self.session.adopt(vec![(unit, dropped)]);
            for unit in &mut adopted {
                let warning = lone::warning(unit, self.session.engines());
                let added: Vec<Diagnostic> = warning.iter().chain(&done.diagnostics).map(noted).collect();
                self.session.add(&mut unit.batch, added);
                lone::refuse_what_is_no_program(unit);
                is_sound &= unit.exit() == Exit::Ok && !done.outputs.is_empty();
                self.made.push(Made {
                    program: group.name.clone(),
                    outputs: Vec::new(),
                    sources: depfile::files_read(group, &unit.batch.sources),
                });
            }
            self.units.extend(adopted);
        }
        is_sound
    }

    /// Writes the outputs, then the index. A file that is as it should be is left alone.
    fn write(&self) -> Result<(), Failure> {
        let is_whole = self.units.iter().all(|unit| unit.exit() == Exit::Ok);
        if self.job.check || !is_whole {
            return Ok(());
        }
        let folder = self.job.folder;
        let own = self.index.files().keys().map(|name| folder.join(name)).chain([folder.join(INDEX)]);
        let accounts = self.job.depfile.iter().chain(&self.job.manifest).map(|path| path.to_path_buf());
        let all: Vec<PathBuf> = own.chain(accounts).collect();
        overwrite::refuse_equal(all.iter().map(PathBuf::as_path))?;
        files::make_folder(folder)?;
        let parts = self.index.files().keys().filter_map(|name| name.split('/').next());
        let folders: BTreeSet<PathBuf> = parts.map(|program| folder.join(program)).collect();
        folders.iter().try_for_each(|folder| files::make_folder(folder))?;
        let write = |(name, bytes): (&String, &Content)| {
            let path = folder.join(name);
            let is_there = fs::read(&path).is_ok_and(|found| *found == **bytes);
            if is_there { Ok(()) } else { files::write(&path, bytes) }
        };
        let written = self.session.threads().map(self.index.files().iter().collect(), write);
        written.into_iter().collect::<Result<(), _>>()?;
        files::write(&folder.join(INDEX), self.index.json().as_bytes())?;
        if self.job.prune {
            prune::prune(folder, self.index.files())?;
        }
        Ok(())
    }

    /// Writes the depfile and the manifest.
    fn write_accounts(&self) -> Result<(), Failure> {
        let permutations = files::shown(self.job.file);
        let sources: Vec<String> = self.made.iter().flat_map(|made| made.sources.clone()).collect();
        let all: Vec<String> = [permutations].into_iter().chain(sources).collect();
        if let Some(path) = self.job.depfile {
            // The other outputs are not known to a build system before they are written.
            let index = files::shown(&self.job.folder.join(INDEX));
            let rule = depfile::make_rule([index], all.clone());
            files::write(path, &rule)?;
        }
        if let Some(path) = self.job.manifest {
            let path_of = |name: &str| files::shown(&self.job.folder.join(name));
            let made: Vec<Made> = self.programs_made(&all, path_of);
            files::write(path, depfile::manifest(&made).as_bytes())?;
        }
        Ok(())
    }

    /// For each program its files, and all that its variants read.
    fn programs_made(&self, all: &[String], path_of: impl Fn(&str) -> String) -> Vec<Made> {
        let mut programs: Vec<Made> = Vec::new();
        for (name, content) in self.index.files() {
            let program = name.split('/').next().unwrap_or_default();
            if programs.last().is_none_or(|last| last.program != program) {
                let own = self.made.iter().filter(|made| made.program == program);
                let sources = all.iter().take(1).cloned().chain(own.flat_map(|made| made.sources.clone())).collect();
                programs.push(Made { program: program.to_owned(), outputs: Vec::new(), sources });
            }
            if let Some(last) = programs.last_mut() {
                last.outputs.push((path_of(name), content.clone()));
            }
        }
        programs
    }
}

/// A variant for people.
fn shown(variant: &Variant) -> String {
    let words: Vec<String> = variant
        .iter()
        .map(|(name, value)| if value == "1" { name.clone() } else { format!("{name}={value}") })
        .collect();
    if words.is_empty() { "without any of the macros".to_owned() } else { format!("`{}`", words.join(" ")) }
}
