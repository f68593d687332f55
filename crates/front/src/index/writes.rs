//! Where variables are written: assignments (GLSL 1.50 §5.8), increments, and arguments for `out` and `inout` parameters (§6.1.1).

use crate::hir::{ExprId, ExprKind, ParamMode, Shader};
use crate::source::Span;
use rustc_hash::FxHashSet;

/// The names through which a shader writes to variables: those of the variables, and of the members that are written.
pub(super) fn written(shader: &Shader) -> FxHashSet<Span> {
    let mut spans = FxHashSet::default();
    for expr in &shader.exprs {
        match &expr.kind {
            ExprKind::Assign(_, place, _) | ExprKind::IncDec(_, place) => add(shader, *place, &mut spans),
            ExprKind::Call(function, arguments) => {
                let Some(function) = shader.functions.get(function.index()) else { continue };
                for (index, &argument) in arguments.iter().enumerate() {
                    if matches!(function.param_mode(index), ParamMode::Out | ParamMode::Inout) {
                        add(shader, argument, &mut spans);
                    }
                }
            }
            _ => {}
        }
    }
    spans
}

fn add(shader: &Shader, place: ExprId, spans: &mut FxHashSet<Span>) {
    let mut at = place;
    loop {
        let Some(expr) = shader.exprs.get(at.index()) else { return };
        match &expr.kind {
            ExprKind::Var(_) => {
                spans.insert(expr.span);
                return;
            }
            ExprKind::Member(inner, _) | ExprKind::Index(inner, _) | ExprKind::Swizzle(inner, _) => at = *inner,
            _ => return,
        }
    }
}
