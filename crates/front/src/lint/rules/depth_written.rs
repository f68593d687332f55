//! `depth-written`: `gl_FragDepth` in a shader, which keeps the GPU from testing the depth before the fragment stage.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinVariable;
use crate::hir::Stage;
use crate::link::usage::first_use;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let Some(fragment) = subject.program.stage(Stage::Fragment) else { return };
    for (id, global) in fragment.globals().filter(|(_, global)| global.builtin == Some(BuiltinVariable::FragDepth)) {
        if global.written {
            let span = first_use(fragment, id).unwrap_or(global.span);
            let finding = findings.at(span, "the depth test has to wait for the fragment stage");
            findings
                .push(finding.help(
                    "say with `layout(depth_greater)` or `depth_less` how it changes, where the language has it",
                ));
        }
    }
}
