//! Says in terms of a later version what it has dropped or never had: `gl_FragColor` and `gl_FragData`, the `shadow`
//! lookups, commas of constants, and in ES initializers that are not constant, initializers of uniforms, and noise.
//!
//! *In:* a copy of a stage. *Out:* the same stage, with the locations of the interface. *Holds:* it means the same.

use super::blocks::flatten;
use super::commas::plain_commas;
use super::varyings;
use crate::target::GlslVersion;
use glisten_front::builtin::operations::{Class, Lookup};
use glisten_front::builtin::{BuiltinFunction, BuiltinVariable};
use glisten_front::hir::{
    ArraySize, ConstructKind, DepthMode, ExprId, ExprKind, Global, GlobalId, Interpolation, LocalKind, Scalar,
    ScalarValue, Shader, Stage, Stmt, StmtKind, Storage, Type, TypeId, Types, VarRef, all_names, fresh_name,
};
use glisten_front::link::Program;
use glisten_front::source::Span;

/// Rewrites a stage for a version.
pub(super) fn rewrite(types: &mut Types, shader: &mut Shader, program: &Program, version: GlslVersion) {
    locations(shader, program);
    varyings::match_by_name(shader, program);
    if version == GlslVersion::Es300 {
        flatten(types, shader, program);
    }
    unwritten_inputs(shader, program);
    interpolations(shader, program);
    built_in_colors(types, shader);
    shadow_lookups(types, shader);
    variable_constants(shader);
    plain_inputs(shader);
    if matches!(version, GlslVersion::Es300 | GlslVersion::Vulkan) {
        silence(types, shader);
    }
    if version != GlslVersion::Desktop330 {
        outputs_alone_are_invariant(types, shader);
        plain_commas(shader);
    }
    if version == GlslVersion::Es300 {
        late_initializers(shader);
        plain_qualifiers(shader);
    }
}

/// Attributes and outputs have their locations in the text.
fn locations(shader: &mut Shader, program: &Program) {
    let dual = program.interface.outputs.iter().any(|output| output.index == 1);
    let mut place = |id: GlobalId, location, index| {
        if let Some(global) = shader.globals.get_mut(id.index()).filter(|global| global.builtin.is_none()) {
            (global.location, global.index) = (Some(location), index);
        }
    };
    match shader.stage {
        Stage::Vertex => {
            program.interface.attributes.iter().for_each(|row| place(row.global, row.location, None));
        }
        Stage::Fragment => {
            let outputs = program.interface.outputs.iter();
            outputs.for_each(|row| place(row.global, row.location, dual.then_some(row.index)));
        }
        Stage::Geometry => {}
    }
}

/// An input of the compatibility profile that the stage before does not write is undefined (GLSL 1.20 §7.6). Later versions do not link then,
/// so it is a variable without a value.
fn unwritten_inputs(shader: &mut Shader, program: &Program) {
    if shader.stage != Stage::Fragment || !program.stages.iter().any(|stage| stage.stage != Stage::Fragment) {
        return;
    }
    let written: Vec<GlobalId> = program
        .interface
        .varyings
        .iter()
        .filter(|row| row.from.is_some())
        .filter_map(|row| Some(row.to?.global))
        .collect();
    for index in 0..shader.globals.len() {
        let is_written = written.contains(&GlobalId::new(index));
        let unwritten = shader.globals.get_mut(index).filter(|global| {
            let is_fixed = global.builtin.is_none() && global.name.starts_with("gl_") && global.block.is_none();
            is_fixed && global.storage == Storage::In && !is_written
        });
        if let Some(global) = unwritten {
            (global.storage, global.location) = (Storage::Private, None);
            (global.interpolation, global.interpolation_written) = (Interpolation::Smooth, false);
        }
    }
}

/// Both sides of a varying name its interpolation: later versions compare them (GLSL ES 3.00 §4.3.9).
fn interpolations(shader: &mut Shader, program: &Program) {
    let before = program.stages.iter().rev().find(|shader| shader.stage != Stage::Fragment).map(|shader| shader.stage);
    if before != Some(shader.stage) {
        return;
    }
    for row in &program.interface.varyings {
        let global = row.from.and_then(|end| shader.globals.get_mut(end.global.index()));
        if let Some(global) = global.filter(|global| global.block.is_none() && row.to.is_some()) {
            global.interpolation = row.interpolation;
            let fragment = program.stages.iter().find(|shader| shader.stage == Stage::Fragment);
            let input = row.to.zip(fragment).and_then(|(end, fragment)| fragment.globals.get(end.global.index()));
            global.interpolation_written =
                row.interpolation != Interpolation::Smooth || input.is_some_and(|input| input.interpolation_written);
            global.sampling = row.sampling;
        }
    }
}

