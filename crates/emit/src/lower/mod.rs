//! Lowers the typed program to naga IR, from OpenGL's semantics to WebGPU's and Vulkan's.
//!
//! *In:* a [`Program`] without errors and the conventions. *Out:* a `naga::Module` for one stage, whose spans are
//! the global offsets of the [`SourceMap`](glisten_front::source::SourceMap).
//!
//! *Holds:* locations, offsets and bindings are those of [`Program::interface`]. The natural layout of every type in
//! uniform space is its std140 layout, because naga's WGSL writer writes neither sizes nor strides. The only pointers
//! passed to functions point to whole local variables, because naga's SPIR-V writer has no others. Expressions are
//! evaluated left to right, each where GLSL evaluates it. What a target cannot represent is a diagnostic and never a
//! wrong result.
//!
//! | file | contents |
//! | --- | --- |
//! | `facts`, `discards` | facts that must be known first |
//! | `types`, `uniforms` | types of values, types in std140 memory |
//! | `interface`, `outputs` | attributes, varyings, colors, built-in variables, the entry point |
//! | `function` | the state of one function: naga's arenas, emission, names |
//! | `sprites` | points as quads |
//! | `slots` | how globals, locals and outputs are represented |
//! | `statements`, `control` | §6 |
//! | `expressions`, `operators`, `constructors`, `places`, `calls` | §5 |
//! | `builtins`, `textures`, `texel_loads`, `matrices`, `aggregates` | §8 |
//! | `constants` | constant values, and how to keep the target from evaluating what is not finite |

mod aggregates;
mod bits;
mod builtins;
mod calls;
mod constants;
mod constructors;
mod control;
mod discards;
mod expressions;
mod facts;
mod function;
mod gathers;
mod interface;
mod matrices;
mod operands;
mod operators;
mod outputs;
mod places;
mod samplers;
mod slots;
mod sprites;
mod statements;
mod texel_loads;
mod texture_queries;
mod textures;
mod types;
mod uniforms;

pub(crate) use operands::for_each_operand;

use crate::select::{Choice, select};
use crate::target::{Capabilities, Conventions, Target};
use facts::Facts;
use glisten_front::diagnostic::codes::{general, targets};
use glisten_front::diagnostic::{Advice, Diagnostic};
use glisten_front::hir::{FunctionId, Global, GlobalId, Shader, Stage, Storage, Types};
use glisten_front::link::{Interface, Program};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;
use slots::{GlobalSlot, Lowered};

/// A result of the lowering, or the one diagnostic that says why there is none.
type Try<T> = Result<T, Box<Diagnostic>>;

/// Lowers one stage of a program.
///
/// # Errors
/// Diagnostics, all of them errors: what the target cannot represent, what is not supported yet, and internal errors.
pub(crate) fn lower(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
) -> Result<naga::Module, Vec<Diagnostic>> {
    lower_with(program, stage, target, conventions, None)
}

/// Lowers functions of one stage, whose `main` is empty, to a module without an entry point, with all constants and uniforms of the
/// texts.
///
/// # Errors
/// Those of [`lower`], and that the functions read what only an entry point gets.
pub(crate) fn lower_functions(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
    wanted: &[FunctionId],
) -> Result<naga::Module, Vec<Diagnostic>> {
    let mut module = lower_with(program, stage, target, conventions, Some(wanted))?;
    module.entry_points.clear();
    Ok(module)
}

/// The diagnostic for functions that use what only an entry point sets.
fn without_an_entry_point(shader: &Shader, facts: &Facts) -> Option<Box<Diagnostic>> {
    let is_used = |id: GlobalId| facts.used.get(id.index()).copied().unwrap_or(false);
    let is_set = |global: &Global| match global.storage {
        Storage::In | Storage::Out => true,
        Storage::Private => global.initializer.is_some() && global.value.is_none(),
        Storage::Const | Storage::Uniform => false,
    };
    let (_, global) = shader.globals().find(|(id, global)| is_used(*id) && is_set(global))?;
    let message = format!("functions without an entry point use `{}`, which only an entry point sets", global.name);
    Some(lacking(global.span, message, "pass it to the functions as a parameter"))
}

/// Lowers `main`; with functions that it need not call, these and all constants and uniforms.
fn lower_with(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
    wanted: Option<&[FunctionId]>,
) -> Result<naga::Module, Vec<Diagnostic>> {
    let Some(shader) = program.stage(stage) else {
        let message = format!("the program `{}` has no {} stage", program.name, stage.name());
        return Err(vec![Diagnostic::new(&general::INTERNAL, Span::default(), message)]);
    };
    // What a vertex stage passes to a geometry stage is no varying that a target could have.
    if let Some(geometry) = program.stage(Stage::Geometry).filter(|_| stage != Stage::Fragment) {
        return Err(vec![no_geometry(geometry)]);
    }
    let chosen = select(&program.types, shader, Choice::Samplers).map_err(|diagnostic| vec![*diagnostic])?;
    let shader = chosen.as_ref();
    let mut facts = Facts::of(shader, wanted.unwrap_or_default());
    if wanted.is_some() {
        if let Some(refused) = without_an_entry_point(shader, &facts) {
            return Err(vec![*refused]);
        }
        facts.use_all_uniforms(shader);
    }
    facts.loops_after_discard = discards::guarded_loops(shader, &facts.functions, &facts.order);
    let nesting = facts.functions.iter().map(|function| function.depth).max().unwrap_or(0);
    // A statement and its contents take several stack frames; an expression takes one or two.
    glisten_front::stack::with_stack(shader.depth.saturating_add(nesting.saturating_mul(4)), || {
        Lower::new(program, shader, target, conventions, facts).run(wanted.is_some())
    })
}

