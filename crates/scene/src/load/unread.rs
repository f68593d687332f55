//! Warns about keys of lights and materials that no program of the scene reads.
//!
//! *In:* the scene's tables, its draws, and what their programs read. *Out:* one warning for each table. *Holds:* a
//! key counts as read if one program to which the table applies reads its value. A model that is the one a program of
//! the library has anyway is no mistake. *Not done here:* tables that no program declares at all (`warn_unlit`).

use super::layers;
use crate::library::Library;
use crate::model::Draw;
use crate::reads::scene_values_read;
use crate::tables::{Node, Reader};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_UNREAD_KEY;
use std::collections::BTreeSet;
use toml::de::DeTable;

/// Keys of a material, and the values that they set, besides those of layers.
const MATERIAL: &[(&str, &str)] = &[
    ("ambient", "material.ambient"),
    ("diffuse", "material.diffuse"),
    ("specular", "material.specular"),
    ("emission", "material.emission"),
    ("shininess", "material.shininess"),
    ("threshold", "finish.threshold"),
    ("shade", "finish.shade"),
    ("base_color", "material.diffuse"),
    ("metallic", "material.specular"),
    ("roughness", "finish.roughness"),
    ("clearcoat", "finish.clearcoat"),
    ("clearcoat_roughness", "finish.clearcoat_roughness"),
    ("diffuse_model", "finish.diffuse_model"),
    ("specular_model", "finish.specular_model"),
    ("decal", "decal"),
    ("ramp", "ramp"),
    ("highlight", "highlight"),
    ("metallic_roughness", "metallic_roughness"),
    ("emission_map", "emission_map"),
    ("occlusion_map", "occlusion_map"),
    ("normal_map", "normal_map"),
    ("dielectric", "finish.dielectric"),
    ("dielectric", "material.specular"),
    ("alpha", "finish.alpha"),
    ("alpha_cutoff", "finish.alpha_cutoff"),
    ("two_sided", "finish.two_sided"),
    ("normal_scale", "finish.normal_scale"),
    ("occlusion_strength", "finish.occlusion_strength"),
];

/// Keys of a light, and the values that they set. A color sets two, of which one is enough.
const LIGHT: &[(&str, &str)] = &[
    ("position", "light.position"),
    ("towards", "light.direction"),
    ("direction", "light.direction"),
    ("target", "light.direction"),
    ("axis", "light.direction"),
    ("color", "light.diffuse"),
    ("color", "light.specular"),
    ("ambient", "light.ambient"),
    ("diffuse", "light.diffuse"),
    ("specular", "light.specular"),
    ("sky", "light.diffuse"),
    ("ground", "light.ambient"),
    ("attenuation", "light.attenuation"),
    ("exponent", "light.exponent"),
    ("range", "light.range"),
    ("cone", "light.outer"),
    ("from", "light.x"),
    ("to", "light.x"),
    ("up", "light.x"),
    ("width", "light.x"),
    ("height", "light.y"),
    ("radius", "light.radius"),
    ("two_sided", "light.direction"),
];

/// The models that the textbook's programs have by themselves: program, diffuse model, specular model.
const OWN_MODELS: &[(&str, &str, &str)] = &[
    ("lambert", "lambert", "none"),
    ("phong", "lambert", "phong"),
    ("blinn_phong", "lambert", "blinn_phong"),
    ("schlick", "lambert", "schlick_blinn"),
    ("threshold", "lambert", "threshold"),
];

/// A draw's table, with what its program reads.
struct Reading<'t, 'i> {
    table: &'t DeTable<'i>,
    /// The program as the scene names it.
    program: &'t str,
    declares: Vec<&'t str>,
    read: BTreeSet<String>,
}