/// `gl_FragColor` and `gl_FragData` become outputs of the shader's own.
fn built_in_colors(types: &mut Types, shader: &mut Shader) {
    for index in 0..shader.globals.len() {
        let Some(global) = shader.globals.get(index) else { continue };
        let (name, ty) = match global.builtin {
            Some(BuiltinVariable::FragColor) => ("fragColor", global.ty),
            Some(BuiltinVariable::FragData) => {
                ("fragData", types.array(TypeId::VEC4, ArraySize::Sized(used_elements(types, shader, index))))
            }
            _ => continue,
        };
        let taken = all_names(types, shader);
        let name = fresh_name(name, |name| taken.contains(name));
        if let Some(global) = shader.globals.get_mut(index) {
            let plain = Global { builtin: None, name, ty, location: Some(0), ..global.clone() };
            *global = plain;
        }
    }
}

/// The number of elements of an array up to the last that the shader names; all if an index is not constant.
fn used_elements(types: &Types, shader: &Shader, index: usize) -> u32 {
    let all = shader.globals.get(index).map_or(1, |global| types.flat_len(global.ty) / 4);
    let own = VarRef::Global(GlobalId::new(index));
    let is_own = |id: ExprId| matches!(shader.expr(id).kind, ExprKind::Var(var) if var == own);
    let (mut uses, mut indexed, mut last) = (0, 0, 0);
    for expr in &shader.exprs {
        match expr.kind {
            ExprKind::Var(var) if var == own => uses += 1,
            ExprKind::Index(base, at) if is_own(base) => {
                let element = match shader.expr(at).kind {
                    ExprKind::Literal(ScalarValue::Int(element)) => u32::try_from(element).ok(),
                    ExprKind::Literal(ScalarValue::Uint(element)) => Some(element),
                    _ => None,
                };
                let Some(element) = element else { return all };
                indexed += 1;
                last = last.max(element);
            }
            _ => {}
        }
    }
    if uses == indexed { last.saturating_add(1).min(all) } else { all }
}

/// `shadow2D(s, p)` is `vec4(vec3(texture(s, p)), 1.0)`.
fn shadow_lookups(types: &Types, shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(expr) = shader.exprs.get(index).cloned() else { continue };
        let ExprKind::BuiltinCall(function, arguments) = &expr.kind else { continue };
        let gathers = matches!(function.class(), Class::Texture(form) if form.lookup == Lookup::Gather);
        let of_depth = arguments
            .first()
            .is_some_and(|sampler| matches!(types.get(shader.expr(*sampler).ty), Type::Sampler(ty) if ty.shadow));
        if !of_depth || gathers || expr.ty != TypeId::VEC4 {
            continue;
        }
        let depth = shader.push(expr.kind.clone(), TypeId::FLOAT, expr.span);
        let parts = match shader.depth_mode {
            DepthMode::Luminance => vec![splat(shader, depth, 3), float(shader, 1.0)],
            DepthMode::Intensity => vec![splat(shader, depth, 4)],
            DepthMode::Alpha => {
                let zero = float(shader, 0.0);
                vec![splat(shader, zero, 3), depth]
            }
            DepthMode::Red => {
                let zero = float(shader, 0.0);
                vec![depth, splat(shader, zero, 2), float(shader, 1.0)]
            }
        };
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = ExprKind::Construct(ConstructKind::Compose, parts);
        }
    }
}

fn float(shader: &mut Shader, value: f32) -> ExprId {
    shader.push(ExprKind::Literal(ScalarValue::Float(value)), TypeId::FLOAT, Span::default())
}

fn splat(shader: &mut Shader, value: ExprId, size: u8) -> ExprId {
    let span = shader.expr(value).span;
    shader.push(ExprKind::Construct(ConstructKind::Splat, vec![value]), TypeId::vector(Scalar::Float, size), span)
}

