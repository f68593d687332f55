//! `non-finite-constant`: a constant operation that yields an infinity or NaN from finite operands.

use super::super::{Findings, Subject, running};
use crate::fold;
use crate::hir::{ExprId, ExprKind, ScalarValue, Shader, Types};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (_, body) in running(shader) {
            shader.visit_body(body, &mut |expr| examine(&program.types, shader, expr, findings));
        }
        let initializers = shader.globals.iter().filter(|global| global.used).filter_map(|global| global.initializer);
        for initializer in initializers {
            shader.visit_expr(initializer, &mut |expr| examine(&program.types, shader, expr, findings));
        }
    }
}

fn examine(types: &Types, shader: &Shader, expr: ExprId, findings: &mut Findings<'_>) {
    // Operands nested more deeply are not constants that a person wrote.
    if !matches!(shader.expr(expr).kind, ExprKind::Binary(..) | ExprKind::BuiltinCall(..)) {
        return;
    }
    let children = shader.children(expr);
    let simple = children.iter().all(|&child| is_finite(types, shader, child) == Some(true));
    if simple && is_finite(types, shader, expr) == Some(false) {
        let message = "this constant is infinite or not a number";
        let help =
            "WGSL refuses such constants; write a large number, or keep the operands out of constant expressions";
        findings.push(findings.at(shader.expr(expr).span, message).help(help));
    }
}

/// Whether all numbers of a constant are finite; `None` if it is not constant. Examines only literals, constructors
/// and operators close by, so that long chains are not evaluated again at each link.
fn is_finite(types: &Types, shader: &Shader, expr: ExprId) -> Option<bool> {
    const REACH: usize = 64;
    let mut count = 0;
    let mut pending = vec![expr];
    while let Some(id) = pending.pop() {
        count += 1;
        if count > REACH || matches!(shader.expr(id).kind, ExprKind::Var(_)) {
            return None;
        }
        pending.extend(shader.children(id));
    }
    let value = fold::evaluate(shader, types, expr, &|_| None)?;
    Some(value.scalars.iter().all(|scalar| !matches!(scalar, ScalarValue::Float(number) if !number.is_finite())))
}
