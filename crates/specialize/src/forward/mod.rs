//! The forward walk: evaluates a stage with what is known, and writes down what is left to do.
//!
//! *In:* a stage, and facts of its globals. *Out:* a [`Walked`] stage: the same program with decided branches gone, loops
//! unrolled where that pays and functions cloned by what they are called with; next to each expression is what is known
//! of it, each variable still being read and written as it was. So it means the same as before, whatever is done with the
//! facts later.
//!
//! *Holds:* the work is bounded by [`Forward::fuel`], a multiple of the program's size: when it is spent loops are kept and
//! functions are walked once for all their calls. Calls nest as deep as the source likes; beyond [`DEEPEST`] they are
//! walked on their own.

mod calls;
mod effects;
mod expressions;
mod loops;
mod places;
mod reasons;
mod refine;
mod selections;
mod statements;
mod store;
mod tallies;

pub(crate) use effects::Effects;
pub(crate) use reasons::{Reason, Reasons};

use super::facts::{Fact, Facts};
use super::known::KnownTexture;
use super::options::{Extent, Math, Options};
use calls::Variants;
use glisten_front::hir::{
    ExprId, ExprKind, FunctionId, GlobalId, LocalId, Shader, Stmt, Storage, TypeId, Types, VarRef, may_act,
};
use glisten_front::source::Span;
use glisten_front::stack::with_stack;
use rustc_hash::FxHashMap;
use store::{Changes, Key, Mark, Store};

/// How deep calls are walked in one another.
const DEEPEST: usize = 24;
/// Facts of at most so many scalars are kept next to an expression.
const NOTED: usize = 16;
/// Of larger variables nothing is followed but what the scene fixes.
const FOLLOWED: u32 = 1024;

/// What is known of an expression where it stands.
#[derive(Clone, Debug, Default)]
pub(crate) struct Note {
    /// Its scalars; empty if nothing is known or it is large.
    pub(crate) facts: Facts,
    /// Whether evaluating it changes nothing.
    pub(crate) pure: bool,
    /// Whether it is a scalar, a vector or a matrix.
    pub(crate) basic: bool,
}

/// A stage that was walked.
pub(crate) struct Walked {
    /// What is left to do. Its functions are clones: `main`, and one for each way in which a function is called.
    pub(crate) shader: Shader,
    /// One for each expression.
    pub(crate) notes: Vec<Note>,
    /// What a compound assignment or `++` found in its target, by the expression.
    pub(crate) before: FxHashMap<ExprId, Facts>,
    /// For each function of `shader` the one that it is a clone of.
    pub(crate) origins: Vec<FunctionId>,
    /// What was decided, by the place of the condition.
    pub(crate) reasons: Reasons,
    /// What the globals hold when the stage ends.
    pub(crate) ends: Vec<Facts>,
    /// Globals that are named as a whole: by one of the expressions, and how often.
    pub(crate) named: FxHashMap<GlobalId, (ExprId, u32)>,
    /// What was taken for granted of numbers.
    pub(crate) math: Math,
    /// For each expression whether somebody sees the sign of its zeros; empty until that is found out.
    pub(crate) signs: Vec<bool>,
    /// For each expression whether an operation of a stage sees the sign of its zeros, and not only somebody outside.
    pub(crate) looked_at: Vec<bool>,
    /// By how many expressions each loop that was written out became longer, without the loops in it.
    pub(crate) written_out: FxHashMap<Span, u64>,
}

/// A value: the expression that gives it, and what is known of it.
struct Val {
    id: ExprId,
    facts: Facts,
}

/// A call under way.
struct Frame {
    function: FunctionId,
    /// The key of its first local.
    base: u32,
    mark: Mark,
    /// What was changed at each `return`.
    exits: Vec<Changes>,
    /// What is returned, as far as it was seen.
    result: Option<Facts>,
}

/// What a `break` or `continue` leads out of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Target {
    /// A loop or switch that is kept.
    Kept { is_loop: bool },
    /// One that is written out, how many open branches it is in, and the jumps under open conditions that may stay in it.
    Flat { is_loop: bool, forks: usize, open: Option<Jump> },
}

