//! The state of the fixed-function pipeline that decides what a stage's outputs become: clamped colors, the side whose
//! color is seen, and clip planes (OpenGL 2.1 §2.12, §2.14.1, §2.14.6, §2.19; GLSL 1.20 §7.1, §7.2, §7.6).
//!
//! *In:* the merged stages, and the [`FixedState`] of the host. *Out:* the same stages, with what OpenGL does to these
//! variables after the vertex stage and before the fragment stage written as statements. *Holds:* no later phase knows of
//! this state, so that every target and the reference do the same. A program without these variables is left as it is.

use super::clip_states;
use super::statements::{assignment, literal, statement, variable};
use crate::builtin::{BuiltinFunction, BuiltinVariable, fixed};
use crate::hir::{
    ArraySize, DepthMode, ExprKind, Function, FunctionId, Global, GlobalId, Interpolation, Sampling, ScalarValue,
    Shader, Stage, Stmt, StmtKind, Storage, TypeId, Types, Value,
};
use crate::language::Scalar;
use crate::source::Span;

/// The state of a host for programs that write the variables of the fixed-function pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FixedState {
    /// `GL_VERTEX_PROGRAM_TWO_SIDE`: back faces get `gl_BackColor` as `gl_Color` where the program writes it.
    pub two_side: bool,
    /// `glShadeModel(GL_FLAT)`: colors without a qualifier are those of the provoking vertex.
    pub flat_colors: bool,
    /// How many of `gl_ClipPlane` clip by `gl_ClipVertex`, from the first on.
    pub clip_planes: u32,
    /// `glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE)`: the colors of the vertex stage may leave [0, 1].
    pub unclamped_colors: bool,
    /// `GL_DEPTH_TEXTURE_MODE` of the textures that are compared.
    pub depth_mode: DepthMode,
    /// Bit n: `GL_CLIP_DISTANCEn` is disabled below the highest one that is enabled. Nothing is clipped by such a distance.
    pub disabled_distances: u8,
}

/// The most clip planes that a program may have (`gl_MaxClipPlanes`).
const MOST_PLANES: u32 = 8;

/// The colors that the vertex stage writes.
const COLORS: [&str; 4] = ["gl_FrontColor", "gl_BackColor", "gl_FrontSecondaryColor", "gl_BackSecondaryColor"];

/// The inputs of the fragment stage, and the two outputs that each may be.
const SIDES: [(&str, &str, &str); 2] = [
    ("gl_Color", "gl_FrontColor", "gl_BackColor"),
    ("gl_SecondaryColor", "gl_FrontSecondaryColor", "gl_BackSecondaryColor"),
];

/// Writes what the state does to the stages of a program, which are in pipeline order.
pub(super) fn apply(types: &mut Types, stages: &mut [Shader], state: FixedState) {
    stages.iter_mut().for_each(|shader| shader.depth_mode = state.depth_mode);
    let (before, fragment) = match stages.split_last_mut() {
        Some((last, before)) if last.stage == Stage::Fragment => (before, Some(last)),
        Some(_) => (stages, None),
        None => return,
    };
    let Some(producer) = before.last_mut() else { return };
    let mut end = Vec::new();
    if !state.unclamped_colors {
        end.extend(clamped_colors(producer));
    }
    end.extend(clip_distances(types, producer, state.clip_planes.min(MOST_PLANES)));
    end.extend(clip_states::without_effect(types, producer, state.disabled_distances));
    if !end.is_empty() {
        at_the_end(producer, end);
        producer.mark_static_use();
    }
    let Some(fragment) = fragment else { return };
    if state.flat_colors {
        [&mut *producer, &mut *fragment].into_iter().for_each(flat_colors);
    }
    if state.two_side {
        for (read, front, back) in SIDES {
            select_side(producer, fragment, read, [front, back]);
        }
    }
}

/// Makes the colors flat that have no qualifier of interpolation (OpenGL 2.1 §2.14.7; GLSL 1.30 §4.3.7).
fn flat_colors(shader: &mut Shader) {
    let of_color = |name: &str| COLORS.contains(&name) || SIDES.iter().any(|(read, ..)| *read == name);
    let is_open = |global: &&mut Global| global.is_fixed() && !global.interpolation_written && of_color(&global.name);
    shader.globals.iter_mut().filter(is_open).for_each(|global| global.interpolation = Interpolation::Flat);
}

fn find(shader: &Shader, storage: Storage, name: &str) -> Option<GlobalId> {
    let is_it = |global: &Global| global.is_fixed() && global.storage == storage && global.name == name;
    shader.globals().find(|(_, global)| is_it(global)).map(|(id, _)| id)
}

