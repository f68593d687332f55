//! Static use: which globals a body reads, and which it may write (GLSL 1.50 §4.3.4, "actually read").

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use crate::hir::{ExprKind, GlobalId, Shader, VarRef, written_by};
use crate::source::Span;

/// The position of the first assignment to a global in the functions that `main` reaches.
pub(super) fn first_write(shader: &Shader, global: GlobalId) -> Option<Span> {
    let mut first: Option<Span> = None;
    for function in shader.functions.iter().filter(|function| function.reachable) {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if shader.root_variable(target) == Some(VarRef::Global(global)) {
                    let span = shader.expr(target).span;
                    first = Some(first.map_or(span, |known| known.min(span)));
                }
            });
        });
    }
    first
}

/// Whether any function, reached by `main` or not, assigns to a global.
pub(super) fn is_assigned(shader: &Shader, global: GlobalId) -> bool {
    let mut found = false;
    for function in &shader.functions {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            written_by(shader, expr, &mut |target| {
                found |= shader.root_variable(target) == Some(VarRef::Global(global));
            });
        });
    }
    found
}

/// Where a global is named in the text, in order.
pub(super) fn uses(shader: &Shader, global: GlobalId) -> Vec<Span> {
    let mut spans = Vec::new();
    for function in &shader.functions {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            let expr = shader.expr(expr);
            if matches!(&expr.kind, ExprKind::Var(VarRef::Global(id)) if *id == global) {
                spans.push(expr.span);
            }
        });
    }
    spans.sort_unstable();
    spans.dedup();
    spans
}

/// Where a global is first named in the text of the functions that `main` reaches.
pub fn first_use(shader: &Shader, global: GlobalId) -> Option<Span> {
    let mut first: Option<Span> = None;
    for function in shader.functions.iter().filter(|function| function.reachable) {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            let expr = shader.expr(expr);
            // What the linker adds has no place in the text.
            if expr.span.is_known() && matches!(expr.kind, ExprKind::Var(VarRef::Global(named)) if named == global) {
                first = Some(first.map_or(expr.span, |known| known.min(expr.span)));
            }
        });
    }
    first
}