/// A `const` whose value is computed while the shader runs (ARB_shading_language_420pack) is a variable.
fn variable_constants(shader: &mut Shader) {
    if shader.version.number >= 420 {
        return;
    }
    for local in shader.functions.iter_mut().flat_map(|function| &mut function.locals) {
        if local.kind == LocalKind::Const && local.value.is_none() {
            local.kind = LocalKind::Variable;
        }
    }
}

/// `in gl_PerVertex { .. } gl_in[];` may be redeclared since 4.10: before, the built-in declaration has all of it.
fn plain_inputs(shader: &mut Shader) {
    if shader.version.number >= 410 {
        return;
    }
    for global in shader.globals.iter_mut().filter(|global| global.builtin == Some(BuiltinVariable::In)) {
        global.span = Span::default();
    }
}

/// Noise is 0, as §8.9 allows; ES and Vulkan have none.
fn silence(types: &Types, shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(expr) = shader.exprs.get(index).cloned() else { continue };
        let is_noise = matches!(
            expr.kind,
            ExprKind::BuiltinCall(
                BuiltinFunction::Noise1 | BuiltinFunction::Noise2 | BuiltinFunction::Noise3 | BuiltinFunction::Noise4,
                _
            )
        );
        if !is_noise {
            continue;
        }
        let zero = ExprKind::Literal(ScalarValue::Float(0.0));
        let scalar = matches!(types.get(expr.ty), Type::Scalar(_));
        let inner = shader.push(zero.clone(), TypeId::FLOAT, expr.span);
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = if scalar { zero } else { ExprKind::Construct(ConstructKind::Splat, vec![inner]) };
        }
    }
}

/// Initializers of globals are constant in ES (GLSL ES 3.00 §4.3): the others run first in `main`. Uniforms have none;
/// the host sets what the reflection calls their default.
fn late_initializers(shader: &mut Shader) {
    let mut first = Vec::new();
    for index in 0..shader.globals.len() {
        let Some(global) = shader.globals.get(index) else { continue };
        let (storage, ty, span, initializer) = (global.storage, global.ty, global.span, global.initializer);
        if storage == Storage::Uniform {
            if let Some(global) = shader.globals.get_mut(index) {
                (global.initializer, global.value) = (None, None);
            }
            continue;
        }
        // What nothing uses is left out.
        let is_written = storage == Storage::Private && global.used;
        let Some(initializer) = initializer.filter(|_| is_written) else { continue };
        if is_constant(shader, initializer) {
            continue;
        }
        let target = shader.push(ExprKind::Var(VarRef::Global(GlobalId::new(index))), ty, span);
        let assignment = shader.push(ExprKind::Assign(None, target, initializer), ty, span);
        first.push(Stmt { kind: StmtKind::Expr(assignment), span: Span::default() });
        if let Some(global) = shader.globals.get_mut(index) {
            global.initializer = None;
        }
    }
    let main = shader.main.and_then(|main| shader.functions.get_mut(main.index()));
    if let Some(body) = main.and_then(|main| main.body.as_mut()) {
        first.append(body);
        *body = first;
    }
}

fn is_constant(shader: &Shader, initializer: ExprId) -> bool {
    let mut constant = true;
    shader.visit_expr(initializer, &mut |id| match shader.expr(id).kind {
        ExprKind::Var(VarRef::Global(global)) => constant &= shader.global(global).storage == Storage::Const,
        ExprKind::Var(VarRef::Local(_)) | ExprKind::Call(..) => constant = false,
        _ => {}
    });
    constant
}

/// From 4.20 on and in ES 3.00, only outputs are invariant, and match inputs that do not say so (GLSL 4.20 §4.8.1).
fn outputs_alone_are_invariant(types: &mut Types, shader: &mut Shader) {
    for global in shader.globals.iter_mut().filter(|global| global.storage == Storage::In) {
        global.invariant = false;
        let element = match types.get(global.ty) {
            Type::Array(element, _) => element,
            _ => global.ty,
        };
        if let (Some(_), Type::Struct(block)) = (&global.block, types.get(element)) {
            types.structure_mut(block).members.iter_mut().for_each(|member| member.invariant = false);
        }
    }
}

/// Qualifiers that ES lacks and that change nothing in it: units of samplers and blocks.
fn plain_qualifiers(shader: &mut Shader) {
    for global in &mut shader.globals {
        global.binding = None;
        if let Some(block) = &mut global.block {
            block.binding = None;
        }
    }
}
