//! `glisten test`: runs `.shader_test` files, and the functions of sources under `//! test`, on the GPU and with the CPU reference.

use crate::arguments::args::{BindingArgs, LevelArgs, ResultFormat, SourceArgs};
use crate::arguments::engine::STDIN as SHOWN_STDIN;
use crate::batch::Batch;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs::{STDIN, identity};
use crate::process::guard;
use crate::process::journal::{self, Note};
use crate::progress::Progress;
use crate::scenes::{gpu_failure, open_gpu};
use crate::search;
use crate::session::Session;
use clap::{Args, ValueEnum};
use glisten_front::compiler::{Compilation, Compiler, Options};
use glisten_front::diagnostic::Diagnostic;
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::Picture;
use glisten_verify::scene::Scene;
use glisten_verify::shader_test::{self, TestBackend, TestResult};
use glisten_verify::unit_test::{UnitTest, has_tests, tests};
use glisten_verify::verify::as_compiled;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[("glisten test tests/", "all .shader_test files of a folder")];

/// Run .shader_test files, and the functions of shaders under a comment `//! test`
#[derive(Args, Debug)]
pub(crate) struct TestArgs {
    /// Test files and shaders, folders to search for them, or `-` for standard input
    #[arg(required = true, value_name = "FILE|DIR")]
    paths: Vec<PathBuf>,
    /// The backend
    #[arg(long, value_enum, default_value_t)]
    backend: TestBackends,
    /// The form of the code that the GPU runs
    #[arg(long, value_enum, default_value_t)]
    via: crate::scenes::ViaArg,
    /// The GPU to use, by a part of its name, or `software`
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Give up on a draw after this many seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    timeout: u64,
    /// The format of the results
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum TestBackends {
    /// Vulkan through wgpu
    Gpu,
    /// The CPU reference
    Cpu,
    /// Both, one after the other
    #[default]
    Both,
}

impl TestArgs {
    /// Whether a driver draws.
    pub(crate) fn draws_by_a_driver(&self) -> bool {
        self.backend != TestBackends::Cpu
    }
}

/// The result of a test on a backend.
#[derive(Debug, Deserialize, Serialize)]
struct TestRow {
    file: String,
    backend: String,
    result: String,
    reason: Option<String>,
    /// The function, of a test in GLSL.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    test: Option<String>,
    /// The line of its comment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    /// How many calls it makes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cases: Option<usize>,
}

/// The name of the backend that a driver is.
const GPU: &str = "gpu";
/// The section that each test file has.
const TEST: &str = "[test]";
/// The extension of test files.
const EXTENSION: &str = "shader_test";
/// How deep folders are searched.
const MOST_FOLDERS: u32 = 64;

/// Runs the command.
pub(crate) fn run(args: &TestArgs, console: &Console) -> Outcome {
    let (mut files, mut unread, mut exit) = (Vec::new(), Vec::new(), Exit::Ok);
    let mut seen = BTreeSet::new();
    for path in &args.paths {
        match std::fs::metadata(path) {
            // The others are run all the same.
            Err(error) if path.as_os_str() != STDIN && args.paths.len() > 1 => {
                console.failure(&format!("cannot read `{}`: {error}", path.display()), None);
                exit = Exit::Usage;
            }
            _ => collect(path, &mut files, &mut unread, 0)?,
        }
    }
    // A file that is named twice counts once.
    files.retain(|path| seen.insert(identity(path)));
    exit = unread.into_iter().map(|failure| console.tell(failure)).fold(exit, Exit::max);
    if files.is_empty() && exit > Exit::Ok {
        return Ok(exit);
    }
    if files.is_empty() {
        return Err(Failure::usage(format!("there is no .{EXTENSION} file, and no shader with `//! test`")));
    }
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 1)?;
    let mut backends = backends(args)?;
    let progress = Progress::new(console, files.len());
    let (mut results, mut batches) = (Vec::new(), Vec::new());
    let mut known = Known::read();
    for path in &files {
        let is_stdin = path.as_os_str() == STDIN;
        let name = if is_stdin { SHOWN_STDIN.to_owned() } else { path.display().to_string() };
        progress.say(&name);
        let text =
            if is_stdin { files::read_source(&name, None).map(|text| text.to_string()) } else { text_of(&name, path) };
        let text = text.map_err(|error| Failure::usage(error.message))?;
        let is_test = has_section(&text);
        let compilation = if is_source(path) && has_tests(&text) && !(is_stdin && is_test) {
            let (rows, compilation) = units(&name, &text, session.compiler(), &mut backends, &mut known);
            results.extend(rows);
            compilation
        } else if is_source(path) && !is_test {
            // A mistyped name does not pass as a test that is skipped.
            return Err(Failure::usage(format!("`{name}` has no section `{TEST}`, and no shader with `//! test`")));
        } else {
            let compiler = Compiler::new(Options::default()).without_levels();
            for (backend, draws) in &mut backends {
                let row = known.take(&name, backend).unwrap_or_else(|| {
                    let _work = (*backend == GPU).then(|| journal::at_work(&journal::drawing(&name)));
                    let row = TestRow::new(&name, backend, &one(&name, &text, &compiler, draws.as_mut()));
                    row.keep();
                    row
                });
                results.push(row);
            }
            guard::guarded(|| shader_test::compilation(&name, &text, &compiler)).ok().flatten()
        };
        if let Some(Compilation { sources, diagnostics, .. }) = compilation {
            let mut batch = Batch { sources, diagnostics: Vec::new() };
            session.add(&mut batch, diagnostics);
            batches.push(batch);
        }
        progress.step();
    }
    drop(progress);
    let text = match args.format {
        ResultFormat::Json => serde_json::to_string_pretty(&results).expect("results are always JSON") + "\n",
        ResultFormat::Human => human(&results, !console.is_quiet()),
    };
    let exit = exit.max(session.tell(&batches.iter().collect::<Vec<_>>(), false)?);
    console.output(&text)?;
    let failed = results.iter().any(|result| result.result == "fail");
    Ok(if failed { exit.max(Exit::Content) } else { exit })
}

