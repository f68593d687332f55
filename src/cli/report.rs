//! `glisten report`: error against run time of the ways to shade a scene, as JSON and as a page.

use super::args::WithContractArgs;
use super::batch::Batch;
use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use super::made::made;
use super::progress::Progress;
use super::scenes::{DrawError, SceneArgs, ViaArg};
use super::session::Session;
use crate::report::{self, Error, Options, Report, Watcher, Ways};
use crate::scene::DiskFiles;
use clap::{Args, ValueEnum};
use glisten_front::source::SourceMap;
use glisten_gpu::Via;
use std::path::PathBuf;

/// Measure the ways to shade a scene: error against run time
#[derive(Args, Debug)]
pub(super) struct ReportArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The folder for report.json and report.html
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The form of the code that the GPU runs
    #[arg(long, value_enum, default_value_t)]
    via: ViaArg,
    /// The ways to compare
    #[arg(long, value_enum, default_value_t)]
    ways: WaysArg,
    /// Add each way once more with programs of which nothing is left but what the picture needs
    #[arg(long)]
    specialize: bool,
    #[command(flatten)]
    contract: WithContractArgs,
}

/// Which ways to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum WaysArg {
    /// Those of the scene's [report] table, or the scene alone
    #[default]
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

/// Shows the steps of a report as progress.
struct Steps<'a> {
    console: &'a Console,
    progress: Progress,
    begun: bool,
}

impl Watcher for Steps<'_> {
    fn steps(&mut self, count: usize) {
        self.progress = Progress::new(self.console, count);
    }

    fn step(&mut self, what: &str) {
        if self.begun {
            self.progress.step();
        }
        self.begun = true;
        self.progress.say(what);
    }
}

/// Runs the command.
pub(super) fn run(args: &ReportArgs, console: &Console) -> Outcome {
    let session = args.scene.session(console)?;
    files::make_folder(&args.output)?;
    let gpu = match args.scene.gpu() {
        Ok(gpu) => gpu,
        Err(error) => return told(session, SourceMap::default(), error),
    };
    let via: Via = args.via.into();
    let options =
        Options { via, specialized: args.specialize.then(|| args.contract.contract()), ways: args.ways.into() };
    let mut steps = Steps { console, progress: Progress::new(console, 1), begun: false };
    let result = report::run(&args.scene.scene, &DiskFiles, session.compiler(), &gpu, &options, &mut steps);
    drop(steps);
    match result {
        Ok(report) => write(args, console, &report),
        Err(Error::Scene { sources, diagnostics, io_error }) => {
            let exit = told(session, *sources, DrawError::Diagnostics(diagnostics.into_iter().collect()))?;
            Ok(if io_error { exit.max(Exit::Usage) } else { exit })
        }
        Err(Error::Reference { way, diagnostics }) => {
            console.remark(&format!("the reference cannot draw `{way}`"));
            told(session, SourceMap::default(), DrawError::Diagnostics(diagnostics))
        }
        Err(Error::Gpu { way, error }) => {
            console.remark(&format!("the GPU cannot draw `{way}`"));
            told(session, SourceMap::default(), error.into())
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

fn write(args: &ReportArgs, console: &Console, report: &Report) -> Outcome {
    let html = report.html(&made()).map_err(|error| Failure::new(Exit::Content, format!("internal error: {error}")))?;
    files::write(&args.output.join("report.json"), report.json().as_bytes())?;
    let page = args.output.join("report.html");
    files::write(&page, html.as_bytes())?;
    if !console.is_quiet() {
        console.output(&report.table())?;
    }
    console.remark(&format!("drawn by {}, driver {}", report.adapter.name, report.adapter.driver));
    console.remark(&format!("wrote {}", page.display()));
    Ok(Exit::Ok)
}
