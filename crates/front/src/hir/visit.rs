//! Traversals of statements and expressions that do not use the caller's stack: every expression of a body, and the
//! functions that a function calls.

use super::{Condition, ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind};
use smallvec::{SmallVec, smallvec};

impl StmtKind {
    /// The expressions directly in the statement, in the order of their first evaluation.
    pub fn exprs(&self) -> SmallVec<[ExprId; 4]> {
        match self {
            Self::Expr(expr) => smallvec![*expr],
            Self::Local(_, expr) | Self::Return(expr) => expr.iter().copied().collect(),
            Self::If { arms, .. } => arms.iter().map(|(condition, _)| *condition).collect(),
            Self::Switch { selector, .. } => smallvec![*selector],
            Self::Loop { condition, step, .. } => {
                condition.iter().map(|Condition { expr, .. }| *expr).chain(step.iter().copied()).collect()
            }
            Self::Block(_) | Self::Break | Self::Continue | Self::Discard => SmallVec::new(),
        }
    }

    /// The bodies inside the statement, in order.
    pub fn bodies(&self) -> SmallVec<[&[Stmt]; 4]> {
        match self {
            Self::Block(body) | Self::Loop { body, .. } => smallvec![body.as_slice()],
            Self::If { arms, otherwise } => {
                arms.iter().map(|(_, body)| body.as_slice()).chain([otherwise.as_slice()]).collect()
            }
            Self::Switch { cases, .. } => cases.iter().map(|case| case.body.as_slice()).collect(),
            Self::Expr(_) | Self::Local(..) | Self::Break | Self::Continue | Self::Return(_) | Self::Discard => {
                SmallVec::new()
            }
        }
    }
}

impl Shader {
    /// Calls `f` for an expression and everything inside it: operands after the whole, left before right.
    pub fn visit_expr(&self, root: ExprId, f: &mut dyn FnMut(ExprId)) {
        // Most expressions are small: their stack needs no memory of its own.
        let mut stack: SmallVec<[ExprId; 32]> = smallvec![root];
        while let Some(id) = stack.pop() {
            f(id);
            self.expr(id).kind.push_operands(&mut stack);
        }
    }

    /// Calls `f` for every statement of a body: outer ones first, in source order.
    pub fn visit_statements<'a>(&'a self, body: &'a [Stmt], f: &mut dyn FnMut(&'a Stmt)) {
        let mut stack: SmallVec<[&'a Stmt; 32]> = body.iter().rev().collect();
        while let Some(statement) = stack.pop() {
            f(statement);
            for inner in statement.kind.bodies().into_iter().rev() {
                stack.extend(inner.iter().rev());
            }
        }
    }

    /// Calls `f` for every expression of a body.
    pub fn visit_body(&self, body: &[Stmt], f: &mut dyn FnMut(ExprId)) {
        self.visit_statements(body, &mut |statement| {
            for expr in statement.kind.exprs() {
                self.visit_expr(expr, f);
            }
        });
    }

    /// The functions that a function calls, in order of the calls.
    pub fn callees(&self, id: FunctionId) -> Vec<FunctionId> {
        let mut list = Vec::new();
        if let Some(body) = self.functions.get(id.index()).and_then(|function| function.body.as_deref()) {
            self.visit_body(body, &mut |expr| {
                if let ExprKind::Call(callee, _) = self.expr(expr).kind {
                    list.push(callee);
                }
            });
        }
        list
    }

    /// The functions that `root` reaches, callees before callers, `root` last. Recursion, an error in the source, is
    /// cut.
    pub fn callees_first(&self, root: FunctionId) -> Vec<FunctionId> {
        self.callees_first_of([root])
    }

    /// The functions that these reach, each once and after those that it calls, in the order of the roots.
    pub fn callees_first_of(&self, roots: impl IntoIterator<Item = FunctionId>) -> Vec<FunctionId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.functions.len()];
        let mut stack = Vec::new();
        for root in roots {
            stack.push((root, false));
            while let Some((id, done)) = stack.pop() {
                if done {
                    order.push(id);
                    continue;
                }
                match seen.get_mut(id.index()) {
                    Some(seen) if !*seen => *seen = true,
                    _ => continue,
                }
                stack.push((id, true));
                stack.extend(self.callees(id).into_iter().rev().map(|callee| (callee, false)));
            }
        }
        order
    }
}
