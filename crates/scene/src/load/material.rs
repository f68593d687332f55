//! `[material]` and `[draw.material]`: the values for the uniforms `material` and `finish` of the library's module
//! `scene`.
//!
//! *In:* the table of the draw, or else of the scene. *Out:* the value of each member by name, and the table, from
//! which `textures` reads `decal`, `ramp` and `highlight`. *Holds:* a draw's own material replaces the scene's as a
//! whole. The scene's material does not affect programs that declare none.

use super::layers;
use super::lights::Member;
use crate::fixed::uses_fixed_state;
use crate::tables::{Node, Reader};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{SCENE_MISSING_KEY, SCENE_UNKNOWN_NAME};
use glisten_front::link::Program;
use toml::de::DeTable;

/// The samplers of the library's programs for which a material may provide a texture, besides those of layers.
const TEXTURES: &[&str] =
    &["decal", "ramp", "highlight", "metallic_roughness", "emission_map", "occlusion_map", "normal_map"];

/// Whether a material may provide the texture of a sampler.
pub(super) fn has_texture(sampler: &str) -> bool {
    TEXTURES.contains(&sampler) || layers::MAPS.contains(&sampler)
}

/// The keys for which the program `standard` has the macro `GLISTEN_SURFACE`: what changes from point to point.
const SURFACE_KEYS: &[&str] = &[
    "metallic_roughness",
    "emission_map",
    "occlusion_map",
    "normal_map",
    "alpha",
    "alpha_cutoff",
    "two_sided",
    "normal_scale",
    "occlusion_strength",
    "vertex_colors",
];

/// All other keys.
const KEYS: &[&str] = &[
    "ambient",
    "diffuse",
    "specular",
    "emission",
    "shininess",
    "threshold",
    "shade",
    "base_color",
    "metallic",
    "roughness",
    "clearcoat",
    "clearcoat_roughness",
    "diffuse_model",
    "specular_model",
    "decal",
    "ramp",
    "highlight",
    "dielectric",
];

/// Diffuse models, with the numbers of the module's constants `DIFFUSE_NONE` and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DiffuseModel {
    None,
    Lambert,
    HalfLambert,
    ToonSoft,
    ToonHard,
    OrenNayar,
    Eon,
    Burley,
    Wrap,
    Minnaert,
}

const DIFFUSE_MODELS: &[(&str, DiffuseModel)] = &[
    ("none", DiffuseModel::None),
    ("lambert", DiffuseModel::Lambert),
    ("half_lambert", DiffuseModel::HalfLambert),
    ("toon_soft", DiffuseModel::ToonSoft),
    ("toon_hard", DiffuseModel::ToonHard),
    ("oren_nayar", DiffuseModel::OrenNayar),
    ("eon", DiffuseModel::Eon),
    ("burley", DiffuseModel::Burley),
    ("wrap", DiffuseModel::Wrap),
    ("minnaert", DiffuseModel::Minnaert),
];

/// Specular models, with the numbers of the module's constants `SPECULAR_NONE` and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SpecularModel {
    None,
    Phong,
    BlinnPhong,
    SchlickPhong,
    SchlickBlinn,
    Threshold,
    Quartic,
    TableHalf,
    TableLight,
    Ggx,
    Beckmann,
    Sheen,
    Normalized,
}

const SPECULAR_MODELS: &[(&str, SpecularModel)] = &[
    ("none", SpecularModel::None),
    ("phong", SpecularModel::Phong),
    ("blinn_phong", SpecularModel::BlinnPhong),
    ("schlick_phong", SpecularModel::SchlickPhong),
    ("schlick_blinn", SpecularModel::SchlickBlinn),
    ("threshold", SpecularModel::Threshold),
    ("quartic", SpecularModel::Quartic),
    ("table_half", SpecularModel::TableHalf),
    ("table_light", SpecularModel::TableLight),
    ("ggx", SpecularModel::Ggx),
    ("beckmann", SpecularModel::Beckmann),
    ("sheen", SpecularModel::Sheen),
    ("normalized", SpecularModel::Normalized),
];

/// The uniforms of a material by name.
pub(super) type Material = Vec<(String, Member)>;

