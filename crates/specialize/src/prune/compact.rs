//! Rebuilds a stage of what is left: functions that `main` reaches, parameters and locals that are named, expressions that
//! stand somewhere, children before parents.
//!
//! *In:* a stage and the globals that stay. *Out:* a stage with new handles.

use super::uses::Uses;
use glisten_front::hir::{
    Condition, ExprId, ExprKind, Function, FunctionId, GlobalId, LocalId, LocalKind, ParamMode, Shader, Stmt, StmtKind,
    Types, VarRef, may_act,
};
use glisten_front::stack::with_stack;
use rustc_hash::FxHashMap;
use std::cell::OnceCell;

struct Rebuild<'a> {
    types: &'a Types,
    old: &'a Shader,
    /// For each global whether somebody reads it when the stage has ended.
    live: &'a [bool],
    new: Shader,
    functions: FxHashMap<FunctionId, FunctionId>,
    globals: FxHashMap<GlobalId, GlobalId>,
    /// For each function of the old stage its locals' new handles; parameters that are not read have none.
    locals: FxHashMap<FunctionId, Vec<Option<LocalId>>>,
    /// The arguments of all calls, by callee, once somebody asked.
    calls: OnceCell<FxHashMap<FunctionId, Vec<&'a [ExprId]>>>,
}

/// The arguments of the calls in these functions and in initializers of globals.
fn calls<'a>(shader: &'a Shader, functions: &[FunctionId]) -> FxHashMap<FunctionId, Vec<&'a [ExprId]>> {
    let mut calls: FxHashMap<FunctionId, Vec<&[ExprId]>> = FxHashMap::default();
    let mut see = |id: ExprId| {
        if let ExprKind::Call(callee, arguments) = &shader.expr(id).kind {
            calls.entry(*callee).or_default().push(arguments);
        }
    };
    functions
        .iter()
        .filter_map(|id| shader.function(*id).body.as_deref())
        .for_each(|body| shader.visit_body(body, &mut see));
    shader.globals.iter().filter_map(|global| global.initializer).for_each(|root| shader.visit_expr(root, &mut see));
    calls
}

/// Rebuilds a stage of which `uses` are the counts. `live` says for each global whether somebody reads it when the stage has ended,
/// `keeps` which globals stay though nobody names them. `origins` follows the functions.
pub(super) fn compact(
    (types, shader): (&Types, &Shader),
    (uses, live): (&Uses, &[bool]),
    keeps: &(dyn Fn(GlobalId) -> bool + Sync),
    origins: &mut Vec<FunctionId>,
) -> (Shader, Vec<GlobalId>) {
    let known = std::mem::take(origins);
    let (new, globals, from) = with_stack(shader.depth.saturating_add(1024), || {
        let mut rebuild = Rebuild {
            types,
            old: shader,
            live,
            new: Shader { exprs: Vec::with_capacity(shader.exprs.len()), ..shader.emptied() },
            functions: FxHashMap::default(),
            globals: FxHashMap::default(),
            locals: FxHashMap::default(),
            calls: OnceCell::new(),
        };
        let globals = rebuild.choose_globals(uses, keeps);
        let from = rebuild.choose_functions(uses);
        rebuild.bodies(&globals, &from);
        (rebuild.new, globals, from)
    });
    *origins = from.iter().filter_map(|id| known.get(id.index()).copied()).collect();
    (new, globals)
}

