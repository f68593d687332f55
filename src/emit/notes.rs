//! What emission leaves out without changing the picture, worth a note to who wrote it.

use super::Conventions;
use crate::builtin::BuiltinVariable;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::targets::POINT_SIZE_DROPPED;
use crate::hir::Stage;
use crate::link::Program;

/// Notes on a program under these conventions; never an error.
pub fn notes(program: &Program, conventions: &Conventions) -> Vec<Diagnostic> {
    let Some(vertex) = program.stage(Stage::Vertex) else { return Vec::new() };
    let is_size = |global: &&crate::hir::Global| global.builtin == Some(BuiltinVariable::PointSize) && global.written;
    match vertex.globals.iter().find(is_size) {
        Some(global) if !conventions.program_point_size => {
            let span = if global.span.is_known() {
                global.span
            } else {
                vertex.main.map_or(global.span, |main| vertex.function(main).span)
            };
            let message = "`gl_PointSize` is written and has no effect: points are one pixel wide";
            vec![
                Diagnostic::new(&POINT_SIZE_DROPPED, span, message)
                    .help("where the host enables PROGRAM_POINT_SIZE, say `--program-point-size`"),
            ]
        }
        _ => Vec::new(),
    }
}