/// The text of a file.
fn text_of(name: &str, path: &Path) -> Result<String, files::ReadError> {
    files::read(name, path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
}

/// Whether a text is a test file.
fn has_section(text: &str) -> bool {
    text.lines().any(|line| line.trim() == TEST)
}

/// Whether a file is a shader, and not a test file.
fn is_source(path: &Path) -> bool {
    path.extension().is_none_or(|extension| extension != EXTENSION)
}

/// Runs the tests in the functions of a source.
fn units(
    name: &str,
    text: &str,
    compiler: &Compiler,
    backends: &mut [Named],
    known: &mut Known,
) -> (Vec<TestRow>, Option<Compilation>) {
    let (found, compilation) = match guard::guarded(|| tests(name, text, compiler)) {
        Ok(found) => found,
        Err(panic) => {
            let result = TestResult::Fail(format!("internal error: {panic}"));
            return (vec![TestRow::new(name, "cpu", &result)], None);
        }
    };
    let mut rows = Vec::new();
    for test in &found {
        for (backend, draws) in &mut *backends {
            let key = format!("{name}:{}", test.line);
            let row = known.take(&key, backend).unwrap_or_else(|| {
                let _work = (*backend == GPU).then(|| journal::at_work(&journal::drawing(&key)));
                let result = guard::guarded(|| match *backend {
                    GPU => test.run(Some(draws.as_mut())),
                    _ => test.run(None),
                });
                let result = result.unwrap_or_else(|panic| TestResult::Fail(format!("internal error: {panic}")));
                let row = TestRow { file: key, ..TestRow::new(name, backend, &result) };
                row.keep();
                row
            });
            rows.push(row.of(name, test));
        }
    }
    (rows, Some(compilation))
}

/// The results of processes before this one, which a driver took down.
#[derive(Default)]
struct Known {
    rows: BTreeMap<(String, String), TestRow>,
    /// The work at which they crashed, and the sentence that says so.
    crashes: BTreeMap<String, String>,
}

impl Known {
    fn read() -> Self {
        let mut known = Self::default();
        for note in journal::notes() {
            match note {
                Note::Result(row) => {
                    let row: Option<TestRow> = serde_json::from_value(row).ok();
                    known.rows.extend(row.map(|row| ((row.file.clone(), row.backend.clone()), row)));
                }
                Note::Crash { work, what } => {
                    known.crashes.insert(work, what);
                }
                Note::Driver(_) | Note::Begin(_) | Note::End | Note::Done(_) => {}
            }
        }
        known
    }

    fn take(&mut self, file: &str, backend: &str) -> Option<TestRow> {
        let crash = || {
            let what = self.crashes.get(&journal::drawing(file)).filter(|_| backend == GPU)?;
            Some(TestRow::new(file, backend, &TestResult::Fail(what.clone())))
        };
        crash().or_else(|| self.rows.remove(&(file.to_owned(), backend.to_owned())))
    }
}

impl TestRow {
    fn new(file: &str, backend: &str, found: &TestResult) -> Self {
        let (result, reason) = (found.name().to_owned(), found.reason().map(str::to_owned));
        let (file, backend) = (file.to_owned(), backend.to_owned());
        Self { file, backend, result, reason, test: None, line: None, cases: None }
    }

    /// The row of a test in the source `file`.
    fn of(self, file: &str, test: &UnitTest) -> Self {
        let (name, line, cases) = (Some(test.name.clone()), Some(test.line), Some(test.cases()));
        Self { file: file.to_owned(), test: name, line, cases, ..self }
    }

    /// Keeps the result for a process after this one.
    fn keep(&self) {
        journal::note(&Note::Result(serde_json::to_value(self).expect("a row is always JSON")));
    }
}

/// Runs a test. A panic fails it and does not affect the others.
fn one(name: &str, text: &str, compiler: &Compiler, backend: &mut dyn TestBackend) -> TestResult {
    guard::guarded(|| shader_test::run(name, text, compiler, backend))
        .unwrap_or_else(|panic| TestResult::Fail(format!("internal error: {panic}")))
}

/// Collects the files at a path: the path itself, or the files in it, in the order of their names. A folder in it that cannot be read
/// does not keep the others from being searched.
fn collect(path: &Path, found: &mut Vec<PathBuf>, unread: &mut Vec<Failure>, depth: u32) -> Result<(), Failure> {
    if path.as_os_str() == STDIN {
        found.push(path.to_owned());
        return Ok(());
    }
    let unreadable = |error: std::io::Error| Failure::usage(format!("cannot read `{}`: {error}", path.display()));
    if !std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        found.push(path.to_owned());
        return Ok(());
    }
    if depth == 0 {
        let with_tests = |path: &PathBuf| {
            let read = files::read(&path.to_string_lossy(), path);
            read.is_ok_and(|text| has_tests(&String::from_utf8_lossy(&text)))
        };
        found.extend(search::texts(path)?.into_iter().filter(with_tests));
    }
    let mut entries = std::fs::read_dir(path)
        .and_then(|entries| entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>())
        .map_err(unreadable)?;
    entries.sort();
    for entry in entries {
        // `./a.shader_test` is `a.shader_test`, as in all commands.
        let entry = entry.strip_prefix(".").map(Path::to_owned).unwrap_or(entry);
        let is_test = entry.extension().is_some_and(|extension| extension == EXTENSION) && entry.is_file();
        // A link to a parent folder would make the search endless.
        let is_folder = entry.is_dir() && !entry.is_symlink() && depth < MOST_FOLDERS;
        if is_test || is_folder {
            let failed = collect(&entry, found, unread, depth + 1).err();
            unread.extend(failed);
        }
    }
    Ok(())
}