/// A jump out of an iteration or a loop.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Jump {
    Break,
    Continue,
}

/// The walk.
pub(crate) struct Forward<'a> {
    types: &'a Types,
    shader: &'a Shader,
    textures: &'a [Option<KnownTexture>],
    effects: Effects,
    out: Shader,
    notes: Vec<Note>,
    before: FxHashMap<ExprId, Facts>,
    origins: Vec<FunctionId>,
    reasons: Reasons,
    /// The decided condition by which control left the body that is walked.
    left_by: Option<Span>,
    named: FxHashMap<GlobalId, (ExprId, u32)>,
    store: Store,
    frames: Vec<Frame>,
    targets: Vec<Target>,
    variants: Variants,
    /// How many branches are open that stay in the program.
    forks: usize,
    /// How many loops around are kept.
    jump: Option<Jump>,
    /// A loop or switch that is being written out cannot be.
    failed: bool,
    /// The jump under an open condition because of which it failed.
    blocked: Option<Jump>,
    /// What was changed at each jump that stays in a loop that is being written out.
    leaving: Vec<Changes>,
    /// The mark of the journal when the innermost loop with such jumps began, or its iteration.
    leaving_since: Mark,
    /// Expressions that may still be written for loops and clones.
    fuel: u64,
    /// Expressions written so far of which something is open.
    weight: u64,
    /// What is taken for granted of numbers.
    math: Math,
    /// How much may be written out.
    extent: Extent,
    /// Loops that stay loops.
    kept: &'a [Span],
    /// By how many expressions each loop that was written out became longer.
    written_out: FxHashMap<Span, u64>,
    /// The expressions of loops in the present one.
    inner: u64,
}

/// Walks a stage. `inputs` are the facts of its globals, `textures` those of the interface's sampler slots; `options` say how
/// much may be written out, and what is taken for granted of numbers.
pub(crate) fn walk(
    types: &Types,
    shader: &Shader,
    inputs: Vec<Vec<Fact>>,
    textures: &[Option<KnownTexture>],
    options: &Options<'_>,
) -> Walked {
    with_stack(shader.depth.saturating_mul(2).saturating_add(4096), move || {
        let mut forward = Forward::new(types, shader, textures);
        forward.math = options.math;
        forward.extent = options.extent;
        forward.kept = options.kept;
        if options.extent > Extent::LoopsKept {
            forward.fuel = 0;
        }
        forward.run(inputs);
        let ends = forward.ends();
        let Forward { out, notes, before, origins, reasons, named, written_out, .. } = forward;
        let (signs, looked_at, math) = (Vec::new(), Vec::new(), options.math);
        Walked { shader: out, notes, before, origins, reasons, ends, named, math, signs, looked_at, written_out }
    })
}

impl<'a> Forward<'a> {
    fn new(types: &'a Types, shader: &'a Shader, textures: &'a [Option<KnownTexture>]) -> Self {
        let out = Shader { globals: shader.globals.clone(), ..shader.emptied() };
        Self {
            types,
            shader,
            textures,
            effects: Effects::of(shader, shader.functions().map(|(id, _)| id)),
            out,
            notes: Vec::new(),
            before: FxHashMap::default(),
            origins: Vec::new(),
            reasons: Reasons::default(),
            left_by: None,
            named: FxHashMap::default(),
            store: Store::live(),
            frames: Vec::new(),
            targets: Vec::new(),
            variants: Variants::default(),
            forks: 0,
            jump: None,
            failed: false,
            blocked: None,
            leaving: Vec::new(),
            leaving_since: Mark::default(),
            fuel: shader.exprs.len() as u64 * 6 + 20_000,
            weight: 0,
            math: Math::Exact,
            extent: Extent::All,
            kept: &[],
            written_out: FxHashMap::default(),
            inner: 0,
        }
    }

