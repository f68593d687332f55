//! `point-size`: `gl_PointSize`, which WebGPU and Direct3D do not have.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinVariable;
use crate::link::usage::first_use;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in &subject.program.stages {
        let mut sizes = shader.globals().filter(|(_, global)| global.builtin == Some(BuiltinVariable::PointSize));
        let Some((id, _)) = sizes.find(|(_, global)| global.written) else { continue };
        if let Some(span) = first_use(shader, id) {
            let finding = findings.at(span, "WebGPU and Direct3D draw points of one pixel, whatever `gl_PointSize` is");
            findings.push(finding.help("draw a square for each point instead"));
        }
    }
}
