//! `unused-varying`: an output that a stage writes and the next stage does not declare.

use super::super::Findings;
use crate::hir::{Global, Storage};
use crate::link::Program;

fn name(global: &Global) -> &str {
    global.block.as_ref().map_or(&global.name, |block| &block.name)
}

pub(super) fn check(program: &Program, findings: &mut Findings<'_>) {
    for pair in program.stages.windows(2) {
        let [producer, consumer] = pair else { continue };
        let located = |global: &Global| consumer.globals.iter().any(|other| other.location == global.location);
        for output in
            producer.globals.iter().filter(|global| global.storage == Storage::Out && global.builtin.is_none())
        {
            let declared =
                consumer.globals.iter().any(|other| other.storage == Storage::In && name(other) == name(output));
            if output.written && !declared && !(output.location.is_some() && located(output)) {
                let message =
                    format!("`{}` is written, and the {} stage does not read it", name(output), consumer.stage.name());
                let finding = findings.at(output.span, message);
                findings.push(finding.help("remove it, or declare it as an input of the next stage"));
            }
        }
    }
}
