//! Declarations move to where their variables get their values: `vec3 c; c = a * b;` is `vec3 c = a * b;`.
//!
//! *In:* a body. *Out:* the body; whether anything moved. *Holds:* only the first statement of the same list that names the
//! variable is looked at, and only if it assigns all of it.

use glisten_front::hir::{ExprId, ExprKind, LocalId, Shader, Stmt, StmtKind, VarRef};

/// Moves declarations in a body and the bodies in it.
pub(super) fn join(shader: &Shader, body: &mut Vec<Stmt>) -> bool {
    let mut changed = false;
    for stmt in body.iter_mut() {
        changed |= inner(shader, &mut stmt.kind);
    }
    let mut place = 0;
    while place < body.len() {
        if let Some(Stmt { kind: StmtKind::Local(local, None), .. }) = body.get(place)
            && let Some((to, value)) = first_store(shader, body, place + 1, *local)
        {
            let local = *local;
            if let Some(slot) = body.get_mut(to) {
                slot.kind = StmtKind::Local(local, Some(value));
            }
            body.remove(place);
            changed = true;
        } else {
            place += 1;
        }
    }
    changed
}

fn inner(shader: &Shader, kind: &mut StmtKind) -> bool {
    match kind {
        StmtKind::Block(body) | StmtKind::Loop { body, .. } => join(shader, body),
        StmtKind::If { arms, otherwise } => {
            let arms = arms.iter_mut().fold(false, |changed, (_, body)| join(shader, body) | changed);
            join(shader, otherwise) | arms
        }
        StmtKind::Switch { cases, .. } => cases.iter_mut().fold(false, |changed, case| {
            case.body.iter_mut().fold(changed, |changed, stmt| inner(shader, &mut stmt.kind) | changed)
        }),
        _ => false,
    }
}

/// The first statement that names a local, if it assigns all of it a value that does not name it.
fn first_store(shader: &Shader, body: &[Stmt], from: usize, local: LocalId) -> Option<(usize, ExprId)> {
    // Far away a declaration would be missed where it was.
    let near = body.iter().enumerate().skip(from).take(64);
    for (place, stmt) in near {
        let mut named = false;
        let one = std::slice::from_ref(stmt);
        shader.visit_body(one, &mut |expr| named |= is_local(shader, expr, local));
        if !named {
            continue;
        }
        let StmtKind::Expr(expr) = stmt.kind else { return None };
        let ExprKind::Assign(None, target, value) = shader.expr(expr).kind else { return None };
        let mut own = false;
        shader.visit_expr(value, &mut |expr| own |= is_local(shader, expr, local));
        return (is_local(shader, target, local) && !own).then_some((place, value));
    }
    None
}

fn is_local(shader: &Shader, expr: ExprId, local: LocalId) -> bool {
    matches!(shader.expr(expr).kind, ExprKind::Var(VarRef::Local(named)) if named == local)
}
