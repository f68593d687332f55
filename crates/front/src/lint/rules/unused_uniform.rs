//! `unused-uniform`: a uniform that the shader does not read.

use super::super::unused::is_unused;
use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::hir::Storage;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in &subject.program.stages {
        for global in &shader.globals {
            if global.storage != Storage::Uniform || !is_unused(subject, shader, global) {
                continue;
            }
            let whole = subject.texts.simple_statement(global.span);
            let fix = whole.and_then(|whole| subject.texts.remove(Applicability::Unsafe, whole, "remove it"));
            let message = format!("`{}` is a uniform that nothing reads", global.name);
            findings.push(findings.at(global.span, message).help("remove it").maybe_fix(fix));
        }
    }
}