/// The macros that the program `standard` has for the material of a draw, or of the scene.
pub(super) fn macros(draw: &DeTable<'_>, scene: Option<&Node<'_>>) -> Vec<&'static str> {
    let node = draw.get("material").or(scene);
    let Some(table) = node.and_then(|node| node.get_ref().as_table()) else { return Vec::new() };
    let flagged = |key: &str| table.get(key).and_then(|node| node.get_ref().as_bool()).unwrap_or(false);
    let layers = layers::macros(table);
    let rows = [
        ("GLISTEN_SURFACE", !layers.is_empty() || SURFACE_KEYS.iter().any(|key| table.contains_key(*key))),
        ("GLISTEN_NORMALS", table.contains_key("normal_map")),
        ("GLISTEN_COLORS", flagged("vertex_colors")),
    ];
    let named = rows.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| name);
    named.chain(layers).collect()
}

/// The material of a draw, with its node; `None` if there is none, or if the program does not use one.
pub(super) fn load_material<'t, 'i>(
    reader: &mut Reader,
    draw: &'t DeTable<'i>,
    scene: Option<&'t Node<'i>>,
    program: &Program,
) -> Option<(Material, &'t Node<'i>)> {
    let declared = program.interface.roots.iter().any(|root| root.name == "material");
    if !declared && uses_fixed_state(program) {
        return None;
    }
    let own = draw.get_key_value("material");
    if let Some((key, _)) = own
        && !declared
    {
        let span = reader.span_of(key);
        let diagnostic = Diagnostic::new(&SCENE_UNKNOWN_NAME, span, "the program declares no uniform `material`");
        reader.report(diagnostic.help("`#include <glisten/scene.glsl>` declares it; `program = \"standard\"` uses it"));
        return None;
    }
    if !declared {
        return None;
    }
    let node = own.map(|(_, node)| node).or(scene)?;
    let table = reader.table(node, "material")?;
    reader.check_keys(table, "a material", &keys());
    // The model of metals and roughness: a metal has no diffuse color, anything else mirrors 0.04.
    let is_physical = table.contains_key("base_color") || table.contains_key("metallic");
    let base = reader.reals(table, "base_color", [0.8; 3]);
    let metallic = reader.real(table, "metallic", 0.0);
    let dielectric = reader.reals(table, "dielectric", [0.04; 3]);
    let [own_diffuse, own_specular] =
        if is_physical { by_metallic(base, metallic, dielectric) } else { [[0.8; 3], [0.0; 3]] };
    // Colors that the scene states are not those of the model.
    let is_stated = ["diffuse", "specular"].iter().any(|key| table.contains_key(*key));
    let parted = if is_physical && !is_stated { metallic.clamp(0.0, 1.0) } else { -1.0 };
    let two_sided = f64::from(u8::from(reader.flag(table, "two_sided", false)));
    reader.flag(table, "vertex_colors", false);
    let own_model = if is_physical { SpecularModel::Ggx } else { SpecularModel::BlinnPhong };
    let diffuse = reader.reals(table, "diffuse", own_diffuse);
    let diffuse_model = reader.choice_at(table, "diffuse_model", DiffuseModel::Lambert, DIFFUSE_MODELS);
    let specular_model = reader.choice_at(table, "specular_model", own_model, SPECULAR_MODELS);
    require(reader, table, "diffuse_model", "ramp", diffuse_model == DiffuseModel::ToonSoft)?;
    let by_table = matches!(specular_model, SpecularModel::TableHalf | SpecularModel::TableLight);
    require(reader, table, "specular_model", "highlight", by_table)?;
    let members = [
        ("material.ambient", Member::Vector(reader.reals(table, "ambient", diffuse))),
        ("material.diffuse", Member::Vector(diffuse)),
        ("material.specular", Member::Vector(reader.reals(table, "specular", own_specular))),
        ("material.emission", Member::Vector(reader.reals(table, "emission", [0.0; 3]))),
        ("material.shininess", Member::Float(reader.real(table, "shininess", 32.0))),
        ("finish.threshold", Member::Float(reader.real(table, "threshold", 0.5))),
        ("finish.shade", Member::Vector(reader.reals(table, "shade", [0.0; 3]))),
        ("finish.roughness", Member::Float(reader.real(table, "roughness", 0.5))),
        ("finish.clearcoat", Member::Float(reader.real(table, "clearcoat", 0.0))),
        ("finish.clearcoat_roughness", Member::Float(reader.real(table, "clearcoat_roughness", 0.1))),
        ("finish.diffuse_model", Member::Int(diffuse_model as i32)),
        ("finish.specular_model", Member::Int(specular_model as i32)),
        ("finish.base_color", Member::Vector(base)),
        ("finish.metallic", Member::Float(parted)),
        ("finish.own_ambient", Member::Float(f64::from(u8::from(table.contains_key("ambient"))))),
        ("finish.dielectric", Member::Vector(dielectric)),
        (
            "finish.alpha",
            Member::Float(reader.real(table, "alpha", if table.contains_key("alpha_cutoff") { 1.0 } else { -1.0 })),
        ),
        ("finish.alpha_cutoff", Member::Float(reader.real(table, "alpha_cutoff", 0.0))),
        ("finish.two_sided", Member::Float(two_sided)),
        ("finish.normal_scale", Member::Float(reader.real(table, "normal_scale", 1.0))),
        ("finish.occlusion_strength", Member::Float(reader.real(table, "occlusion_strength", 1.0))),
    ];
    let own = members.map(|(name, value)| (name.to_owned(), value));
    Some((own.into_iter().chain(layers::members(reader, table)).collect(), node))
}

