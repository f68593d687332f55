//! Coordinates as the conventions want them: clip-space z in [0, w], the direction of y, `gl_FragCoord` and
//! `gl_PointCoord` with OpenGL's origin, `dFdy` along OpenGL's y, `gl_DepthRange`.
//!
//! *In:* a stage whose uniforms are in a block. *Out:* the same stage; `main` is a new function that calls the old one.

use super::uniforms::Height;
use super::{builtin, declare, needs_height, plain, unused, variable};
use crate::target::{ClipZ, Conventions, SpirvEnv, WindowOrigin};
use glisten_front::builtin::operations::{Class, DerivativeAxis};
use glisten_front::builtin::{BuiltinFunction, BuiltinVariable};
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, Function, FunctionId, Global, GlobalId, ScalarValue, Shader, Stage,
    Stmt, StmtKind, Storage, Swizzle, TypeId, UnaryOp, VarRef,
};
use glisten_front::link::Program;
use glisten_front::source::Span;

/// Converts the coordinates of a stage.
pub(super) fn convert(shader: &mut Shader, program: &Program, conventions: &Conventions, height: Option<Height>) {
    depth_range(shader);
    match shader.stage {
        Stage::Vertex if program.stage(Stage::Geometry).is_some() => {}
        Stage::Vertex => {
            let statements = after_main(shader, conventions);
            wrap(shader, program, "openglMain", statements);
        }
        Stage::Geometry => emit_vertex(shader, program, conventions),
        Stage::Fragment => fragment(shader, program, conventions, height),
    }
}

/// `gl_DepthRange` is (0, 1, 1): no target passes another to the shader.
fn depth_range(shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(ExprKind::Member(base, member)) = shader.exprs.get(index).map(|expr| expr.kind.clone()) else {
            continue;
        };
        if !is_builtin(shader, base, BuiltinVariable::DepthRange) {
            continue;
        }
        let value = if member == 0 { 0.0 } else { 1.0 };
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = ExprKind::Literal(ScalarValue::Float(value));
        }
    }
}

fn is_builtin(shader: &Shader, id: ExprId, builtin: BuiltinVariable) -> bool {
    matches!(shader.expr(id).kind, ExprKind::Var(VarRef::Global(global)) if shader.global(global).builtin == Some(builtin))
}

/// The statements that convert the position, and the size of a point where the host does not let programs set it.
fn after_main(shader: &mut Shader, conventions: &Conventions) -> Vec<Stmt> {
    let mut statements = position(shader, conventions);
    if !conventions.program_point_size && shader.stage == Stage::Vertex {
        // Vulkan leaves the size of points undefined without one.
        let size = builtin(shader, BuiltinVariable::PointSize).unwrap_or_else(|| {
            let name = BuiltinVariable::PointSize.name().to_owned();
            let plain = plain(name, TypeId::FLOAT, Storage::Out);
            declare(shader, Global { builtin: Some(BuiltinVariable::PointSize), ..plain })
        });
        let (size, one) = (variable(shader, size), float(shader, 1.0));
        statements.push(assign(shader, size, one));
    }
    statements
}

fn position(shader: &mut Shader, conventions: &Conventions) -> Vec<Stmt> {
    let Some(global) = builtin(shader, BuiltinVariable::Position) else { return Vec::new() };
    let down = conventions.spirv_env == SpirvEnv::Vulkan;
    let flips = (conventions.window_origin == WindowOrigin::LowerLeft) != down;
    let mut statements = Vec::new();
    if flips {
        let (to, from) = (part(shader, global, 1), part(shader, global, 1));
        let negated = shader.push(ExprKind::Unary(UnaryOp::Negate, from), TypeId::FLOAT, Span::default());
        statements.push(assign(shader, to, negated));
    }
    if conventions.clip_z == ClipZ::ZeroToOne {
        let (to, z, w) = (part(shader, global, 2), part(shader, global, 2), part(shader, global, 3));
        let sum = binary(shader, BinaryOp::Add, z, w);
        let half = float(shader, 0.5);
        let halved = binary(shader, BinaryOp::Mul, sum, half);
        statements.push(assign(shader, to, halved));
    }
    statements
}

/// `main` calls the old `main` and runs the statements afterwards. Early returns of the old one end in them, too.
fn wrap(shader: &mut Shader, program: &Program, name: &str, statements: Vec<Stmt>) {
    let Some(main) = shader.main.filter(|_| !statements.is_empty()) else { return };
    let name = unused(program, name);
    if let Some(old) = shader.functions.get_mut(main.index()) {
        old.name = name;
    }
    let call = shader.push(ExprKind::Call(main, Vec::new()), TypeId::VOID, Span::default());
    let mut body = vec![run(call)];
    body.extend(statements);
    shader.main = Some(define(shader, "main".to_owned(), body));
}

/// A function without parameters and result.
fn define(shader: &mut Shader, name: String, body: Vec<Stmt>) -> FunctionId {
    let id = FunctionId::new(shader.functions.len());
    shader.functions.push(Function {
        name,
        ret: TypeId::VOID,
        param_count: 0,
        locals: Vec::new(),
        body: Some(body),
        reachable: true,
        span: Span::default(),
    });
    id
}