/// A statement for each color that is written: it is clamped to [0, 1] (§2.14.6).
fn clamped_colors(shader: &mut Shader) -> Vec<Stmt> {
    let is_written = |name: &&str| find(shader, Storage::Out, name).is_some_and(|id| shader.global(id).written);
    let written: Vec<&str> = COLORS.iter().copied().filter(is_written).collect();
    let mut statements = Vec::new();
    for name in written {
        let Some(id) = find(shader, Storage::Out, name) else { continue };
        let (target, value) = (variable(shader, id), variable(shader, id));
        let bounds = [0.0, 1.0].map(|bound| literal(shader, ScalarValue::Float(bound), TypeId::FLOAT));
        let [low, high] = bounds;
        let clamp = ExprKind::BuiltinCall(BuiltinFunction::Clamp, vec![value, low, high]);
        let clamped = shader.push(clamp, TypeId::VEC4, Span::default());
        statements.push(assignment(shader, target, clamped));
    }
    statements
}

/// A statement for each enabled plane: the distance of the vertex from it (§2.12).
fn clip_distances(types: &mut Types, shader: &mut Shader, planes: u32) -> Vec<Stmt> {
    let distance = Some(BuiltinVariable::ClipDistance);
    if planes == 0 || shader.globals.iter().any(|global| global.builtin == distance) {
        return Vec::new();
    }
    let Some(vertex) = clip_vertex(shader) else { return Vec::new() };
    let floats = types.array(TypeId::FLOAT, ArraySize::Sized(planes));
    let clip = add(shader, Global { builtin: distance, ..global("gl_ClipDistance", floats, Storage::Out) });
    let plane = find(shader, Storage::Uniform, "gl_ClipPlane").unwrap_or_else(|| clip_plane(types, shader));
    let each = |index: u32| {
        let place = |shader: &mut Shader| {
            literal(shader, ScalarValue::Int(index.cast_signed()), TypeId::vector(Scalar::Int, 1))
        };
        let element = |shader: &mut Shader, array: GlobalId, ty: TypeId| {
            let (array, index) = (variable(shader, array), place(shader));
            shader.push(ExprKind::Index(array, index), ty, Span::default())
        };
        let target = element(shader, clip, TypeId::FLOAT);
        let operands = vec![element(shader, plane, TypeId::VEC4), variable(shader, vertex)];
        let dot = ExprKind::BuiltinCall(BuiltinFunction::Dot, operands);
        let value = shader.push(dot, TypeId::FLOAT, Span::default());
        assignment(shader, target, value)
    };
    (0..planes).map(each).collect()
}

/// The position that is compared with the planes: `gl_ClipVertex`, which becomes a variable of the stage, or `gl_Position` if that is not
/// written (GLSL 1.30 §7.1).
fn clip_vertex(shader: &mut Shader) -> Option<GlobalId> {
    if let Some(vertex) = find(shader, Storage::Out, "gl_ClipVertex").filter(|&id| shader.global(id).written) {
        rename(shader, vertex, Storage::Private);
        return Some(vertex);
    }
    let has_planes = fixed::named("gl_ClipPlane", shader.version, shader.stage).is_some();
    let is_position = |global: &Global| global.builtin == Some(BuiltinVariable::Position) && global.written;
    shader.globals().find(|(_, global)| has_planes && is_position(global)).map(|(id, _)| id)
}

fn clip_plane(types: &mut Types, shader: &mut Shader) -> GlobalId {
    let row = fixed::FIXED.iter().find(|row| row.name == "gl_ClipPlane");
    let ty = types.array(TypeId::VEC4, ArraySize::Sized(MOST_PLANES));
    let scalars = row.map(|row| row.initial().into_iter().map(ScalarValue::Float).collect());
    let value = scalars.map(|scalars| Value { ty, scalars });
    add(shader, Global { value, ..global("gl_ClipPlane", ty, Storage::Uniform) })
}

/// Reads the color of the side that is seen, if the vertex stage writes that of the back (§2.19; GLSL 1.20 §7.6). A front
/// color that is not written stays undefined.
fn select_side(producer: &mut Shader, fragment: &mut Shader, read: &str, sides: [&str; 2]) {
    let Some(color) = find(fragment, Storage::In, read).filter(|&id| fragment.global(id).used) else { return };
    let outputs = sides.map(|name| find(producer, Storage::Out, name).filter(|&id| producer.global(id).written));
    let [front, Some(back)] = outputs else { return };
    let declared = fragment.global(color).clone();
    rename(fragment, color, Storage::Private);
    let [front, back] = [front, Some(back)].map(|output| {
        let name = output.map_or_else(|| declared.name.clone(), |output| new_name(producer, fragment, output));
        add(fragment, Global { name, ..declared.clone() })
    });
    let facing = facing(fragment);
    let operands = [facing, front, back].map(|id| variable(fragment, id));
    let [facing, front, back] = operands;
    let choice = fragment.push(ExprKind::Ternary(facing, front, back), TypeId::VEC4, Span::default());
    if let Some(global) = fragment.globals.get_mut(color.index()) {
        global.initializer = Some(choice);
        (global.interpolation, global.interpolation_written) = (Interpolation::default(), false);
        (global.sampling, global.invariant) = (Sampling::Center, false);
    }
    fragment.depth = fragment.depth.max(2);
    fragment.mark_static_use();
}

