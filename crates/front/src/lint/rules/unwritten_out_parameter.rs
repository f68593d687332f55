//! `unwritten-out-parameter`: an `out` parameter that its function never assigns.

use super::super::{Findings, Subject, running};
use crate::hir::written_by;
use crate::hir::{LocalKind, ParamMode, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (function, body) in running(shader) {
            let mut written = vec![false; function.param_count];
            shader.visit_body(body, &mut |expr| {
                written_by(shader, expr, &mut |target| {
                    if let Some(VarRef::Local(local)) = shader.root_variable(target)
                        && let Some(written) = written.get_mut(local.index())
                    {
                        *written = true;
                    }
                });
            });
            for (param, written) in function.params().iter().zip(written) {
                if param.kind == LocalKind::Param(ParamMode::Out) && !written && !param.name.is_empty() {
                    let message = format!("`{}` never writes its `out` parameter `{}`", function.name, param.name);
                    findings.push(findings.at(param.span, message).here("the caller gets an undefined value"));
                }
            }
        }
    }
}
