//! Compiles HIR to instructions.
//!
//! Functions are inlined (GLSL has no recursion). A call that would be too long is an instruction that ends the run if a lane
//! reaches it, because a branch that is never taken may contain more calls than any machine could make. Each scalar of a variable is either a computed value (which is not
//! copied) or is in its *home* register. The code between two points where lanes diverge or join is a *region*.
//! Inside the region that declares a variable, an assignment only records the new value. Before a construct whose
//! parts assign to the variable under a narrower mask, the variable moves to its home, where stores are masked.
//!
//! What depends only on constants and uniforms goes into the preamble ([`Emitter::pure`]).

mod affine;
mod alloc;
mod bits;
mod builtin;
mod chains;
mod dead;
mod effects;
mod emission;
mod emit;
mod ends;
mod expr;
mod facts;
mod fuse;
mod matrix;
mod note;
mod open;
mod path;
mod stmt;
mod texture;
mod vars;

use super::code::{Code, Form, Inner, Port, Runs, Section};
use super::inst::{Class, Operand, Slot};
use effects::Effects;
use emit::Emitter;
use glisten_front::diagnostic::{Code as DiagnosticCode, Diagnostic, codes};
use glisten_front::hir::{ExprId, FunctionId, Scalar, Shader, Stage, Storage, Type, TypeId, Types};
use glisten_front::link::Program;
use glisten_front::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;
use std::rc::Rc;
use std::sync::Arc;
use vars::{Var, VarId};

/// The largest number of scalars in one value.
const MAX_SCALARS: u32 = 1 << 20;
/// The largest number of instructions of a stage, with all calls inlined.
const MAX_INSTRUCTIONS: usize = 1 << 20;

/// The scalars of a value, in flat order.
type Val = SmallVec<[Operand; 4]>;

/// A construct around the current code, as far as leaving it matters.
enum Scope {
    /// Lanes wait in the slot until the selection ends.
    Arms {
        join: Slot,
    },
    Switch {
        join: Slot,
    },
    Loop {
        join: Slot,
        active: Slot,
    },
    /// An inlined call, or `main`.
    Function,
}

/// An inlined function.
struct Frame {
    function: FunctionId,
    locals: Vec<Option<VarId>>,
    result: Option<VarId>,
    /// Whether lanes may leave before the end.
    parts: bool,
}

struct Compiler<'a> {
    types: &'a Types,
    shader: &'a Shader,
    program: &'a Program,
    emit: Emitter,
    effects: Effects,
    /// For each function, how long it is with its calls written out.
    sizes: Vec<u64>,
    vars: Vec<Var>,
    globals: Vec<Option<VarId>>,
    inputs: Vec<Port>,
    /// The noise of inputs.
    noises: Vec<Port>,
    frames: Vec<Frame>,
    scopes: Vec<Scope>,
    region: u32,
    regions: u32,
    /// Whether lanes have left a function that continues without them: variables that outlive it are stored with a
    /// mask.
    parted: bool,
    classes: FxHashMap<TypeId, Rc<[Class]>>,
    /// The constants whose value is undefined.
    open: FxHashSet<VarId>,
    /// The declarations of the variables that are read before anything was written to them.
    unwritten: Vec<Span>,
    errors: Vec<Diagnostic>,
}

impl Code {
    /// Compiles a stage of a program.
    ///
    /// # Errors
    /// Returns diagnostics if the executor does not support something: a program without that stage or without
    /// `main`, programs above the limits of the compiler.
    pub fn compile(program: &Program, stage: Stage) -> Result<Self, Vec<Diagnostic>> {
        Self::compile_as(program, stage, Form::Fast)
    }

    /// Compiles a stage of a program in a form.
    ///
    /// # Errors
    /// Those of [`Self::compile`].
    pub fn compile_as(program: &Program, stage: Stage, form: Form) -> Result<Self, Vec<Diagnostic>> {
        compile(program, stage, form).map(|inner| Self { inner: Arc::new(inner) })
    }
}

/// Compiles a stage. Returns diagnostics if the executor does not support it.
fn compile(program: &Program, stage: Stage, form: Form) -> Result<Inner, Vec<Diagnostic>> {
    let missing = |what: &str| {
        let message = format!("`{}` has no {what} for the CPU reference to run", program.name);
        vec![Diagnostic::new(&codes::general::NOT_SUPPORTED_YET, Span::default(), message)]
    };
    let Some(shader) = program.stage(stage) else { return Err(missing(&format!("{} stage", stage.name()))) };
    let Some(main) = shader.main else { return Err(missing("`main`")) };
    shader.on_stack(|| Compiler::new(program, shader, form).run(main))
}

impl<'a> Compiler<'a> {
    fn new(program: &'a Program, shader: &'a Shader, form: Form) -> Self {
        Self {
            types: &program.types,
            shader,
            program,
            emit: Emitter::new(form),
            effects: Effects::of(shader),
            sizes: shader.written_out(),
            vars: Vec::new(),
            globals: vec![None; shader.globals.len()],
            inputs: Vec::new(),
            noises: Vec::new(),
            frames: Vec::new(),
            scopes: Vec::new(),
            region: 0,
            regions: 0,
            parted: false,
            classes: FxHashMap::default(),
            open: FxHashSet::default(),
            unwritten: Vec::new(),
            errors: Vec::new(),
        }
    }

