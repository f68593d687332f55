//! Facts about a shader that the lowering needs before it starts: calls, writes, side effects.
//!
//! *In:* a [`Shader`]. *Out:* [`Facts`]. *Holds:* nothing here recurses over expressions. The arena stores children
//! before their parents, so one pass over it is enough; functions are traversed with work lists.

use glisten_front::hir::{
    ExprId, ExprKind, Function, FunctionId, GlobalId, LocalId, LocalKind, ScalarValue, Shader, Stmt, StmtKind, Storage,
    VarRef, may_act, written_by,
};
use rustc_hash::FxHashSet;

/// The possible effects of an expression besides yielding a value.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Nature {
    /// Whether it writes, or calls a function of the shader.
    pub(super) effects: bool,
    /// Whether it samples a texture or takes a derivative, so that it depends on control flow.
    pub(super) control: bool,
    /// Whether its value may be known before the shader runs: it consists of literals and constants.
    pub(super) constant: bool,
    /// The number of its nodes, saturating.
    pub(super) cost: u32,
}

/// Facts about a function.
#[derive(Clone, Debug, Default)]
pub(super) struct FunctionFacts {
    /// For each local: whether it is assigned after its declaration, passed to an `out` parameter, or indexed by a
    /// variable.
    pub(super) needs_variable: Vec<bool>,
    /// For each local: whether it is assigned after its declaration or passed to an `out` parameter.
    pub(super) written: Vec<bool>,
    /// The globals that it uses.
    pub(super) globals: Vec<GlobalId>,
    /// The functions that it calls.
    pub(super) calls: Vec<FunctionId>,
    /// The depth of its nested statements.
    pub(super) depth: u32,
    /// For each local: how often the function writes to it after its declaration, saturating.
    writes: Vec<u8>,
    /// Whether it contains a `discard`.
    pub(super) discards: bool,
}

/// Loops by the first and the last byte of their statements.
pub(super) type GuardedLoops = FxHashSet<(u32, u32)>;

/// Facts about a shader.
#[derive(Clone, Debug, Default)]
pub(super) struct Facts {
    /// The nature of each expression.
    pub(super) natures: Vec<Nature>,
    /// The facts of each function.
    pub(super) functions: Vec<FunctionFacts>,
    /// The functions that `main` reaches, callees before callers, `main` last.
    pub(super) order: Vec<FunctionId>,
    /// For each global: whether a function other than `main`, or the initializer of another global, uses it.
    pub(super) shared: Vec<bool>,
    /// For each global: whether anything that `main` reaches uses it.
    pub(super) used: Vec<bool>,
    /// For each global: whether it is indexed by a variable.
    pub(super) indexed: Vec<bool>,
    /// The loops that a discarded invocation may run, and that do not evidently end, by the first and the last byte of
    /// their statements; set by `discards`.
    pub(super) loops_after_discard: GuardedLoops,
}

impl Facts {
    /// Collects the facts about a shader. `wanted` is reached as if `main` called it.
    pub(super) fn of(shader: &Shader, wanted: &[FunctionId]) -> Self {
        let mut facts = Self {
            natures: Vec::new(),
            functions: Vec::new(),
            order: Vec::new(),
            shared: vec![false; shader.globals.len()],
            used: vec![false; shader.globals.len()],
            indexed: vec![false; shader.globals.len()],
            loops_after_discard: GuardedLoops::default(),
        };
        let mut constants = vec![false; shader.exprs.len()];
        for function in &shader.functions {
            let walked = FunctionWalk::new(shader, function, &mut facts.indexed, &mut constants).run();
            facts.functions.push(walked);
        }
        if let Some(main) = shader.main.and_then(|main| facts.functions.get_mut(main.index())) {
            main.calls.extend(initializer_calls(shader));
            main.calls.extend(wanted);
        }
        facts.natures = natures(shader, &constants);
        facts.order = order(shader, &facts.functions);
        facts.mark_globals(shader);
        facts
    }

    /// The facts of a function.
    pub(super) fn function(&self, id: FunctionId) -> Option<&FunctionFacts> {
        self.functions.get(id.index())
    }

    /// The nature of an expression.
    pub(super) fn nature(&self, id: ExprId) -> Nature {
        self.natures.get(id.index()).copied().unwrap_or_default()
    }

    /// Takes all uniforms for used.
    pub(super) fn use_all_uniforms(&mut self, shader: &Shader) {
        for (index, _) in shader.globals.iter().enumerate().filter(|(_, global)| global.storage == Storage::Uniform) {
            set(&mut self.used, index);
        }
    }

