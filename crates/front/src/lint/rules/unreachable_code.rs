//! `unreachable-code`: statements after `return`, `break`, `continue` or `discard` in the same body.

use super::super::{Findings, Subject, running};
use crate::hir::{Stmt, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (_, body) in running(shader) {
            examine(body, findings);
            shader.visit_statements(body, &mut |statement| {
                for inner in statement.kind.bodies() {
                    examine(inner, findings);
                }
            });
        }
    }
}

fn examine(body: &[Stmt], findings: &mut Findings<'_>) {
    let word = |statement: &Stmt| match statement.kind {
        StmtKind::Return(_) => Some("return"),
        StmtKind::Break => Some("break"),
        StmtKind::Continue => Some("continue"),
        StmtKind::Discard => Some("discard"),
        _ => None,
    };
    for pair in body.windows(2) {
        let [statement, next] = pair else { continue };
        // Some people end every case of a switch with a `break`, even after a `return`, and put a `return` behind a `discard`.
        let is_habit = match next.kind {
            StmtKind::Break => true,
            StmtKind::Return(_) => matches!(statement.kind, StmtKind::Discard),
            _ => false,
        };
        if let Some(word) = word(statement).filter(|_| !is_habit) {
            let message = format!("nothing after this `{word}` is ever reached");
            let finding = findings.at(next.span, message);
            findings.push(finding.label(statement.span, "control leaves here"));
            return;
        }
    }
}
