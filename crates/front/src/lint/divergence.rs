//! Finds divergent control flow: where neighboring fragments may take different paths.
//!
//! A value is divergent if it depends on a fragment input, through data or through the conditions around its
//! assignments. A variable counts as a whole, regardless of the order of its assignments; a function by what any of
//! its calls passes. A divergent condition makes what it guards divergent. If it guards a `return`, the rest of the
//! function is divergent; if it may leave a loop, the whole loop is.

use crate::builtin::BuiltinVariable;
use crate::hir::written_by;
use crate::hir::{
    ExprId, ExprKind, FunctionId, Global, Interpolation, ParamMode, Shader, Stmt, StmtKind, Storage, VarRef,
};
use rustc_hash::FxHashMap;
use std::cell::RefCell;

/// A call of a built-in function in divergent control flow.
pub(super) struct DivergentCall {
    pub(super) expr: ExprId,
    pub(super) cause: Cause,
}

/// The reason why control flow is divergent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cause {
    /// The divergent condition.
    pub(super) condition: ExprId,
    /// The call that the condition guards, if it is in a caller.
    pub(super) call: Option<ExprId>,
}

/// The number of iterations after which the analysis gives up; real shaders need two or three.
const MAX_ROUNDS: usize = 32;

struct Divergence<'a> {
    shader: &'a Shader,
    globals: Vec<bool>,
    locals: Vec<Vec<bool>>,
    returns: Vec<bool>,
    /// For each function that is called in divergent control flow: why. The first cause found counts, since later ones may
    /// follow from it.
    called: Vec<Option<Cause>>,
    /// For each divergent loop, by its first expression: the first cause found.
    loops: FxHashMap<ExprId, ExprId>,
    /// The answers for the expressions that were asked for.
    known: RefCell<FxHashMap<ExprId, Known>>,
    /// How many variables and results have become divergent.
    taints: u32,
    changed: bool,
    calls: Option<Vec<DivergentCall>>,
    function: FunctionId,
}

/// Whether an expression may be divergent.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    /// It may, and nothing takes that back.
    Differs,
    /// It was not, when there were so many taints.
    Not(u32),
}

/// Whether control flow is divergent, and why.
#[derive(Clone, Copy)]
enum Flow {
    Uniform,
    Divergent(Cause),
}

impl Flow {
    fn because(condition: ExprId) -> Self {
        Self::Divergent(Cause { condition, call: None })
    }

    fn is_divergent(self) -> bool {
        matches!(self, Self::Divergent(_))
    }
}

/// All calls of built-in functions in divergent control flow.
pub(super) fn divergent_calls(shader: &Shader) -> Vec<DivergentCall> {
    let Some(main) = shader.main else { return Vec::new() };
    let order = shader.callees_first(main);
    let mut walk = Divergence {
        shader,
        globals: shader.globals.iter().map(differs_in_a_quad).collect(),
        locals: shader.functions.iter().map(|function| vec![false; function.locals.len()]).collect(),
        returns: vec![false; shader.functions.len()],
        called: vec![None; shader.functions.len()],
        loops: FxHashMap::default(),
        known: RefCell::default(),
        taints: 0,
        changed: true,
        calls: None,
        function: main,
    };
    for _ in 0..MAX_ROUNDS {
        walk.changed = false;
        // Callers first, for what they pass; then callees first, for what they return.
        order.iter().rev().chain(&order).for_each(|&id| walk.function(id));
        if !walk.changed {
            walk.calls = Some(Vec::new());
            order.iter().for_each(|&id| walk.function(id));
            return walk.calls.unwrap_or_default();
        }
    }
    Vec::new()
}

/// Whether an input may differ between the fragments of a quad, which belong to one primitive: a `flat` input does not
/// (§4.3.9), nor does what a primitive has as a whole.
fn differs_in_a_quad(global: &Global) -> bool {
    let of_primitive = matches!(global.builtin, Some(BuiltinVariable::PrimitiveId | BuiltinVariable::FrontFacing));
    global.storage == Storage::In && global.interpolation != Interpolation::Flat && !of_primitive
}

