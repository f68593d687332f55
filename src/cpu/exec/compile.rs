//! HIR to instructions.

use super::code::Inner;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::Stage;
use crate::link::Program;
use crate::source::Span;

pub(super) fn compile(_: &Program, stage: Stage) -> Result<Inner, Vec<Diagnostic>> {
    Err(vec![Diagnostic::new(
        &codes::general::NOT_SUPPORTED_YET,
        Span::default(),
        format!("the CPU reference cannot run {} stages yet", stage.name()),
    )])
}
