//! The parts of GLSL 1.50 that GLSL ES 3.00 (WebGL 2) lacks.
//!
//! *In:* a stage. *Out:* one error for each kind of thing that it uses and that ES has no equal for. *Not done here:*
//! what can be said in other words, which `rewrite` does.

use crate::target::GlslVersion;
use glisten_front::builtin::BuiltinVariable;
use glisten_front::builtin::functions::Row;
use glisten_front::builtin::operations::{Class, Lookup};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::{FEATURE_NOT_IN_TARGET, STAGE_NOT_IN_TARGET};
use glisten_front::hir::{
    Expr, ExprId, ExprKind, Global, Interpolation, Member, ParamMode, SamplerDim, SamplerType, Sampling, Shader, Stage,
    Storage, Type, TypeId, Types, VarRef,
};
use glisten_front::language::NEVER;
use glisten_front::link::Program;
use glisten_front::source::Span;
use smallvec::SmallVec;

/// The errors for a stage, in the order of its globals.
pub(super) fn of_es(program: &Program, shader: &Shader) -> Vec<Diagnostic> {
    let anchor = shader.anchor();
    if shader.stage == Stage::Geometry {
        return vec![
            Diagnostic::new(&STAGE_NOT_IN_TARGET, anchor, "GLSL ES 3.00 has no geometry stage")
                .help("compile for `--glsl-version 330`, or compute the emitted vertices in a vertex shader"),
        ];
    }
    let types = &program.types;
    // The rest is left out.
    let used = shader.used_expressions();
    let mut lacks = Vec::new();
    for global in &shader.globals {
        let span = if global.span.is_known() { global.span } else { anchor };
        if let Some((what, help)) = of_global(types, shader, global) {
            lacks.push(lacking(span, what, help));
        }
    }
    for function in shader.functions.iter().filter(|function| function.reachable) {
        for param in function.params() {
            if let Some(sampler) = foreign_sampler(types, param.ty) {
                lacks.push(lacking(param.span, format!("`{}`", sampler.name()), SAMPLERS));
            }
        }
    }
    for (argument, param) in written_by_conversion(types, shader, &used) {
        let what = format!("implicit conversion, here of an `{}` that a function writes", types.name(param));
        let help = "pass a variable of the parameter's type, and convert what it then has";
        lacks.push(lacking(shader.expr(argument).span, what, help));
    }
    for index in indices_of_outputs(shader, &used) {
        let what = "index of a fragment output that is not constant".into();
        lacks.push(lacking(index, what, "compute in a variable, and copy it to the output"));
    }
    for span in arrays_of_arrays(types, shader, &used).take(1) {
        lacks.push(lacking(span, "array of arrays".into(), "compute one index from two"));
    }
    for (name, span) in later_functions(types, shader, &mut used.iter().map(|id| shader.expr(*id)), true) {
        lacks.push(lacking(span, format!("function `{name}`"), "compile for `--glsl-version 330`"));
    }
    if program.interface.outputs.iter().any(|output| output.index == 1) && shader.stage == Stage::Fragment {
        lacks.push(lacking(anchor, "second source of blending".into(), "compile for `--glsl-version 330`"));
    }
    lacks
}

/// The variables, the values and the results that are arrays of arrays.
fn arrays_of_arrays<'a>(types: &'a Types, shader: &'a Shader, used: &'a [ExprId]) -> impl Iterator<Item = Span> {
    let kept = |global: &&Global| global.used || !matches!(global.storage, Storage::Private | Storage::Const);
    let globals = shader.globals.iter().filter(kept).map(|global| (global.ty, global.span));
    let functions = || shader.functions.iter().filter(|function| function.reachable);
    let locals = functions().flat_map(|function| &function.locals).map(|local| (local.ty, local.span));
    let nests = |ty| matches!(types.get(ty), Type::Array(element, _) if matches!(types.get(element), Type::Array(..)));
    let results = functions().map(|function| (function.ret, function.span));
    let values = used.iter().map(|id| shader.expr(*id)).map(|expr| (expr.ty, expr.span));
    globals.chain(locals).chain(results).chain(values).filter(move |(ty, _)| nests(*ty)).map(|(_, span)| span)
}

