//! [`Session`]: what all commands that read shaders do: read, compile in parallel, apply levels, report.
//!
//! *Holds:* results are in the order of the groups, whatever `-j` is.

use crate::arguments::args::{BindingArgs, DiagnosticFormat, LevelArgs, SourceArgs};
use crate::arguments::config::{Configs, Settings};
use crate::arguments::engine::Engines;
use crate::batch::Batch;
use crate::cache::Kept;
use crate::console::Console;
use crate::digest::Digest;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::inputs::{Group, Input};
use crate::not_checked;
use crate::process::guard;
use crate::progress::Progress;
use crate::strings;
use crate::threads::Threads;
use crate::told::Told;
use crate::trace::Trace;
use glisten_front::compiler::{Compilation, Compiler, Source};
use glisten_front::diagnostic::codes::link::{BINDING_WITHOUT_VARIABLE, LONE_WITHOUT_DEFINITION, UNDEFINED_FUNCTION};
use glisten_front::diagnostic::codes::preprocess::INCLUDE_WITHOUT_EXTENSION;
use glisten_front::diagnostic::codes::scenes;
use glisten_front::diagnostic::write::{self, Finding, Scope};
use glisten_front::diagnostic::{Applicability, Code, Diagnostic, Level, Severity};
use glisten_front::hir::Stage;
use glisten_front::link::COLOR_NUMBER;
use glisten_front::link::Program;
use glisten_front::source::{FileId, SourceMap, Span};
use glisten_sources::engines;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The result for a group of files.
#[derive(Debug)]
pub(crate) struct Unit {
    /// The files.
    pub(crate) group: Group,
    /// Files that could not be read, one batch each.
    pub(crate) unread: Vec<Batch>,
    /// The diagnostics of the compiler, and those that commands add.
    pub(crate) batch: Batch,
    /// The linked program, if there are no errors and it was compiled.
    pub(crate) program: Option<Program>,
    /// The outputs, if they come from a cache.
    pub(crate) kept: Option<Kept>,
    /// The facts that a cache needs to keep the result.
    pub(crate) fresh: Option<Fresh>,
    /// The watched macros that the result depends on.
    pub(crate) asked: BTreeSet<String>,
    /// The files of each input, its own first; none for one that could not be read.
    pub(crate) read: Vec<Vec<FileId>>,
}

/// A result that a cache does not have yet.
#[derive(Debug)]
pub(crate) struct Fresh {
    /// The key of its options.
    pub(crate) key: Digest,
    /// All that was read.
    pub(crate) trace: Trace,
    /// The diagnostics before any level.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// How many diagnostics past the limit there were.
    pub(crate) dropped: usize,
}

impl Unit {
    /// The unit of a group before anything is known.
    pub(crate) fn new(group: Group) -> Self {
        let (unread, batch, asked) = (Vec::new(), Batch::default(), BTreeSet::new());
        Self { group, unread, batch, program: None, kept: None, fresh: None, asked, read: Vec::new() }
    }

    /// Whether there is a program, compiled or from a cache.
    pub(crate) fn is_program(&self) -> bool {
        self.program.is_some() || self.kept.is_some()
    }

    /// All of its diagnostics: of files that could not be read, and of the compiler.
    pub(crate) fn batches(&self) -> impl Iterator<Item = &Batch> {
        self.unread.iter().chain([&self.batch])
    }

    /// The exit code of the diagnostics.
    pub(crate) fn exit(&self) -> Exit {
        self.batches().map(|batch| Exit::of(&batch.diagnostics)).max().unwrap_or_default()
    }

    /// The program, unless it has any error (which may be a denied warning).
    pub(crate) fn sound_program(&self) -> Option<&Program> {
        self.program.as_ref().filter(|_| self.exit() == Exit::Ok)
    }
}

/// The state of a command that reads shaders.
pub(crate) struct Session<'a> {
    console: &'a Console,
    compiler: Compiler,
    engines: Engines,
    format: DiagnosticFormat,
    configs: Configs,
    threads: Threads,
    dropped: usize,
    /// The files of the run, for a command that tells them.
    scope: Option<Scope>,
    /// Whether the command has `--fix`.
    has_fixes: bool,
}