/// All keys of a material.
fn keys() -> Vec<&'static str> {
    [KEYS, SURFACE_KEYS, &layers::keys()].concat()
}

/// The diffuse color and the reflectance at normal incidence of a base color, as in glTF 2.0, appendix B.
fn by_metallic(base: [f64; 3], metallic: f64, dielectric: [f64; 3]) -> [[f64; 3]; 2] {
    let metallic = metallic.clamp(0.0, 1.0);
    let mut mirrored = dielectric;
    for (mirrored, color) in mirrored.iter_mut().zip(base) {
        *mirrored = *mirrored * (1.0 - metallic) + color * metallic;
    }
    [base.map(|color| color * (1.0 - metallic)), mirrored]
}

/// The colors of a material that the fixed-function pipeline has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Colors {
    pub(super) emission: [f64; 3],
    pub(super) ambient: [f64; 3],
    pub(super) diffuse: [f64; 3],
    pub(super) specular: [f64; 3],
    pub(super) shininess: f64,
}

/// The colors of the material of a draw, or of the scene; `None` if there is none.
pub(super) fn load_colors(
    reader: &mut Reader,
    draw: &DeTable<'_>,
    scene: Option<&Node<'_>>,
    program: &Program,
) -> Option<Colors> {
    let table = reader.table(draw.get("material").or(scene)?, "material")?;
    if program.interface.roots.iter().all(|root| root.name != "material") {
        reader.check_keys(table, "a material", &keys());
    }
    let diffuse = reader.reals(table, "diffuse", [0.8; 3]);
    Some(Colors {
        emission: reader.reals(table, "emission", [0.0; 3]),
        ambient: reader.reals(table, "ambient", diffuse),
        specular: reader.reals(table, "specular", [0.0; 3]),
        shininess: reader.real(table, "shininess", 32.0),
        diffuse,
    })
}

/// Reports a model that reads a texture which is not there.
fn require(reader: &mut Reader, table: &DeTable<'_>, model: &str, texture: &str, wanted: bool) -> Option<()> {
    let Some(node) = table.get(model).filter(|_| wanted && !table.contains_key(texture)) else { return Some(()) };
    let span = reader.span_of(node);
    let message = format!("this model looks up the texture `{texture}`");
    let pattern = if texture == "ramp" { "soft" } else { "specular" };
    let help = format!("add `{texture} = {{ pattern = \"{pattern}\" }}` to the material");
    reader.report(Diagnostic::new(&SCENE_MISSING_KEY, span, message).here("without a texture").help(help));
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The module's constants must be equal to the numbers in a scene.
    #[test]
    fn models_have_the_numbers_of_the_module() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shader_lib/scene.glsl");
        let text = std::fs::read_to_string(path).expect("the module is there");
        let diffuse = DIFFUSE_MODELS.iter().map(|(name, model)| ("DIFFUSE", name, *model as i32));
        let specular = SPECULAR_MODELS.iter().map(|(name, model)| ("SPECULAR", name, *model as i32));
        for (what, name, number) in diffuse.chain(specular) {
            let line = format!("const int {what}_{} = {number};\n", name.to_uppercase());
            assert!(text.contains(&line), "{line}");
        }
    }
}
