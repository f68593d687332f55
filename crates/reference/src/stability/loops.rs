//! Finds what loops repeat, and the sums and products that they accumulate: `s += f(x)`, `s = s + f(x)`, `s = a * s + b`.
//!
//! *In:* the typed program of a stage. *Out:* the spans of expressions. *Holds:* a function that a loop calls belongs to the
//! loop.

use glisten_front::hir::{ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind, VarRef};
use glisten_front::source::Span;
use std::collections::BTreeSet;

/// The spans of expressions that run in loops.
#[derive(Debug, Default)]
pub(super) struct Loops {
    /// Every expression.
    pub(super) inside: BTreeSet<Span>,
    /// Those whose result is stored in a variable that they read.
    pub(super) accumulate: BTreeSet<Span>,
}

impl Loops {
    /// The loops that `main` reaches.
    pub(super) fn of(shader: &Shader) -> Self {
        let mut found = Self::default();
        let Some(main) = shader.main else { return found };
        let mut repeated = BTreeSet::new();
        for function in shader.callees_first(main).into_iter().rev() {
            let Some(body) = shader.functions.get(function.index()).and_then(|function| function.body.as_deref())
            else {
                continue;
            };
            let whole = repeated.contains(&function);
            if whole {
                shader.visit_body(body, &mut |expr| found.note(shader, expr, &mut repeated));
            }
            shader.visit_statements(body, &mut |statement| {
                if let StmtKind::Loop { body, .. } = &statement.kind
                    && !whole
                {
                    found.note_loop(shader, statement, body, &mut repeated);
                }
            });
        }
        found
    }

    fn note_loop(&mut self, shader: &Shader, whole: &Stmt, body: &[Stmt], repeated: &mut BTreeSet<FunctionId>) {
        for expr in whole.kind.exprs() {
            shader.visit_expr(expr, &mut |expr| self.note(shader, expr, repeated));
        }
        shader.visit_body(body, &mut |expr| self.note(shader, expr, repeated));
    }

    fn note(&mut self, shader: &Shader, id: ExprId, repeated: &mut BTreeSet<FunctionId>) {
        let expr = shader.expr(id);
        self.inside.insert(expr.span);
        match expr.kind {
            ExprKind::Call(callee, _) => {
                repeated.insert(callee);
            }
            ExprKind::Assign(operator, to, value) => {
                let Some(variable) = shader.root_variable(to) else { return };
                if operator.is_some() {
                    self.accumulate.insert(expr.span);
                }
                self.note_readers(shader, value, variable);
            }
            _ => {}
        }
    }

    /// Notes the operations in an expression that have read a variable.
    fn note_readers(&mut self, shader: &Shader, value: ExprId, variable: VarRef) {
        shader.visit_expr(value, &mut |id| {
            let is_operation = matches!(shader.expr(id).kind, ExprKind::Binary(..) | ExprKind::BuiltinCall(..));
            if is_operation && reads(shader, id, variable) {
                self.accumulate.insert(shader.expr(id).span);
            }
        });
    }
}

fn reads(shader: &Shader, root: ExprId, variable: VarRef) -> bool {
    let mut found = false;
    shader.visit_expr(root, &mut |id| {
        found |= matches!(shader.expr(id).kind, ExprKind::Var(read) if read == variable);
    });
    found
}
