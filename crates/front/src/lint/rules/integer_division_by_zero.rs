//! `division-by-zero`: an integer divided by a constant zero.

use super::super::{Findings, Subject, running};
use crate::fold;
use crate::hir::{BinaryOp, ExprKind, ScalarValue};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (_, body) in running(shader) {
            shader.visit_body(body, &mut |expr| {
                let divisor = match shader.expr(expr).kind {
                    ExprKind::Binary(BinaryOp::Div | BinaryOp::Rem, _, divisor)
                    | ExprKind::Assign(Some(BinaryOp::Div | BinaryOp::Rem), _, divisor) => divisor,
                    _ => return,
                };
                let integer =
                    program.types.scalar_of(shader.expr(divisor).ty).is_some_and(|scalar| scalar.is_integer());
                let value = if integer { fold::evaluate(shader, &program.types, divisor, &|_| None) } else { None };
                let is_zero = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Int(0) | ScalarValue::Uint(0));
                if value.is_some_and(|value| value.scalars.iter().any(is_zero)) {
                    let message = "an integer is divided by zero, which gives an undefined value";
                    findings.push(findings.at(shader.expr(divisor).span, message));
                }
            });
        }
    }
}