    fn run(&mut self, inputs: Vec<Vec<Fact>>) {
        for facts in inputs {
            self.store.push(facts);
        }
        for index in 0..self.shader.globals.len() {
            self.initialize(index);
        }
        if let Some(main) = self.shader.main {
            let clone = self.clone_of(main);
            let body = self.shader.function(main).body.as_deref().unwrap_or(&[]);
            let (body, _) = self.walk_body(main, body, &[]);
            self.finish_clone(clone, body);
            self.out.main = Some(clone);
        }
    }

    /// The initializer of a private global runs before `main`.
    fn initialize(&mut self, index: usize) {
        let Some(global) = self.shader.globals.get(index) else { return };
        let Some(initializer) = global.initializer else { return };
        if global.storage != Storage::Private {
            // Of a constant or a uniform the value is known, and says the same.
            if let Some(global) = self.out.globals.get_mut(index) {
                global.initializer = None;
            }
            return;
        }
        let value = self.eval(initializer);
        self.store.set(Key(index as u32), std::rc::Rc::new(value.facts.into_vec()));
        if let Some(global) = self.out.globals.get_mut(index) {
            global.initializer = Some(value.id);
        }
    }

    /// What the globals hold now; then the clones that stand for all other calls are walked.
    fn ends(&mut self) -> Vec<Facts> {
        let globals = 0..self.shader.globals.len() as u32;
        let ends = globals.map(|index| Facts::from_slice(self.store.get(Key(index)))).collect();
        self.walk_general();
        ends
    }

    /// Writes an expression down.
    fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span, facts: &[Fact]) -> ExprId {
        let pure = self.is_pure_kind(&kind)
            && kind.children().iter().all(|child| self.notes.get(child.index()).is_some_and(|note| note.pure));
        let facts = if facts.len() <= NOTED { Facts::from_slice(facts) } else { Facts::new() };
        let open = facts.is_empty() || facts.iter().any(|fact| fact.value().is_none());
        self.weight += u64::from(open);
        self.fuel = self.fuel.saturating_sub(1);
        self.notes.push(Note { facts, pure, basic: self.types.scalar_of(ty).is_some() });
        let variable = if let ExprKind::Var(VarRef::Global(global)) = kind { Some(global) } else { None };
        let id = self.out.push(kind, ty, span);
        if let Some(global) = variable {
            self.named.entry(global).or_insert((id, 0)).1 += 1;
        }
        id
    }

    fn is_pure_kind(&self, kind: &ExprKind) -> bool {
        match kind {
            ExprKind::Call(clone, arguments) => {
                let Some(origin) = self.origins.get(clone.index()) else { return false };
                let effect = self.effects.function(*origin);
                let function = self.shader.function(*origin);
                let mut given = 0..arguments.len();
                !effect.ends && effect.writes.is_empty() && given.all(|index| is_in(function.param_mode(index)))
            }
            kind => !may_act(kind),
        }
    }

    fn is_pure(&self, id: ExprId) -> bool {
        self.notes.get(id.index()).is_some_and(|note| note.pure)
    }

    /// The store's key of a variable.
    fn key(&self, variable: VarRef) -> Key {
        match variable {
            VarRef::Global(id) => Key(id.index() as u32),
            VarRef::Local(id) => self.local_key(id),
        }
    }

    fn local_key(&self, id: LocalId) -> Key {
        Key(self.frames.last().map_or(0, |frame| frame.base) + id.index() as u32)
    }

    /// Whether loops may be written out and functions cloned.
    fn may_grow(&self) -> bool {
        self.fuel > 0
    }

    /// Notes what was decided at a place. It is walked once for each call and round, which may decide it otherwise.
    fn tell(&mut self, place: Span, reason: Reason) {
        self.reasons.tell(place, reason);
    }

    fn statement(kind: glisten_front::hir::StmtKind, span: Span) -> Stmt {
        Stmt { kind, span }
    }
}

/// Whether a parameter only takes a value.
pub(crate) fn is_in(mode: glisten_front::hir::ParamMode) -> bool {
    matches!(mode, glisten_front::hir::ParamMode::In | glisten_front::hir::ParamMode::ConstIn)
}
