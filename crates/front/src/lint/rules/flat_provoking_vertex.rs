//! `flat-provoking-vertex`: a `flat` varying takes another vertex's value on WebGPU and Vulkan.

use super::super::Findings;
use crate::hir::{Interpolation, Stage, Storage};
use crate::link::Program;

pub(super) fn check(program: &Program, findings: &mut Findings<'_>) {
    let Some(fragment) = program.stage(Stage::Fragment).filter(|_| program.stages.len() > 1) else { return };
    let flat = fragment.globals.iter().filter(|global| {
        global.storage == Storage::In
            && global.builtin.is_none()
            && global.interpolation == Interpolation::Flat
            && global.used
    });
    for global in flat {
        let message =
            format!("`{}` is flat: OpenGL takes the last vertex's value, WebGPU and Vulkan the first's", global.name);
        let help = "rotate the indices of each primitive, or give the vertices of a primitive equal values";
        findings.push(findings.at(global.span, message).help(help));
    }
}
