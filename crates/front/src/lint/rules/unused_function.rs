//! `unused-function`: a function of the shader's own file that nothing calls.

use super::super::unused::{body, declares_function};
use super::super::{Findings, Subject};
use crate::hir::Shader;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        for function in shader.functions.iter().filter(|function| !function.reachable && function.body.is_some()) {
            let is_own = subject.texts.is_own(shader, function.span);
            if is_own && !is_named(subject, shader, &function.name) && subject.texts.are_whole(shader) {
                findings
                    .push(findings.at(function.span, format!("nothing calls `{}`", function.name)).help("remove it"));
            }
        }
    }
}

/// Whether a name is used anywhere, other than in declarations of functions and inside of functions of that name.
fn is_named(subject: &Subject<'_>, shader: &Shader, name: &str) -> bool {
    let own: Vec<_> =
        shader.functions.iter().filter(|function| function.name == name).filter_map(|one| body(subject, one)).collect();
    subject.texts.files(shader).into_iter().any(|file| {
        let lexemes = subject.texts.lexemes(file);
        lexemes.places(name).any(|span| {
            let within = own.iter().any(|(_, body)| body.start < span.start && span.end < body.end);
            !within && !declares_function(&lexemes, lexemes.from(span.start))
        })
    })
}
