//! The inputs that an expression depends on, by the assignments of a shader.
//!
//! *In:* an expression. *Out:* globals. *Holds:* all assignments to a variable count, wherever they are. *Not done here:* conditions.

use glisten_front::hir::written_by;
use glisten_front::hir::{ExprId, ExprKind, FunctionId, GlobalId, LocalId, Shader, StmtKind, VarRef};
use std::collections::{BTreeMap, BTreeSet};

/// A variable of a shader: a global, or a local of a function.
type Variable = (Option<FunctionId>, usize);

/// The expressions of which the variables of a shader are made.
#[derive(Default)]
struct Sources {
    /// Expressions that give a variable its values, each with its function.
    values: BTreeMap<Variable, Vec<(FunctionId, ExprId)>>,
    /// The expressions that a function returns.
    returns: BTreeMap<FunctionId, Vec<ExprId>>,
}

/// The inputs and uniforms that an expression depends on.
pub(super) fn inputs_of(shader: &Shader, expr: ExprId) -> BTreeSet<GlobalId> {
    let mut sources = Sources::default();
    let mut home = None;
    for (id, function) in shader.functions() {
        let body = function.body.as_deref().unwrap_or(&[]);
        shader.visit_statements(body, &mut |statement| match &statement.kind {
            StmtKind::Local(local, Some(value)) => sources.add((Some(id), local.index()), id, *value),
            StmtKind::Return(Some(value)) => sources.returns.entry(id).or_default().push(*value),
            _ => {}
        });
        shader.visit_body(body, &mut |one| {
            if one == expr {
                home = Some(id);
            }
            let kind = &shader.expr(one).kind;
            written_by(shader, one, &mut |target| {
                let Some(variable) = shader.root_variable(target) else { return };
                for child in kind.children() {
                    sources.add(variable_of(id, variable), id, child);
                }
            });
            if let ExprKind::Call(callee, arguments) = kind {
                for (index, argument) in arguments.iter().enumerate() {
                    sources.add((Some(*callee), LocalId::new(index).index()), id, *argument);
                }
            }
        });
    }
    let mut found = BTreeSet::new();
    let mut seen = BTreeSet::new();
    let mut pending: Vec<(FunctionId, ExprId)> = home.map(|home| (home, expr)).into_iter().collect();
    while let Some((function, id)) = pending.pop() {
        if !seen.insert((function, id)) {
            continue;
        }
        match &shader.expr(id).kind {
            ExprKind::Var(variable) => {
                if let VarRef::Global(global) = variable {
                    found.insert(*global);
                }
                pending.extend(sources.values.get(&variable_of(function, *variable)).into_iter().flatten());
            }
            ExprKind::Call(callee, _) => {
                let returned = sources.returns.get(callee).into_iter().flatten();
                pending.extend(returned.map(|value| (*callee, *value)));
            }
            _ => {}
        }
        pending.extend(shader.expr(id).kind.children().into_iter().map(|child| (function, child)));
    }
    found
}

fn variable_of(function: FunctionId, variable: VarRef) -> Variable {
    match variable {
        VarRef::Global(global) => (None, global.index()),
        VarRef::Local(local) => (Some(function), local.index()),
    }
}

impl Sources {
    fn add(&mut self, variable: Variable, function: FunctionId, value: ExprId) {
        self.values.entry(variable).or_default().push((function, value));
    }
}
