//! The other models of the library, for scenes that the library shades.
//!
//! *In:* a scene, and its file as a table. *Out:* the scene with another model of light: by the uniforms of the standard
//! program, or by another program of the library. *Holds:* a model is no approximation of another one, so each has a reference of
//! its own.

use glisten_front::hir::ScalarValue;
use glisten_scene::{Draw, Scene};
use toml::{Table, Value};

/// The uniform that selects the specular model of the standard program.
const SPECULAR: &str = "finish.specular_model";

/// The specular models of the standard program that need no texture.
static SPECULAR_MODELS: &[(i32, &str)] = &[
    (1, "Phong"),
    (2, "Blinn-Phong"),
    (3, "Schlick on the mirror direction"),
    (4, "Schlick on the half vector"),
    (5, "threshold"),
    (6, "the fourth power"),
];

/// Programs of the library that shade with one model, and that model's name. Each has a program per vertex, with `_vertex`
/// after its name.
static PROGRAMS: &[(&str, &str)] = &[
    ("lambert", "Lambert"),
    ("phong", "Phong"),
    ("blinn_phong", "Blinn-Phong"),
    ("schlick", "Schlick on the half vector"),
    ("threshold", "threshold"),
];

/// The scene with another specular model of the standard program: name and scene, for each model but its own.
pub(super) fn by_uniform(scene: &Scene) -> Vec<(&'static str, Scene)> {
    let own: Vec<Option<i32>> = scene.draws.iter().map(specular_model).collect();
    if own.iter().all(Option::is_none) {
        return Vec::new();
    }
    let others = SPECULAR_MODELS.iter().filter(|(model, _)| own.iter().flatten().all(|known| known != model));
    others
        .map(|(model, name)| {
            let mut scene = scene.clone();
            scene.draws.iter_mut().for_each(|draw| set_specular_model(draw, *model));
            (*name, scene)
        })
        .collect()
}

/// Where the uniform is in a draw: its root, and its place in that.
fn place(draw: &Draw) -> Option<(usize, usize)> {
    let leaf = draw.program.interface.uniforms.iter().find(|leaf| leaf.name == SPECULAR)?;
    let is_dynamic = draw.dynamic.iter().any(|name| name == SPECULAR || name == "finish");
    (!is_dynamic).then_some((leaf.root.0 as usize, leaf.flat_offset as usize))
}

/// The specular model of a draw with a highlight.
fn specular_model(draw: &Draw) -> Option<i32> {
    let (root, offset) = place(draw)?;
    match draw.uniforms.get(root)?.get(offset)? {
        ScalarValue::Int(model) if *model > 0 => Some(*model),
        _ => None,
    }
}

fn set_specular_model(draw: &mut Draw, model: i32) {
    if specular_model(draw).is_some()
        && let Some((root, offset)) = place(draw)
        && let Some(slot) = draw.uniforms.get_mut(root).and_then(|values| values.get_mut(offset))
    {
        *slot = ScalarValue::Int(model);
    }
}

/// The text of the scene with another program of the library in the draws that have one: name and text, for each program but
/// its own.
pub(super) fn by_program(scene: &Table) -> Vec<(&'static str, String)> {
    let own: Vec<&str> = programs(scene).filter(|name| PROGRAMS.iter().any(|(known, _)| known == name)).collect();
    let [own] = own.as_slice() else { return Vec::new() };
    let others = PROGRAMS.iter().filter(|(program, _)| program != own);
    others.filter_map(|(program, name)| Some((*name, with_program(scene, own, program)?))).collect()
}

/// The text of the scene with the library's programs per vertex.
pub(super) fn per_vertex(scene: &Table) -> Option<String> {
    let known = glisten_library::programs();
    let counterpart = |name: &str| {
        let wanted = format!("{name}_vertex");
        known.iter().any(|program| program.name == wanted).then_some(wanted)
    };
    let mut text = None;
    let mut scene = scene.clone();
    let names: Vec<String> = programs(&scene).map(str::to_owned).collect();
    for name in names {
        if let Some(wanted) = counterpart(&name) {
            let changed = with_program(&scene, &name, &wanted)?;
            scene = changed.parse().ok()?;
            text = Some(changed);
        }
    }
    text
}

fn programs(scene: &Table) -> impl Iterator<Item = &str> {
    let draws = scene.get("draw").and_then(Value::as_array).into_iter().flatten();
    draws.filter_map(|draw| draw.get("program").and_then(Value::as_str))
}

fn with_program(scene: &Table, from: &str, to: &str) -> Option<String> {
    let mut scene = scene.clone();
    scene.remove("report");
    for draw in scene.get_mut("draw")?.as_array_mut()? {
        let program = draw.as_table_mut()?.get_mut("program");
        if let Some(program) = program.filter(|program| program.as_str() == Some(from)) {
            *program = Value::String(to.into());
        }
    }
    toml::to_string(&scene).ok()
}