impl<'a> Session<'a> {
    /// A session with `jobs` threads (0: one per core).
    pub(crate) fn new(
        console: &'a Console,
        sources: &SourceArgs,
        bindings: &BindingArgs,
        levels: &LevelArgs,
        jobs: usize,
    ) -> Result<Self, Failure> {
        let engines = Engines::new(sources)?;
        console.set_format(levels.diagnostics);
        Ok(Self {
            console,
            compiler: compiler(sources, bindings, &engines),
            engines,
            format: levels.diagnostics,
            configs: Configs::new(levels.levels()?),
            threads: Threads::new(jobs),
            dropped: 0,
            scope: None,
            has_fixes: false,
        })
    }

    /// The levels of a file.
    #[cfg(any(feature = "lsp", feature = "play"))]
    pub(crate) fn levels_of(&mut self, name: &str) -> glisten_front::diagnostic::Levels {
        self.configs.levels(name).clone()
    }

    /// The settings that `lint` obeys for a file.
    pub(crate) fn settings_of(&mut self, name: &str) -> Arc<Settings> {
        Arc::clone(self.configs.settings(name))
    }

    /// The errors in configurations so far.
    #[cfg(feature = "lsp")]
    pub(crate) fn configuration_errors(&self) -> &[Batch] {
        &self.configs.errors
    }

    /// This session with other engines, whose compiler is made again.
    #[cfg(feature = "lsp")]
    #[must_use]
    pub(crate) fn with_engines(self, engines: Engines, sources: &SourceArgs, bindings: &BindingArgs) -> Self {
        Self { compiler: compiler(sources, bindings, &engines), engines, ..self }
    }

    /// The compiler with the options of the command line.
    pub(crate) fn compiler(&self) -> &Compiler {
        &self.compiler
    }

    /// How sources are completed.
    pub(crate) fn engines(&self) -> &Engines {
        &self.engines
    }

    /// The threads, as many as `-j` says.
    pub(crate) fn threads(&self) -> &Threads {
        &self.threads
    }

    /// Sets the format of diagnostics.
    pub(crate) fn set_format(&mut self, format: DiagnosticFormat) {
        self.format = format;
    }

    /// Has people told how many findings `--fix` would change, which the command has.
    pub(crate) fn offer_fixes(&mut self) {
        self.has_fixes = true;
    }

    /// Sets what the run looks at, which is told with the diagnostics.
    pub(crate) fn set_scope(&mut self, scope: Scope) {
        self.scope = Some(scope);
    }

    /// The level of a code in a file.
    pub(crate) fn level(&mut self, name: &str, code: &Code) -> Option<Level> {
        self.configs.levels(name).get(code)
    }

    /// Whether diagnostics are for people, so that they may be told bit by bit and other lines may stand between them.
    pub(crate) fn is_human(&self) -> bool {
        self.format == DiagnosticFormat::Human
    }

    /// The exit code of the diagnostics of a batch and of the configurations.
    pub(crate) fn exit(&self, batch: &Batch) -> Exit {
        let batches = self.configs.errors.iter().chain([batch]);
        batches.map(|batch| Exit::of(&batch.diagnostics)).max().unwrap_or_default()
    }

    /// Compiles every group and applies the levels.
    pub(crate) fn compile(&mut self, groups: Vec<Group>) -> Vec<Unit> {
        self.dropped = 0;
        let engines = self.engines.clone();
        self.compile_by(groups, |compiler, group| compile_anywhere(compiler, &engines, group))
    }

    /// Compiles every group by `by`, which also counts the diagnostics past the compiler's limit, and applies the levels.
    pub(crate) fn compile_by(
        &mut self,
        groups: Vec<Group>,
        by: impl Fn(&Compiler, Group) -> (Unit, usize) + Sync,
    ) -> Vec<Unit> {
        let progress = Progress::new(self.console, groups.len());
        let compiler = &self.compiler;
        let work = |group: Group| {
            progress.say(&group.name);
            let unit = by(compiler, group);
            progress.step();
            unit
        };
        let units: Vec<(Unit, usize)> = self.threads.map(groups, work);
        drop(progress);
        self.adopt(units)
    }

    /// Applies the levels to units that were compiled, each with the number of its diagnostics past the compiler's limit.
    pub(crate) fn adopt(&mut self, mut units: Vec<(Unit, usize)>) -> Vec<Unit> {
        keep_bindings_that_fit_nowhere(&mut units);
        for (unit, dropped) in &mut units {
            // Errors in a configuration are reported even if there are no diagnostics that it applies to.
            for input in &unit.group.inputs {
                self.configs.levels(&input.name);
            }
            let mut found = std::mem::take(&mut unit.batch.diagnostics);
            if unit.group.is_guess {
                allow_more_shaders(&mut found);
            }
            self.add(&mut unit.batch, found);
            self.dropped += *dropped;
        }
        units.into_iter().map(|(unit, _)| unit).collect()
    }

