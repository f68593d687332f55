//! The textures of a glTF material: where each one's image is, how it is sampled, and how it is placed.
//!
//! *In:* the texture of a key, of the material itself or of an extension. *Out:* a [`Map`] for each key of the scene's `[material]`.
//! *Holds:* `KHR_texture_transform` is turned into coordinates whose t grows upwards, as those of scenes do. *Not done here:* images.

use super::super::model::TextureSource;
use super::layers;
use super::looks::source;
use super::numbers::{number, pair};
use gltf::json::material::Material;
use gltf::json::texture::{CLAMP_TO_EDGE, Info, MIRRORED_REPEAT, NEAREST, Texture};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, Value};

/// A texture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Map {
    /// The key of `[material]`.
    pub(crate) key: &'static str,
    /// Whether its colors are encoded by the transfer function of sRGB.
    pub(crate) is_encoded: bool,
    pub(crate) source: TextureSource,
    /// The name of its wrap mode in scene files.
    pub(crate) wrap: &'static str,
    pub(crate) is_nearest: bool,
    pub(crate) transform: Option<Transform>,
}

/// Where a texture is: its coordinates are scaled, then turned counterclockwise, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Transform {
    pub(crate) scale: [f64; 2],
    /// In degrees.
    pub(crate) rotate: f64,
    pub(crate) translate: [f64; 2],
    /// Whether the coordinates are those of the second set.
    pub(crate) is_second: bool,
}

/// A texture of a glTF material: the key of `[material]`, what it is called in a remark, and whether it has encoded colors.
type Row = (&'static str, &'static str, bool);

const BASE_COLOR: Row = ("decal", "the base color", true);
const METALLIC_ROUGHNESS: Row = ("metallic_roughness", "the metal and roughness", false);
const EMISSION: Row = ("emission_map", "the emission", true);
const OCCLUSION: Row = ("occlusion_map", "the occlusion", false);
const NORMAL: Row = ("normal_map", "the map of normals", false);

/// The textures of extensions.
const OF_EXTENSIONS: &[(&str, &str, Row)] = &[
    ("KHR_materials_sheen", "sheenColorTexture", ("sheen_map", "the sheen", true)),
    ("KHR_materials_sheen", "sheenRoughnessTexture", ("sheen_roughness_map", "the roughness of the sheen", false)),
    ("KHR_materials_anisotropy", "anisotropyTexture", ("anisotropy_map", "the anisotropy", false)),
    ("KHR_materials_iridescence", "iridescenceTexture", ("iridescence_map", "the iridescence", false)),
    (
        "KHR_materials_iridescence",
        "iridescenceThicknessTexture",
        ("iridescence_thickness_map", "the thickness of the film", false),
    ),
    ("KHR_materials_clearcoat", "clearcoatTexture", ("clearcoat_map", "the coat", false)),
    (
        "KHR_materials_clearcoat",
        "clearcoatRoughnessTexture",
        ("clearcoat_roughness_map", "the roughness of the coat", false),
    ),
    (
        "KHR_materials_clearcoat",
        "clearcoatNormalTexture",
        ("clearcoat_normal_map", "the map of normals of the coat", false),
    ),
    ("KHR_materials_specular", "specularTexture", ("dielectric_strength_map", "the strength of the reflection", false)),
    ("KHR_materials_specular", "specularColorTexture", ("dielectric_map", "the color of the reflection", true)),
    (LEAF, "diffuseTransmissionTexture", ("diffuse_transmission_map", "the diffuse transmission", false)),
    (
        LEAF,
        "diffuseTransmissionColorTexture",
        ("diffuse_transmission_color_map", "the color of the diffuse transmission", true),
    ),
    (TRANSMISSION, "transmissionTexture", ("transmission_map", "the transmission", false)),
    (VOLUME, "thicknessTexture", ("thickness_map", "the thickness", false)),
];