/// Gives an output a name that neither stage has.
fn new_name(producer: &mut Shader, fragment: &Shader, output: GlobalId) -> String {
    let name = free_name(&producer.global(output).name, &[&*producer, fragment]);
    if let Some(global) = producer.globals.get_mut(output.index()) {
        global.name.clone_from(&name);
    }
    name
}

/// `gl_FrontFacing`, which is added if the stage does not name it.
fn facing(shader: &mut Shader) -> GlobalId {
    let builtin = Some(BuiltinVariable::FrontFacing);
    let known = shader.globals().find(|(_, global)| global.builtin == builtin).map(|(id, _)| id);
    let ty = TypeId::vector(Scalar::Bool, 1);
    known.unwrap_or_else(|| add(shader, Global { builtin, ..global("gl_FrontFacing", ty, Storage::In) }))
}

/// Makes an interface variable an ordinary one of the program.
fn rename(shader: &mut Shader, id: GlobalId, storage: Storage) {
    let name = free_name(&shader.global(id).name, &[shader]);
    if let Some(global) = shader.globals.get_mut(id.index()) {
        (global.name, global.storage) = (name, storage);
    }
}

/// `fixed_Color` for `gl_Color`, with underscores until no shader has the name.
fn free_name(name: &str, shaders: &[&Shader]) -> String {
    let mut new = format!("fixed_{}", name.trim_start_matches("gl_"));
    let is_taken = |new: &str| {
        shaders.iter().any(|shader| {
            let functions = shader.functions.iter();
            shader.globals.iter().any(|global| global.name == new)
                || functions.clone().any(|one| one.name == new)
                || functions.flat_map(|one| &one.locals).any(|local| local.name == new)
        })
    };
    while is_taken(&new) {
        new.push('x');
    }
    new
}

/// Runs statements where a vertex is complete: at the end of `main`, or before each `EmitVertex`.
fn at_the_end(shader: &mut Shader, end: Vec<Stmt>) {
    shader.depth = shader.depth.max(4);
    if shader.stage == Stage::Geometry {
        let emitted = |expr: &ExprKind| matches!(expr, ExprKind::BuiltinCall(BuiltinFunction::EmitVertex, _));
        let calls: Vec<usize> =
            shader.exprs.iter().enumerate().filter(|(_, expr)| emitted(&expr.kind)).map(|(index, _)| index).collect();
        let emit = ExprKind::BuiltinCall(BuiltinFunction::EmitVertex, Vec::new());
        let emit = shader.push(emit, TypeId::VOID, Span::default());
        let body = end.into_iter().chain([statement(StmtKind::Expr(emit))]).collect();
        let function = add_function(shader, "gl_EmitFixed", body);
        for index in calls {
            if let Some(expr) = shader.exprs.get_mut(index) {
                expr.kind = ExprKind::Call(function, Vec::new());
            }
        }
        return;
    }
    let Some(main) = shader.main else { return };
    let body = shader.function(main).body.as_deref().unwrap_or_default();
    let mut returns = false;
    shader.visit_statements(body, &mut |one| returns |= matches!(one.kind, StmtKind::Return(_)));
    if !returns {
        let body = shader.functions.get_mut(main.index()).and_then(|function| function.body.as_mut());
        body.into_iter().for_each(|body| body.extend(end.iter().cloned()));
        return;
    }
    let name = free_name("gl_main", &[shader]);
    if let Some(function) = shader.functions.get_mut(main.index()) {
        function.name = name;
    }
    let call = shader.push(ExprKind::Call(main, Vec::new()), TypeId::VOID, Span::default());
    let body = [statement(StmtKind::Expr(call))].into_iter().chain(end).collect();
    let whole = add_function(shader, "main", body);
    shader.main = Some(whole);
}

fn add_function(shader: &mut Shader, name: &str, body: Vec<Stmt>) -> FunctionId {
    let name = if name == "main" { name.to_owned() } else { free_name(name, &[shader]) };
    let (ret, span) = (TypeId::VOID, Span::default());
    let function = Function { name, ret, param_count: 0, locals: Vec::new(), body: Some(body), reachable: true, span };
    shader.functions.push(function);
    FunctionId::new(shader.functions.len() - 1)
}

fn add(shader: &mut Shader, global: Global) -> GlobalId {
    shader.globals.push(global);
    GlobalId::new(shader.globals.len() - 1)
}

fn global(name: &str, ty: TypeId, storage: Storage) -> Global {
    Global {
        name: name.to_owned(),
        ty,
        storage,
        builtin: None,
        interpolation: Interpolation::default(),
        interpolation_written: false,
        sampling: Sampling::Center,
        invariant: false,
        location: None,
        host_location: None,
        component: None,
        index: None,
        binding: None,
        block: None,
        initializer: None,
        value: None,
        implicitly_sized: false,
        used: true,
        written: false,
        span: Span::default(),
    }
}