fn no_geometry(shader: &Shader) -> Diagnostic {
    let span = shader.main.map_or(Span::default(), |main| shader.function(main).span);
    Diagnostic::new(&targets::STAGE_NOT_IN_TARGET, span, "of glisten's targets only GLSL has a geometry stage")
        .here("the entry point of a geometry shader")
        .help("compute the emitted vertices in a vertex shader that is drawn once for each of them")
}

/// The state of lowering one stage.
struct Lower<'a> {
    types: &'a Types,
    shader: &'a Shader,
    interface: &'a Interface,
    target: Target,
    conventions: &'a Conventions,
    facts: Facts,
    module: naga::Module,
    layouter: naga::proc::Layouter,
    values: FxHashMap<glisten_front::hir::TypeId, naga::Handle<naga::Type>>,
    hosts: uniforms::Hosts,
    globals: Vec<GlobalSlot>,
    samplers: FxHashMap<GlobalId, Vec<samplers::SamplerVariables>>,
    framebuffer_height: Option<(naga::Handle<naga::GlobalVariable>, u32)>,
    /// For each offset of a hidden number of texels: its block and the member in it.
    texel_counts: FxHashMap<u32, (naga::Handle<naga::GlobalVariable>, u32)>,
    functions: Vec<Option<Lowered>>,
    helpers: aggregates::Helpers,
    hidden: Vec<(u32, naga::Handle<naga::GlobalVariable>)>,
    /// Whether the fragment stage reads the number of its primitive.
    reads_primitive_id: bool,
    /// The uniform buffer with the viewport's size, where points are drawn as quads.
    viewport: Option<naga::Handle<naga::GlobalVariable>>,
    /// Whether the invocation has been discarded, in targets where it continues and a loop has to know.
    discarded: Option<naga::Handle<naga::GlobalVariable>>,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Lower<'a> {
    /// The means of the target.
    fn can(&self) -> Capabilities {
        self.target.capabilities()
    }

    fn new(
        program: &'a Program,
        shader: &'a Shader,
        target: Target,
        conventions: &'a Conventions,
        facts: Facts,
    ) -> Self {
        Self {
            types: &program.types,
            shader,
            interface: &program.interface,
            target,
            conventions,
            facts,
            module: naga::Module::default(),
            layouter: naga::proc::Layouter::default(),
            values: FxHashMap::default(),
            hosts: uniforms::Hosts::default(),
            globals: vec![GlobalSlot::Unused; shader.globals.len()],
            samplers: FxHashMap::default(),
            framebuffer_height: None,
            texel_counts: FxHashMap::default(),
            functions: vec![None; shader.functions.len()],
            helpers: aggregates::Helpers::default(),
            hidden: Vec::new(),
            reads_primitive_id: program.stage(Stage::Fragment).is_some_and(sprites::reads_primitive_id),
            viewport: None,
            discarded: None,
            diagnostics: Vec::new(),
        }
    }

    /// Lowers all functions that are reached, and the constants that none of them reads if these are asked for.
    fn run(mut self, has_all_constants: bool) -> Result<naga::Module, Vec<Diagnostic>> {
        let constants = if has_all_constants { self.declare_constants() } else { Ok(()) };
        if let Err(diagnostic) = constants.and_then(|()| self.declare_globals()) {
            self.diagnostics.push(*diagnostic);
            return Err(self.diagnostics);
        }
        for id in self.facts.order.clone() {
            let lowered = if Some(id) == self.shader.main { self.entry_point(id) } else { self.function(id) };
            if let Err(diagnostic) = lowered {
                self.diagnostics.push(*diagnostic);
                // Every caller of a function that could not be lowered would only report the same.
                return Err(self.diagnostics);
            }
        }
        if self.diagnostics.is_empty() { Ok(self.module) } else { Err(self.diagnostics) }
    }

    fn global_slot(&self, id: GlobalId) -> &GlobalSlot {
        self.globals.get(id.index()).unwrap_or(&GlobalSlot::Unused)
    }

    fn lowered(&self, id: FunctionId) -> Option<&Lowered> {
        self.functions.get(id.index())?.as_ref()
    }
}

/// An internal error of glisten.
fn internal(span: Span, message: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(&general::INTERNAL, span, message))
}

/// The diagnostic for something that glisten knows but does not support.
fn unsupported(span: Span, message: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(&general::NOT_SUPPORTED_YET, span, message))
}

/// The diagnostic for something that the target lacks, with a way out.
fn lacking(span: Span, message: impl Into<String>, help: impl Into<Advice>) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(&targets::FEATURE_NOT_IN_TARGET, span, message).help(help))
}

/// The span as naga's type.
fn naga_span(span: Span) -> naga::Span {
    naga::Span::new(span.start, span.end)
}
