//! The parts of GLSL 1.50 that Vulkan lacks.
//!
//! *In:* a stage. *Out:* one error for each kind of thing that it uses and that cannot be said in Vulkan's terms.

use crate::target::{Conventions, WindowOrigin};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::FEATURE_NOT_IN_TARGET;
use glisten_front::hir::{ExprId, ExprKind, SamplerDim, Shader, Storage, Type, TypeId, Types, VarRef};
use glisten_front::source::Span;

/// The errors for a stage.
pub(super) fn of(types: &Types, shader: &Shader, conventions: &Conventions) -> Vec<Diagnostic> {
    let anchor = shader.anchor();
    let mut lacks = Vec::new();
    for global in shader.globals.iter().filter(|global| global.used && global.storage == Storage::Uniform) {
        if is_rect(types, global.ty) {
            let help = "use a 2D texture, and divide the coordinates by its size";
            lacks.push(lacking(global.span, "Vulkan has no rectangle textures".into(), help));
        }
    }
    let is_upper_left = shader.frag_coord.origin_upper_left;
    if is_upper_left && conventions.window_origin == WindowOrigin::LowerLeft {
        let what = "`layout(origin_upper_left)` of `gl_FragCoord` needs the framebuffer's height, which only \
                    `--window-origin upper-left` has";
        lacks.push(lacking(anchor, what.into(), "compile with `--window-origin upper-left`"));
    }
    lacks.extend(whole_structs(types, shader).take(1).map(|span| {
        let help = "pass the sampler and the other members as parameters of their own";
        lacking(span, "a struct with a sampler is used as a whole, and Vulkan has no sampler in a block".into(), help)
    }));
    if uses(shader, BuiltinVariable::DepthRange).is_some_and(|whole| whole) {
        let help = "name `near`, `far` or `diff` alone: they are 0, 1 and 1";
        lacks.push(lacking(anchor, "Vulkan has no `gl_DepthRange`".into(), help));
    }
    lacks
}

fn lacking(span: Span, message: String, help: &str) -> Diagnostic {
    Diagnostic::new(&FEATURE_NOT_IN_TARGET, span, message).help(help)
}

fn is_rect(types: &Types, ty: TypeId) -> bool {
    match types.get(ty) {
        Type::Sampler(sampler) => sampler.dim == SamplerDim::Rect,
        Type::Array(element, _) => is_rect(types, element),
        Type::Struct(id) => types.structure(id).members.iter().any(|member| is_rect(types, member.ty)),
        _ => false,
    }
}

/// The uses of structs with samplers that are neither a member nor an element of them.
fn whole_structs<'a>(types: &'a Types, shader: &'a Shader) -> impl Iterator<Item = Span> {
    let is_whole = |id: ExprId| {
        let expr = shader.expr(id);
        let mut ty = expr.ty;
        while let Type::Array(element, _) = types.get(ty) {
            ty = element;
        }
        let is_struct = matches!(types.get(ty), Type::Struct(_)) && types.contains_sampler(ty);
        (is_struct && shader.root_variable(id).is_some()).then_some(expr.span)
    };
    shader.exprs.iter().flat_map(move |expr| {
        let parts = match &expr.kind {
            ExprKind::Member(..) => Vec::new(),
            ExprKind::Index(_, index) => vec![*index],
            kind => kind.children().to_vec(),
        };
        parts.into_iter().filter_map(is_whole).collect::<Vec<_>>()
    })
}

/// Whether a stage names a built-in variable, and if so whether it does other than name its members.
fn uses(shader: &Shader, builtin: BuiltinVariable) -> Option<bool> {
    let is_own = |id: ExprId| matches!(shader.expr(id).kind, ExprKind::Var(VarRef::Global(global)) if shader.global(global).builtin == Some(builtin));
    let all = shader.exprs.iter().filter(|expr| {
        matches!(expr.kind, ExprKind::Var(VarRef::Global(global)) if shader.global(global).builtin == Some(builtin))
    });
    let members = shader.exprs.iter().filter(|expr| matches!(expr.kind, ExprKind::Member(base, _) if is_own(base)));
    let (all, members) = (all.count(), members.count());
    (all > 0).then_some(members < all)
}