    fn mark_globals(&mut self, shader: &Shader) {
        for &function in &self.order {
            let Some(known) = self.functions.get(function.index()) else { continue };
            for global in &known.globals {
                set(&mut self.used, global.index());
                if Some(function) != shader.main {
                    set(&mut self.shared, global.index());
                }
            }
        }
        // Initializers of private globals run at the start of `main`, but only those of globals in use.
        for (index, global) in shader.globals.iter().enumerate().rev() {
            if !self.used.get(index).copied().unwrap_or(false) || global.value.is_some() {
                continue;
            }
            let Some(initializer) = global.initializer else { continue };
            let mut work = vec![initializer];
            while let Some(id) = work.pop() {
                if let ExprKind::Var(VarRef::Global(named)) = shader.expr(id).kind {
                    set(&mut self.used, named.index());
                    set(&mut self.shared, named.index());
                }
                work.extend(shader.expr(id).kind.children());
            }
        }
    }
}

/// The functions that the initializers of private globals call. They run at the start of `main`.
fn initializer_calls(shader: &Shader) -> Vec<FunctionId> {
    let mut calls = Vec::new();
    for global in shader.globals.iter().filter(|global| global.used && global.storage == Storage::Private) {
        let Some(initializer) = global.initializer else { continue };
        shader.visit_expr(initializer, &mut |expr| {
            if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                calls.push(callee);
            }
        });
    }
    calls.sort_unstable();
    calls.dedup();
    calls
}

fn set(flags: &mut [bool], index: usize) {
    if let Some(flag) = flags.get_mut(index) {
        *flag = true;
    }
}

/// The nature of each expression. `constants` says which expressions are local constants, which only their function
/// knows.
fn natures(shader: &Shader, constants: &[bool]) -> Vec<Nature> {
    let mut all: Vec<Nature> = Vec::with_capacity(shader.exprs.len());
    for (expr, constant) in shader.exprs.iter().zip(constants) {
        let mut nature = own_nature(shader, &expr.kind, *constant);
        expr.kind.children().into_iter().for_each(|child| {
            if let Some(known) = all.get(child.index()) {
                nature.effects |= known.effects;
                nature.control |= known.control;
                nature.constant &= known.constant;
                nature.cost = nature.cost.saturating_add(known.cost);
            }
        });
        all.push(nature);
    }
    all
}

fn own_nature(shader: &Shader, kind: &ExprKind, local_constant: bool) -> Nature {
    let effects = may_act(kind);
    let control = match kind {
        ExprKind::BuiltinCall(function, _) => function.implicit_derivatives(),
        _ => false,
    };
    let constant = match kind {
        ExprKind::Var(VarRef::Global(global)) => shader.global(*global).storage == Storage::Const,
        ExprKind::Var(VarRef::Local(_)) => local_constant,
        _ => !effects && !control,
    };
    Nature { effects, control, constant, cost: 1 }
}

struct FunctionWalk<'a> {
    shader: &'a Shader,
    function: &'a Function,
    facts: FunctionFacts,
    indexed: &'a mut [bool],
    constants: &'a mut [bool],
    roots: Vec<ExprId>,
}

impl<'a> FunctionWalk<'a> {
    fn new(shader: &'a Shader, function: &'a Function, indexed: &'a mut [bool], constants: &'a mut [bool]) -> Self {
        let locals = function.locals.len();
        let facts = FunctionFacts {
            needs_variable: vec![false; locals],
            written: vec![false; locals],
            writes: vec![0; locals],
            ..FunctionFacts::default()
        };
        Self { shader, function, facts, indexed, constants, roots: Vec::new() }
    }

    fn run(mut self) -> FunctionFacts {
        if let Some(body) = &self.function.body {
            self.statements(body);
        }
        while let Some(id) = self.roots.pop() {
            let kind = &self.shader.expr(id).kind;
            if let ExprKind::Var(VarRef::Local(local)) = kind {
                let local = self.function.local(*local);
                if local.kind == LocalKind::Const && local.value.is_some() {
                    set(self.constants, id.index());
                }
            }
            self.expression(id);
            self.roots.extend(kind.children());
        }
        self.facts.globals.sort_unstable();
        self.facts.globals.dedup();
        self.facts.calls.sort_unstable();
        self.facts.calls.dedup();
        self.facts
    }

    fn statements(&mut self, body: &'a [Stmt]) {
        let mut work: Vec<(&Stmt, u32)> = body.iter().map(|stmt| (stmt, 1)).collect();
        while let Some((stmt, depth)) = work.pop() {
            self.facts.depth = self.facts.depth.max(depth);
            let mut inner = |body: &'a [Stmt]| work.extend(body.iter().map(|stmt| (stmt, depth + 1)));
            match &stmt.kind {
                StmtKind::Expr(id) => self.roots.push(*id),
                StmtKind::Local(_, initializer) => self.roots.extend(initializer),
                StmtKind::Block(body) => inner(body),
                StmtKind::If { arms, otherwise } => {
                    for (condition, body) in arms {
                        self.roots.push(*condition);
                        inner(body);
                    }
                    inner(otherwise);
                }
                StmtKind::Switch { selector, cases } => {
                    self.roots.push(*selector);
                    cases.iter().for_each(|case| inner(&case.body));
                }
                StmtKind::Loop { condition, step, body, .. } => {
                    if let Some(condition) = condition {
                        self.roots.push(condition.expr);
                    }
                    self.roots.extend(step);
                    inner(body);
                }
                StmtKind::Return(value) => self.roots.extend(value),
                StmtKind::Discard => self.facts.discards = true,
                StmtKind::Break | StmtKind::Continue => {}
            }
        }
    }