impl Rebuild<'_> {
    fn choose_globals(&mut self, uses: &Uses, keeps: &dyn Fn(GlobalId) -> bool) -> Vec<GlobalId> {
        let mut chosen = Vec::new();
        for (id, global) in self.old.globals() {
            // An initializer may do something to other globals.
            let acts = global.initializer.is_some_and(|initializer| !self.does_nothing(initializer));
            if uses.global(id).named > 0 || keeps(id) || acts {
                self.globals.insert(id, GlobalId::new(self.new.globals.len()));
                self.new.globals.push(global.clone());
                chosen.push(id);
            }
        }
        chosen
    }

    fn choose_functions(&mut self, uses: &Uses) -> Vec<FunctionId> {
        let from = uses.functions.clone();
        for id in &from {
            self.functions.insert(*id, FunctionId::new(self.new.functions.len()));
            let function = self.old.function(*id);
            let mut places = vec![None; function.locals.len()];
            let mut new = Function { locals: Vec::new(), body: None, ..function.clone() };
            new.param_count = 0;
            for (index, local) in function.locals.iter().enumerate() {
                let is_param = matches!(local.kind, LocalKind::Param(_));
                let drops = is_param && self.is_droppable(*id, index, uses);
                if drops {
                    continue;
                }
                if let Some(place) = places.get_mut(index) {
                    *place = Some(LocalId::new(new.locals.len()));
                }
                new.param_count += usize::from(is_param);
                new.locals.push(local.clone());
            }
            self.locals.insert(*id, places);
            self.new.functions.push(new);
        }
        self.new.main = self.old.main.and_then(|main| self.functions.get(&main).copied());
        from
    }

    /// Whether nobody reads the value that a parameter takes or gives, and all arguments for it do nothing.
    fn is_droppable(&self, function: FunctionId, index: usize, uses: &Uses) -> bool {
        if uses.local(function, LocalId::new(index)).named > 0 {
            return false;
        }
        let mode = self.old.function(function).param_mode(index);
        // What goes in comes out again, and may overwrite what another argument gave the same variable.
        if mode == ParamMode::Inout {
            return false;
        }
        let gives = mode == ParamMode::Out;
        // What is never written is undefined where it is read, and stays to be so.
        if gives && !uses.is_unread_by_callers(self.types, self.old, self.live, (function, index)) {
            return false;
        }
        let calls = self.calls.get_or_init(|| calls(self.old, &uses.functions)).get(&function);
        calls.into_iter().flatten().all(|arguments| arguments.get(index).is_some_and(|id| self.does_nothing(*id)))
    }

    fn does_nothing(&self, root: ExprId) -> bool {
        let mut nothing = true;
        self.old.visit_expr(root, &mut |expr| {
            nothing &= !may_act(&self.old.expr(expr).kind);
        });
        nothing
    }

    fn bodies(&mut self, globals: &[GlobalId], functions: &[FunctionId]) {
        let old = self.old;
        for (place, id) in globals.iter().enumerate() {
            let initializer = old.global(*id).initializer.map(|initializer| self.expr(FunctionId::new(0), initializer));
            if let Some(global) = self.new.globals.get_mut(place) {
                global.initializer = initializer;
            }
        }
        for (place, id) in functions.iter().enumerate() {
            let Some(body) = &old.function(*id).body else { continue };
            let body = self.body(*id, body);
            if let Some(function) = self.new.functions.get_mut(place) {
                function.body = Some(body);
            }
        }
    }

    fn local(&self, function: FunctionId, local: LocalId) -> LocalId {
        let places = self.locals.get(&function);
        places.and_then(|places| places.get(local.index()).copied().flatten()).unwrap_or(LocalId::new(0))
    }

    fn expr(&mut self, function: FunctionId, id: ExprId) -> ExprId {
        let expr = self.old.expr(id).clone();
        let mut kind = expr.kind;
        match &mut kind {
            ExprKind::Var(VarRef::Global(global)) => {
                if let Some(new) = self.globals.get(global) {
                    *global = *new;
                }
            }
            ExprKind::Var(VarRef::Local(local)) => *local = self.local(function, *local),
            ExprKind::Call(callee, arguments) => {
                if let Some(places) = self.locals.get(callee) {
                    let mut index = 0;
                    arguments.retain(|_| {
                        index += 1;
                        places.get(index - 1).copied().flatten().is_some()
                    });
                }
                if let Some(new) = self.functions.get(callee) {
                    *callee = *new;
                }
            }
            _ => {}
        }
        kind.for_each_operand(&mut |child| *child = self.expr(function, *child));
        self.new.push(kind, expr.ty, expr.span)
    }

    fn body(&mut self, function: FunctionId, body: &[Stmt]) -> Vec<Stmt> {
        body.iter().map(|stmt| Stmt { kind: self.statement(function, &stmt.kind), span: stmt.span }).collect()
    }

    fn statement(&mut self, function: FunctionId, kind: &StmtKind) -> StmtKind {
        match kind {
            StmtKind::Expr(expr) => StmtKind::Expr(self.expr(function, *expr)),
            StmtKind::Local(local, initializer) => {
                let initializer = initializer.map(|initializer| self.expr(function, initializer));
                StmtKind::Local(self.local(function, *local), initializer)
            }
            StmtKind::Block(body) => StmtKind::Block(self.body(function, body)),
            StmtKind::If { arms, otherwise } => {
                let arms = arms.iter().map(|(c, body)| (self.expr(function, *c), self.body(function, body))).collect();
                StmtKind::If { arms, otherwise: self.body(function, otherwise) }
            }
            StmtKind::Switch { selector, cases } => {
                let selector = self.expr(function, *selector);
                let cases = cases.iter().map(|case| glisten_front::hir::Case {
                    labels: case.labels.clone(),
                    body: self.body(function, &case.body),
                });
                StmtKind::Switch { selector, cases: cases.collect() }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let condition = condition.as_ref().map(|condition| Condition {
                    local: condition.local.map(|local| self.local(function, local)),
                    expr: self.expr(function, condition.expr),
                });
                let step = step.map(|step| self.expr(function, step));
                StmtKind::Loop { kind: *kind, condition, step, body: self.body(function, body) }
            }
            StmtKind::Return(value) => StmtKind::Return(value.map(|value| self.expr(function, value))),
            StmtKind::Break => StmtKind::Break,
            StmtKind::Continue => StmtKind::Continue,
            StmtKind::Discard => StmtKind::Discard,
        }
    }
}
