//! Finds the differences that are the fraction of a number: `x - floor(x)`, `x - floor(x / y) * y`. They show the digits that the number
//! has, as `fract(x)` and `mod(x, y)` do.
//!
//! *In:* a scene. *Out:* the spans of these differences.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, Shader, Stage, same_form};
use glisten_front::source::Span;
use glisten_scene::Scene;
use std::collections::BTreeSet;

/// The differences of a scene's programs.
pub(super) fn fractions(scene: &Scene) -> BTreeSet<(Stage, Span)> {
    let shaders = scene.draws.iter().flat_map(|draw| &draw.program.stages);
    let of = |shader: &Shader| -> Vec<(Stage, Span)> {
        let differences = shader.exprs.iter().filter_map(|expr| match expr.kind {
            ExprKind::Binary(BinaryOp::Sub, from, whole) if is_whole_of(shader, whole, from) => Some(expr.span),
            _ => None,
        });
        differences.map(|span| (shader.stage, span)).collect()
    };
    shaders.flat_map(of).collect()
}

/// Whether an expression is the `floor` of another one, or of a part or a multiple of it, times a number or not.
fn is_whole_of(shader: &Shader, whole: ExprId, of: ExprId) -> bool {
    let is_floor = |id: ExprId| match &shader.expr(id).kind {
        ExprKind::BuiltinCall(BuiltinFunction::Floor | BuiltinFunction::Trunc, arguments) => {
            arguments.first().is_some_and(|argument| is_scaled(shader, *argument, of))
        }
        _ => false,
    };
    match shader.expr(whole).kind {
        ExprKind::Binary(BinaryOp::Mul, left, right) => is_floor(left) || is_floor(right),
        _ => is_floor(whole),
    }
}

fn is_scaled(shader: &Shader, scaled: ExprId, of: ExprId) -> bool {
    match shader.expr(scaled).kind {
        ExprKind::Binary(BinaryOp::Mul, left, right) => {
            [left, right, scaled].iter().any(|one| same_form(shader, *one, of))
        }
        ExprKind::Binary(BinaryOp::Div, left, _) => same_form(shader, left, of) || same_form(shader, scaled, of),
        _ => same_form(shader, scaled, of),
    }
}