    /// Reads the configuration for a file, so that its errors are reported even if the file has none.
    pub(crate) fn read_configuration(&mut self, name: &str) {
        self.configs.levels(name);
    }

    /// Adds diagnostics to a batch by the levels of the files that they are in, and sorts the batch by position in the
    /// text. What a scene lacks comes last, since another diagnostic may be the reason for it.
    pub(crate) fn add(&mut self, batch: &mut Batch, found: impl IntoIterator<Item = Diagnostic>) {
        let sources = &batch.sources;
        for mut diagnostic in found {
            let file = sources.file_of(sources.call_site(diagnostic.primary.span));
            let name = file.or(sources.files().next().map(|(id, _)| id)).map_or("", |id| sources.file(id).name());
            // The texts of an engine serve all its sources: what one does not use is no finding.
            if name.starts_with(engines::SHOWN) && !diagnostic.is_error() {
                continue;
            }
            let is_include = *diagnostic.code == INCLUDE_WITHOUT_EXTENSION && !diagnostic.is_error();
            if is_include
                && (batch.diagnostics.iter().any(|told| told.code == diagnostic.code) || self.engines.has_folders(name))
            {
                continue;
            }
            if self.configs.levels(name).apply(sources, &mut diagnostic) {
                batch.diagnostics.push(diagnostic);
            }
        }
        batch
            .diagnostics
            .sort_by_key(|diagnostic| (is_told_last(diagnostic), sources.call_site(diagnostic.primary.span).start));
    }

    /// The diagnostics of the configurations and of a batch as values, each once.
    #[cfg(feature = "play")]
    pub(crate) fn findings(&self, batch: &Batch) -> Vec<Finding> {
        let mut told = Told::default();
        for batch in self.configs.errors.iter().chain([batch]) {
            told.add(batch);
        }
        told.findings
    }

    /// Reports all diagnostics, to standard output if `to_output` (as `lint` does), otherwise to standard error. Each
    /// is reported once, though several programs may share a file. Returns the exit code.
    pub(crate) fn tell(&self, batches: &[&Batch], to_output: bool) -> Result<Exit, Failure> {
        let all: Vec<&Batch> = self.configs.errors.iter().chain(batches.iter().copied()).collect();
        let scope = self.scope.as_ref();
        if to_output || self.is_human() || !self.console.document_has(&all, scope) {
            self.write(&all, to_output)?;
        }
        let denied = scope.is_some_and(|scope| scope.not_checked.iter().any(|one| one.is_denied));
        let exit = if denied { Exit::Content } else { Exit::Ok };
        Ok(all.iter().map(|batch| Exit::of(&batch.diagnostics)).max().unwrap_or_default().max(exit))
    }

    /// Writes diagnostics, each once.
    fn write(&self, batches: &[&Batch], to_output: bool) -> Result<(), Failure> {
        let color = if to_output { self.console.colors_output() } else { self.console.colors_messages() };
        let mut told = Told::default();
        let mut human = String::new();
        for batch in batches {
            let fresh = told.add(batch);
            if self.is_human() {
                human.push_str(&write::human(&batch.sources, fresh, color));
            }
        }
        let text = told.text(self.format, self.scope.as_ref()).unwrap_or(human);
        if to_output {
            self.console.output(&text)?;
        } else {
            self.console.message(&text);
        }
        if self.is_human() {
            self.remark(&told.findings);
        }
        Ok(())
    }

    /// Tells people what was not checked, and how much was found.
    fn remark(&self, findings: &[Finding]) {
        let scope = self.scope.as_ref();
        if let Some(scope) = scope.filter(|scope| !scope.not_checked.is_empty()) {
            self.console.message(&not_checked::told(scope, self.console.colors_messages()));
        }
        let clean = || scope.filter(|scope| scope.files > 0).map(|scope| format!("{}: nothing found", counted(scope)));
        let Some(summary) = summary(findings, self.dropped).or_else(clean) else { return };
        self.console.remark(&summary);
        if let Some(offer) = scope.filter(|_| self.has_fixes).and_then(|_| fixable(findings)) {
            self.console.remark(&offer);
        }
        if let Some(error) = findings.iter().find(|finding| finding.severity == Severity::Error) {
            self.console.remark(&format!("`glisten explain {}` explains the first error", error.code.id));
        }
    }

