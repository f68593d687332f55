//! `pow-of-negative`: `pow` with a base that is a negative constant.

use super::super::{Findings, Subject, running};
use crate::builtin::BuiltinFunction;
use crate::fold;
use crate::hir::{ExprKind, ScalarValue};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (_, body) in running(shader) {
            shader.visit_body(body, &mut |expr| {
                let ExprKind::BuiltinCall(BuiltinFunction::Pow, arguments) = &shader.expr(expr).kind else { return };
                let Some(&base) = arguments.first() else { return };
                let value = fold::evaluate(shader, &program.types, base, &|_| None);
                let negative = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Float(number) if *number < 0.0);
                if value.is_some_and(|value| value.scalars.iter().any(negative)) {
                    let message = "`pow` of a negative base is undefined";
                    let help = "multiply instead, or take `abs` of the base and put the sign back";
                    findings.push(findings.at(shader.expr(base).span, message).help(help));
                }
            });
        }
    }
}
