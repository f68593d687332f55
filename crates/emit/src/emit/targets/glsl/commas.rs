//! Commas of constant expressions, which later versions do not allow.
//!
//! *In:* a copy of a stage. *Out:* the same stage. *Holds:* what does something, stays.

use glisten_front::hir::{ExprKind, Shader, may_act};

/// From 4.30 on and in ES 3.00, an expression with a comma is not constant (GLSL 4.30 §4.3.3): where the left side does nothing, the right
/// one is written alone.
pub(super) fn plain_commas(shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(ExprKind::Comma(left, right)) = shader.exprs.get(index).map(|expr| expr.kind.clone()) else {
            continue;
        };
        let mut does_something = false;
        shader.visit_expr(left, &mut |id| {
            does_something |= may_act(&shader.expr(id).kind);
        });
        let kind = shader.expr(right).kind.clone();
        if let Some(expr) = shader.exprs.get_mut(index).filter(|_| !does_something) {
            expr.kind = kind;
        }
    }
}
