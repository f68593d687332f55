//! [`Names`]: locals that are names for one expression.
//!
//! *In:* a stage. *Out:* for each local that is assigned where it is declared and nowhere else, and for each parameter of
//! a function that is called from one place, the expression that it stands for. *Holds:* such a local has the same value
//! wherever it can be read, as long as the variables in its expression are not assigned to in between: [`Names::is_steady`]
//! tells that they never are.

use glisten_front::hir::written_by;
use glisten_front::hir::{
    ExprId, ExprKind, FunctionId, LocalId, LocalKind, ParamMode, Shader, Stmt, StmtKind, Storage, VarRef,
};
use std::collections::{BTreeMap, BTreeSet};

/// The locals that are names, and the variables that are assigned to.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    known: BTreeMap<(FunctionId, LocalId), (FunctionId, ExprId)>,
    /// Locals that are assigned to after their declaration.
    assigned: BTreeSet<(FunctionId, LocalId)>,
}

impl Names {
    /// Those of a stage.
    pub(super) fn of(shader: &Shader) -> Self {
        let mut names = Self::default();
        for (id, function) in shader.functions() {
            let body = function.body.as_deref().unwrap_or(&[]);
            shader.visit_statements(body, &mut |stmt| names.declare(id, stmt));
            shader.visit_body(body, &mut |expr| {
                written_by(shader, expr, &mut |target| {
                    if let Some(VarRef::Local(local)) = shader.root_variable(target) {
                        names.assigned.insert((id, local));
                    }
                });
            });
        }
        names.arguments(shader);
        for local in names.assigned.clone() {
            names.known.remove(&local);
        }
        names
    }

    fn declare(&mut self, id: FunctionId, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Local(local, Some(value)) => {
                let before = self.known.insert((id, *local), (id, *value));
                self.assigned.extend(before.map(|_| (id, *local)));
            }
            StmtKind::Local(local, None) => {
                self.assigned.insert((id, *local));
            }
            StmtKind::Loop { condition: Some(condition), .. } => {
                self.assigned.extend(condition.local.map(|local| (id, local)));
            }
            _ => {}
        }
    }

    /// The arguments of functions that are called from one place.
    fn arguments(&mut self, shader: &Shader) {
        let mut calls: BTreeMap<FunctionId, Vec<(FunctionId, ExprId)>> = BTreeMap::new();
        for (id, function) in shader.functions() {
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
                if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                    calls.entry(callee).or_default().push((id, expr));
                }
            });
        }
        for (callee, calls) in calls {
            let [(caller, call)] = calls.as_slice() else { continue };
            let ExprKind::Call(_, arguments) = &shader.expr(*call).kind else { continue };
            let function = shader.function(callee);
            for (index, argument) in arguments.iter().enumerate().take(function.param_count) {
                if matches!(function.param_mode(index), ParamMode::In | ParamMode::ConstIn) {
                    self.known.insert((callee, LocalId::new(index)), (*caller, *argument));
                }
            }
        }
    }

    /// The expression that a local stands for, and the function that it is in.
    pub(super) fn get(&self, function: FunctionId, local: LocalId) -> Option<(FunctionId, ExprId)> {
        self.known.get(&(function, local)).copied()
    }

    /// Whether all variables of an expression keep their values: none is assigned to but where it is declared.
    pub(super) fn is_steady(&self, shader: &Shader, function: FunctionId, id: ExprId) -> bool {
        let mut steady = true;
        shader.visit_expr(id, &mut |part| match shader.expr(part).kind {
            ExprKind::Var(VarRef::Local(local)) => steady &= !self.assigned.contains(&(function, local)),
            ExprKind::Var(VarRef::Global(global)) => {
                steady &= matches!(shader.global(global).storage, Storage::Const | Storage::Uniform | Storage::In);
            }
            _ => {}
        });
        steady
    }
}

/// The functions of a stage that do nothing but give a value: they write no global and no argument, look up no texture,
/// take no derivative, discard nothing, and read no global but constants and uniforms.
pub(super) fn pure_functions(shader: &Shader) -> BTreeSet<FunctionId> {
    let mut pure: BTreeSet<FunctionId> = BTreeSet::new();
    for id in shader.callees_first_of(shader.functions().map(|(id, _)| id)) {
        if is_pure(shader, id, &pure) {
            pure.insert(id);
        }
    }
    pure
}

fn is_pure(shader: &Shader, id: FunctionId, pure: &BTreeSet<FunctionId>) -> bool {
    let function = shader.function(id);
    let Some(body) = function.body.as_deref() else { return false };
    let by_value = function
        .locals
        .iter()
        .take(function.param_count)
        .all(|param| matches!(param.kind, LocalKind::Param(ParamMode::In | ParamMode::ConstIn)));
    let mut plain = by_value;
    shader.visit_statements(body, &mut |stmt| plain &= !matches!(stmt.kind, StmtKind::Discard));
    shader.visit_body(body, &mut |expr| {
        plain &= match &shader.expr(expr).kind {
            ExprKind::Var(VarRef::Global(global)) => {
                let global = shader.global(*global);
                matches!(global.storage, Storage::Const | Storage::Uniform) && global.builtin.is_none()
            }
            ExprKind::Call(callee, _) => pure.contains(callee),
            ExprKind::BuiltinCall(function, _) => function.follows_from_arguments(),
            _ => true,
        };
    });
    plain
}
