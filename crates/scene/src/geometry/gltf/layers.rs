//! The layers that extensions add to a glTF material: a coat, fibers, a brush, a film, glass.
//!
//! *In:* the tables of the extensions. *Out:* keys of the scene's `[material]` with their numbers. *Holds:* an extension whose strength
//! is 0 adds nothing. *Not done here:* textures.

use super::numbers::{number, triple};
use gltf::json::{Value, material::Material};

/// A key of `[material]`, and its value: one number, or three for a color.
pub(crate) type Setting = (&'static str, Vec<f64>);

/// The kind of a member of an extension.
#[derive(Clone, Copy)]
enum Kind {
    /// From 0 to 1.
    Part(f64),
    /// A color from 0 to 1.
    Color([f64; 3]),
    /// Radians; degrees in scenes.
    Angle,
    /// From 0 on.
    Size(f64),
}

/// A member of an extension, and the key of `[material]`.
type Row = (&'static str, &'static str, Kind);

/// An extension: its first member is its strength.
struct Layer {
    extension: &'static str,
    rows: &'static [Row],
}

const LAYERS: &[Layer] = &[
    Layer {
        extension: "KHR_materials_clearcoat",
        rows: &[
            ("clearcoatFactor", "clearcoat", Kind::Part(0.0)),
            ("clearcoatRoughnessFactor", "clearcoat_roughness", Kind::Part(0.0)),
        ],
    },
    Layer {
        extension: "KHR_materials_sheen",
        rows: &[
            ("sheenColorFactor", "sheen", Kind::Color([0.0; 3])),
            ("sheenRoughnessFactor", "sheen_roughness", Kind::Part(0.0)),
        ],
    },
    Layer {
        extension: "KHR_materials_anisotropy",
        rows: &[
            ("anisotropyStrength", "anisotropy", Kind::Part(0.0)),
            ("anisotropyRotation", "anisotropy_rotation", Kind::Angle),
        ],
    },
    Layer {
        extension: "KHR_materials_iridescence",
        rows: &[
            ("iridescenceFactor", "iridescence", Kind::Part(0.0)),
            ("iridescenceIor", "iridescence_ior", Kind::Size(1.3)),
            ("iridescenceThicknessMaximum", "iridescence_thickness", Kind::Size(400.0)),
            ("iridescenceThicknessMinimum", "iridescence_thinnest", Kind::Size(100.0)),
        ],
    },
    Layer {
        extension: LEAF,
        rows: &[
            ("diffuseTransmissionFactor", "diffuse_transmission", Kind::Part(0.0)),
            ("diffuseTransmissionColorFactor", LEAF_COLOR, Kind::Color([1.0; 3])),
        ],
    },
    Layer { extension: TRANSMISSION, rows: &[("transmissionFactor", "transmission", Kind::Part(0.0))] },
];

const TRANSMISSION: &str = "KHR_materials_transmission";
const LEAF: &str = "KHR_materials_diffuse_transmission";
const LEAF_COLOR: &str = "diffuse_transmission_color";
const VOLUME: &str = "KHR_materials_volume";

/// How little of a color a volume leaves: e to the power of minus this.
const DARKEST: f64 = 64.0;

/// The settings of all layers that a material has. A thick body bends light if it is `surrounded` by some.
///
/// # Errors
/// A sentence about one of them.
pub(super) fn of(material: &Material, surrounded: bool) -> Result<Vec<Setting>, String> {
    let mut settings = Vec::new();
    let specular = table(material, "KHR_materials_specular").map(|table| number(table, "specularFactor", 1.0));
    let strength = specular.transpose()?.map(|strength| strength.clamp(0.0, 1.0));
    settings
        .extend(strength.filter(|strength| *strength < 1.0).map(|strength| ("dielectric_strength", vec![strength])));
    for layer in LAYERS {
        let Some(table) = table(material, layer.extension) else { continue };
        let mut own = layer.rows.iter().map(|row| setting(table, row)).collect::<Result<Vec<Setting>, String>>()?;
        if !is_there(&own) {
            continue;
        }
        if layer.extension == LEAF {
            let absorbed = absorption(material)?.unwrap_or_default();
            for (_, values) in own.iter_mut().filter(|(key, _)| *key == LEAF_COLOR) {
                values.iter_mut().zip(&absorbed).for_each(|(value, absorbed)| *value *= (-absorbed).exp());
            }
        }
        settings.extend(own);
        if layer.extension == TRANSMISSION {
            settings.extend(absorption(material)?.map(|absorbed| ("absorption", absorbed)));
            if surrounded && is_thick(material)? {
                settings.extend(refraction(material)?);
            }
        }
    }
    let scale = table(material, "KHR_materials_clearcoat").and_then(|coat| coat.get("clearcoatNormalTexture"));
    if let Some(texture) = scale.filter(|_| has(material, "KHR_materials_clearcoat")) {
        settings.push(("clearcoat_normal_scale", vec![number(texture, "scale", 1.0)?]));
    }
    Ok(settings)
}

/// Whether a material is that of a body, and not of a thin wall.
///
/// # Errors
/// A sentence about its thickness.
pub(super) fn is_thick(material: &Material) -> Result<bool, String> {
    let Some(volume) = table(material, VOLUME) else { return Ok(false) };
    Ok(number(volume, "thicknessFactor", 0.0)? > 0.0)
}

/// How a body bends light.
fn refraction(material: &Material) -> Result<Vec<Setting>, String> {
    let given = |extension: &str, key: &str, default: f64| {
        table(material, extension).map_or(Ok(default), |table| number(table, key, default))
    };
    let index = given("KHR_materials_ior", "ior", 1.5)?.max(1.0);
    let dispersion = given("KHR_materials_dispersion", "dispersion", 0.0)?;
    let split = (dispersion > 0.0).then(|| ("dispersion", vec![dispersion]));
    Ok([("refraction", vec![index])].into_iter().chain(split).collect())
}

/// The light that a volume takes: e^-x of it is left, for x = -ln(color) thickness / distance.
fn absorption(material: &Material) -> Result<Option<Vec<f64>>, String> {
    let Some(volume) = table(material, VOLUME) else { return Ok(None) };
    let thickness = number(volume, "thicknessFactor", 0.0)?.max(0.0);
    let color = triple(volume, "attenuationColor", [1.0; 3])?;
    // Without a distance, it takes nothing.
    let Some(distance) = volume.get("attenuationDistance").map(|_| number(volume, "attenuationDistance", 1.0)) else {
        return Ok(None);
    };
    let per_length = thickness / distance?.max(f64::MIN_POSITIVE);
    let part = |channel: f64| (-channel.clamp(0.0, 1.0).ln() * per_length).clamp(0.0, DARKEST);
    // 0 times infinity is for a volume without thickness.
    let parts = color.map(|channel| if per_length > 0.0 { part(channel) } else { 0.0 });
    Ok(Some(parts.map(|part| part + 0.0).to_vec()))
}

/// Whether an extension adds anything to a material.
pub(super) fn has(material: &Material, extension: &str) -> bool {
    let layer = LAYERS.iter().find(|layer| layer.extension == extension);
    let Some((layer, table)) = layer.zip(table(material, extension)) else { return true };
    let strength = layer.rows.first().and_then(|row| setting(table, row).ok());
    is_there(strength.as_slice())
}

fn is_there(settings: &[Setting]) -> bool {
    settings.first().is_some_and(|(_, values)| values.iter().any(|value| *value > 0.0))
}

fn table<'a>(material: &'a Material, extension: &str) -> Option<&'a Value> {
    material.extensions.as_ref().and_then(|all| all.others.get(extension))
}

fn setting(table: &Value, (member, key, kind): &Row) -> Result<Setting, String> {
    let values = match kind {
        Kind::Part(default) => vec![number(table, member, *default)?.clamp(0.0, 1.0)],
        Kind::Color(default) => triple(table, member, *default)?.map(|channel| channel.clamp(0.0, 1.0)).to_vec(),
        Kind::Angle => vec![number(table, member, 0.0)?.to_degrees()],
        Kind::Size(default) => vec![number(table, member, *default)?.max(0.0)],
    };
    Ok((*key, values))
}
