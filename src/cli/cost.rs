//! `glisten cost`: what programs cost, before a GPU sees them; with `--measure`, how well that ranks measured times.
//!
//! *In:* shaders, or scenes. *Out:* a table, or JSON: `{"programs": [..]}`.

use super::args::{BindingArgs, LevelArgs, ProgramArgs, ResultFormat, SourceArgs};
use super::bounds::Bounds;
use super::console::Console;
use super::cost_rank::{self, Measuring};
use super::cost_table::table;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use super::inputs;
use super::scenes::MachineArgs;
use super::session::{Session, Unit};
use super::settings::numbers;
use crate::cost::{Assumptions, ProgramCost, cost};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten cost a.vert a.frag", "operations on the shortest and the longest path, and the dearest lines"),
    ("glisten cost shaders --range lights=0..4 --format json", "with a limit for the rounds of loops, for scripts"),
    ("glisten cost --measure", "how well costs rank the times of the library's scenes here"),
];

/// Count the operations of shaders by line and class, on the shortest and the longest path
#[derive(Args, Debug)]
pub(super) struct CostArgs {
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
    pub(super) fn draws_by_a_driver(&self) -> bool {
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

/// Runs the command.
pub(super) fn run(args: &CostArgs, console: &Console) -> Outcome {
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, 0)?;
    if args.measure {
        let (format, iterations, rounds) = (args.format, args.iterations, args.rounds);
        let measuring = Measuring { adapter: args.machine.adapter(), format, iterations, rounds };
        return cost_rank::run(&measuring, &args.files, session.compiler(), console);
    }
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, true)?;
    if inputs.groups.is_empty() {
        return Err(Failure::usage("there is no shader"));
    }
    let units = session.compile(inputs.groups);
    let exit = session.tell_units(&units, false)?;
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
