//! Programs of a single stage: what they are warned of, and when they are none.
//!
//! *In:* a compiled unit. *Out:* a warning, or errors instead of warnings. *Holds:* such a shader is valid as a part of a program,
//! which `lint` accepts; these are the rules for emitting it.

use crate::arguments::engine::Engines;
use crate::inputs::Input;
use crate::session::Unit;
use glisten_front::diagnostic::codes::general::LONE_STAGE;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::{Diagnostic, Severity};
use glisten_front::source::Span;

/// Turns the warnings of a single shader that lacks a function into errors. Such a shader is valid as part of a
/// program, which `lint` accepts, but nothing can be emitted for it.
pub(crate) fn refuse_what_is_no_program(unit: &mut Unit) {
    if unit.is_program() {
        return;
    }
    for diagnostic in &mut unit.batch.diagnostics {
        if [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION].contains(&diagnostic.code) {
            diagnostic.severity = Severity::Error;
        }
    }
}

/// The warning about a program of a single stage.
pub(crate) fn warning(unit: &Unit, engines: &Engines) -> Option<Diagnostic> {
    let has_no_partner = |input: &Input| input.path.as_ref().is_some_and(|path| engines.is_whole(path));
    if !unit.group.is_lone() || !unit.is_program() || unit.group.inputs.iter().all(has_no_partner) {
        return None;
    }
    let (_, file) = unit.batch.sources.files().next()?;
    let stage = unit.group.inputs.first().map_or("", |input| input.stage.name());
    let message = format!("`{}` is compiled without its partner", file.name());
    let span = Span::new(file.base(), file.base());
    let warning = Diagnostic::new(&LONE_STAGE, span, message)
        .note(format!("locations of varyings and the uniform block are those of the {stage} stage alone"))
        .help("name all files of a program in one command, or say `--program a.vert,b.frag`");
    Some(warning)
}
