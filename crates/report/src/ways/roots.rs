//! Forms of `inversesqrt`: one root in place of a root and a division.
//!
//! *In:* a scene and one of its draws. *Out:* the scene with `normalize(v)` and `v / length(v)` as `v * inversesqrt(dot(v, v))`,
//! and `a / sqrt(x)` as `a * inversesqrt(x)`. *Holds:* the same in exact arithmetic; every operand is evaluated as often as
//! before.

use super::edit::{Edited, Open, call, with_draw};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, Scalar, Shader, Stage, TypeId, Types, same_form};
use glisten_scene::Scene;

/// An expression, and its operands in the call that takes its place.
enum Root {
    /// `normalize(v)`, `v / length(v)`
    Unit(ExprId),
    /// `a / sqrt(x)`
    Over(ExprId, ExprId),
}

/// The scene with roots by `inversesqrt`, and how many there are.
pub(super) fn inverse(scene: &Scene, index: usize) -> Option<(Scene, usize)> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let types = edited.types.clone();
    let mut count = 0;
    for stage in [Stage::Vertex, Stage::Fragment] {
        let open = if stage == Stage::Vertex { &mut edited.vertex } else { &mut edited.fragment };
        for (id, root) in roots(&types, &open.shader) {
            rewrite(&types, open, id, &root);
            count += 1;
        }
    }
    (count > 0).then_some(())?;
    Some((with_draw(scene, index, edited.draw(draw)?)?, count))
}

fn roots(types: &Types, shader: &Shader) -> Vec<(ExprId, Root)> {
    let mut found = Vec::new();
    for function in shader.main.map(|main| shader.callees_first(main)).unwrap_or_default() {
        shader.visit_body(shader.function(function).body.as_deref().unwrap_or(&[]), &mut |id| {
            let root = match &shader.expr(id).kind {
                ExprKind::BuiltinCall(BuiltinFunction::Normalize, list) => list.first().copied().map(Root::Unit),
                ExprKind::Binary(BinaryOp::Div, a, b) => quotient(types, shader, *a, *b),
                _ => None,
            };
            let floats = types.scalar_of(shader.expr(id).ty) == Some(Scalar::Float);
            found.extend(root.filter(|_| floats).map(|root| (id, root)));
        });
    }
    found
}

fn quotient(types: &Types, shader: &Shader, a: ExprId, b: ExprId) -> Option<Root> {
    let ExprKind::BuiltinCall(function, list) = &shader.expr(b).kind else { return None };
    let x = *list.first()?;
    let is_vector = types.flat_len(shader.expr(x).ty) > 1;
    match function {
        BuiltinFunction::Length if is_vector && same_form(shader, a, x) => Some(Root::Unit(a)),
        BuiltinFunction::Sqrt if !is_vector => Some(Root::Over(a, x)),
        _ => None,
    }
}

fn rewrite(types: &Types, open: &mut Open, id: ExprId, root: &Root) {
    let ty = |id: ExprId| open.shader.expr(id).ty;
    match *root {
        Root::Unit(v) => {
            let params = [ty(v)];
            call(types, open, id, ("unit_vector", &params, "return a * inversesqrt(dot(a, a));"), vec![v]);
        }
        Root::Over(a, x) => {
            let params = [ty(a), TypeId::FLOAT];
            call(types, open, id, ("over_root", &params, "return a * inversesqrt(b);"), vec![a, x]);
        }
    }
}