/// Warns about the keys of a scene, whose draws are complete, that nothing reads. The materials of draws after the first `n_own`
/// are not the scene's own.
pub(super) fn warn_unread(
    reader: &mut Reader,
    scene: &DeTable<'_>,
    (draws, n_own): (&[(&Node<'_>, &Draw)], usize),
    library: &dyn Library,
) {
    let readings: Vec<Reading<'_, '_>> = draws.iter().filter_map(|(node, draw)| reading(node, draw)).collect();
    let all: Vec<&Reading<'_, '_>> = readings.iter().collect();
    let lit: Vec<&Reading<'_, '_>> = declaring(&all, "light");
    let lights = scene.get("light").and_then(|node| node.get_ref().as_array()).into_iter().flatten();
    let lights: Vec<_> = lights.filter_map(|light| light.get_ref().as_table()).collect();
    // What a light in error would have asked of a program, the program does not have.
    if !lights.iter().any(|table| has_error(reader, table)) {
        for table in lights {
            warn_table(reader, ("light", table), LIGHT, &lit, library);
        }
    }
    let values: Vec<_> = MATERIAL.iter().copied().chain(layers::values()).collect();
    let shared: Vec<&Reading<'_, '_>> = all.iter().copied().filter(|one| !one.table.contains_key("material")).collect();
    if let Some(table) = scene.get("material").and_then(|node| node.get_ref().as_table()) {
        warn_table(reader, ("material", table), &values, &declaring(&shared, "material"), library);
    }
    for one in all.iter().take(n_own) {
        if let Some(table) = one.table.get("material").and_then(|node| node.get_ref().as_table()) {
            warn_table(reader, ("material", table), &values, &declaring(&[one], "material"), library);
        }
    }
}

/// Whether an error in a table was reported.
fn has_error(reader: &Reader, table: &DeTable<'_>) -> bool {
    let ranges = table.iter().flat_map(|(key, node)| [key.span(), node.span()]);
    let Some(whole) = ranges.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)) else { return false };
    let whole = reader.span(whole);
    reader.diagnostics.iter().any(|found| {
        let span = found.primary.span;
        found.is_error() && whole.start <= span.start && span.end <= whole.end
    })
}

fn reading<'t, 'i>(node: &'t Node<'i>, draw: &'t Draw) -> Option<Reading<'t, 'i>> {
    let table = node.get_ref().as_table()?;
    let program = table.get("program").or(table.get("fragment"))?.get_ref().as_str()?;
    let declares = draw.program.interface.roots.iter().map(|root| root.name.as_str()).collect();
    Some(Reading { table, program, declares, read: scene_values_read(&draw.program) })
}

fn declaring<'r, 't, 'i>(all: &[&'r Reading<'t, 'i>], root: &str) -> Vec<&'r Reading<'t, 'i>> {
    all.iter().copied().filter(|one| one.declares.contains(&root)).collect()
}

/// Warns about the keys of a table that none of the programs reads.
fn warn_table(
    reader: &mut Reader,
    (what, table): (&str, &DeTable<'_>),
    values: &[(&'static str, &'static str)],
    programs: &[&Reading<'_, '_>],
    library: &dyn Library,
) {
    if programs.is_empty() {
        return;
    }
    let unread: Vec<_> = table
        .iter()
        .filter(|(key, node)| !is_read(key.get_ref(), node, values, programs))
        .map(|(key, _)| (key.get_ref().as_ref(), reader.span_of(key)))
        .collect();
    let Some((_, first)) = unread.first() else { return };
    let mut names: Vec<&str> = programs.iter().map(|one| one.program).collect();
    names.sort_unstable();
    names.dedup();
    let keys: Vec<&str> = unread.iter().map(|(key, _)| *key).collect();
    let who = if names.len() == 1 { "the program" } else { "none of the programs" };
    let verb = if names.len() == 1 { "does not read" } else { "reads" };
    let message = format!("{who} {} {verb} {} of the {what}", quoted(&names), quoted(&keys));
    let mut diagnostic = Diagnostic::new(&SCENE_UNREAD_KEY, *first, message).here("changes nothing");
    for (_, span) in unread.iter().skip(1) {
        diagnostic = diagnostic.label(*span, "nor does this");
    }
    let wanted: Vec<&str> = values.iter().filter(|(key, _)| keys.contains(key)).map(|(_, value)| *value).collect();
    reader.report(diagnostic.maybe_help(users(&wanted, library)));
}

/// Whether a key has an effect in one of the programs.
fn is_read(key: &str, node: &Node<'_>, values: &[(&'static str, &'static str)], programs: &[&Reading<'_, '_>]) -> bool {
    let mut known = values.iter().filter(|(name, _)| *name == key).peekable();
    // A key that sets nothing by itself: the kind of a light, or one that has been reported.
    if known.peek().is_none() {
        return true;
    }
    let mut known = known.map(|(_, value)| *value);
    let given = node.get_ref().as_str();
    known.any(|value| programs.iter().any(|one| one.read.contains(value)))
        || programs.iter().all(|one| given.is_some_and(|given| has_by_itself(one.program, key, given)))
}

/// Whether a program of the library has this model anyway.
fn has_by_itself(program: &str, key: &str, given: &str) -> bool {
    let name = program.strip_suffix("_vertex").unwrap_or(program);
    let row = OWN_MODELS.iter().find(|(known, ..)| *known == name);
    row.is_some_and(|&(_, diffuse, specular)| match key {
        "diffuse_model" => given == diffuse,
        "specular_model" => given == specular,
        _ => false,
    })
}

/// The programs of the library that read all these values.
fn users(wanted: &[&str], library: &dyn Library) -> Option<String> {
    let users: Vec<&str> = library
        .program_names()
        .into_iter()
        .filter(|name| library.values_read(name).is_some_and(|read| wanted.iter().all(|value| read.contains(*value))))
        .collect();
    let verb = if users.len() == 1 { "reads" } else { "read" };
    (!users.is_empty())
        .then(|| format!("of the library, {} {verb} {}", quoted(&users), if wanted.len() == 1 { "it" } else { "them" }))
}

/// `a`, `b` and `c`
fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}
