//! Clamps of what is clamped to the same numbers: `clamp(clamp(x, 0.0, 1.0), 0.0, 1.0)` is one of them.
//!
//! *In:* a stage. *Out:* the stage; whether anything went. *Holds:* the second clamp finds a number between the limits, or a NaN of which
//! the first has made what it makes of one.

use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{Expr, ExprId, ExprKind, Shader, same_value};

/// Leaves one of two equal clamps.
pub(super) fn join(shader: &mut Shader) -> bool {
    let mut changed = false;
    for index in 0..shader.exprs.len() {
        let inner = shader.exprs.get(index).and_then(|outer| repeated(shader, outer));
        let Some(inner) = inner else { continue };
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = inner;
            changed = true;
        }
    }
    changed
}

/// The clamp that an expression repeats.
fn repeated(shader: &Shader, outer: &Expr) -> Option<ExprKind> {
    let [value, low, high] = limits(&outer.kind)?;
    let inner = shader.expr(value);
    let [_, inner_low, inner_high] = limits(&inner.kind)?;
    let same = inner.ty == outer.ty && same_value(shader, low, inner_low) && same_value(shader, high, inner_high);
    same.then(|| inner.kind.clone())
}

fn limits(kind: &ExprKind) -> Option<[ExprId; 3]> {
    let ExprKind::BuiltinCall(F::Clamp, list) = kind else { return None };
    list.as_slice().try_into().ok()
}