/// The indices of fragment outputs that are not constant (GLSL ES 3.00 §4.3.6).
fn indices_of_outputs(shader: &Shader, used: &[ExprId]) -> Vec<Span> {
    let is_output = |var: VarRef| match var {
        VarRef::Global(id) => shader.stage == Stage::Fragment && shader.global(id).storage == Storage::Out,
        VarRef::Local(_) => false,
    };
    let indices = used.iter().filter_map(|id| match shader.expr(*id).kind {
        ExprKind::Index(base, index) if shader.root_variable(base).is_some_and(is_output) => Some(index),
        _ => None,
    });
    let indices = indices.map(|index| shader.expr(index));
    indices.filter(|index| !matches!(index.kind, ExprKind::Literal(_))).map(|index| index.span).collect()
}

/// The arguments of `out` and `inout` parameters that have another type than these, which is told, too.
fn written_by_conversion(types: &Types, shader: &Shader, used: &[ExprId]) -> Vec<(ExprId, TypeId)> {
    let mut found = Vec::new();
    for id in used {
        let ExprKind::Call(function, arguments) = &shader.expr(*id).kind else { continue };
        for (argument, (ty, mode)) in arguments.iter().zip(shader.function(*function).param_types()) {
            let is_written = matches!(mode, ParamMode::Out | ParamMode::Inout);
            if is_written && types.get(shader.expr(*argument).ty) != types.get(ty) {
                found.push((*argument, ty));
            }
        }
    }
    found
}

/// The errors for what GLSL 3.30 lacks.
pub(super) fn of_330(types: &Types, shader: &Shader) -> Vec<Diagnostic> {
    let lacks = |(name, span)| {
        let message = format!("GLSL 3.30 has no function `{name}` for these arguments");
        Diagnostic::new(&FEATURE_NOT_IN_TARGET, span, message).help("compile for `--glsl-version 450`")
    };
    later_functions(types, shader, &mut shader.exprs.iter(), false).into_iter().map(lacks).collect()
}

