//! [`specialize`]: the phases in their order, over all stages, until they find nothing more.

use crate::account::{self, How, LeftOut, Moved};
use crate::forward::{self, Reasons, Walked};
use crate::known::Known;
use crate::left::Left;
use crate::options::{Extent, Math, Options};
use crate::prune::{self, Pruned};
use crate::settle::{self, Demand, Demands, Settled, mark_looked_at, mark_signs};
use crate::{fast, inputs, motion, text, unlocated, words};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Types, print};
use glisten_front::link::{Bindings, relink};
use glisten_front::source::{SourceMap, Span};
use glisten_front::{Compiler, Program, Source};
use rustc_hash::FxHashMap;

/// A program is evaluated at most so often.
const ROUNDS: usize = 4;

/// A program of which nothing is left but what is needed.
#[derive(Clone, Debug)]
pub struct Residual {
    /// The stages in the order of the pipeline.
    pub stages: Vec<ResidualStage>,
    /// The residual, read back and linked.
    pub program: Program,
    /// The texts that it was read back from.
    pub sources: SourceMap,
    /// What was left out, in the order of the original.
    pub left_out: Vec<LeftOut>,
    /// What moved to the vertex stage.
    pub moved: Vec<Moved>,
    /// How far the program was evaluated.
    pub extent: Extent,
    /// The places of the loops that were written out, those first that became longest.
    pub written_out: Vec<Span>,
    /// Why the residual did not read back, a fault of this crate: the program is then as it was.
    pub fault: Option<String>,
}

/// A stage of a residual.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResidualStage {
    /// Which.
    pub stage: Stage,
    /// GLSL 1.50.
    pub text: String,
    /// For each line of the text the place in the original that it comes from; unknown for closing braces and their like.
    pub lines: Vec<Span>,
}

impl ResidualStage {
    fn of(types: &Types, shader: &Shader, sources: Option<&SourceMap>) -> Self {
        let (text, lines) = text::write(types, shader, sources);
        Self { stage: shader.stage, text, lines }
    }
}

impl Residual {
    /// The text of a stage.
    pub fn text(&self, stage: Stage) -> Option<&str> {
        self.stages.iter().find(|residual| residual.stage == stage).map(|residual| residual.text.as_str())
    }

    /// Whether anything was left out.
    pub fn is_smaller(&self) -> bool {
        !self.left_out.is_empty()
    }
}

/// Leaves out of a program what is not needed when this is known.
pub fn specialize(program: &Program, known: &Known) -> Residual {
    specialize_with(program, known, &Options::default())
}

/// The same with the texts at hand.
pub fn specialize_with(program: &Program, known: &Known, options: &Options<'_>) -> Residual {
    if options.extent == Extent::Nothing {
        return unevaluated(program, options);
    }
    let mut evaluated = evaluate(program, known, options);
    for _ in 1..ROUNDS {
        let Some(left) = linked_again(program, &evaluated) else { break };
        let next = evaluate(&left, known, options);
        let found_more = !same_text(&evaluated, &next);
        evaluated = next.after(evaluated);
        if !found_more {
            break;
        }
    }
    assemble(program, known, options, evaluated)
}

/// What evaluating a program leaves.
struct Evaluated {
    types: Types,
    /// In the order of the pipeline.
    shaders: Vec<Shader>,
    /// What was decided, by stage.
    reasons: Vec<(Stage, Reasons)>,
    moved: Vec<Moved>,
    /// By how many expressions loops became longer.
    written_out: FxHashMap<Span, u64>,
}

impl Evaluated {
    /// With what was decided and moved before.
    fn after(mut self, before: Self) -> Self {
        for (stage, first) in before.reasons {
            if let Some((_, reasons)) = self.reasons.iter_mut().find(|(of, _)| *of == stage) {
                let later = std::mem::replace(reasons, first);
                reasons.then(later);
            }
        }
        self.moved.splice(0..0, before.moved);
        before.written_out.into_iter().for_each(|(place, grown)| *self.written_out.entry(place).or_default() += grown);
        self
    }
}

