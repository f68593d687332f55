//! [`Effects`]: which variables a construct may assign to, calls included.
//!
//! *In:* the program as it was written. *Out:* for each function the globals that it may write or read, and what it does
//! besides; for a piece of a body the locals, too.

use glisten_front::hir::written_by;
use glisten_front::hir::{ExprId, ExprKind, FunctionId, GlobalId, LocalId, Shader, Stmt, StmtKind, VarRef};
use std::collections::BTreeSet;

/// What a function does besides giving a value.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effect {
    /// The globals that it may assign to.
    pub(crate) writes: BTreeSet<GlobalId>,
    /// The globals that it names.
    pub(crate) names: BTreeSet<GlobalId>,
    /// Whether it may discard the fragment, or emit a vertex.
    pub(crate) ends: bool,
}

/// The effects of all functions of a shader.
#[derive(Debug)]
pub(crate) struct Effects {
    functions: Vec<Effect>,
}

/// What a piece of a body may assign to.
#[derive(Debug, Default)]
pub(crate) struct Assigned {
    /// Locals of the function it is in.
    pub(crate) locals: BTreeSet<LocalId>,
    /// Globals, by calls as well.
    pub(crate) globals: BTreeSet<GlobalId>,
}

impl Effects {
    /// Of these functions and of those that they call, callees before callers.
    pub(crate) fn of(shader: &Shader, functions: impl IntoIterator<Item = FunctionId>) -> Self {
        let mut effects = Self { functions: vec![Effect::default(); shader.functions.len()] };
        for id in shader.callees_first_of(functions) {
            let effect = effects.of_function(shader, id);
            if let Some(slot) = effects.functions.get_mut(id.index()) {
                *slot = effect;
            }
        }
        effects
    }

    /// Those of a function.
    pub(crate) fn function(&self, id: FunctionId) -> &Effect {
        // One for each function of the shader.
        &self.functions[id.index()]
    }

    fn of_function(&self, shader: &Shader, id: FunctionId) -> Effect {
        let mut effect = Effect::default();
        let body = shader.function(id).body.as_deref().unwrap_or(&[]);
        shader.visit_statements(body, &mut |stmt| effect.ends |= matches!(stmt.kind, StmtKind::Discard));
        shader.visit_body(body, &mut |expr| {
            self.of_expr(shader, expr, &mut effect);
            written_by(shader, expr, &mut |target| {
                if let Some(VarRef::Global(global)) = shader.root_variable(target) {
                    effect.writes.insert(global);
                }
            });
        });
        effect
    }

    fn of_expr(&self, shader: &Shader, expr: ExprId, effect: &mut Effect) {
        match &shader.expr(expr).kind {
            ExprKind::Var(VarRef::Global(global)) => {
                effect.names.insert(*global);
            }
            ExprKind::Call(callee, _) => {
                let callee = self.function(*callee);
                effect.writes.extend(callee.writes.iter().copied());
                effect.names.extend(callee.names.iter().copied());
                effect.ends |= callee.ends;
            }
            ExprKind::BuiltinCall(function, _) => effect.ends |= function.operation().emits(),
            _ => {}
        }
    }

    /// What statements and expressions of one function may assign to.
    pub(crate) fn assigned(&self, shader: &Shader, body: &[Stmt], exprs: &[ExprId]) -> Assigned {
        let mut assigned = Assigned::default();
        let mut see = |expr: ExprId| {
            if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                assigned.globals.extend(self.function(callee).writes.iter().copied());
            }
            written_by(shader, expr, &mut |target| match shader.root_variable(target) {
                Some(VarRef::Global(global)) => {
                    assigned.globals.insert(global);
                }
                Some(VarRef::Local(local)) => {
                    assigned.locals.insert(local);
                }
                None => {}
            });
        };
        shader.visit_body(body, &mut see);
        exprs.iter().for_each(|expr| shader.visit_expr(*expr, &mut see));
        shader.visit_statements(body, &mut |stmt| {
            match &stmt.kind {
                StmtKind::Local(local, _) => assigned.locals.insert(*local),
                StmtKind::Loop { condition: Some(condition), .. } => {
                    condition.local.is_some_and(|local| assigned.locals.insert(local))
                }
                _ => false,
            };
        });
        assigned
    }
}
