//! Which loops a discarded invocation may run, in targets where it continues after a `discard` (§6.4).
//!
//! *In:* a shader, and the facts of its functions. *Out:* the loops that have to check whether the invocation was
//! discarded: those that do not evidently end, and that a `discard` may precede. *Holds:* a `discard` precedes a loop if it
//! is before it in the text, in it, in a loop around it, or in a function that is called there; what precedes the call of
//! a function precedes everything in it.

use super::facts::{FunctionFacts, GuardedLoops, is_counted};
use glisten_front::hir::{ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind};

/// The loops of the functions that `main` reaches. `order` has callees before callers.
pub(super) fn guarded_loops(shader: &Shader, functions: &[FunctionFacts], order: &[FunctionId]) -> GuardedLoops {
    let mut discards = vec![false; functions.len()];
    for id in order {
        let Some(facts) = functions.get(id.index()) else { continue };
        let calls = |callee: &FunctionId| discards.get(callee.index()).copied().unwrap_or(false);
        let own = facts.discards || facts.calls.iter().any(calls);
        if let Some(place) = discards.get_mut(id.index()) {
            *place = own;
        }
    }
    let mut walk =
        Walk { shader, discards, entered: vec![false; functions.len()], current: None, loops: GuardedLoops::default() };
    // Callers first: what precedes a call is known before its callee is walked.
    for id in order.iter().rev() {
        walk.current = functions.get(id.index());
        let entered = walk.entered.get(id.index()).copied().unwrap_or(false);
        walk.statements(shader.function(*id).body.as_deref().unwrap_or(&[]), entered);
    }
    walk.loops
}

struct Walk<'a> {
    shader: &'a Shader,
    /// For each function, whether it or one that it calls discards.
    discards: Vec<bool>,
    /// For each function, whether a `discard` may precede a call.
    entered: Vec<bool>,
    current: Option<&'a FunctionFacts>,
    loops: GuardedLoops,
}

impl Walk<'_> {
    /// Walks statements, before which there may be a `discard` or not. Returns whether there may be one after them.
    fn statements(&mut self, body: &[Stmt], mut seen: bool) -> bool {
        for stmt in body {
            seen = self.statement(stmt, seen);
        }
        seen
    }

    fn statement(&mut self, stmt: &Stmt, mut seen: bool) -> bool {
        if let StmtKind::Loop { condition, step, .. } = &stmt.kind {
            seen |= self.contains(stmt);
            let condition = condition.as_ref().map(|condition| condition.expr);
            let counted = self.current.is_some_and(|facts| is_counted(self.shader, facts, condition, *step));
            if seen && !counted {
                self.loops.insert((stmt.span.start, stmt.span.end));
            }
        }
        for expr in stmt.kind.exprs() {
            seen = self.calls(expr, seen);
        }
        let mut after = seen || matches!(stmt.kind, StmtKind::Discard);
        let falls_through = matches!(stmt.kind, StmtKind::Switch { .. });
        for inner in stmt.kind.bodies() {
            let before = if falls_through { after } else { seen };
            after |= self.statements(inner, before);
        }
        after
    }

    /// Marks the functions that an expression calls. Returns whether there may be a `discard` after it.
    fn calls(&mut self, expr: ExprId, mut seen: bool) -> bool {
        let mut callees = Vec::new();
        self.shader.visit_expr(expr, &mut |id| {
            if let ExprKind::Call(callee, _) = self.shader.expr(id).kind {
                callees.push(callee);
            }
        });
        // The order of operands is not looked at: what one of them discards may precede all others.
        seen |= callees.iter().any(|callee| self.discards.get(callee.index()).copied().unwrap_or(false));
        for callee in callees {
            if let Some(entered) = self.entered.get_mut(callee.index()) {
                *entered |= seen;
            }
        }
        seen
    }

    /// Whether a `discard` is in a statement, or in a function that it calls.
    fn contains(&self, stmt: &Stmt) -> bool {
        let discards = |id: ExprId| {
            let mut found = false;
            self.shader.visit_expr(id, &mut |id| {
                if let ExprKind::Call(callee, _) = self.shader.expr(id).kind {
                    found |= self.discards.get(callee.index()).copied().unwrap_or(false);
                }
            });
            found
        };
        let mut pending = vec![stmt];
        while let Some(stmt) = pending.pop() {
            if matches!(stmt.kind, StmtKind::Discard) || stmt.kind.exprs().into_iter().any(discards) {
                return true;
            }
            pending.extend(stmt.kind.bodies().into_iter().flatten());
        }
        false
    }
}
