//! Sources of Shadertoy that are compiled as if they were whole: `mainImage` without `main`.
//!
//! *In:* a shader and its diagnostics. *Out:* one diagnostic that names the engine, in place of one for each name that Shadertoy
//! declares.

use super::expr::foreign::OF_SHADERTOY;
use crate::diagnostic::codes::names::UNDECLARED;
use crate::diagnostic::codes::preprocess::MISSING_VERSION;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::hir::Shader;

/// The remedy.
pub(crate) const HELP: &str = "add `--engine shadertoy`, which declares the names of Shadertoy and calls `mainImage`";
/// The fact that shows it.
pub(crate) const NOTE: &str = "`mainImage` without `main`: this is a source of Shadertoy";

/// Whether the shader is such a source.
pub(crate) fn is_shadertoy(shader: &Shader) -> bool {
    let has = |name: &str| shader.functions.iter().any(|function| function.name == name);
    has("mainImage") && !has("main")
}

/// Keeps the first of the errors that the engine would remove, among the diagnostics from number `first` on.
pub fn point_to_engine(shader: &Shader, diagnostics: &mut Diagnostics, first: usize) {
    if !is_shadertoy(shader) {
        return;
    }
    let is_of_engine = |found: &Diagnostic| {
        let is_name =
            *found.code == UNDECLARED && found.help.as_ref().is_some_and(|help| help.starts_with(OF_SHADERTOY));
        is_name || *found.code == MISSING_VERSION
    };
    let (mut index, mut is_told) = (0, false);
    diagnostics.retain_mut(|found| {
        index += 1;
        if index <= first || !is_of_engine(found) {
            return true;
        }
        found.notes = vec![NOTE.to_owned()];
        found.help = Some(HELP.to_owned());
        !std::mem::replace(&mut is_told, true)
    });
}
