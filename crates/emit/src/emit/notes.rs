//! Notes on what emission omits, where that does not change the picture or where only the host can tell.

use crate::target::Conventions;
use glisten_front::builtin::{BuiltinFunction, BuiltinVariable};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::{COMPARISON_LEVEL_DROPPED, POINT_SIZE_DROPPED};
use glisten_front::hir::{ExprKind, SamplerDim, ScalarValue, Shader, Stage, Type, Types};
use glisten_front::link::Program;
use glisten_front::source::Span;

/// Notes and warnings on a program under these conventions; never an error.
pub fn notes(program: &Program, conventions: &Conventions) -> Vec<Diagnostic> {
    let mut notes: Vec<Diagnostic> = point_size(program, conventions).into_iter().collect();
    notes.extend(levels_of_comparisons(program).map(|span| {
        let message =
            "depth is compared without this level of detail: no target compares in a level of the shader's choice";
        Diagnostic::new(&COMPARISON_LEVEL_DROPPED, span, message)
            .here("the same picture if the depth texture has one level")
            .help("leave the bias out, or use `textureLod` with level 0.0")
    }));
    notes
}

fn point_size(program: &Program, conventions: &Conventions) -> Option<Diagnostic> {
    let vertex = program.stage(Stage::Vertex)?;
    let is_size =
        |global: &&glisten_front::hir::Global| global.builtin == Some(BuiltinVariable::PointSize) && global.written;
    let global = vertex.globals.iter().find(is_size).filter(|_| !conventions.program_point_size)?;
    let span = if global.span.is_known() {
        global.span
    } else {
        vertex.main.map_or(global.span, |main| vertex.function(main).span)
    };
    let message = "`gl_PointSize` is written and has no effect: points are one pixel wide";
    Some(
        Diagnostic::new(&POINT_SIZE_DROPPED, span, message)
            .help("where the host enables PROGRAM_POINT_SIZE, say `--program-point-size`"),
    )
}

/// Lookups in depth textures with an explicit or biased level of detail: targets have only the implicit level and the
/// base level.
pub fn levels_of_comparisons(program: &Program) -> impl Iterator<Item = Span> {
    program.stages.iter().flat_map(|shader| {
        let mut spans = Vec::new();
        for function in shader.functions.iter().filter(|function| function.reachable) {
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |id| {
                if names_level(&program.types, shader, &shader.expr(id).kind) {
                    spans.push(shader.expr(id).span);
                }
            });
        }
        spans
    })
}

fn names_level(types: &Types, shader: &Shader, kind: &ExprKind) -> bool {
    use BuiltinFunction as F;
    let ExprKind::BuiltinCall(function, arguments) = kind else { return false };
    let sampler = arguments.first().and_then(|sampler| match types.get(shader.expr(*sampler).ty) {
        Type::Sampler(sampler) => Some(sampler),
        _ => None,
    });
    let of_depth = sampler.is_some_and(|sampler| sampler.shadow);
    let place = match function {
        // The reference of the comparison is a parameter of its own there.
        F::Texture if sampler.is_some_and(|sampler| sampler.dim == SamplerDim::Cube && sampler.arrayed) => 3,
        F::Texture
        | F::TextureProj
        | F::TextureLod
        | F::TextureLodOffset
        | F::TextureProjLod
        | F::TextureProjLodOffset => 2,
        F::TextureOffset | F::TextureProjOffset => 3,
        F::TextureGrad | F::TextureGradOffset | F::TextureProjGrad | F::TextureProjGradOffset => return of_depth,
        _ => return false,
    };
    let is_zero = |id| matches!(shader.expr(id).kind, ExprKind::Literal(ScalarValue::Float(value)) if value == 0.0);
    of_depth && arguments.get(place).is_some_and(|level| !is_zero(*level))
}