/// Evaluates a program once. What was decided late or went late may decide more in the next round.
fn evaluate(program: &Program, known: &Known, options: &Options<'_>) -> Evaluated {
    let textures = inputs::textures(program, known);
    let (vertex, fragment) = (program.stage(Stage::Vertex), program.stage(Stage::Fragment));
    let whole = program.stage(Stage::Geometry).is_none();
    let walk = |shader: &Shader, ends: Option<&Walked>| {
        let ends = ends.filter(|_| whole).map(|walked| walked.ends.as_slice());
        forward::walk(&program.types, shader, inputs::inputs(program, shader, known, ends), &textures, options)
    };
    let vertex = vertex.map(|shader| (shader, walk(shader, None)));
    let fragment = fragment.map(|shader| (shader, walk(shader, vertex.as_ref().map(|(_, walked)| walked))));
    let mut reasons: Vec<(Stage, Reasons)> = Vec::new();
    let mut pruned: Vec<(Pruned, Vec<bool>)> = Vec::new();
    let mut moved = Vec::new();
    let stages = vertex.iter().chain(&fragment);
    let written_out = stages.flat_map(|(_, stage)| &stage.written_out).map(|(place, grown)| (*place, *grown)).collect();
    // The fragment stage first: what it reads is what the vertex stage must write.
    let mut wanted = None;
    // Whether somebody sees the sign of a zero in what the vertex stage writes.
    let mut signs: Vec<bool> = vertex.iter().flat_map(|(shader, _)| &shader.globals).map(is_written_out).collect();
    // And whether an operation of the fragment stage does.
    let mut looked_at = vec![!whole; signs.len()];
    if let Some((shader, mut stage)) = fragment {
        let seen = mark_signs(&program.types, &mut stage, colors_with_signs(shader, known));
        varyings_with_signs(program, &seen, &mut signs);
        let seen = mark_looked_at(&program.types, &mut stage, vec![false; shader.globals.len()]);
        varyings_with_signs(program, &seen, &mut looked_at);
        let live = live_colors(shader, program, known);
        let (settled, demands) = settled(program, &stage, vec![Demand::NONE; shader.globals.len()]);
        wanted = Some(demands).filter(|_| whole);
        pruned.push((prune::prune(&program.types, settled, &live), live));
        reasons.push((Stage::Fragment, stage.reasons));
    }
    if let Some((shader, mut stage)) = vertex {
        if whole {
            mark_signs(&program.types, &mut stage, signs);
        }
        mark_looked_at(&program.types, &mut stage, looked_at);
        let mut demands = vec![Demand::NONE; shader.globals.len()];
        if let Some(of_fragment) = &wanted {
            hand_on(program, of_fragment, &mut demands);
        }
        let (mut settled, _) = settled(program, &stage, demands);
        let reader = pruned.first_mut().filter(|_| whole);
        let live = match reader {
            Some((fragment, colors)) => {
                if options.move_to_vertex {
                    moved = motion::run(&program.types, program, fragment, colors, &mut settled);
                }
                live_varyings(shader, program, known, Some(&fragment.globals))
            }
            None => live_varyings(shader, program, known, None),
        };
        pruned.push((prune::prune(&program.types, settled, &live), live));
        reasons.push((Stage::Vertex, stage.reasons));
    }
    let moved: Vec<Moved> = moved.into_iter().map(|one| described(one, options.sources)).collect();
    let mut types = program.types.clone();
    // A geometry stage stays as it is, and has structs and arrays of the others.
    prune::finish(&mut types, &mut pruned, whole);
    let mut shaders: Vec<Shader> = pruned.into_iter().map(|(pruned, _)| pruned.shader).collect();
    shaders.extend(program.stage(Stage::Geometry).cloned());
    shaders.sort_by_key(|shader| shader.stage);
    Evaluated { types, shaders, reasons, moved, written_out }
}

/// What is left, as a program.
fn linked_again(program: &Program, evaluated: &Evaluated) -> Option<Program> {
    let (attributes, outputs) = locations(program);
    let bindings = Bindings { attribute_locations: &attributes, frag_data_locations: &outputs, ..Bindings::default() };
    let mut stages = evaluated.shaders.clone();
    stages.iter_mut().for_each(Shader::mark_static_use);
    relink(program.name.clone(), evaluated.types.clone(), stages, bindings)
}

/// Whether both are written alike.
fn same_text(a: &Evaluated, b: &Evaluated) -> bool {
    let same = |(one, other): (&Shader, &Shader)| print(&a.types, one) == print(&b.types, other);
    a.shaders.len() == b.shaders.len() && a.shaders.iter().zip(&b.shaders).all(same)
}

/// Locations by name.
type Named = Vec<(String, u32)>;

