//! The stage that a program lacks, from the fixed-function pipeline (OpenGL 2.1 §2.15, §3.11: a program object without a stage
//! leaves that stage to it).
//!
//! *In:* the other stage, and the switches. *Out:* a text that fits it: with the coordinates, colors and fog coordinate that it
//! reads.

use super::UNITS;
use super::pipeline::{FogMode, GlslDialect, Pipeline};
use glisten_front::hir::{ArraySize, ExprKind, ScalarValue, Shader, Stage, Storage, Type, Types, VarRef};
use glisten_front::language::Profile;

/// Whether the language of a shader has the fixed-function pipeline.
pub fn has_fixed_function(shader: &Shader) -> bool {
    match shader.version.profile {
        Profile::Compatibility => true,
        Profile::Core => shader.version.number <= 130,
        Profile::Es => false,
    }
}

/// The stage that a lone shader lacks.
#[derive(Clone, Debug)]
pub struct OtherStage {
    /// The stage.
    pub stage: Stage,
    /// Its text.
    pub text: String,
    /// The switches from which it was written.
    pub pipeline: Pipeline,
}

/// The stage that a lone shader lacks.
pub fn other_stage(mut pipeline: Pipeline, types: &Types, shader: &Shader) -> OtherStage {
    pipeline.dialect = if shader.version.number < 140 { GlslDialect::V120 } else { GlslDialect::V150 };
    let coordinates = shader.globals.iter().find(|global| global.is_fixed() && global.name == "gl_TexCoord");
    let size = coordinates.map(|global| types.get(global.ty)).and_then(|ty| match ty {
        Type::Array(_, ArraySize::Sized(size)) => Some(size),
        _ => None,
    });
    pipeline.texture_coordinates = size.filter(|&size| size != UNITS as u32);
    if shader.stage == Stage::Vertex {
        return OtherStage { stage: Stage::Fragment, text: pipeline.fragment(), pipeline };
    }
    let reads = |name: &str| {
        let mut globals = shader.globals.iter();
        globals.any(|global| global.is_fixed() && global.storage == Storage::In && global.used && global.name == name)
    };
    pipeline.color_sum |= reads("gl_SecondaryColor");
    if reads("gl_FogFragCoord") {
        pipeline.fog = pipeline.fog.or(Some(FogMode::Linear));
    }
    if reads("gl_TexCoord") {
        let read = coordinates_read(shader);
        for (unit, _) in pipeline.units.iter_mut().zip(read).filter(|(_, read)| *read) {
            *unit = Some(unit.unwrap_or_default());
        }
    }
    OtherStage { stage: Stage::Vertex, text: pipeline.vertex(), pipeline }
}

/// The elements of `gl_TexCoord` that a fragment shader reads; all of them if an index is not constant.
fn coordinates_read(shader: &Shader) -> [bool; UNITS] {
    let is_coordinates = |id| match shader.expr(id).kind {
        ExprKind::Var(VarRef::Global(global)) => shader.global(global).name == "gl_TexCoord",
        _ => false,
    };
    let mut read = [false; UNITS];
    let (mut whole, mut parts) = (0, 0);
    for expr in &shader.exprs {
        match expr.kind {
            ExprKind::Var(VarRef::Global(global)) if shader.global(global).name == "gl_TexCoord" => whole += 1,
            ExprKind::Index(base, index) if is_coordinates(base) => {
                let index = match shader.expr(index).kind {
                    ExprKind::Literal(ScalarValue::Int(value)) => usize::try_from(value).ok(),
                    ExprKind::Literal(ScalarValue::Uint(value)) => usize::try_from(value).ok(),
                    _ => None,
                };
                if let Some(slot) = index.and_then(|index| read.get_mut(index)) {
                    *slot = true;
                    parts += 1;
                }
            }
            _ => {}
        }
    }
    if whole > parts { [true; UNITS] } else { read }
}