impl Divergence<'_> {
    fn function(&mut self, id: FunctionId) {
        self.function = id;
        let flow = self.called.get(id.index()).copied().flatten().map_or(Flow::Uniform, Flow::Divergent);
        let shader = self.shader;
        if let Some(body) = &shader.function(id).body {
            self.body(body, flow);
        }
    }

    /// Traverses a body. What follows a divergent `return` (or, in a loop, `break` and `continue`) is divergent, too.
    fn body(&mut self, body: &[Stmt], mut flow: Flow) {
        for statement in body {
            self.statement(statement, flow);
            if !flow.is_divergent()
                && let Some(condition) = self.divergent_exit(statement)
            {
                flow = Flow::because(condition);
            }
        }
    }

    /// The divergent condition under which a statement leaves the function or the loop around it.
    fn divergent_exit(&self, statement: &Stmt) -> Option<ExprId> {
        let StmtKind::If { arms, otherwise } = &statement.kind else { return None };
        let condition = arms.iter().map(|(condition, _)| *condition).find(|&condition| self.differs(condition))?;
        let leaves = |body: &[Stmt]| {
            let mut found = false;
            self.shader.visit_statements(body, &mut |statement| {
                found |= matches!(statement.kind, StmtKind::Return(_) | StmtKind::Break | StmtKind::Continue);
            });
            found
        };
        let any = arms.iter().any(|(_, body)| leaves(body)) || leaves(otherwise);
        any.then_some(condition)
    }

    fn statement(&mut self, statement: &Stmt, flow: Flow) {
        match &statement.kind {
            StmtKind::Local(id, Some(initializer)) => {
                self.expr(*initializer, flow);
                if self.differs(*initializer) || flow.is_divergent() {
                    self.taint(VarRef::Local(*id));
                }
            }
            StmtKind::Block(body) => self.body(body, flow),
            StmtKind::If { arms, otherwise } => {
                let mut flow = flow;
                for (condition, body) in arms {
                    self.expr(*condition, flow);
                    flow = self.under(*condition, flow);
                    self.body(body, flow);
                }
                self.body(otherwise, flow);
            }
            StmtKind::Switch { selector, cases } => {
                self.expr(*selector, flow);
                let flow = self.under(*selector, flow);
                cases.iter().for_each(|case| self.body(&case.body, flow));
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let condition = condition.as_ref();
                let flow = self.in_loop(condition.map(|condition| condition.expr), body, flow);
                if let Some(condition) = condition {
                    self.expr(condition.expr, flow);
                    if let Some(id) = condition.local.filter(|_| self.differs(condition.expr)) {
                        self.taint(VarRef::Local(id));
                    }
                }
                self.body(body, flow);
                step.iter().for_each(|step| self.expr(*step, flow));
            }
            StmtKind::Return(Some(value)) => {
                self.expr(*value, flow);
                if self.differs(*value) || flow.is_divergent() {
                    let function = self.function.index();
                    self.changed |= set(&mut self.returns, function, &mut self.taints);
                }
            }
            StmtKind::Expr(expr) => self.expr(*expr, flow),
            StmtKind::Local(_, None)
            | StmtKind::Return(None)
            | StmtKind::Break
            | StmtKind::Continue
            | StmtKind::Discard => {}
        }
    }

    /// The control flow in a loop. Its own condition, or that of a `break`, may make it divergent; then the counter is
    /// divergent, too, and the other condition seems to differ as well. So the one that was found first is the cause.
    fn in_loop(&mut self, condition: Option<ExprId>, body: &[Stmt], flow: Flow) -> Flow {
        if flow.is_divergent() {
            return flow;
        }
        let own = condition.filter(|&condition| self.differs(condition));
        let Some(found) = own.or_else(|| body.iter().find_map(|statement| self.divergent_exit(statement))) else {
            return flow;
        };
        let key = condition.unwrap_or(found);
        Flow::because(*self.loops.entry(key).or_insert(found))
    }

    fn under(&self, condition: ExprId, flow: Flow) -> Flow {
        if !flow.is_divergent() && self.differs(condition) { Flow::because(condition) } else { flow }
    }

    /// Whether the value may be divergent. Each operand is looked at once, until there is another taint: a chain `a && b && c` asks for
    /// each of its parts.
    fn differs(&self, root: ExprId) -> bool {
        let mut known = self.known.borrow_mut();
        let current = Known::Not(self.taints);
        let mut pending = vec![(root, false)];
        while let Some((id, is_after)) = pending.pop() {
            let told = known.get(&id).copied().filter(|told| *told == Known::Differs || *told == current);
            if told.is_some() {
                continue;
            }
            let kind = &self.shader.expr(id).kind;
            if is_after {
                let any = kind.children().into_iter().any(|child| known.get(&child) == Some(&Known::Differs));
                known.insert(id, if any { Known::Differs } else { current });
            } else if self.is_source(kind) {
                known.insert(id, Known::Differs);
            } else {
                pending.push((id, true));
                pending.extend(kind.children().into_iter().map(|child| (child, false)));
            }
        }
        known.get(&root) == Some(&Known::Differs)
    }

    /// Whether an expression is divergent whatever its operands are.
    fn is_source(&self, kind: &ExprKind) -> bool {
        match kind {
            ExprKind::Var(VarRef::Global(id)) => self.globals.get(id.index()) == Some(&true),
            ExprKind::Var(VarRef::Local(id)) => {
                self.locals.get(self.function.index()).and_then(|locals| locals.get(id.index())) == Some(&true)
            }
            ExprKind::Call(function, _) => self.returns.get(function.index()) == Some(&true),
            ExprKind::BuiltinCall(function, _) => {
                matches!(function.class(), crate::builtin::operations::Class::Derivative(_))
            }
            _ => false,
        }
    }

    fn taint(&mut self, variable: VarRef) {
        match variable {
            VarRef::Global(id) => self.changed |= set(&mut self.globals, id.index(), &mut self.taints),
            VarRef::Local(id) => {
                if let Some(locals) = self.locals.get_mut(self.function.index()) {
                    self.changed |= set(locals, id.index(), &mut self.taints);
                }
            }
        }
    }

    /// Traverses an expression: writes, calls, and operands that are evaluated conditionally.
    fn expr(&mut self, root: ExprId, flow: Flow) {
        let shader = self.shader;
        let mut pending = vec![(root, flow)];
        while let Some((id, flow)) = pending.pop() {
            let kind = &shader.expr(id).kind;
            self.effects(id, flow);
            match kind {
                ExprKind::Logical(_, left, right) => {
                    pending.push((*right, self.under(*left, flow)));
                    pending.push((*left, flow));
                }
                ExprKind::Ternary(condition, yes, no) => {
                    let inner = self.under(*condition, flow);
                    pending.extend([(*no, inner), (*yes, inner), (*condition, flow)]);
                }
                _ => pending.extend(kind.children().into_iter().rev().map(|child| (child, flow))),
            }
        }
    }

    fn effects(&mut self, id: ExprId, flow: Flow) {
        let shader = self.shader;
        match &shader.expr(id).kind {
            ExprKind::Assign(_, target, value)
                if flow.is_divergent() || self.differs(*value) || self.differs(*target) =>
            {
                shader.root_variable(*target).into_iter().for_each(|variable| self.taint(variable));
            }
            ExprKind::Call(function, arguments) => self.call(id, *function, arguments, flow),
            ExprKind::BuiltinCall(..) => {
                let differs = flow.is_divergent() || self.differs(id);
                written_by(shader, id, &mut |target| {
                    if let Some(variable) = shader.root_variable(target).filter(|_| differs) {
                        self.taint(variable);
                    }
                });
                if let (Flow::Divergent(cause), Some(calls)) = (flow, &mut self.calls) {
                    calls.push(DivergentCall { expr: id, cause });
                }
            }
            ExprKind::IncDec(_, target) if flow.is_divergent() => {
                shader.root_variable(*target).into_iter().for_each(|variable| self.taint(variable));
            }
            _ => {}
        }
    }

    fn call(&mut self, id: ExprId, function: FunctionId, arguments: &[ExprId], flow: Flow) {
        let shader = self.shader;
        if let (Flow::Divergent(cause), Some(called @ None)) = (flow, self.called.get_mut(function.index())) {
            *called = Some(Cause { call: cause.call.or(Some(id)), ..cause });
            self.changed = true;
        }
        for (index, &argument) in arguments.iter().enumerate() {
            let mode = shader.function(function).param_mode(index);
            if mode != ParamMode::Out
                && self.differs(argument)
                && let Some(locals) = self.locals.get_mut(function.index())
            {
                self.changed |= set(locals, index, &mut self.taints);
            }
            let comes_back = matches!(mode, ParamMode::Out | ParamMode::Inout);
            let inside = self.locals.get(function.index()).and_then(|locals| locals.get(index)) == Some(&true);
            if comes_back && (inside || flow.is_divergent()) {
                shader.root_variable(argument).into_iter().for_each(|variable| self.taint(variable));
            }
        }
    }
}

/// Sets a flag. Returns whether it was not set before, and counts it then.
fn set(flags: &mut [bool], index: usize, taints: &mut u32) -> bool {
    let unset = flags.get_mut(index).filter(|flag| !**flag);
    let is_new = unset.is_some();
    unset.into_iter().for_each(|flag| *flag = true);
    *taints += u32::from(is_new);
    is_new
}