/// `EmitVertex()` converts the position first.
fn emit_vertex(shader: &mut Shader, program: &Program, conventions: &Conventions) {
    let mut body = position(shader, conventions);
    if body.is_empty() {
        return;
    }
    let calls: Vec<usize> = (0..shader.exprs.len())
        .filter(|index| {
            let kind = shader.exprs.get(*index).map(|expr| &expr.kind);
            matches!(kind, Some(ExprKind::BuiltinCall(BuiltinFunction::EmitVertex, _)))
        })
        .collect();
    let emit = ExprKind::BuiltinCall(BuiltinFunction::EmitVertex, Vec::new());
    let emit = shader.push(emit, TypeId::VOID, Span::default());
    body.push(run(emit));
    let function = define(shader, unused(program, "emitVertex"), body);
    for index in calls {
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = ExprKind::Call(function, Vec::new());
        }
    }
}

fn fragment(shader: &mut Shader, program: &Program, conventions: &Conventions, height: Option<Height>) {
    let upper_left = conventions.window_origin == WindowOrigin::UpperLeft;
    if upper_left {
        negate_derivatives(shader);
    }
    let layout = shader.frag_coord;
    let height = height.filter(|_| needs_height(shader, conventions));
    if let Some(old) = builtin(shader, BuiltinVariable::FragCoord)
        && (height.is_some() || layout.pixel_center_integer)
    {
        let mut components = Vec::new();
        for component in 0..4 {
            let mut value = part(shader, old, component);
            if let (1, Some(height)) = (component, height) {
                let base = variable(shader, height.block);
                let kind = ExprKind::Member(base, height.member);
                let height = shader.push(kind, TypeId::FLOAT, Span::default());
                value = binary(shader, BinaryOp::Sub, height, value);
            }
            if component < 2 && layout.pixel_center_integer {
                let half = float(shader, 0.5);
                value = binary(shader, BinaryOp::Sub, value, half);
            }
            components.push(value);
        }
        replace(shader, program, old, "fragCoord", TypeId::VEC4, components);
    }
    shader.frag_coord.pixel_center_integer = false;
    if let Some(old) = builtin(shader, BuiltinVariable::PointCoord).filter(|_| !upper_left) {
        let (x, y) = (part(shader, old, 0), part(shader, old, 1));
        let one = float(shader, 1.0);
        let y = binary(shader, BinaryOp::Sub, one, y);
        replace(shader, program, old, "pointCoord", TypeId::VEC2, vec![x, y]);
    }
}

/// A variable in place of a built-in one in all of the stage's own expressions.
fn replace(shader: &mut Shader, program: &Program, old: GlobalId, name: &str, ty: TypeId, components: Vec<ExprId>) {
    let kept = reachable(shader, &components);
    let compose = ExprKind::Construct(ConstructKind::Compose, components);
    let initializer = Some(shader.push(compose, ty, Span::default()));
    let new = declare(shader, Global { initializer, ..plain(unused(program, name), ty, Storage::Private) });
    for index in 0..shader.exprs.len() {
        let Some(expr) = shader.exprs.get_mut(index) else { continue };
        if matches!(expr.kind, ExprKind::Var(VarRef::Global(global)) if global == old) && !kept.contains(&index) {
            expr.kind = ExprKind::Var(VarRef::Global(new));
        }
    }
}

/// The expressions under some others.
fn reachable(shader: &Shader, roots: &[ExprId]) -> Vec<usize> {
    let mut found = Vec::new();
    for root in roots {
        shader.visit_expr(*root, &mut |id| found.push(id.index()));
    }
    found
}

/// The rows of the target run downwards, and so does its y axis.
fn negate_derivatives(shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(expr) = shader.exprs.get(index).cloned() else { continue };
        let ExprKind::BuiltinCall(function, _) = &expr.kind else { continue };
        if !matches!(function.class(), Class::Derivative(of) if of.axis() == DerivativeAxis::Y) {
            continue;
        }
        let inner = shader.push(expr.kind, expr.ty, expr.span);
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = ExprKind::Unary(UnaryOp::Negate, inner);
        }
    }
}

fn part(shader: &mut Shader, global: GlobalId, component: u8) -> ExprId {
    let base = variable(shader, global);
    let swizzle = Swizzle { len: 1, components: [component, 0, 0, 0] };
    shader.push(ExprKind::Swizzle(base, swizzle), TypeId::FLOAT, Span::default())
}

fn float(shader: &mut Shader, value: f32) -> ExprId {
    shader.push(ExprKind::Literal(ScalarValue::Float(value)), TypeId::FLOAT, Span::default())
}

fn binary(shader: &mut Shader, op: BinaryOp, a: ExprId, b: ExprId) -> ExprId {
    shader.push(ExprKind::Binary(op, a, b), TypeId::FLOAT, Span::default())
}

fn assign(shader: &mut Shader, to: ExprId, value: ExprId) -> Stmt {
    let ty = shader.expr(to).ty;
    let assignment = shader.push(ExprKind::Assign(None, to, value), ty, Span::default());
    run(assignment)
}

fn run(expr: ExprId) -> Stmt {
    Stmt { kind: StmtKind::Expr(expr), span: Span::default() }
}
