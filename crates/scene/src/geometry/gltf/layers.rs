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
    Layer { extension: TRANSMISSION, rows: &[("transmissionFactor", "transmission", Kind::Part(0.0))] },
];

const TRANSMISSION: &str = "KHR_materials_transmission";

/// How little of a color a volume leaves: e to the power of minus this.
const DARKEST: f64 = 64.0;

/// The settings of all layers that a material has.
///
/// # Errors
/// A sentence about one of them.
pub(super) fn of(material: &Material) -> Result<Vec<Setting>, String> {
    let mut settings = Vec::new();
    for layer in LAYERS {
        let Some(table) = table(material, layer.extension) else { continue };
        let own = layer.rows.iter().map(|row| setting(table, row)).collect::<Result<Vec<Setting>, String>>()?;
        if is_there(&own) {
            settings.extend(own);
            if layer.extension == TRANSMISSION {
                settings.extend(absorption(material)?);
            }
        }
    }
    let scale = table(material, "KHR_materials_clearcoat").and_then(|coat| coat.get("clearcoatNormalTexture"));
    if let Some(texture) = scale.filter(|_| has(material, "KHR_materials_clearcoat")) {
        settings.push(("clearcoat_normal_scale", vec![number(texture, "scale", 1.0)?]));
    }
    Ok(settings)
}

/// The light that a volume takes: e^-x of it is left, for x = -ln(color) thickness / distance.
fn absorption(material: &Material) -> Result<Option<Setting>, String> {
    let Some(volume) = table(material, "KHR_materials_volume") else { return Ok(None) };
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
    Ok(Some(("absorption", parts.map(|part| part + 0.0).to_vec())))
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