const LEAF: &str = "KHR_materials_diffuse_transmission";
const TRANSMISSION: &str = "KHR_materials_transmission";
const VOLUME: &str = "KHR_materials_volume";

const TRANSFORM: &str = "KHR_texture_transform";

/// A texture as a material has it.
struct Given {
    row: Row,
    index: Index<Texture>,
    /// The set of texture coordinates.
    set: u32,
    /// Its transform.
    placed: Option<Value>,
}

impl Given {
    fn new(row: Row, index: Index<Texture>, set: u32, placed: Option<&Value>) -> Self {
        // The transform may name another set.
        let own = placed.and_then(|placed| placed.get("texCoord")).and_then(Value::as_u64);
        let set = own.and_then(|own| u32::try_from(own).ok()).unwrap_or(set);
        Self { row, index, set, placed: placed.cloned() }
    }

    fn of(row: Row, info: &Info) -> Self {
        let placed = info.extensions.as_ref().and_then(|all| all.others.get(TRANSFORM));
        Self::new(row, info.index, info.tex_coord, placed)
    }
}

/// The textures of a material, in the order of their tables.
fn given(material: &Material) -> Result<Vec<Given>, String> {
    let own = &material.pbr_metallic_roughness;
    let plain = [
        (BASE_COLOR, own.base_color_texture.as_ref()),
        (EMISSION, material.emissive_texture.as_ref()),
        (METALLIC_ROUGHNESS, own.metallic_roughness_texture.as_ref()),
    ];
    let mut all: Vec<Given> = plain.into_iter().filter_map(|(row, info)| Some(Given::of(row, info?))).collect();
    if let Some(found) = &material.occlusion_texture {
        let placed = found.extensions.as_ref().and_then(|all| all.others.get(TRANSFORM));
        all.push(Given::new(OCCLUSION, found.index, found.tex_coord, placed));
    }
    if let Some(found) = &material.normal_texture {
        let placed = found.extensions.as_ref().and_then(|all| all.others.get(TRANSFORM));
        all.push(Given::new(NORMAL, found.index, found.tex_coord, placed));
    }
    let extensions = material.extensions.as_ref().map(|all| &all.others);
    for (extension, key, row) in OF_EXTENSIONS {
        let info = extensions.and_then(|all| all.get(*extension)).and_then(|table| table.get(*key));
        // A volume without light in it changes nothing.
        let layer = if *extension == VOLUME { TRANSMISSION } else { *extension };
        let is_there = extensions.is_some_and(|all| all.contains_key(layer)) && layers::has(material, layer);
        let Some(info) = info.filter(|_| is_there) else { continue };
        let wrong = || format!("its `{key}` is no texture");
        let info: Info = gltf::json::deserialize::from_value(info.clone()).map_err(|_| wrong())?;
        all.push(Given::of(*row, &info));
    }
    Ok(all)
}

/// The two sets of texture coordinates that a material has: the set of the base color, or 0, and the first other one.
pub(super) fn sets(material: &Material) -> (u32, Option<u32>) {
    sets_of(&given(material).unwrap_or_default())
}

fn sets_of(all: &[Given]) -> (u32, Option<u32>) {
    let first = all.iter().find(|given| given.row == BASE_COLOR).map_or(0, |given| given.set);
    (first, all.iter().map(|given| given.set).find(|set| *set != first))
}

/// The textures of a material.
///
/// # Errors
/// A sentence about one of them.
pub(super) fn of(root: &Root, material: &Material, name: &str, remarks: &mut Vec<String>) -> Result<Vec<Map>, String> {
    let all = given(material)?;
    let sets = sets_of(&all);
    let mut maps = Vec::new();
    for one in &all {
        maps.extend(map(root, one, sets, (name, remarks))?);
    }
    Ok(maps)
}