/// A backend and its name.
type Named = (&'static str, Box<dyn TestBackend>);

fn backends(args: &TestArgs) -> Result<Vec<Named>, Failure> {
    let mut backends: Vec<Named> = Vec::new();
    if args.backend != TestBackends::Cpu {
        let gpu = open_gpu(args.adapter.as_deref()).map_err(gpu_failure)?;
        let gpu = gpu.with_timeout(Duration::from_secs(args.timeout));
        backends.push((GPU, Box::new(GpuBackend { gpu, via: args.via.into() })));
    }
    if args.backend != TestBackends::Gpu {
        backends.push(("cpu", Box::new(CpuBackend)));
    }
    Ok(backends)
}

/// The errors that say what a target or glisten lacks.
const LIMITS: [&str; 3] = ["E0001", "E0801", "E0802"];

struct GpuBackend {
    gpu: Gpu,
    via: Via,
}

impl TestBackend for GpuBackend {
    fn draw(&mut self, scene: &Scene) -> Result<Picture, TestResult> {
        // What a geometry stage emits may be more than a vertex stage passes on.
        let scene = as_compiled(scene).map_err(|found| TestResult::Skip(first(&found)))?;
        match self.gpu.render(&scene, self.via) {
            Ok(rendered) => Ok(rendered.picture),
            // What the target lacks, or what is not supported yet, is no mistake of the program.
            Err(glisten_gpu::Error::Emit(found)) if found.iter().any(|one| LIMITS.contains(&one.code.id)) => {
                Err(TestResult::Skip(first(&found)))
            }
            Err(glisten_gpu::Error::Emit(diagnostics)) => Err(TestResult::Fail(first(&diagnostics))),
            Err(error @ glisten_gpu::Error::Unsupported(_)) => Err(TestResult::Skip(error.to_string())),
            Err(error) => Err(TestResult::Fail(error.to_string())),
        }
    }
}

struct CpuBackend;

impl TestBackend for CpuBackend {
    fn draw(&mut self, scene: &Scene) -> Result<Picture, TestResult> {
        // A test states the results of 32-bit floats, for example where they underflow.
        let options = RenderOptions {
            precision: Precision::F32,
            lines: LineRule::OpenGl,
            mark_edges: false,
            ..RenderOptions::default()
        };
        glisten_reference::render(scene, &options).map_err(|diagnostics| TestResult::Fail(first(&diagnostics)))
    }
}

fn first(diagnostics: &[Diagnostic]) -> String {
    diagnostics
        .first()
        .map_or_else(|| "it cannot be drawn".to_owned(), |first| format!("{} ({})", first.message, first.code))
}

/// One line for each test that did not pass, then the numbers of all if they are asked for.
fn human(results: &[TestRow], has_summary: bool) -> String {
    let mut text = String::new();
    for result in results.iter().filter(|result| result.result != "pass") {
        let reason = result.reason.as_deref().unwrap_or_default();
        let test = result.test.as_ref().map_or_else(String::new, |test| format!(" {test}"));
        text.push_str(&format!("{} {} {}{test}: {reason}\n", result.result, result.backend, result.file));
    }
    let count = |name: &str| results.iter().filter(|result| result.result == name).count();
    if has_summary {
        text.push_str(&format!("{} passed, {} failed, {} skipped\n", count("pass"), count("fail"), count("skip")));
    }
    text
}
