//! `initialized-uniform`: a uniform with a value of its own, which OpenGL ES, Vulkan and WebGPU do not have.

use super::super::{Findings, Subject};
use crate::hir::Storage;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in &subject.program.stages {
        for global in shader.globals.iter().filter(|global| global.storage == Storage::Uniform && global.used) {
            if global.initializer.is_some() && global.span.is_known() {
                let message = format!("`{}` has a value of its own, which only OpenGL has", global.name);
                findings.push(findings.at(global.span, message).help("let the host set it"));
            }
        }
    }
}