    /// Reports the diagnostics of these units; see [`Self::tell`].
    pub(crate) fn tell_units(&self, units: &[Unit], to_output: bool) -> Result<Exit, Failure> {
        let batches: Vec<&Batch> = units.iter().flat_map(Unit::batches).collect();
        self.tell(&batches, to_output)
    }
}

/// Turns the errors about functions that no shader of a program defines into warnings: names of files say which shaders belong
/// together, and not that there are no more of them. OpenGL links several shaders of a stage (GLSL 1.50 §6.1).
pub(crate) fn allow_more_shaders(found: &mut [Diagnostic]) {
    for diagnostic in found.iter_mut().filter(|found| *found.code == UNDEFINED_FUNCTION) {
        diagnostic.code = &LONE_WITHOUT_DEFINITION;
        diagnostic.severity = Severity::Warning;
    }
}

/// Drops warnings about bound names that one of the programs has: the bindings of a call are for all of them. What no
/// program has is told once.
fn keep_bindings_that_fit_nowhere(units: &mut [(Unit, usize)]) {
    let is_one = |found: &Diagnostic| found.code.id == BINDING_WITHOUT_VARIABLE.id;
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for found in units.iter().flat_map(|(unit, _)| &unit.batch.diagnostics).filter(|found| is_one(found)) {
        *counts.entry(found.message.clone()).or_default() += 1;
    }
    if counts.is_empty() {
        return;
    }
    // Units that could have the name are those with its stage, which the message does not name.
    let with_stage = |stage: Stage| {
        units.iter().filter(|(unit, _)| unit.group.inputs.iter().any(|input| input.stage == stage)).count()
    };
    let of_output = format!("a {COLOR_NUMBER} ");
    let (vertex, fragment) = (with_stage(Stage::Vertex), with_stage(Stage::Fragment));
    for (unit, _) in units {
        unit.batch.diagnostics.retain(|found| {
            // The first one stays, if it is one of as many as there are programs with the stage.
            let whole = if found.message.starts_with(&of_output) { fragment } else { vertex };
            let count = counts.get_mut(&found.message).filter(|_| is_one(found));
            count.is_none_or(|count| std::mem::replace(count, 0) == whole)
        });
    }
}

/// Whether the diagnostic is about something that is not there.
fn is_told_last(diagnostic: &Diagnostic) -> bool {
    static LAST: &[&Code] = &[
        &scenes::SCENE_MISSING_ATTRIBUTE,
        &scenes::SCENE_UNSET_ATTRIBUTE,
        &scenes::SCENE_UNSET_UNIFORM,
        &scenes::SCENE_UNSET_TEXTURE,
        &scenes::NOTHING_COVERED,
        &scenes::NAN_IN_PNG,
    ];
    LAST.iter().any(|code| code.id == diagnostic.code.id)
}

/// The compiler of the command line. It reports everything: the session applies the levels of each file.
pub(crate) fn compiler(sources: &SourceArgs, bindings: &BindingArgs, engines: &Engines) -> Compiler {
    let compiler = Compiler::new(sources.options(bindings)).with_includes(engines.includes());
    compiler.with_preparation(engines.clone()).without_levels()
}

/// How many files and programs a run looked at.
fn counted(scope: &Scope) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    match scope.programs {
        0 => count(scope.files, "file"),
        n_programs => format!("{}, {}", count(scope.files, "file"), count(n_programs, "program")),
    }
}

/// How many findings have a fix.
fn fixable(findings: &[Finding]) -> Option<String> {
    let has = |finding: &&Finding, kind| finding.fixes.iter().any(|fix| fix.applicability == kind);
    let safe = findings.iter().filter(|finding| has(finding, Applicability::Safe)).count();
    let other = |finding: &&Finding| has(finding, Applicability::Unsafe) && !has(finding, Applicability::Safe);
    match (safe, findings.iter().filter(other).count()) {
        (0, 0) => None,
        (0, guessed) => Some(format!("`--unsafe-fixes` changes the text for {guessed} of them")),
        (safe, 0) => Some(format!("`--fix` changes the text for {safe} of them")),
        (safe, guessed) => {
            Some(format!("`--fix` changes the text for {safe} of them, `--unsafe-fixes` for {guessed} more"))
        }
    }
}

