//! `unused-varying`: an output that a stage writes and the next stage does not declare.

use super::super::{Findings, Subject};
use crate::hir::{Global, Storage};
use crate::link::usage::first_use;

/// The name by which the next stage reads an output. The color of a back face comes in place of the front color (GLSL 1.20
/// §7.6), where the host selects it.
fn read_as(output: &Global) -> &str {
    match output.match_name() {
        "gl_BackColor" => "gl_FrontColor",
        "gl_BackSecondaryColor" => "gl_FrontSecondaryColor",
        name => name,
    }
}

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for pair in program.stages.windows(2) {
        let [producer, consumer] = pair else { continue };
        let located = |global: &Global| {
            let mut inputs = consumer.globals.iter().filter(|other| other.storage == Storage::In);
            inputs.any(|other| other.location == global.location)
        };
        let outputs =
            producer.globals().filter(|(_, global)| global.storage == Storage::Out && global.builtin.is_none());
        for (id, output) in outputs {
            let is_input = |other: &Global| other.storage == Storage::In && other.match_name() == read_as(output);
            let declared = consumer.globals.iter().any(is_input);
            // The fixed-function pipeline reads it, to clip (GLSL 1.20 §7.1).
            let is_clipped = output.is_fixed() && output.name == "gl_ClipVertex";
            if !output.written || declared || is_clipped || (output.location.is_some() && located(output)) {
                continue;
            }
            let name = output.block.as_ref().map_or(&output.name, |block| &block.name);
            let message = format!("`{name}` is written, and the {} stage does not read it", consumer.stage.name());
            let (span, help) = if output.is_fixed() {
                (first_use(producer, id).unwrap_or(output.span), "remove what is assigned to it")
            } else {
                (output.span, "remove it, or declare it as an input of the next stage")
            };
            findings.push(findings.at(span, message).help(help));
        }
    }
}