    fn run(mut self, main: FunctionId) -> Result<Inner, Vec<Diagnostic>> {
        self.declare_globals();
        self.note_globals(Storage::In);
        self.inline(main, Vec::new(), Span::default());
        self.note_globals(Storage::Out);
        let outputs = self.settle_outputs();
        if self.emit.main.insts.len() > MAX_INSTRUCTIONS {
            self.refuse(
                &codes::general::NOT_SUPPORTED_YET,
                Span::default(),
                "so long a program with all calls inlined",
            );
        }
        if !self.errors.is_empty() {
            return Err(self.errors);
        }
        if self.emit.form == Form::Fast {
            fuse::fuse(&mut self.emit);
        }
        if self.emit.form == Form::Counted {
            self.emit.main.dead = dead::dead(&mut self.emit, &outputs);
        }
        let emitted = self.emitted_places();
        let mut ports: Vec<Port> = self.inputs.iter().chain(&outputs).chain(&self.noises).copied().collect();
        let registers = alloc::allocate(&mut self.emit, &mut ports);
        let noises = ports.split_off(self.inputs.len() + outputs.len());
        let outputs = ports.split_off(self.inputs.len());
        let Emitter { main, preamble, words, textures, pools, preamble_results, mask_slots, splats, notes, .. } =
            self.emit;
        let [float_pool, int_pool] = pools;
        Ok(Inner {
            stage: self.shader.stage,
            preamble: Section { runs: Runs::Once, ..preamble },
            main,
            words,
            textures,
            float_pool,
            int_pool,
            preamble_results: preamble_results.map(|count| count as usize),
            registers,
            splats: splats.into_iter().map(|(class, register, from)| (class, register.number(), from)).collect(),
            inputs: ports,
            noises,
            outputs,
            emitted,
            max_vertices: self.shader.geometry.max_vertices.unwrap_or(0),
            mask_slots: mask_slots as usize,
            unwritten: self.unwritten,
            notes,
        })
    }

    /// Records that the executor does not support something.
    fn refuse(&mut self, code: &'static DiagnosticCode, span: Span, what: &str) {
        self.errors.push(Diagnostic::new(code, span, format!("the CPU reference cannot run {what} yet")));
    }

    fn ty(&self, expr: ExprId) -> TypeId {
        self.shader.expr(expr).ty
    }

    /// The class of each scalar of a type, in flat order. Samplers are ints: the numbers of their slots.
    fn classes(&mut self, ty: TypeId) -> Rc<[Class]> {
        if let Some(classes) = self.classes.get(&ty) {
            return Rc::clone(classes);
        }
        if self.types.flat_len(ty) > MAX_SCALARS {
            self.refuse(&codes::general::NOT_SUPPORTED_YET, Span::default(), "values of more than 2^20 scalars");
            return Rc::new([]);
        }
        let mut list = Vec::new();
        flatten(self.types, ty, &mut list);
        let classes: Rc<[Class]> = list.into_iter().map(Class::of).collect();
        self.classes.insert(ty, Rc::clone(&classes));
        classes
    }

    /// The class of the scalars of a scalar, vector or matrix.
    fn class(&self, ty: TypeId) -> Class {
        match self.types.scalar_of(ty) {
            Some(Scalar::Float) => Class::Float,
            _ => Class::Int,
        }
    }

    /// Runs `body` in a new region.
    fn in_region<R>(&mut self, body: impl FnOnce(&mut Self) -> R) -> R {
        self.regions += 1;
        let outer = std::mem::replace(&mut self.region, self.regions);
        let result = body(self);
        self.region = outer;
        result
    }

    /// Runs `body`; the instructions that it emits have this span, except those of expressions and statements inside.
    fn at<R>(&mut self, span: Span, body: impl FnOnce(&mut Self) -> R) -> R {
        let outer = std::mem::replace(&mut self.emit.span, span);
        let result = body(self);
        self.emit.span = outer;
        result
    }

    fn full(&self) -> bool {
        self.emit.main.insts.len() > MAX_INSTRUCTIONS || !self.errors.is_empty()
    }
}

/// Adds the type of each scalar in flat order; none of a sampler.
fn flatten(types: &Types, ty: TypeId, list: &mut Vec<Option<Scalar>>) {
    match types.get(ty) {
        Type::Error | Type::Void => {}
        Type::Sampler(_) => list.push(None),
        Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) => {
            list.extend((0..types.flat_len(ty)).map(|_| types.scalar_of(ty)));
        }
        Type::Struct(id) => types.structure(id).members.iter().for_each(|member| flatten(types, member.ty, list)),
        Type::Array(element, _) => {
            let size = types.flat_len(element);
            let start = list.len();
            flatten(types, element, list);
            let one: Vec<Option<Scalar>> = list.get(start..).unwrap_or(&[]).to_vec();
            let count = types.flat_len(ty).checked_div(size).unwrap_or(0);
            list.truncate(start);
            (0..count).for_each(|_| list.extend_from_slice(&one));
        }
    }
}