fn summary(findings: &[Finding], dropped: usize) -> Option<String> {
    let count = |severity| findings.iter().filter(|finding| finding.severity == severity).count();
    let parts =
        [(count(Severity::Error), "error"), (count(Severity::Warning), "warning"), (count(Severity::Note), "note")];
    let mut parts: Vec<String> = parts
        .iter()
        .filter(|(n, _)| *n > 0)
        .map(|(n, what)| format!("{n} {what}{}", if *n == 1 { "" } else { "s" }))
        .collect();
    if dropped > 0 {
        parts.push(format!("{dropped} more not shown"));
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Reads and compiles a group. The second value counts diagnostics past the compiler's limit.
pub(crate) fn compile_group(compiler: &Compiler, group: Group) -> (Unit, usize) {
    let (unit, dropped, ()) = compile_group_by(group, |sources| (compiler.compile(sources), ()));
    (unit, dropped)
}

/// The same by `work`, which tells something besides.
pub(crate) fn compile_group_by<T: Default>(
    group: Group,
    work: impl FnOnce(&[Source]) -> (Compilation, T),
) -> (Unit, usize, T) {
    let mut unit = Unit::new(group);
    let mut sources = Vec::new();
    let mut is_read = Vec::new();
    for input in &unit.group.inputs {
        let source = read(input);
        is_read.push(source.is_ok());
        match source {
            Ok(source) => sources.push(source),
            Err(batch) => unit.unread.push(batch),
        }
    }
    if sources.is_empty() {
        return (unit, 0, T::default());
    }
    compile_into(unit, &sources, is_read, work)
}

/// Compiles a group whose sources were read before, one for each input.
pub(crate) fn compile_sources(
    group: Group,
    sources: &[Source],
    work: impl FnOnce(&[Source]) -> Compilation,
) -> (Unit, usize) {
    let is_read = vec![true; sources.len()];
    let (unit, dropped, ()) = compile_into(Unit::new(group), sources, is_read, |sources| (work(sources), ()));
    (unit, dropped)
}

/// Fills a unit. `is_read` says for each input whether it is among the sources.
fn compile_into<T: Default>(
    mut unit: Unit,
    sources: &[Source],
    is_read: Vec<bool>,
    work: impl FnOnce(&[Source]) -> (Compilation, T),
) -> (Unit, usize, T) {
    let compiled = guard::guarded(|| work(sources));
    match compiled {
        Ok((mut compilation, told)) => {
            strings::show_files(&unit.group, &mut compilation.sources, text_of);
            let dropped = compilation.diagnostics.dropped();
            let diagnostics = compilation.diagnostics.into_iter().collect();
            let program = compilation.program.map(|program| Program { name: unit.group.name.clone(), ..program });
            unit.program = program.filter(|_| unit.unread.is_empty());
            unit.batch = Batch { sources: compilation.sources, diagnostics };
            unit.asked = compilation.asked;
            let mut read = compilation.read.into_iter();
            let files_of = |is_read: bool| if is_read { read.next().unwrap_or_default() } else { Vec::new() };
            unit.read = is_read.into_iter().map(files_of).collect();
            (unit, dropped, told)
        }
        Err(panic) => {
            unit.batch = internal(sources, &panic);
            (unit, 0, T::default())
        }
    }
}

/// The text of an input's file.
fn text_of(input: &Input) -> Option<Arc<str>> {
    files::read_source(&input.name, input.path.as_deref()).ok()
}

/// Reads and compiles a group, whether its shaders are files or in the strings of one.
pub(crate) fn compile_anywhere(by: &Compiler, engines: &Engines, group: Group) -> (Unit, usize) {
    let text = group.inputs.first().filter(|input| strings::is_in_string(input)).and_then(text_of);
    let compiler = text.and_then(|text| strings::compiler(by, engines, &group, &text));
    compile_group(compiler.as_ref().unwrap_or(by), group)
}

/// A batch that reports an internal error in the compilation of these sources.
fn internal(sources: &[Source], panic: &str) -> Batch {
    let mut map = SourceMap::default();
    let mut span = Span::default();
    for source in sources.iter().rev() {
        if let Some(id) = map.add(source.name.clone(), source.text.clone()) {
            span = Span::new(map.file(id).base(), map.file(id).base());
        }
    }
    Batch { sources: map, diagnostics: vec![guard::diagnostic(panic, span)] }
}

pub(crate) fn read(input: &Input) -> Result<Source, Batch> {
    match files::read_source(&input.name, input.path.as_deref()) {
        Ok(text) => {
            let text = input.part.as_ref().map_or(text.clone(), |part| part.text(&text, input.stage));
            Ok(Source { name: input.name.clone(), text, stage: input.stage })
        }
        Err(error) => {
            let mut sources = SourceMap::default();
            let diagnostics = vec![error.diagnostic(&mut sources, &input.name)];
            Err(Batch { sources, diagnostics })
        }
    }
}
