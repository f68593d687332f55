//! Several shaders of one stage become one (OpenGL 3.2 §2.11.2).

use super::Context;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::Shader;

/// The one shader that a stage consists of; `None` if there is none.
pub(super) fn merge(ctx: &mut Context<'_>, shaders: Vec<Shader>) -> Option<Shader> {
    let mut shaders = shaders.into_iter();
    let first = shaders.next()?;
    if let Some(second) = shaders.next() {
        let message = "several shaders of one stage are not merged yet";
        ctx.report(Diagnostic::new(&codes::general::NOT_SUPPORTED_YET, super::stages::anchor(&second), message));
    }
    Some(first)
}
