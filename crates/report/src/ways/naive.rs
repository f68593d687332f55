//! The plain forms of the library's functions, in programs that call them.
//!
//! *In:* a scene and one of its draws. *Out:* the scene whose program has the equations as printed (the library's module
//! `naive`) in place of the forms that are finite and exact everywhere. *Holds:* in exact arithmetic they are the same where
//! the equations are defined; functions are known by their names and parameters.

use super::edit::{Edited, with_draw};
use glisten_front::hir::{Shader, Stage, TypeId, Types};
use glisten_scene::Scene;
use std::fmt::Write;

const FLOAT: TypeId = TypeId::FLOAT;
const VEC3: TypeId = TypeId::VEC3;
const VEC4: TypeId = TypeId::VEC4;

/// Functions of the library: the name, the types of the parameters `a`, `b`, `c`, and the body as printed.
static FORMS: &[(&str, &[TypeId], &str)] = &[
    ("safeLimit", &[FLOAT], "return a;"),
    ("safeLimit", &[VEC3], "return a;"),
    ("safeLimit", &[VEC4], "return a;"),
    ("safeFinite", &[FLOAT], "return a;"),
    ("safeFinite", &[VEC3], "return a;"),
    ("safePositive", &[FLOAT], "return max(a, 0.0);"),
    ("safeUnit", &[FLOAT], "return clamp(a, 0.0, 1.0);"),
    ("safeLength", &[VEC3], "return length(a);"),
    ("safeNormalize", &[VEC3], "return normalize(a);"),
    ("safePow", &[FLOAT, FLOAT], "return pow(max(a, 0.0), b);"),
    ("safePowOneMinus", &[FLOAT, FLOAT], "return pow(max(1.0 - a, 0.0), b);"),
    ("safeOneMinusCos", &[VEC3, VEC3], "return 1.0 - dot(a, b);"),
    ("safeCosPow", &[VEC3, VEC3, FLOAT], "return pow(max(dot(a, b), 0.0), c);"),
    ("attenuation", &[FLOAT, VEC3], "return 1.0 / (b.x + b.y * a + b.z * a * a);"),
    ("schlickBetween", &[VEC3, VEC3, FLOAT], "float t = max(dot(a, b), 0.0);\n    return t / (c - t * c + t);"),
    ("schlick", &[FLOAT, FLOAT], "return a / (b - a * b + a);"),
];

/// A program is of the library if it calls one of these.
static SURE: &[&str] = &["safeNormalize", "safeCosPow", "safeLength", "safeOneMinusCos", "safePow", "schlickBetween"];

/// The scene with the equations as printed, and the names of the functions.
pub(super) fn naive(scene: &Scene, index: usize) -> Option<(Scene, Vec<&'static str>)> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let mut names = Vec::new();
    let types = edited.types.clone();
    for stage in [Stage::Vertex, Stage::Fragment] {
        let open = if stage == Stage::Vertex { &mut edited.vertex } else { &mut edited.fragment };
        for (name, params, body) in FORMS {
            if declared_anew(&types, &mut open.shader, name, params, body, &mut open.appended) {
                names.push(*name);
            }
        }
    }
    names.iter().any(|name| SURE.contains(name)).then_some(())?;
    names.sort_unstable();
    names.dedup();
    Some((with_draw(scene, index, edited.draw(draw)?)?, names))
}

/// Takes the body of a function away, and appends another one. False if the stage does not reach such a function.
fn declared_anew(
    types: &Types,
    shader: &mut Shader,
    name: &str,
    params: &[TypeId],
    body: &str,
    appended: &mut String,
) -> bool {
    let known = shader.functions.iter_mut().find(|function| {
        let types = function.params().iter().map(|param| param.ty);
        function.name == name && function.reachable && function.body.is_some() && types.eq(params.iter().copied())
    });
    let Some(function) = known else { return false };
    function.body = None;
    let list: Vec<String> =
        params.iter().zip(["a", "b", "c"]).map(|(ty, name)| format!("{} {name}", types.name(*ty))).collect();
    let _ = write!(appended, "\n{} {name}({}) {{\n    {body}\n}}\n", types.name(function.ret), list.join(", "));
    true
}
