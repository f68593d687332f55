//! `flat-provoking-vertex`: a `flat` varying takes another vertex's value on WebGPU and Vulkan.

use super::super::{Findings, Subject};
use crate::hir::{Interpolation, Stage, Storage};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let Some(fragment) = program.stage(Stage::Fragment).filter(|_| program.stages.len() > 1) else { return };
    let flat = fragment.globals.iter().filter(|global| {
        global.storage == Storage::In
            && global.builtin.is_none()
            && global.interpolation == Interpolation::Flat
            && global.used
    });
    // They have one cause: how the host draws. So they are one finding.
    let all: Vec<_> = flat.collect();
    let [first, others @ ..] = all.as_slice() else { return };
    let (them, are) = match others {
        [] => (format!("`{}`", first.name), "is"),
        [second] => (format!("`{}` and `{}`", first.name, second.name), "are"),
        _ => (format!("`{}` and {} more varyings", first.name, others.len()), "are"),
    };
    let message = format!("{them} {are} flat: OpenGL takes the last vertex's value, WebGPU and Vulkan the first's");
    let help = "rotate the indices of each primitive, or give the vertices of a primitive equal values";
    let mut finding = findings.at(first.span, message).help(help);
    for other in others.iter().take(MOST_LABELS) {
        finding = finding.label(other.span, "flat, too");
    }
    findings.push(finding);
}

/// The number of other varyings that a finding shows.
const MOST_LABELS: usize = 3;
