//! `infinite-loop`: a loop whose condition is always true and that nothing leaves.

use super::super::{Findings, Subject, running};
use crate::fold;
use crate::hir::{ScalarValue, Shader, Stmt, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (_, body) in running(shader) {
            shader.visit_statements(body, &mut |statement| {
                let StmtKind::Loop { condition, body, .. } = &statement.kind else { return };
                let always = condition.as_ref().is_none_or(|condition| {
                    let value = fold::evaluate(shader, &program.types, condition.expr, &|_| None);
                    value.is_some_and(|value| value.scalars.first() == Some(&ScalarValue::Bool(true)))
                });
                if always && !has_way_out(body) {
                    let message = "this loop never ends";
                    findings
                        .push(findings.at(head(shader, statement), message).help("leave it by `break` or `return`"));
                }
            });
        }
    }
}

/// The span of the condition, or of the whole loop if it has none.
fn head(shader: &Shader, statement: &Stmt) -> crate::source::Span {
    match &statement.kind {
        StmtKind::Loop { condition: Some(condition), .. } => shader.expr(condition.expr).span,
        _ => statement.span,
    }
}

/// Whether the body contains a `break` of this loop, a `return` or a `discard`.
fn has_way_out(body: &[Stmt]) -> bool {
    let mut found = false;
    let mut pending: Vec<(&Stmt, bool)> = body.iter().map(|statement| (statement, true)).collect();
    while let Some((statement, breaks)) = pending.pop() {
        match &statement.kind {
            StmtKind::Break if breaks => found = true,
            StmtKind::Return(_) | StmtKind::Discard => found = true,
            _ => {}
        }
        let breaks = breaks && !matches!(statement.kind, StmtKind::Loop { .. } | StmtKind::Switch { .. });
        pending.extend(statement.kind.bodies().into_iter().flatten().map(|inner| (inner, breaks)));
    }
    found
}
