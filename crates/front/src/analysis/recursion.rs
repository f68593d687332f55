//! Recursion (§6.1): the call graph must not have a cycle, even if it is never entered.

use super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::statements;
use crate::hir::{ExprId, ExprKind, FunctionId};
use crate::source::Span;

/// A call: its caller, its callee and its position.
#[derive(Clone, Copy)]
struct Edge {
    callee: FunctionId,
    span: Span,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    Open,
    Done,
}

impl Analyzer<'_> {
    /// Reports each call that closes a cycle.
    pub(super) fn check_recursion(&mut self) {
        let edges: Vec<Vec<Edge>> = self.shader.functions().map(|(id, _)| self.calls_of(id)).collect();
        let mut states = vec![State::New; edges.len()];
        let mut found: Vec<(FunctionId, Edge)> = Vec::new();
        for start in 0..edges.len() {
            if states.get(start) != Some(&State::New) {
                continue;
            }
            // The path from `start`: each function, and the index of its next call to follow.
            let mut path = vec![(start, 0)];
            while let Some(&mut (at, ref mut next)) = path.last_mut() {
                set(&mut states, at, State::Open);
                let Some(&edge) = edges.get(at).and_then(|edges| edges.get(*next)) else {
                    set(&mut states, at, State::Done);
                    path.pop();
                    continue;
                };
                *next += 1;
                let callee = edge.callee.index();
                match states.get(callee) {
                    Some(State::New) => path.push((callee, 0)),
                    Some(State::Open) => found.push((FunctionId::new(at), edge)),
                    _ => {}
                }
            }
        }
        for (caller, edge) in found {
            let (caller, callee) = (self.shader.function(caller), self.shader.function(edge.callee));
            let message = if caller.name == callee.name && caller.span == callee.span {
                format!("`{}` calls itself", callee.name)
            } else {
                format!("`{}` and `{}` call each other", caller.name, callee.name)
            };
            let finding = Diagnostic::new(&statements::RECURSION, edge.span, message)
                .here("this call closes the circle")
                .label(callee.span, "declared here");
            self.report(finding);
        }
    }

    fn calls_of(&self, id: FunctionId) -> Vec<Edge> {
        let mut edges = Vec::new();
        let mut pending: Vec<ExprId> = self.shader.roots(self.shader.function(id).body.as_deref().unwrap_or(&[]));
        pending.reverse();
        while let Some(id) = pending.pop() {
            let expr = self.shader.expr(id);
            if let ExprKind::Call(callee, _) = expr.kind {
                edges.push(Edge { callee, span: expr.span });
            }
            pending.extend(expr.kind.children().into_iter().rev());
        }
        edges
    }
}

fn set(states: &mut [State], index: usize, state: State) {
    if let Some(slot) = states.get_mut(index) {
        *slot = state;
    }
}
