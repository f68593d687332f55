//! `unwritten-output`: a color that a fragment shader declares and never writes.

use super::super::{Findings, Subject};
use crate::hir::{Stage, Storage};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let Some(fragment) = program.stage(Stage::Fragment) else { return };
    for output in fragment.globals.iter().filter(|global| global.storage == Storage::Out && global.builtin.is_none()) {
        if !output.written {
            let message = format!("the fragment output `{}` is never written", output.name);
            findings.push(findings.at(output.span, message).here("its color is undefined"));
        }
    }
}
