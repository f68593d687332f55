//! `glisten report`: error against work and run time of the variants of a scene's shading, as JSON and as a page.
//!
//! *Holds:* Ctrl-C leaves what is done as a report that says that it is not complete; if nothing is done, it says so.

mod checks;
use crate::arguments::args::WithContractArgs;
use crate::batch::Batch;
use crate::commands::examples::Examples;
use crate::commands::report::checks::CheckArgs;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::{self, SceneFiles};
use crate::made::made;
use crate::process::interrupt::Interrupt;
use crate::process::journal::{self, AtWork};
use crate::process::machine::machine;
use crate::process::watchdog::{self, Watchdog};
use crate::progress::Progress;
use crate::scenes::{DrawError, SceneArgs, ViaArg};
use crate::session::Session;
use clap::builder::ArgPredicate;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::SourceMap;
use glisten_report::{Error, LIBRARY_SCENE, LibraryFiles, Limits, Options, Report, TIMING, Watcher, Ways, Weights};
use glisten_verify::scene::{FileSource, is_model_file};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten report scene.toml -o out", "error against work and run time, as a page and a table"),
    ("glisten report scene.toml -o out --ways auto", "with variants that are found automatically"),
    ("glisten report scene.toml -o out --compare old.json", "in CI: what got worse"),
    ("glisten report scene.toml -o out --budget rmse=1e-3", "the cheapest variant that is close enough"),
];

/// Measure variants of a scene's shading: error against work and run time
///
/// Drawing takes seconds, timing up to half a minute more: `--seconds` sets the limit. Ctrl-C ends it early, with a report on what had
/// finished.
#[derive(Args, Debug)]
#[command(mut_arg("scene", |scene| {
    let library = ArgPredicate::Equals("true".into());
    scene.required(false).required_unless_present("library").default_value_if("library", library, LIBRARY_SCENE)
}))]
pub(crate) struct ReportArgs {
    /// Compare the models of the library in one scene instead, per fragment and per vertex
    #[arg(long, conflicts_with = "scene")]
    library: bool,
    /// The folder for report.json and report.html
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The form of the code that the GPU runs
    #[arg(long, value_enum, default_value_t)]
    via: ViaArg,
    /// The variants to compare
    #[arg(long, value_enum, default_value_t)]
    ways: WaysArg,
    /// Add each variant once more, specialized to what the picture needs
    #[arg(long)]
    specialize: bool,
    #[command(flatten)]
    contract: WithContractArgs,
    /// The weights of operations: `operations` (the default), `llvmpipe`, `gpu`, or a file of your own
    #[arg(long, value_name = "NAME|FILE")]
    weights: Option<String>,
    /// Time all variants at most this often, and 6 times at least (default: as the scene says, or 100)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: Option<u32>,
    /// Time them for at most this many seconds, after all are drawn (default 30)
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    seconds: Option<f64>,
    #[command(flatten)]
    checks: CheckArgs,
    #[command(flatten)]
    scene: SceneArgs,
}

/// Which variants to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum WaysArg {
    /// Those that the scene declares.
    #[default]
    #[value(help = "Those of the scene's [report] table, or the scene alone")]
    Declared,
    /// Those that are found by themselves as well
    Auto,
}

impl From<WaysArg> for Ways {
    fn from(ways: WaysArg) -> Self {
        match ways {
            WaysArg::Declared => Self::Declared,
            WaysArg::Auto => Self::Auto,
        }
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=1e6).contains(&seconds) => Ok(seconds),
        _ => Err(format!("`{text}` is not a number of seconds")),
    }
}

/// Shows the steps of a report as progress, and ends those that take too long.
struct Steps {
    progress: Progress,
    begun: bool,
    interrupt: Interrupt,
    scene: String,
    work: Option<AtWork>,
    watchdog: Watchdog,
    started: Instant,
    limit: Duration,
    /// Whether the time was up before all was drawn.
    is_late: Cell<bool>,
    /// Whether all is drawn: `--seconds` ends what is left.
    is_timing: bool,
}

impl Watcher for Steps {
    fn steps(&mut self, count: usize) {
        self.progress.extend_to(count);
    }

    fn step(&mut self, what: &str) {
        self.watchdog.again();
        self.is_timing |= what.starts_with(TIMING);
        if self.begun {
            self.progress.step();
        }
        self.begun = true;
        self.progress.say(what);
        // The earlier step ends before the next one begins.
        self.work = None;
        self.work = Some(journal::at_work(&format!("measuring `{}`: {what}", self.scene)));
    }

    fn is_stopped(&self) -> bool {
        let is_late = !self.is_timing && self.started.elapsed() >= self.limit;
        self.is_late.set(self.is_late.get() || is_late);
        self.is_late.get() || self.interrupt.is_pressed()
    }
}

/// The title of a report on the library.
const LIBRARY_TITLE: &str = "Lighting models of the library";