    fn expression(&mut self, id: ExprId) {
        let shader = self.shader;
        written_by(shader, id, &mut |target| self.write(target));
        match &shader.expr(id).kind {
            ExprKind::Var(VarRef::Global(global)) => self.facts.globals.push(*global),
            ExprKind::Call(callee, _) => self.facts.calls.push(*callee),
            ExprKind::Index(base, index) if !self.is_constant(*index) => match shader.root_variable(*base) {
                Some(VarRef::Local(local)) => self.local(local, false),
                Some(VarRef::Global(global)) => set(self.indexed, global.index()),
                None => {}
            },
            _ => {}
        }
    }

    fn write(&mut self, target: ExprId) {
        if let Some(VarRef::Local(local)) = self.shader.root_variable(target) {
            self.local(local, true);
        }
    }

    /// Whether an index is a literal or a constant.
    fn is_constant(&self, id: ExprId) -> bool {
        match self.shader.expr(id).kind {
            ExprKind::Literal(_) => true,
            ExprKind::Var(VarRef::Global(global)) => self.shader.global(global).storage == Storage::Const,
            ExprKind::Var(VarRef::Local(local)) => self.function.local(local).kind == LocalKind::Const,
            _ => false,
        }
    }

    fn local(&mut self, local: LocalId, written: bool) {
        set(&mut self.facts.needs_variable, local.index());
        if written {
            set(&mut self.facts.written, local.index());
            if let Some(count) = self.facts.writes.get_mut(local.index()) {
                *count = count.saturating_add(1);
            }
        }
    }
}

/// Whether a loop evidently ends: its condition compares an `int` with something constant, and only its step changes
/// the `int`, towards the end.
pub(super) fn is_counted(
    shader: &Shader,
    facts: &FunctionFacts,
    condition: Option<ExprId>,
    step: Option<ExprId>,
) -> bool {
    use glisten_front::hir::{BinaryOp, IncDec, TypeId};
    let (Some(condition), Some(step)) = (condition, step) else { return false };
    let ExprKind::Binary(op, left, right) = shader.expr(condition).kind else { return false };
    let upward = match op {
        BinaryOp::Less | BinaryOp::LessEqual => true,
        BinaryOp::Greater | BinaryOp::GreaterEqual => false,
        _ => return false,
    };
    let ExprKind::Var(VarRef::Local(counter)) = shader.expr(left).kind else { return false };
    let moved = match &shader.expr(step).kind {
        ExprKind::IncDec(kind, target) => {
            let up = matches!(kind, IncDec::PreIncrement | IncDec::PostIncrement);
            (up == upward).then_some(*target)
        }
        ExprKind::Assign(Some(op), target, amount) => {
            let along = if upward { BinaryOp::Add } else { BinaryOp::Sub };
            let positive = matches!(shader.expr(*amount).kind, ExprKind::Literal(ScalarValue::Int(value)) if value > 0);
            (*op == along && positive).then_some(*target)
        }
        _ => None,
    };
    let moves_counter = moved.is_some_and(
        |target| matches!(shader.expr(target).kind, ExprKind::Var(VarRef::Local(local)) if local == counter),
    );
    let stays = match shader.expr(right).kind {
        ExprKind::Literal(_) => true,
        ExprKind::Var(VarRef::Global(global)) => {
            matches!(shader.global(global).storage, Storage::Const | Storage::Uniform)
        }
        ExprKind::Var(VarRef::Local(local)) => facts.writes.get(local.index()) == Some(&0),
        _ => false,
    };
    let only_step = facts.writes.get(counter.index()) == Some(&1);
    shader.expr(left).ty == TypeId::INT && moves_counter && stays && only_step
}

/// The functions, callees first. The call graph has no cycles (§6.1), and the traversal has a stack of its own.
fn order(shader: &Shader, functions: &[FunctionFacts]) -> Vec<FunctionId> {
    let Some(main) = shader.main else { return Vec::new() };
    let mut done = vec![false; functions.len()];
    let mut order = Vec::new();
    let mut stack = vec![(main, 0_usize)];
    while let Some((id, next)) = stack.pop() {
        if done.get(id.index()).copied().unwrap_or(true) {
            continue;
        }
        let callee = functions.get(id.index()).and_then(|facts| facts.calls.get(next)).copied();
        match callee {
            Some(callee) => {
                stack.push((id, next + 1));
                // A function that is already on the stack would be recursive, which the analysis rejects.
                if !stack.iter().any(|(open, _)| *open == callee) {
                    stack.push((callee, 0));
                }
            }
            None => {
                set(&mut done, id.index());
                order.push(id);
            }
        }
    }
    order
}
