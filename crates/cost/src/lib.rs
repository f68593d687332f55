//! The cost of a program, before a GPU sees it: operations on the shortest and the longest path by line and class, values that are the
//! same in the whole draw, what is interpolated, and what keeps a GPU from testing the depth early.
//!
//! *In:* a linked [`Program`], its texts, ranges of its uniforms. *Out:* a [`ProgramCost`]. *Holds:* an operation on a vector counts
//! once a component; operations on constants count nothing. A loop whose rounds nobody knows counts [`Assumptions::iterations`]
//! rounds on the longest path, and says so. *Not done here:* what a driver makes of the code; `glisten report` measures times.

mod counts;
mod known;
mod paths;
mod rank;
mod rates;
mod trips;
mod walk;

pub use counts::{CLASSES, Class, Counts};
pub use known::Ranges;
pub use rank::{ranks, spearman};

use glisten_front::hir::{Shader, Stage, Types};
use glisten_front::link::Program;
use glisten_front::source::{FileId, SourceMap, Span};
use paths::Share;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use trips::{Source, Trips};
use walk::Walk;

/// Assumptions about inputs.
#[derive(Clone, Debug)]
pub struct Assumptions {
    /// The rounds of a loop of which nothing is known, on the longest path.
    pub iterations: u64,
    /// The ranges of uniforms.
    pub ranges: Ranges,
}

impl Default for Assumptions {
    fn default() -> Self {
        Self { iterations: 8, ranges: Ranges::default() }
    }
}

/// The cost of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ProgramCost {
    /// The name of the program.
    pub program: String,
    /// The varyings that are interpolated for each fragment.
    pub varyings: VaryingCost,
    /// The stages, in the order of the pipeline.
    pub stages: Vec<StageCost>,
}

/// The varyings between the stages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct VaryingCost {
    /// Locations, each a register of four components.
    pub registers: usize,
    /// The components that are in use.
    pub components: u32,
}

/// The cost of a stage.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StageCost {
    /// The stage.
    pub stage: &'static str,
    /// Its file.
    pub file: String,
    /// The operations on the shortest path.
    pub shortest: Counts,
    /// The operations on the longest path.
    pub longest: Counts,
    /// Those of the longest path whose values are the same in the whole draw.
    pub uniform: Counts,
    /// The loops, in the order of the text.
    pub loops: Vec<LoopCost>,
    /// The places that keep a GPU from testing the depth before the stage runs.
    pub early_z: Vec<LateDepth>,
    /// The lines with operations on either path, in the order of the text.
    pub lines: Vec<LineCost>,
    /// Where `main` is.
    #[serde(skip)]
    pub span: Span,
}

/// The cost of a line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LineCost {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// Its operations on the shortest path.
    pub shortest: Counts,
    /// Its operations on the longest path.
    pub longest: Counts,
    /// Those of the longest path whose values are the same in the whole draw.
    pub uniform: Counts,
    /// A place on the line.
    #[serde(skip)]
    pub span: Span,
}

/// The rounds of a loop.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LoopCost {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// The fewest rounds.
    pub least: u64,
    /// The most rounds.
    pub most: u64,
    /// From where they are known: `counted`, `range`, `array`, `assumed`.
    pub known: &'static str,
}

/// A place that keeps a GPU from testing the depth early.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LateDepth {
    /// `discard` or `gl_FragDepth`.
    pub what: &'static str,
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
}

/// The cost of a program.
pub fn cost(program: &Program, sources: &SourceMap, assumptions: &Assumptions) -> ProgramCost {
    let stage = |shader: &Shader| shader.on_stack(|| of_stage(&program.types, shader, sources, assumptions));
    let (mut registers, mut components) = (BTreeSet::new(), 0);
    for varying in program.interface.interpolated().filter(|varying| varying.active) {
        registers.insert(varying.location);
        components += program.types.flat_len(varying.ty);
    }
    ProgramCost {
        program: program.name.clone(),
        varyings: VaryingCost { registers: registers.len(), components },
        stages: program.stages.iter().map(stage).collect(),
    }
}

/// The lines of a walk by their numbers.
#[derive(Default)]
struct Lines {
    numbers: BTreeMap<(FileId, u32), u32>,
    spans: Vec<Span>,
}

impl Lines {
    /// The number of the line of a place. What has no place counts for the line of `main`.
    fn number(&mut self, sources: &SourceMap, span: Span, main: Span) -> u32 {
        let site = sources.call_site(if span.is_known() { span } else { main });
        let Some(location) = sources.location(site) else { return 0 };
        let next = self.spans.len() as u32;
        let number = *self.numbers.entry((location.file, location.line)).or_insert(next);
        if number == next {
            self.spans.push(site);
        }
        number
    }
}

fn of_stage(types: &Types, shader: &Shader, sources: &SourceMap, assumptions: &Assumptions) -> StageCost {
    let main = shader.main.map_or_else(|| shader.anchor(), |main| shader.function(main).span);
    let mut lines = Lines::default();
    let mut line_of = |span: Span| lines.number(sources, span, main);
    line_of(main);
    let mut walk = Walk::new((types, shader), &assumptions.ranges, assumptions.iterations, &mut line_of);
    let way = walk.whole();
    let (shortest, longest) = (walk.paths.total(way.least), walk.paths.total(way.most));
    let Walk { paths, seen, .. } = walk;
    let count = lines.spans.len();
    let (least, most) = (paths.shares(way.least, count), paths.shares(way.most, count));
    let place = |span: Span| {
        let location = sources.location(sources.call_site(if span.is_known() { span } else { main }));
        location.map_or((String::new(), 0), |at| (sources.file(at.file).name().to_owned(), at.line))
    };
    let mut rows = Vec::new();
    for (number, span) in lines.spans.iter().enumerate() {
        let share = |of: &[Share]| of.get(number).copied().unwrap_or_default();
        let (least, most) = (share(&least), share(&most));
        if least.all.is_nothing() && most.all.is_nothing() {
            continue;
        }
        let (file, line) = place(*span);
        rows.push(LineCost { file, line, shortest: least.all, longest: most.all, uniform: most.uniform, span: *span });
    }
    rows.sort_by_key(|row| row.span.start);
    let uniform = rows.iter().fold(Counts::default(), |sum, row| sum.plus(row.uniform));
    let mut loops: Vec<LoopCost> = seen.loops.iter().map(|(span, trips)| told(place(*span), *trips)).collect();
    loops.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
    let late = if shader.stage == Stage::Fragment { seen.late } else { Vec::new() };
    let mut early_z: Vec<LateDepth> = late
        .iter()
        .map(|(span, what)| {
            let (file, line) = place(*span);
            LateDepth { what, file, line }
        })
        .collect();
    early_z.sort_by(|a, b| (&a.file, a.line, a.what).cmp(&(&b.file, b.line, b.what)));
    early_z.dedup();
    let (file, _) = place(main);
    StageCost { stage: shader.stage.name(), file, shortest, longest, uniform, loops, early_z, lines: rows, span: main }
}

fn told((file, line): (String, u32), trips: Trips) -> LoopCost {
    let known = match trips.source {
        Source::Counted => "counted",
        Source::Range => "range",
        Source::Array => "array",
        Source::Assumed => "assumed",
    };
    LoopCost { file, line, least: trips.least, most: trips.most, known }
}
