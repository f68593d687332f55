//! The layers of a material that few have: fibers, brushed metal, thin films, glass, leaves, bodies that light travels in, pictures of lit
//! balls, textures of coats and of what a dielectric mirrors, places of textures.
//!
//! *In:* the table of a material. *Out:* the macros of the program `standard` for it, and the values of the uniforms. *Holds:* a layer is
//! compiled only for a material with one of its keys, so that no other pays for it; the tables here are the only list of them.

use super::lights::Member;
use crate::tables::{Node, Reader};
use toml::de::{DeTable, DeValue};

/// A macro of the program `standard`, and the keys for which it is defined.
const MACROS: &[(&str, &[&str])] = &[
    ("GLISTEN_FIBERS", &["sheen", "sheen_roughness", "sheen_map", "sheen_roughness_map"]),
    ("GLISTEN_FIBERS_MAPS", &["sheen_map", "sheen_roughness_map"]),
    ("GLISTEN_BRUSHED", &["anisotropy", "anisotropy_rotation", "anisotropy_map"]),
    ("GLISTEN_BRUSHED_MAP", &["anisotropy_map"]),
    (
        "GLISTEN_FILM",
        &[
            "iridescence",
            "iridescence_ior",
            "iridescence_thickness",
            "iridescence_thinnest",
            "iridescence_map",
            "iridescence_thickness_map",
        ],
    ),
    ("GLISTEN_FILM_MAPS", &["iridescence_map", "iridescence_thickness_map"]),
    ("GLISTEN_COAT_MAPS", &["clearcoat_map", "clearcoat_roughness_map"]),
    ("GLISTEN_COAT_NORMALS", &["clearcoat_normal_map", "clearcoat_normal_scale"]),
    ("GLISTEN_DIELECTRIC_MAPS", &["dielectric_map", "dielectric_strength_map"]),
    ("GLISTEN_DIELECTRIC_STRENGTH", &["dielectric_strength", "dielectric_map", "dielectric_strength_map"]),
    (
        "GLISTEN_GLASS",
        &[
            "transmission",
            "transmission_pass",
            "absorption",
            "refraction",
            "dispersion",
            "transmission_map",
            "thickness_map",
        ],
    ),
    ("GLISTEN_REFRACTION", &["refraction", "dispersion"]),
    ("GLISTEN_GLASS_MAPS", &["transmission_map", "thickness_map"]),
    (
        "GLISTEN_LEAF",
        &[
            "diffuse_transmission",
            "diffuse_transmission_color",
            "diffuse_transmission_map",
            "diffuse_transmission_color_map",
        ],
    ),
    ("GLISTEN_LEAF_MAPS", &["diffuse_transmission_map", "diffuse_transmission_color_map"]),
    ("GLISTEN_SUBSURFACE", &["subsurface", "subsurface_radius"]),
    ("GLISTEN_BALL", &["matcap"]),
];

/// The kind of a key's value.
#[derive(Clone, Copy)]
enum Kind {
    Number(f64),
    Color([f64; 3]),
    /// In degrees; the uniform has its cosine and its sine.
    Angle,
    /// One of the names, by its number.
    Choice(&'static [(&'static str, i32)]),
}

/// Which part of a surface that light passes through a draw adds, with the numbers of the module's constants `GLASS_ALL` and so on.
const PASSES: &[(&str, i32)] = &[("all", 0), ("through", 1), ("surface", 2)];

/// Keys with numbers, and the uniforms that they set.
const VALUES: &[(&str, &str, Kind)] = &[
    ("sheen", "finish.sheen", Kind::Color([0.0; 3])),
    ("sheen_roughness", "finish.sheen_roughness", Kind::Number(0.0)),
    ("anisotropy", "finish.anisotropy", Kind::Number(0.0)),
    ("anisotropy_rotation", "finish.anisotropy_turn", Kind::Angle),
    ("iridescence", "finish.film", Kind::Number(0.0)),
    ("iridescence_ior", "finish.film_index", Kind::Number(1.3)),
    ("iridescence_thickness", "finish.film_thickness", Kind::Number(400.0)),
    ("iridescence_thinnest", "finish.film_thinnest", Kind::Number(100.0)),
    ("clearcoat_normal_scale", "finish.clearcoat_normal_scale", Kind::Number(1.0)),
    ("transmission", "finish.transmission", Kind::Number(0.0)),
    ("absorption", "finish.absorption", Kind::Color([0.0; 3])),
    ("transmission_pass", "finish.transmission_pass", Kind::Choice(PASSES)),
    ("refraction", "finish.refraction", Kind::Number(1.5)),
    ("dispersion", "finish.dispersion", Kind::Number(0.0)),
    ("dielectric_strength", "finish.dielectric_strength", Kind::Number(1.0)),
    ("diffuse_transmission", "finish.leaf", Kind::Number(0.0)),
    ("diffuse_transmission_color", "finish.leaf_color", Kind::Color([1.0; 3])),
    ("subsurface", "finish.subsurface", Kind::Number(1.0)),
    ("subsurface_radius", "finish.subsurface_radius", Kind::Color([1.0, 0.5, 0.25])),
];

/// The textures of layers.
pub(super) const MAPS: &[&str] = &[
    "sheen_map",
    "sheen_roughness_map",
    "anisotropy_map",
    "iridescence_map",
    "iridescence_thickness_map",
    "clearcoat_map",
    "clearcoat_roughness_map",
    "clearcoat_normal_map",
    "dielectric_map",
    "dielectric_strength_map",
    "transmission_map",
    "thickness_map",
    "diffuse_transmission_map",
    "diffuse_transmission_color_map",
    "matcap",
];