/// The locations of attributes and outputs, to bind them by their names.
fn locations(program: &Program) -> (Named, Named) {
    // What is built in has its location, and cannot be bound.
    let is_own = |name: &str| !name.starts_with("gl_");
    let attributes = program.interface.attributes.iter().map(|one| (one.name.clone(), one.location));
    let outputs = program.interface.outputs.iter().map(|one| (one.name.clone(), one.location));
    (attributes.filter(|(name, _)| is_own(name)).collect(), outputs.filter(|(name, _)| is_own(name)).collect())
}

/// A move with its text and place.
fn described(moved: motion::Move, sources: Option<&SourceMap>) -> Moved {
    let motion::Move { name, span } = moved;
    let place = sources.and_then(|sources| {
        let place = sources.location(span)?;
        Some((sources.file(place.file).name().to_owned(), place.line))
    });
    let (file, line) = place.unwrap_or_default();
    let expression = sources.map_or_else(String::new, |sources| sources.snippet(span).to_owned());
    Moved { name, expression, file, line, span }
}

fn settled(program: &Program, stage: &Walked, globals: Vec<Demand>) -> (Settled, Demands) {
    let demands = Demands::of(&program.types, stage, globals);
    let mut settled = settle::settle(&program.types, stage, &demands, &program.interface.samplers);
    if stage.math == Math::Fast {
        fast::simplify(&program.types, &mut settled.shader);
    }
    (settled, demands)
}

/// Whether somebody outside of a stage may see the sign of a zero in a global. A position is what it is with either sign.
fn is_written_out(global: &Global) -> bool {
    global.storage == Storage::Out && global.builtin != Some(BuiltinVariable::Position)
}

/// The globals of a fragment stage in which somebody sees the sign of a zero.
fn colors_with_signs(shader: &Shader, known: &Known) -> Vec<bool> {
    let unsigned = known.state.unsigned_colors;
    shader.globals.iter().map(|global| is_written_out(global) && !(unsigned && global.builtin.is_none())).collect()
}

/// Of the globals of the vertex stage, those that the fragment stage reads have the signs that it sees.
fn varyings_with_signs(program: &Program, fragment: &[bool], signs: &mut [bool]) {
    for varying in &program.interface.varyings {
        let (Some(from), Some(to)) = (varying.from, varying.to) else { continue };
        if let Some(slot) = signs.get_mut(from.global.index()) {
            *slot = fragment.get(to.global.index()).copied().unwrap_or(true);
        }
    }
}

/// What the fragment stage demands of a varying it demands of the output.
fn hand_on(program: &Program, of_fragment: &Demands, demands: &mut [Demand]) {
    for varying in &program.interface.varyings {
        let (Some(from), Some(to)) = (varying.from, varying.to) else { continue };
        let demand = of_fragment.globals.get(to.global.index()).copied().unwrap_or(Demand::KEEP);
        if let Some(slot) = demands.get_mut(from.global.index()) {
            *slot = slot.and(demand);
        }
    }
}

/// Which globals of the fragment stage somebody reads at its end.
fn live_colors(shader: &Shader, program: &Program, known: &Known) -> Vec<bool> {
    let attached = |id: GlobalId| {
        let output = program.interface.outputs.iter().find(|output| output.global == id);
        match (output, known.state.attachments) {
            (Some(output), Some(attachments)) => output.location < attachments,
            _ => true,
        }
    };
    let live = |(id, global): (GlobalId, &Global)| match global.builtin {
        Some(BuiltinVariable::FragDepth) => known.state.depth_test != Some(false),
        _ => global.storage == Storage::Out && attached(id),
    };
    shader.globals().map(live).collect()
}

/// Which globals of the vertex stage somebody reads at its end; `wanted` are the fragment stage's globals that are left.
fn live_varyings(shader: &Shader, program: &Program, known: &Known, wanted: Option<&[GlobalId]>) -> Vec<bool> {
    let read = |id: GlobalId| match wanted {
        None => true,
        Some(wanted) => program.interface.varyings.iter().any(|varying| {
            let to = varying.to.is_some_and(|to| wanted.contains(&to.global));
            to && varying.from.is_some_and(|from| from.global == id)
        }),
    };
    let clipped = |builtin: BuiltinVariable| {
        let fragment = program.stage(Stage::Fragment);
        fragment.is_some_and(|shader| shader.globals.iter().any(|global| global.builtin == Some(builtin)))
    };
    let live = |(id, global): (GlobalId, &Global)| match global.builtin {
        _ if global.storage != Storage::Out => false,
        Some(BuiltinVariable::PointSize) => known.state.point_size != Some(false),
        Some(BuiltinVariable::ClipDistance) => {
            known.state.clip_distances != Some(0) || clipped(BuiltinVariable::ClipDistance)
        }
        Some(_) => true,
        None => read(id),
    };
    shader.globals().map(live).collect()
}

