//! Which stages form a program, and what each must have (OpenGL 3.2 §2.11.2, §2.12; GLSL 1.50 §4.3.8, §6.1).

use super::{Linker, merge};
use crate::analysis::{SHADERTOY_HELP, SHADERTOY_NOTE, is_shadertoy};
use crate::diagnostic::{Applicability, Diagnostic, Fix, codes, did_you_mean};
use crate::hir::{FunctionId, Shader, Stage, Types};
use crate::language::Version;

/// One shader per stage, in pipeline order; several shaders of one stage are merged.
pub(super) fn in_order(types: &mut Types, shaders: Vec<Shader>, found: &mut Vec<Diagnostic>) -> Vec<Shader> {
    let mut by_stage: [Vec<Shader>; 3] = Default::default();
    for shader in shaders {
        let [vertex, geometry, fragment] = &mut by_stage;
        match shader.stage {
            Stage::Vertex => vertex.push(shader),
            Stage::Geometry => geometry.push(shader),
            Stage::Fragment => fragment.push(shader),
        }
    }
    by_stage.into_iter().filter_map(|shaders| merge::merge(types, shaders, found)).collect()
}

/// Checks that all shaders are of one language: the desktop's in any versions, or one version of ES's (GLSL ES 3.00
/// §3.4).
pub(super) fn check_languages(shaders: &[Shader], found: &mut Vec<Diagnostic>) {
    let Some((first, rest)) = shaders.split_first() else { return };
    let same = |other: &&Shader| {
        let (a, b) = (first.version, other.version);
        // Without a `#version` line, a text of 1.10 is one of ES 1.00 for WebGL.
        let is_unsaid = |version: Version| !version.is_es() && !version.span.is_known();
        a.is_es() == b.is_es() && (!a.is_es() || a.number == b.number) || is_unsaid(a) || is_unsaid(b)
    };
    if let Some(other) = rest.iter().find(|other| !same(other)) {
        let (one, another) = (first.version.name(), other.version.name());
        let message = format!("a shader of {another} in a program of {one}");
        let finding = Diagnostic::new(&codes::link::MIXED_LANGUAGES, other.anchor(), message);
        found.push(finding.label(first.anchor(), format!("this is {one}")));
    }
}

/// Checks that the stages can run. What only a program must have is a warning instead of an error in a single shader.
pub(super) fn check(ctx: &mut Linker<'_>, stages: &[Shader], lone: bool) -> bool {
    let mut complete = !stages.is_empty();
    for shader in stages {
        if shader.main.is_none() {
            complete = false;
            missing_main(ctx, shader, lone);
        }
        complete &= functions_are_defined(ctx, shader, lone);
        check_recursion(ctx, shader);
        super::outputs::check_exclusive(ctx, shader);
        if shader.stage == Stage::Geometry {
            geometry_layout(ctx, shader, lone);
        }
    }
    let has = |stage| stages.iter().any(|shader| shader.stage == stage);
    if has(Stage::Geometry) && !has(Stage::Vertex) && !lone {
        let span = stages.iter().find(|shader| shader.stage == Stage::Geometry).map(Shader::anchor).unwrap_or_default();
        let message = "a geometry shader without a vertex shader before it";
        ctx.report(
            Diagnostic::new(&codes::link::MISSING_STAGE, span, message).help("add a vertex shader to the program"),
        );
    }
    complete
}

/// Checks that every called function is defined in some shader of the stage (§6.1).
fn functions_are_defined(ctx: &mut Linker<'_>, shader: &Shader, lone: bool) -> bool {
    let code = if lone { &codes::link::LONE_WITHOUT_DEFINITION } else { &codes::link::UNDEFINED_FUNCTION };
    let stage = shader.stage.name();
    let help = format!("if another {stage} shader defines it, name all shaders of the program: `--program FILE,FILE`");
    let undefined = shader.functions.iter().filter(|function| function.reachable && function.body.is_none());
    let mut complete = true;
    for function in undefined {
        complete = false;
        let message = format!("`{}` is called and only declared", function.name);
        ctx.report(Diagnostic::new(code, function.span, message).here("the declaration").help(help.clone()));
    }
    complete
}

/// Reports recursion through functions of different shaders (§6.1). The analysis finds recursion within one shader.
fn check_recursion(ctx: &mut Linker<'_>, shader: &Shader) {
    let Some(main) = shader.main else { return };
    let order = shader.callees_first(main);
    let mut place = vec![usize::MAX; shader.functions.len()];
    for (index, id) in order.iter().enumerate() {
        if let Some(slot) = place.get_mut(id.index()) {
            *slot = index;
        }
    }
    for (index, &caller) in order.iter().enumerate() {
        // Callees come first, except where a cycle was cut.
        let later = |callee: &FunctionId| place.get(callee.index()).is_some_and(|&place| place >= index);
        if let Some(callee) = shader.callees(caller).into_iter().find(later) {
            let (caller, callee) = (shader.function(caller), shader.function(callee));
            let message =
                format!("`{}` and `{}` call each other across shaders of one stage", caller.name, callee.name);
            let finding = Diagnostic::new(&codes::statements::RECURSION, caller.span, message);
            ctx.report(finding.label(callee.span, "declared here"));
        }
    }
}

fn missing_main(ctx: &mut Linker<'_>, shader: &Shader, lone: bool) {
    let code = if lone { &codes::link::LONE_WITHOUT_MAIN } else { &codes::link::MISSING_MAIN };
    let message = format!("the {} stage has no `main`", shader.stage.name());
    let names = shader.functions.iter().map(|function| function.name.as_str());
    let near = did_you_mean("main", names);
    let near = near.and_then(|name| shader.functions.iter().find(|function| function.name == name));
    let finding = Diagnostic::new(code, shader.anchor(), message);
    ctx.report(match near {
        _ if is_shadertoy(shader) => finding.note(SHADERTOY_NOTE).help(SHADERTOY_HELP),
        Some(function) => {
            let fix =
                Fix::new(Applicability::Unsafe, format!("call `{}` `main`", function.name), function.span, "main");
            finding.help(format!("did you mean `{}` to be `main`?", function.name)).fix(fix)
        }
        None => finding,
    });
}

fn geometry_layout(ctx: &mut Linker<'_>, shader: &Shader, lone: bool) {
    let layout = &shader.geometry;
    let missing = [
        (layout.input.is_none(), "the input primitive", "layout(triangles) in;"),
        (layout.output.is_none(), "the output primitive", "layout(triangle_strip) out;"),
        (layout.max_vertices.is_none(), "`max_vertices`", "layout(max_vertices = 3) out;"),
    ];
    let code = if lone { &codes::link::LONE_WITHOUT_LAYOUT } else { &codes::link::MISSING_GEOMETRY_LAYOUT };
    let lacking: Vec<_> = missing.into_iter().filter(|(missing, ..)| *missing).collect();
    if lacking.is_empty() {
        return;
    }
    let what: Vec<_> = lacking.iter().map(|(_, what, _)| *what).collect();
    let help: Vec<_> = lacking.iter().map(|(.., help)| *help).collect();
    let message = format!("the geometry stage does not declare {}", what.join(" and "));
    ctx.report(Diagnostic::new(code, shader.anchor(), message).help(format!("declare `{}`", help.join(" "))));
}
