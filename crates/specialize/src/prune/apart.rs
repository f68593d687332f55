//! A variable that is declared again, as in a loop that was written out, becomes one of its own.
//!
//! *In:* a stage. *Out:* the stage. *Holds:* each local of a function is declared once, so that what nobody reads in one iteration goes,
//! whatever another one reads.

use glisten_front::hir::{ExprId, ExprKind, Local, LocalId, Shader, Stmt, StmtKind, VarRef};
use rustc_hash::{FxHashMap, FxHashSet};

/// Takes the variables of all functions apart.
pub(super) fn apart(shader: &mut Shader) {
    for index in 0..shader.functions.len() {
        let Some(function) = shader.functions.get_mut(index) else { continue };
        let Some(mut body) = function.body.take() else { continue };
        let locals = std::mem::take(&mut function.locals);
        let mut walk = Walk { shader, locals, declared: FxHashSet::default(), names: FxHashMap::default() };
        walk.body(&mut body);
        let locals = walk.locals;
        if let Some(function) = shader.functions.get_mut(index) {
            function.body = Some(body);
            function.locals = locals;
        }
    }
}

struct Walk<'a> {
    shader: &'a mut Shader,
    locals: Vec<Local>,
    declared: FxHashSet<LocalId>,
    /// What stands for a variable in the present scope.
    names: FxHashMap<LocalId, LocalId>,
}

impl Walk<'_> {
    /// A scope of its own.
    fn body(&mut self, body: &mut [Stmt]) {
        let outside = self.names.clone();
        for stmt in body {
            self.statement(&mut stmt.kind);
        }
        self.names = outside;
    }

    fn statement(&mut self, kind: &mut StmtKind) {
        match kind {
            StmtKind::Local(local, initializer) => {
                initializer.iter().for_each(|expr| self.expr(*expr));
                *local = self.declare(*local);
            }
            StmtKind::Expr(expr) => self.expr(*expr),
            StmtKind::Return(value) => value.iter().for_each(|expr| self.expr(*expr)),
            StmtKind::Block(body) => self.body(body),
            StmtKind::If { arms, otherwise } => {
                for (condition, body) in arms {
                    self.expr(*condition);
                    self.body(body);
                }
                self.body(otherwise);
            }
            StmtKind::Switch { selector, cases } => {
                self.expr(*selector);
                // All cases are one scope.
                let outside = self.names.clone();
                for stmt in cases.iter_mut().flat_map(|case| &mut case.body) {
                    self.statement(&mut stmt.kind);
                }
                self.names = outside;
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let outside = self.names.clone();
                if let Some(condition) = condition {
                    self.expr(condition.expr);
                    if let Some(local) = &mut condition.local {
                        *local = self.declare(*local);
                    }
                }
                step.iter().for_each(|expr| self.expr(*expr));
                self.body(body);
                self.names = outside;
            }
            StmtKind::Break | StmtKind::Continue | StmtKind::Discard => {}
        }
    }

    fn declare(&mut self, local: LocalId) -> LocalId {
        let Some(known) = self.locals.get(local.index()).filter(|_| !self.declared.insert(local)) else { return local };
        let known = known.clone();
        let own = LocalId::new(self.locals.len());
        self.locals.push(known);
        self.names.insert(local, own);
        own
    }

    fn expr(&mut self, root: ExprId) {
        if self.names.is_empty() {
            return;
        }
        let mut renamed = Vec::new();
        self.shader.visit_expr(root, &mut |expr| {
            if let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(expr).kind
                && let Some(own) = self.names.get(&local)
            {
                renamed.push((expr, *own));
            }
        });
        for (expr, own) in renamed {
            if let Some(expr) = self.shader.exprs.get_mut(expr.index()) {
                expr.kind = ExprKind::Var(VarRef::Local(own));
            }
        }
    }
}