/// The stages as text, read back.
fn assemble(program: &Program, known: &Known, options: &Options<'_>, evaluated: Evaluated) -> Residual {
    let Evaluated { mut types, mut shaders, reasons, mut moved, written_out } = evaluated;
    let mut written_out: Vec<(Span, u64)> = written_out.into_iter().collect();
    written_out.sort_unstable_by_key(|(place, grown)| (std::cmp::Reverse(*grown), place.start));
    let written_out = written_out.into_iter().map(|(place, _)| place).collect();
    words::free(&mut types, &mut shaders);
    let renamed = unlocated::by_name(&types, &mut shaders);
    let stages = written(&types, &shaders, options.sources);
    match read_back(program, &stages) {
        Ok((left, sources)) => {
            let mut names = Left::all(&shaders, &left.interface);
            // What moved twice is in the later varying.
            moved.retain(|one| names.varyings.contains(one.name.as_str()));
            let how = How { known, reasons: &reasons, moved: &moved };
            let kept = renamed.iter().filter(|row| names.varyings.contains(row.new.as_str()));
            let kept: Vec<&str> = kept.map(|row| row.old.as_str()).collect();
            names.varyings.extend(kept);
            let left_out = account::left_out(program, options.sources, &how, &names);
            Residual {
                stages,
                program: left,
                sources,
                left_out,
                moved,
                extent: options.extent,
                written_out,
                fault: None,
            }
        }
        Err(fault) => Residual { fault: Some(fault), ..whole(program, options) },
    }
}

/// The stages as text.
fn written(types: &Types, shaders: &[Shader], sources: Option<&SourceMap>) -> Vec<ResidualStage> {
    shaders.iter().map(|shader| ResidualStage::of(types, shader, sources)).collect()
}

/// Compiles the residual, with the locations that a host has bound.
fn read_back(program: &Program, stages: &[ResidualStage]) -> Result<(Program, SourceMap), String> {
    let sources: Vec<Source> = stages
        .iter()
        .map(|stage| Source {
            name: format!("{}.{}", program.name, text::extension(stage.stage)),
            text: stage.text.as_str().into(),
            stage: stage.stage,
        })
        .collect();
    let (attribute_locations, frag_data_locations) = locations(program);
    let options =
        glisten_front::Options { attribute_locations, frag_data_locations, ..glisten_front::Options::default() };
    let compiled = Compiler::new(options).compile(&sources);
    let problem = || {
        let error = compiled.diagnostics.iter().find(|found| found.is_error());
        let message = error.map_or("no program", |error| error.message.as_str());
        let line = error.and_then(|error| compiled.sources.location(error.primary.span)).map_or(0, |place| place.line);
        let texts: Vec<&str> = stages.iter().map(|stage| stage.text.as_str()).collect();
        format!("line {line}: {message}\n{}", texts.join("\n"))
    };
    match compiled.program {
        Some(program) => Ok((program, compiled.sources)),
        None => Err(problem()),
    }
}

/// The program without what reaches no output.
fn unevaluated(program: &Program, options: &Options<'_>) -> Residual {
    let optimized = crate::optimize(program);
    let (mut types, mut shaders) = (optimized.types.clone(), optimized.stages.clone());
    words::free(&mut types, &mut shaders);
    unlocated::by_name(&types, &mut shaders);
    let stages = written(&types, &shaders, options.sources);
    match read_back(program, &stages) {
        Ok((program_left, sources)) => {
            let left_out = crate::left_out(program, &optimized, options.sources);
            Residual { stages, program: program_left, left_out, sources, ..whole(program, options) }
        }
        Err(fault) => Residual { fault: Some(fault), ..whole(program, options) },
    }
}

/// The program as it was.
fn whole(program: &Program, options: &Options<'_>) -> Residual {
    let (mut types, mut shaders) = (program.types.clone(), program.stages.clone());
    words::free(&mut types, &mut shaders);
    unlocated::by_name(&types, &mut shaders);
    let stages = written(&types, &shaders, options.sources);
    let sources = options.sources.cloned().unwrap_or_default();
    Residual {
        stages,
        program: program.clone(),
        sources,
        left_out: Vec::new(),
        moved: Vec::new(),
        extent: Extent::Nothing,
        written_out: Vec::new(),
        fault: None,
    }
}
