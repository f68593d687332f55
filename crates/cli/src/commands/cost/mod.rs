//! `glisten cost`: what programs cost, before a GPU sees them; with `--measure`, how well that ranks measured times.
//!
//! *In:* shaders, or scenes. *Out:* a table, or JSON: `{"programs": [..]}`.

mod rank;
mod table;
use crate::arguments::args::{BindingArgs, LevelArgs, ProgramArgs, ResultFormat, SourceArgs};
use crate::arguments::bounds::Bounds;
use crate::arguments::settings::numbers;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::inputs;
use crate::scenes::MachineArgs;
use crate::session::{Session, Unit};
use clap::Args;
use glisten_cost::{Assumptions, ProgramCost, cost};
use glisten_front::diagnostic::did_you_mean;
use glisten_front::hir::Storage;
use rank::Measuring;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::PathBuf;
use table::table;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten cost a.vert a.frag", "operations on the shortest and the longest path, and the dearest lines"),
    ("glisten cost shaders --range lights=0..4 --format json", "with a limit for the rounds of loops, for scripts"),
    ("glisten cost --measure", "how well costs rank the times of the library's scenes here"),
];

/// Count the operations of shaders by line and class, on the shortest and the longest path
#[derive(Args, Debug)]
pub(crate) struct CostArgs {
    /// Shaders, folders, or `-` for standard input; with `--measure` scenes (default: those of the library)
    #[arg(value_name = "FILE|DIR", required_unless_present_any = ["programs", "measure"])]
    files: Vec<PathBuf>,
    /// The format of the costs
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    /// Show every line, not only the dearest
    #[arg(long)]
    lines: bool,
    /// The rounds of a loop that nothing limits
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    iterations: u64,
    /// The range of a uniform, besides those of `[lint.ranges]` (repeatable)
    #[arg(long, value_name = "NAME=LOW..HIGH", value_parser = parse_range)]
    range: Vec<(String, Bounds)>,
    /// Draw scenes, and print how well the costs rank the times
    #[arg(long, conflicts_with_all = ["lines", "range", "programs"])]
    measure: bool,
    /// The rounds of measurements, of which the shortest time counts
    #[arg(long, value_name = "N", default_value_t = 9, requires = "measure")]
    rounds: u32,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

impl CostArgs {
    /// Whether a driver draws.
    pub(crate) fn draws_by_a_driver(&self) -> bool {
        self.measure
    }
}

fn parse_range(text: &str) -> Result<(String, Bounds), String> {
    let parts = text.split_once('=').and_then(|(name, range)| Some((name.trim(), Bounds::parse(range)?)));
    match parts {
        Some((name, bounds)) if !name.is_empty() => Ok((name.to_owned(), bounds)),
        _ => Err("write `NAME=LOW..HIGH`, or `NAME=VALUE`".to_owned()),
    }
}

/// A range of what no program has is a mistake.
fn check_range(name: &str, units: &[Unit]) -> Result<(), Failure> {
    let base = |path: &'_ str| path.find(['.', '[']).map_or(path.len(), |end| end);
    let programs = || units.iter().filter_map(|unit| unit.program.as_ref());
    let uniforms = programs().flat_map(|program| &program.interface.uniforms).map(|leaf| leaf.name.as_str());
    let globals = programs().flat_map(|program| &program.stages).flat_map(|shader| &shader.globals);
    let own = globals.filter(|global| global.storage == Storage::Uniform).map(|global| global.name.as_str());
    let names: BTreeSet<&str> = uniforms.chain(own).filter_map(|path| path.get(..base(path))).collect();
    let wanted = name.get(..base(name)).unwrap_or(name);
    if names.contains(wanted) {
        return Ok(());
    }
    let failure = Failure::usage(format!("no program has a uniform `{name}` (--range)"));
    Err(match did_you_mean(wanted, names.iter().copied()) {
        Some(near) => failure.help(format!("did you mean `{near}`?")),
        None => failure,
    })
}

/// Runs the command.
pub(crate) fn run(args: &CostArgs, console: &Console) -> Outcome {
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, 0)?;
    if args.measure {
        let (format, iterations, rounds) = (args.format, args.iterations, args.rounds);
        let measuring = Measuring { adapter: args.machine.adapter(), format, iterations, rounds };
        return rank::run(&measuring, &args.files, session.compiler(), console);
    }
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, true)?;
    if inputs.groups.is_empty() {
        return Err(Failure::usage("there is no shader"));
    }
    let units = session.compile(inputs.groups);
    let exit = session.tell_units(&units, false)?;
    if units.iter().all(Unit::is_program) {
        args.range.iter().try_for_each(|(name, _)| check_range(name, &units))?;
    }
    let costs: Vec<(&Unit, ProgramCost)> = units
        .iter()
        .filter_map(|unit| {
            let program = unit.sound_program()?;
            let name = unit.group.inputs.first().map_or("", |input| input.name.as_str());
            let mut ranges = session.settings_of(name).ranges.clone();
            ranges.retain(|(name, _)| !args.range.iter().any(|(given, _)| given == name));
            ranges.extend(args.range.iter().cloned());
            let assumptions = Assumptions { iterations: args.iterations, ranges: numbers(&ranges) };
            Some((unit, cost(program, &unit.batch.sources, &assumptions)))
        })
        .collect();
    let text = match args.format {
        ResultFormat::Json => {
            let all: Vec<&ProgramCost> = costs.iter().map(|(_, cost)| cost).collect();
            format!("{:#}\n", json!({ "programs": all }))
        }
        ResultFormat::Human => {
            let tables = costs.iter().map(|(unit, cost)| table(cost, &unit.batch.sources, args.lines));
            tables.collect::<Vec<_>>().join("\n")
        }
    };
    if !costs.is_empty() {
        console.output(&text)?;
    }
    Ok(if costs.is_empty() { exit.max(Exit::Content) } else { exit })
}