/// The functions that came after ES 3.00, or after 3.30 and without an extension, for the arguments of a call. Each with its first call.
fn later_functions(
    types: &Types,
    shader: &Shader,
    exprs: &mut dyn Iterator<Item = &Expr>,
    is_es: bool,
) -> Vec<(&'static str, Span)> {
    let mut found: Vec<(&'static str, Span)> = Vec::new();
    for expr in exprs {
        let ExprKind::BuiltinCall(function, arguments) = &expr.kind else { continue };
        let name = function.name();
        let given: SmallVec<[TypeId; 8]> = arguments.iter().map(|argument| shader.expr(*argument).ty).collect();
        if is_es && given.iter().any(|ty| foreign_sampler(types, *ty).is_some()) {
            // The sampler is refused, if it is used.
            continue;
        }
        let rows: SmallVec<[&Row; 8]> = function
            .operation()
            .prototypes()
            .filter(|row| row.signatures(shader.stage).any(|signature| signature.has_types(&given)))
            .collect();
        let since = |row: &Row| if is_es { row.availability.since.es } else { row.availability.since.desktop };
        let is_in = |row: &&Row| {
            since(row) <= if is_es { 300 } else { 330 } || !is_es && !row.availability.extensions.is_empty()
        };
        // What ES never had is said in other words, or refused by its types.
        let has_no_words = is_es
            && match function.operation().class {
                Class::Derivative(_) => true,
                Class::Texture(form) => matches!(form.lookup, Lookup::QueryLod | Lookup::Levels),
                _ => false,
            };
        let came_later = (has_no_words || rows.iter().any(|row| since(row) != NEVER)) && !rows.iter().any(is_in);
        if came_later && !found.iter().any(|(other, _)| *other == name) {
            found.push((name, expr.span));
        }
    }
    found
}

const SAMPLERS: &str = "use a 2D texture, or compile for `--glsl-version 330`";

fn lacking(span: Span, what: String, help: &str) -> Diagnostic {
    let version = GlslVersion::Es300.word();
    Diagnostic::new(&FEATURE_NOT_IN_TARGET, span, format!("GLSL {version} (WebGL 2) has no {what}")).help(help)
}

fn of_global(types: &Types, shader: &Shader, global: &Global) -> Option<(String, &'static str)> {
    if let Some(builtin) = global.builtin {
        return of_builtin(shader, builtin);
    }
    if let Some(sampler) = foreign_sampler(types, global.ty).filter(|_| global.used) {
        return Some((format!("`{}`", sampler.name()), SAMPLERS));
    }
    let between =
        matches!((shader.stage, global.storage), (Stage::Vertex, Storage::Out) | (Stage::Fragment, Storage::In));
    let members = match types.get(global.ty) {
        Type::Struct(id) if global.block.is_some() => types.structure(id).members.as_slice(),
        _ => &[],
    };
    let placed = |member: &Member| member.place.offset.is_some() || member.place.align > 0;
    if global.storage == Storage::Uniform && members.iter().any(placed) {
        return Some(("`offset` and `align` in a block".into(), "fill the gaps with members"));
    }
    if between && let Some(what) = foreign_varying(types, global) {
        return Some((what.into(), "declare a variable, or an array, for each member"));
    }
    let noperspective = |member: &Member| member.interpolation == Some(Interpolation::Noperspective);
    if between && (global.interpolation == Interpolation::Noperspective || members.iter().any(noperspective)) {
        return Some((
            "`noperspective`".into(),
            "multiply by `gl_Position.w` before the rasterizer, and by `gl_FragCoord.w` after it",
        ));
    }
    if between
        && (global.sampling == Sampling::Sample || members.iter().any(|member| member.sampling == Sampling::Sample))
    {
        return Some(("`sample`".into(), "use `centroid`, or compile for `--glsl-version 330`"));
    }
    if shader.stage == Stage::Vertex && global.storage == Storage::In && matches!(types.get(global.ty), Type::Array(..))
    {
        return Some(("arrays of attributes".into(), "declare one attribute for each element"));
    }
    None
}

/// The part of a varying's type that ES lacks (GLSL ES 3.00 §4.3.4, §4.3.6). A block becomes a varying for each member.
fn foreign_varying(types: &Types, global: &Global) -> Option<&'static str> {
    let of = |ty| match types.get(ty) {
        Type::Array(element, _) if matches!(types.get(element), Type::Struct(_)) => {
            Some("arrays of structs between stages")
        }
        Type::Struct(id) => {
            let nests = |member: &Member| matches!(types.get(member.ty), Type::Array(..) | Type::Struct(_));
            let mut members = types.structure(id).members.iter();
            members.any(nests).then_some("structs with arrays or structs between stages")
        }
        _ => None,
    };
    match types.get(global.ty) {
        Type::Array(..) if global.block.is_some() => Some("arrays of blocks between stages"),
        Type::Struct(id) if global.block.is_some() => {
            types.structure(id).members.iter().find_map(|member| of(member.ty))
        }
        _ => of(global.ty),
    }
}

fn of_builtin(shader: &Shader, builtin: BuiltinVariable) -> Option<(String, &'static str)> {
    let layout = shader.frag_coord;
    match builtin {
        BuiltinVariable::ClipDistance => {
            Some(("`gl_ClipDistance`".into(), "pass the distance as a varying, and `discard` where it is negative"))
        }
        BuiltinVariable::PrimitiveId => {
            Some(("`gl_PrimitiveID`".into(), "pass the number as a `flat` varying of each triangle's own vertices"))
        }
        BuiltinVariable::SampleId | BuiltinVariable::SampleMaskIn => {
            Some((format!("`{}`", builtin.name()), "compile for `--glsl-version 330`"))
        }
        BuiltinVariable::FragCoord if layout.origin_upper_left || layout.pixel_center_integer => Some((
            "layouts of `gl_FragCoord`".into(),
            "compute the coordinate from `gl_FragCoord` and a uniform with the height",
        )),
        _ => None,
    }
}

/// The first sampler type in a type that ES lacks.
fn foreign_sampler(types: &Types, ty: TypeId) -> Option<SamplerType> {
    match types.get(ty) {
        Type::Sampler(sampler) => {
            let known = matches!(sampler.dim, SamplerDim::D2 | SamplerDim::D3 | SamplerDim::Cube);
            (!known || (sampler.dim == SamplerDim::Cube && sampler.arrayed)).then_some(sampler)
        }
        Type::Array(element, _) => foreign_sampler(types, element),
        Type::Struct(id) => types.structure(id).members.iter().find_map(|member| foreign_sampler(types, member.ty)),
        _ => None,
    }
}