/// A texture; `None` for one whose image is not read.
fn map(
    root: &Root,
    given: &Given,
    (first, second): (u32, Option<u32>),
    (name, remarks): (&str, &mut Vec<String>),
) -> Result<Option<Map>, String> {
    let (key, what, is_encoded) = given.row;
    let is_second = second == Some(given.set);
    if given.set != first && !is_second {
        let set = given.set;
        remarks.push(format!("{what} of `{name}` has texture coordinates of set {set}, a third one, and is left out"));
        return Ok(None);
    }
    let Some(source) = source(root, given.index, name, remarks) else { return Ok(None) };
    let sampler = root.get(given.index).and_then(|texture| texture.sampler);
    let sampler = sampler.and_then(|sampler| root.get(sampler));
    let wrap = sampler.map_or("repeat", |sampler| match sampler.wrap_s {
        Checked::Valid(mode) if mode.as_gl_enum() == CLAMP_TO_EDGE => "clamp",
        Checked::Valid(mode) if mode.as_gl_enum() == MIRRORED_REPEAT => "mirror",
        _ => "repeat",
    });
    let magnified = sampler.and_then(|sampler| sampler.mag_filter);
    let is_nearest = matches!(magnified, Some(Checked::Valid(filter)) if filter.as_gl_enum() == NEAREST);
    let placed = given.placed.as_ref().map(transform).transpose()?.unwrap_or(Transform::NONE);
    let placed = Transform { is_second, ..placed };
    let transform = (placed != Transform::NONE).then_some(placed);
    Ok(Some(Map { key, is_encoded, source, wrap, is_nearest, transform }))
}

impl Transform {
    /// A texture stays where it is.
    const NONE: Self = Self { scale: [1.0; 2], rotate: 0.0, translate: [0.0; 2], is_second: false };
}

/// A transform of glTF, whose t grows downwards: for a turn by r, u = o_u + cos r s_u u + sin r s_v v, and
/// v = o_v - sin r s_u u + cos r s_v v, as in the example of its text (the matrix in front of it has the other sign). With
/// t = 1 - v, the turn is the same counterclockwise one, and what v brings into u and v at t = 1 belongs to the translation.
fn transform(table: &Value) -> Result<Transform, String> {
    let [x, y] = pair(table, "scale", [1.0; 2])?;
    let [u, v] = pair(table, "offset", [0.0; 2])?;
    let turn = number(table, "rotation", 0.0)?;
    let (sine, cosine) = turn.sin_cos();
    let translate = [u + sine * y, 1.0 - v - cosine * y];
    if !translate.iter().all(|value| (*value as f32).is_finite()) {
        return Err(format!("the {TRANSFORM} of a texture is not finite"));
    }
    Ok(Transform { scale: [x, y], rotate: turn.to_degrees(), translate, is_second: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the image for the corners of a square, by the rows that a scene makes of the transform.
    fn placed(json: &str, [s, t]: [f64; 2]) -> [f64; 2] {
        let table: Value = gltf::json::deserialize::from_str(json).expect("JSON");
        let Transform { scale: [x, y], rotate, translate: [ds, dt], .. } = transform(&table).expect("a transform");
        let (sine, cosine) = rotate.to_radians().sin_cos();
        [cosine * x * s - sine * y * t + ds, sine * x * s + cosine * y * t + dt]
    }

    /// The two examples of the extension: the lower left quarter, turned; and t upside down.
    #[test]
    fn the_examples_of_the_extension_are_placed() {
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() + (b - d).abs() < 1e-9;
        let quarter = r#"{"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}"#;
        // All of it is in the lower left quarter of the image; the square's lower left corner, u = 0 and v = 1, has u = 1/2 and v = 1.
        assert!(near(placed(quarter, [0.0, 0.0]), [0.5, 0.0]));
        assert!(near(placed(quarter, [1.0, 0.0]), [0.5, 0.5]));
        assert!(near(placed(quarter, [1.0, 1.0]), [0.0, 0.5]));
        let upside_down = r#"{"offset": [0, 1], "scale": [1, -1]}"#;
        assert!(near(placed(upside_down, [0.25, 0.75]), [0.25, 0.25]));
    }
}
