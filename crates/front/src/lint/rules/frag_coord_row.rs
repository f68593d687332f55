//! `frag-coord-row`: the second component of `gl_FragCoord`, which counts from the other side in WebGPU, Direct3D and Metal.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinVariable;
use crate::hir::Stage;
use crate::link::usage::first_use;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let Some(fragment) = subject.program.stage(Stage::Fragment).filter(|one| one.reads_row_of_frag_coord()) else {
        return;
    };
    let coordinate = fragment.globals().find(|(_, global)| global.builtin == Some(BuiltinVariable::FragCoord));
    if let Some(span) = coordinate.and_then(|(id, _)| first_use(fragment, id)) {
        let message = "`gl_FragCoord.y` counts from below in OpenGL, from above in WebGPU, Direct3D and Metal";
        findings
            .push(findings.at(span, message).help("`glisten compile` corrects it by the height of the framebuffer"));
    }
}
