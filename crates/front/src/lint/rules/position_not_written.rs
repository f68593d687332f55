//! `position-not-written`: a vertex stage that feeds a fragment stage and never writes `gl_Position`.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinVariable;
use crate::hir::{Shader, Stage};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let [.., producer, fragment] = program.stages.as_slice() else { return };
    if fragment.stage != Stage::Fragment || writes_position(producer) {
        return;
    }
    let Some(main) = producer.main.map(|main| producer.function(main)) else { return };
    let message = format!("the {} stage never writes `gl_Position`", producer.stage.name());
    findings.push(findings.at(main.span, message).here("the position of the primitives is undefined"));
}

fn writes_position(shader: &Shader) -> bool {
    shader.globals.iter().any(|global| global.builtin == Some(BuiltinVariable::Position) && global.written)
}
