//! Bodies that never reach their ends: a function with such a body always returns a value.
//!
//! *In:* statements. *Out:* yes, or "not obviously". *Not done here:* whether a condition holds.

use glisten_front::hir::{Stmt, StmtKind};

/// Whether a body is certain not to reach its end. Where that is not obvious, the answer is no.
pub(super) fn always_leaves(body: &[Stmt]) -> bool {
    body.iter().any(|stmt| match &stmt.kind {
        StmtKind::Return(_) | StmtKind::Discard => true,
        StmtKind::Block(inner) => always_leaves(inner),
        StmtKind::If { arms, otherwise } => always_leaves(otherwise) && arms.iter().all(|(_, arm)| always_leaves(arm)),
        StmtKind::Loop { condition: None, body, .. } => !breaks(body),
        _ => false,
    })
}

/// Whether a loop's body may leave the loop by `break`.
fn breaks(body: &[Stmt]) -> bool {
    body.iter().any(|stmt| match &stmt.kind {
        StmtKind::Break => true,
        // Their own `break` leaves them alone.
        StmtKind::Loop { .. } | StmtKind::Switch { .. } => false,
        kind => kind.bodies().into_iter().any(breaks),
    })
}