/// A sampler of the program `standard` that has a table, and the pattern that it is.
pub(super) const TABLES: &[(&str, &str)] =
    &[("sheen_table", "sheen_albedo"), ("albedo_table", "ltc_albedo"), ("area_table", "ltc_matrix")];

/// The textures that may have a `transform`, besides those of layers: members of the uniform `places`.
const PLACED: &[&str] = &["decal", "metallic_roughness", "emission_map", "occlusion_map", "normal_map"];

/// The textures of layers that are not on a surface, and have no `transform`.
const UNPLACED: &[&str] = &["matcap"];

const TRANSFORM_KEYS: &[&str] = &["scale", "rotate", "translate", "set"];

/// The keys of all layers.
pub(super) fn keys() -> Vec<&'static str> {
    VALUES.iter().map(|(key, ..)| *key).chain(MAPS.iter().copied()).collect()
}

/// The keys with the values that they set.
pub(super) fn values() -> impl Iterator<Item = (&'static str, &'static str)> {
    VALUES.iter().map(|(key, member, _)| (*key, *member)).chain(MAPS.iter().map(|map| (*map, *map)))
}

/// The names of the textures that may have a `transform`.
fn placed() -> impl Iterator<Item = &'static str> {
    PLACED.iter().chain(MAPS).copied().filter(|map| !UNPLACED.contains(map))
}

/// The macros for a material.
pub(super) fn macros(table: &DeTable<'_>) -> Vec<&'static str> {
    let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
    let mut names: Vec<&str> = MACROS.iter().filter(|(_, keys)| has(keys)).map(|(name, _)| *name).collect();
    if placed().any(|map| transform(table, map).is_some()) {
        names.push("GLISTEN_PLACES");
    }
    if placed().any(|map| transform(table, map).is_some_and(|node| set(node) > 0)) {
        names.push("GLISTEN_TWO_SETS");
    }
    names
}

/// The values of the uniforms.
pub(super) fn members(reader: &mut Reader, table: &DeTable<'_>) -> Vec<(String, Member)> {
    let mut members = Vec::new();
    for (key, member, kind) in VALUES {
        let value = match kind {
            Kind::Number(default) => Member::Float(reader.real(table, key, *default)),
            Kind::Color(default) => Member::Vector(reader.reals(table, key, *default)),
            Kind::Choice(names) => Member::Int(reader.choice_at(table, key, 0, names)),
            Kind::Angle => {
                let (sine, cosine) = reader.real(table, key, 0.0).to_radians().sin_cos();
                Member::Pair([cosine, sine])
            }
        };
        members.push(((*member).to_owned(), value));
    }
    for map in placed() {
        let [s, t] = transform(table, map).map_or(IDENTITY, |node| place(reader, node));
        let second = transform(table, map).map_or(0, set);
        members.push((format!("places.{map}.second"), Member::Float(f64::from(second))));
        members.push((format!("places.{map}.s"), Member::Vector(s)));
        members.push((format!("places.{map}.t"), Member::Vector(t)));
    }
    members
}

/// Texture coordinates as they are: s, and t, of (s, t, 1).
const IDENTITY: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn transform<'t, 'i>(table: &'t DeTable<'i>, map: &str) -> Option<&'t Node<'i>> {
    table.get(map)?.get_ref().as_table()?.get("transform")
}

/// The set of texture coordinates that a transform names, 0 or 1.
fn set(node: &Node<'_>) -> u8 {
    let set = node.get_ref().as_table().and_then(|table| table.get("set")).map(|node| node.get_ref());
    u8::from(matches!(set, Some(DeValue::Integer(number)) if number.as_str() == "1"))
}

/// The rows of a transform of texture coordinates: it scales, then turns counterclockwise, then translates.
fn place(reader: &mut Reader, node: &Node<'_>) -> [[f64; 3]; 2] {
    let Some(table) = reader.table(node, "transform") else { return IDENTITY };
    reader.check_keys(table, "a transform of a texture", TRANSFORM_KEYS);
    let [x, y] = match table.get("scale") {
        Some(node) if node.get_ref().as_array().is_none() => [reader.real(table, "scale", 1.0); 2],
        _ => reader.reals(table, "scale", [1.0; 2]),
    };
    let [ds, dt] = reader.reals(table, "translate", [0.0; 2]);
    reader.count(table, "set", 0, 0..=1);
    let (sine, cosine) = reader.real(table, "rotate", 0.0).to_radians().sin_cos();
    [[cosine * x, -sine * y, ds], [sine * x, cosine * y, dt]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module() -> String {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shader_lib/scene.glsl");
        std::fs::read_to_string(path).expect("the module is there")
    }

    /// The module's constants must be equal to the numbers in a scene.
    #[test]
    fn passes_have_the_numbers_of_the_module() {
        for (name, number) in PASSES {
            let line = format!("const int GLASS_{} = {number};\n", name.to_uppercase());
            assert!(module().contains(&line), "{line}");
        }
    }

    /// Every texture has a place in the module's struct, and every value a member.
    #[test]
    fn the_module_declares_every_uniform() {
        for map in placed() {
            assert!(module().contains(&format!("    Place {map};\n")), "{map}");
        }
        for (_, member, _) in VALUES {
            let name = member.trim_start_matches("finish.");
            assert!(module().contains(&format!(" {name};\n")), "{name}");
        }
    }
}
