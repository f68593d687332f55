//! Stores that are overwritten before anybody reads them.
//!
//! *In:* a body. *Out:* the body without them. *Holds:* only whole locals are followed, and in `main` whole globals that no other function
//! names; what a loop reads anywhere is taken to be read at its end and wherever it is left.

use glisten_front::hir::{
    ExprId, ExprKind, FunctionId, ParamMode, Shader, Stage, Stmt, StmtKind, Storage, VarRef, is_pure,
};

/// Variables that are read later, a bit each: a set is copied for each branch. The locals come first, then the globals.
#[derive(Clone, Debug, Default)]
struct Live(Vec<u64>);

impl Live {
    fn contains(&self, slot: usize) -> bool {
        self.0.get(slot / 64).is_some_and(|word| word >> (slot % 64) & 1 == 1)
    }

    fn insert(&mut self, slot: usize) {
        let word = slot / 64;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        if let Some(word) = self.0.get_mut(word) {
            *word |= 1 << (slot % 64);
        }
    }

    /// Whether it was there.
    fn remove(&mut self, slot: usize) -> bool {
        let was = self.contains(slot);
        if let Some(word) = self.0.get_mut(slot / 64) {
            *word &= !(1 << (slot % 64));
        }
        was
    }

    fn extend(&mut self, other: &Self) {
        if self.0.len() < other.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        self.0.iter_mut().zip(&other.0).for_each(|(word, other)| *word |= other);
    }
}

struct Walk<'a> {
    shader: &'a Shader,
    n_locals: usize,
    /// The globals that are followed.
    globals: &'a [bool],
    /// The live variables where a `break` or `continue` leads, innermost last.
    jumps: Vec<Live>,
    /// The live variables where the function is left.
    end: Live,
    changed: bool,
}

/// The globals that may be followed in `main`: those that it alone names. What a geometry stage emits it reads.
pub(super) fn globals_of_main(shader: &Shader) -> Vec<bool> {
    let own = |global: &glisten_front::hir::Global| {
        matches!(global.storage, Storage::Out | Storage::Private) && global.block.is_none()
    };
    let mut followed: Vec<bool> = shader.globals.iter().map(own).collect();
    if shader.stage == Stage::Geometry {
        followed.fill(false);
    }
    let mut see = |expr: ExprId| {
        if let ExprKind::Var(VarRef::Global(global)) = shader.expr(expr).kind
            && let Some(followed) = followed.get_mut(global.index())
        {
            *followed = false;
        }
    };
    for (id, function) in shader.functions() {
        if Some(id) != shader.main {
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut see);
        }
    }
    for initializer in shader.globals.iter().filter_map(|global| global.initializer) {
        shader.visit_expr(initializer, &mut see);
    }
    followed
}

/// Removes such stores from a function's body; whether there were any. `globals` says which globals are followed.
pub(super) fn remove(shader: &Shader, function: FunctionId, globals: &[bool], body: Vec<Stmt>) -> (Vec<Stmt>, bool) {
    let function = shader.function(function);
    let mut walk = Walk {
        shader,
        n_locals: function.locals.len(),
        globals,
        jumps: Vec::new(),
        end: Live::default(),
        changed: false,
    };
    for (index, param) in function.params().iter().enumerate() {
        if matches!(param.kind, glisten_front::hir::LocalKind::Param(ParamMode::Out | ParamMode::Inout)) {
            walk.end.insert(index);
        }
    }
    for (id, global) in shader.globals() {
        if let Some(slot) = walk.slot(VarRef::Global(id)).filter(|_| global.storage == Storage::Out) {
            walk.end.insert(slot);
        }
    }
    let mut live = walk.end.clone();
    let body = walk.body(body, &mut live);
    (body, walk.changed)
}