/// Runs the command.
pub(crate) fn run(args: &ReportArgs, console: &Console) -> Outcome {
    let interrupt = Interrupt::watch();
    if is_model_file(&args.scene.scene) {
        let failure = Failure::usage(format!("`{}` is a model, and a report is about a scene", args.scene.scene));
        return Err(failure.help("`glisten new-scene MODEL -o SCENE.toml` writes one"));
    }
    let checks = args.checks.read()?;
    let weights = weights(args.weights.as_deref())?;
    let session = args.scene.session(console)?;
    // The library's scene is no file, and there is nothing to tell about it.
    let read = match (!args.library).then(|| args.scene.read(console)).transpose()? {
        Some(Err(exit)) => return Ok(exit),
        read => read.and_then(Result::ok),
    };
    let gpu = match args.scene.gpu() {
        Ok(gpu) => gpu,
        Err(error) => return told(session, SourceMap::default(), error),
    };
    files::make_folder(&args.output)?;
    let options = Options {
        via: args.via.into(),
        specialized: args.specialize.then(|| args.contract.contract()),
        ways: args.ways.into(),
        weights,
        rounds: args.rounds,
        time: args.seconds.map(Duration::from_secs_f64),
        machine: machine(),
    };
    let seconds = args.seconds.unwrap_or_else(|| Limits::default().time.as_secs_f64());
    console.remark(&format!(
        "drawing, then timing for at most {seconds} s (--seconds; Ctrl-C ends it early with a report)"
    ));
    let mut steps = Steps {
        progress: Progress::new(console, 1).with_estimate(),
        begun: false,
        interrupt: interrupt.clone(),
        scene: args.scene.scene.clone(),
        work: None,
        watchdog: args.scene.watchdog(console),
        started: Instant::now(),
        limit: args.scene.long_limit(),
        is_late: Cell::new(false),
        is_timing: false,
    };
    let files: &dyn FileSource = if args.library { &LibraryFiles } else { &SceneFiles };
    let result = glisten_report::run(&args.scene.scene, files, session.compiler(), &gpu, &options, &mut steps);
    let is_late = steps.is_late.get();
    drop(steps);
    let report = match result {
        Ok(report) => Report { title: args.library.then(|| LIBRARY_TITLE.to_owned()), ..report },
        Err(Error::Stopped) if is_late => {
            let (message, help) = watchdog::sentence(args.scene.long_limit());
            return Err(Failure::new(Exit::Content, message).help(help));
        }
        Err(error) => return failed(session, error, console),
    };
    write(args, console, &report)?;
    let is_empty = !report.ways.iter().any(|way| way.picture.covered.contains(&true));
    let exit = match read.filter(|read| is_empty && !read.scene.draws.is_empty()) {
        Some(read) => {
            let nothing = vec![read.nothing_covered()];
            read.finish(nothing)?
        }
        None => Exit::Ok,
    };
    if interrupt.is_pressed() {
        console.remark("interrupted; the report covers what had finished");
        return Ok(Exit::Interrupted);
    }
    if is_late {
        let (message, help) = watchdog::sentence(args.scene.long_limit());
        let message = format!("{message}; the report covers what had finished");
        return Err(Failure::new(Exit::Content, message).help(help));
    }
    Ok(checks.apply(&report, &args.output, console)?.max(exit))
}

/// The weights of that name, or in a file of that name.
fn weights(name: Option<&str>) -> Result<Weights, Failure> {
    let Some(name) = name else { return Ok(Weights::default()) };
    if let Some(weights) = Weights::named(name) {
        return Ok(weights);
    }
    let text = files::read(name, Path::new(name)).map_err(|error| {
        let names = Weights::embedded().join("`, `");
        let help = error.help.unwrap_or_else(|| format!("weights that need no file are `{names}`"));
        Failure::usage(error.message).help(help)
    })?;
    let parsed = Weights::parse(&String::from_utf8_lossy(&text));
    parsed.map_err(|error| Failure::new(Exit::Content, format!("the weights in `{name}` cannot be read: {error}")))
}

/// Reports why there is no report.
fn failed(session: Session<'_>, error: Error, console: &Console) -> Outcome {
    match error {
        Error::Scene { sources, diagnostics, io_error } => {
            // All else was told when the scene was read.
            let errors = diagnostics.into_iter().filter(Diagnostic::is_error).collect();
            let exit = told(session, *sources, DrawError::Diagnostics(errors))?;
            Ok(if io_error { exit.max(Exit::Usage) } else { exit })
        }
        Error::Reference { way, diagnostics } => {
            console.remark(&format!("the reference cannot draw `{way}`"));
            told(session, SourceMap::default(), DrawError::Diagnostics(diagnostics))
        }
        Error::Gpu { way, error } => {
            console.remark(&format!("the GPU cannot draw `{way}`"));
            told(session, SourceMap::default(), error.into())
        }
        Error::Stopped => {
            console.remark("interrupted before a variant was drawn: no report was written");
            Ok(Exit::Interrupted)
        }
    }
}

fn told(mut session: Session<'_>, sources: SourceMap, error: DrawError) -> Outcome {
    match error {
        DrawError::Failure(failure) => Err(failure),
        DrawError::Diagnostics(diagnostics) => {
            let mut batch = Batch { sources, diagnostics: Vec::new() };
            session.add(&mut batch, diagnostics);
            Ok(session.tell(&[&batch], false)?.max(Exit::Content))
        }
    }
}

fn write(args: &ReportArgs, console: &Console, report: &Report) -> Result<(), Failure> {
    let html = report.html(&made()).map_err(|error| Failure::new(Exit::Content, format!("internal error: {error}")))?;
    // It may be the one to compare with.
    files::replace(&args.output.join("report.json"), report.json().as_bytes())?;
    let page = args.output.join("report.html");
    files::write(&page, html.as_bytes())?;
    if !console.is_quiet() {
        console.output(&report.table())?;
    }
    console.remark(&format!("drawn by {}, driver {}", report.adapter.name, report.adapter.driver));
    if report.ways.iter().any(|way| glisten_reference::has_geometry_stage(&way.scene)) {
        console.remark("geometry stages ran on the host: times are those of what they emitted");
    }
    console.remark(&format!("wrote {}", page.display()));
    Ok(())
}
