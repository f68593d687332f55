//! Notes on what emission omits, where that does not change the picture or where only the host can tell.

use crate::target::Conventions;
use glisten_front::builtin::BuiltinVariable;
use glisten_front::builtin::operations::{Class, Lookup, TextureArgument};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::{COMPARISON_LEVEL_DROPPED, POINT_SIZE_DROPPED};
use glisten_front::hir::{ExprKind, GlobalId, ScalarValue, Shader, Stage, Type, Types, VarRef, written_by};
use glisten_front::link::Program;
use glisten_front::source::Span;

/// Notes and warnings on a program under these conventions; never an error.
pub fn notes(program: &Program, conventions: &Conventions) -> Vec<Diagnostic> {
    let mut notes: Vec<Diagnostic> = point_size(program, conventions).into_iter().collect();
    notes.extend(levels_of_comparisons(program).map(|(span, help)| {
        let message =
            "depth is compared without this level of detail: no target compares in a level of the shader's choice";
        Diagnostic::new(&COMPARISON_LEVEL_DROPPED, span, message)
            .here("the same picture if the depth texture has one level")
            .help(help)
    }));
    notes
}

fn point_size(program: &Program, conventions: &Conventions) -> Option<Diagnostic> {
    let vertex = program.stage(Stage::Vertex)?;
    let is_size =
        |global: &glisten_front::hir::Global| global.builtin == Some(BuiltinVariable::PointSize) && global.written;
    let of_host = || !conventions.program_point_size;
    let id = vertex.globals().find(|(_, global)| of_host() && is_size(global)).map(|(id, _)| id)?;
    let span = first_write(vertex, id).or(vertex.main.map(|main| vertex.function(main).span)).unwrap_or_default();
    let message = "`gl_PointSize` is written and has no effect: points are one pixel wide";
    Some(
        Diagnostic::new(&POINT_SIZE_DROPPED, span, message)
            .help("where the host enables PROGRAM_POINT_SIZE, say `--program-point-size`"),
    )
}

/// The place of the first write of a global in the functions that are called.
fn first_write(shader: &Shader, id: GlobalId) -> Option<Span> {
    let mut places: Vec<Span> = Vec::new();
    for function in shader.functions.iter().filter(|function| function.reachable) {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if shader.root_variable(target) == Some(VarRef::Global(id)) {
                    places.push(shader.expr(target).span);
                }
            });
        });
    }
    places.into_iter().filter(|span| span.is_known()).min_by_key(|span| span.start)
}

/// Lookups in depth textures with an explicit or biased level of detail, each with a remedy: targets have only the implicit level and
/// the base level.
pub fn levels_of_comparisons(program: &Program) -> impl Iterator<Item = (Span, &'static str)> {
    program.stages.iter().flat_map(|shader| {
        let mut spans = Vec::new();
        for function in shader.functions.iter().filter(|function| function.reachable) {
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |id| {
                if let Some(help) = level_named(&program.types, shader, &shader.expr(id).kind) {
                    spans.push((shader.expr(id).span, help));
                }
            });
        }
        spans
    })
}

/// The remedy for a comparison that names a level other than the base level.
fn level_named(types: &Types, shader: &Shader, kind: &ExprKind) -> Option<&'static str> {
    let ExprKind::BuiltinCall(function, arguments) = kind else { return None };
    let Class::Texture(form) = function.operation().class else { return None };
    let Type::Sampler(sampler) = types.get(shader.expr(*arguments.first()?).ty) else { return None };
    if !sampler.shadow {
        return None;
    }
    let is_zero = |id| matches!(shader.expr(id).kind, ExprKind::Literal(ScalarValue::Float(value)) if value == 0.0);
    let gives = |role: TextureArgument| {
        // The sampler comes before the others.
        let place = form.arguments(sampler).iter().position(|one| *one == role)? + 1;
        arguments.get(place).filter(|level| !is_zero(**level))
    };
    match form.lookup {
        Lookup::Grad => Some("leave the derivatives out"),
        Lookup::Lod => gives(TextureArgument::Level).map(|_| "use level 0.0, or `texture` for the implicit level"),
        Lookup::Implicit => gives(TextureArgument::Bias).map(|_| "leave the bias out"),
        Lookup::Fetch | Lookup::Size | Lookup::Levels | Lookup::Gather | Lookup::QueryLod => None,
    }
}