impl Walk<'_> {
    /// The place of a variable in the sets, if it is followed.
    fn slot(&self, variable: VarRef) -> Option<usize> {
        match variable {
            VarRef::Local(local) => Some(local.index()),
            VarRef::Global(global) => {
                let followed = self.globals.get(global.index()).copied().unwrap_or(false);
                followed.then_some(self.n_locals + global.index())
            }
        }
    }

    fn body(&mut self, body: Vec<Stmt>, live: &mut Live) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(body.len());
        for stmt in body.into_iter().rev() {
            if let Some(stmt) = self.statement(stmt, live) {
                out.push(stmt);
            }
        }
        out.reverse();
        out
    }

    fn statement(&mut self, stmt: Stmt, live: &mut Live) -> Option<Stmt> {
        let Stmt { kind, span } = stmt;
        let kind = match kind {
            StmtKind::Expr(expr) => {
                if let ExprKind::Assign(None, target, value) = self.shader.expr(expr).kind
                    && let ExprKind::Var(variable) = self.shader.expr(target).kind
                    && let Some(slot) = self.slot(variable)
                {
                    if !live.contains(slot) && is_pure(self.shader, value) {
                        self.changed = true;
                        return None;
                    }
                    live.remove(slot);
                    self.read(value, live);
                } else {
                    self.read(expr, live);
                }
                StmtKind::Expr(expr)
            }
            StmtKind::Local(local, initializer) => {
                let dead = !live.remove(local.index());
                let initializer = match initializer {
                    Some(expr) if dead && is_pure(self.shader, expr) => {
                        self.changed = true;
                        None
                    }
                    initializer => initializer,
                };
                if let Some(expr) = initializer {
                    self.read(expr, live);
                }
                StmtKind::Local(local, initializer)
            }
            StmtKind::Block(body) => StmtKind::Block(self.body(body, live)),
            StmtKind::If { arms, otherwise } => {
                let after = live.clone();
                let otherwise = self.body(otherwise, live);
                let mut walked = Vec::with_capacity(arms.len());
                for (condition, body) in arms.into_iter().rev() {
                    let mut way = after.clone();
                    let body = self.body(body, &mut way);
                    live.extend(&way);
                    self.read(condition, live);
                    walked.push((condition, body));
                }
                walked.reverse();
                StmtKind::If { arms: walked, otherwise }
            }
            StmtKind::Switch { selector, cases } => {
                let whole = StmtKind::Switch { selector, cases };
                self.read_all(&whole, live);
                let StmtKind::Switch { selector, cases } = whole else { return None };
                self.jumps.push(live.clone());
                let cases = cases.into_iter().map(|case| {
                    let mut way = live.clone();
                    let body = self.body(case.body, &mut way);
                    glisten_front::hir::Case { labels: case.labels, body }
                });
                let cases = cases.collect();
                self.jumps.pop();
                StmtKind::Switch { selector, cases }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let whole = StmtKind::Loop { kind, condition, step, body };
                self.read_all(&whole, live);
                let StmtKind::Loop { kind, condition, step, body } = whole else { return None };
                self.jumps.push(live.clone());
                let mut way = live.clone();
                let body = self.body(body, &mut way);
                self.jumps.pop();
                StmtKind::Loop { kind, condition, step, body }
            }
            StmtKind::Return(value) => {
                *live = self.end.clone();
                if let Some(value) = value {
                    self.read(value, live);
                }
                StmtKind::Return(value)
            }
            StmtKind::Break | StmtKind::Continue => {
                if let Some(target) = self.jumps.last() {
                    // A `continue` in a switch leads further than its end: what either wants is live.
                    *live = self.jumps.iter().fold(target.clone(), |mut all, one| {
                        all.extend(one);
                        all
                    });
                }
                kind
            }
            StmtKind::Discard => {
                *live = Live::default();
                kind
            }
        };
        Some(Stmt { kind, span })
    }

    /// All variables that an expression names are taken to be read.
    fn read(&self, root: ExprId, live: &mut Live) {
        self.shader.visit_expr(root, &mut |expr| self.named(expr, live));
    }

    fn named(&self, expr: ExprId, live: &mut Live) {
        if let ExprKind::Var(variable) = self.shader.expr(expr).kind
            && let Some(slot) = self.slot(variable)
        {
            live.insert(slot);
        }
    }

    fn read_all(&self, kind: &StmtKind, live: &mut Live) {
        for expr in kind.exprs() {
            self.read(expr, live);
        }
        for body in kind.bodies() {
            self.shader.visit_body(body, &mut |expr| self.named(expr, live));
        }
        if let StmtKind::Loop { condition: Some(condition), .. } = kind {
            condition.local.into_iter().for_each(|local| live.insert(local.index()));
        }
        // Any round, or any case, may leave the function.
        if returns(kind) {
            live.extend(&self.end);
        }
    }
}

/// Whether a statement may leave the function.
fn returns(kind: &StmtKind) -> bool {
    let mut pending = vec![kind];
    while let Some(kind) = pending.pop() {
        if matches!(kind, StmtKind::Return(_)) {
            return true;
        }
        pending.extend(kind.bodies().into_iter().flatten().map(|stmt| &stmt.kind));
    }
    false
}
