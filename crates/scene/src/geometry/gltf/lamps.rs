//! The lights of `KHR_lights_punctual`, in world space.
//!
//! *In:* the extension of the document and of its nodes. *Out:* a [`Lamp`] for each node with a light. *Holds:* a color is that of the
//! library, whose lights are without pi: the file's color times its intensity, divided by pi.

use super::numbers::{number, triple};
use glam::{DMat4, DVec3};
use gltf::json::scene::Node;
use gltf::json::{Root, Value};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const EXTENSION: &str = "KHR_lights_punctual";

/// A light of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lamp {
    pub(crate) kind: LampKind,
    pub(crate) position: DVec3,
    /// The direction in which the light travels.
    pub(crate) direction: DVec3,
    pub(crate) color: [f64; 3],
}

/// Its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LampKind {
    Directional,
    /// The distance at which it ends, if it does.
    Point(Option<f64>),
    /// As a point light, and the inner and the outer angle in degrees.
    Spot(Option<f64>, [f64; 2]),
}

/// The lights that nodes may refer to.
pub(super) struct Lamps<'a>(&'a [Value]);

impl<'a> Lamps<'a> {
    pub(super) fn of(root: &'a Root) -> Result<Self, String> {
        let Some(extension) = root.extensions.as_ref().and_then(|all| all.others.get(EXTENSION)) else {
            return Ok(Self(&[]));
        };
        let lights = extension.get("lights").and_then(Value::as_array);
        lights.map(|lights| Self(lights)).ok_or_else(|| format!("its {EXTENSION} has no list of `lights`"))
    }

    /// The light of a node.
    pub(super) fn at(&self, node: &Node, world: DMat4) -> Result<Option<Lamp>, String> {
        let Some(extension) = node.extensions.as_ref().and_then(|all| all.others.get(EXTENSION)) else {
            return Ok(None);
        };
        let index = extension.get("light").and_then(Value::as_u64).ok_or("its light has no number")?;
        let light = usize::try_from(index).ok().and_then(|index| self.0.get(index));
        let light = light.ok_or_else(|| format!("there is no light {index}"))?;
        lamp(light, world).map(Some).map_err(|error| format!("light {index}: {error}"))
    }
}

fn lamp(light: &Value, world: DMat4) -> Result<Lamp, String> {
    let intensity = number(light, "intensity", 1.0)?;
    let color = triple(light, "color", [1.0; 3])?.map(|channel| channel * intensity / PI);
    if color.iter().any(|channel| *channel < 0.0 || !(*channel as f32).is_finite()) {
        return Err("its color is not that of a light".to_owned());
    }
    let range = match light.get("range") {
        Some(_) => Some(number(light, "range", 0.0)?).filter(|range| *range > 0.0),
        None => None,
    };
    let kind = match light.get("type").and_then(Value::as_str) {
        Some("directional") => LampKind::Directional,
        Some("point") => LampKind::Point(range),
        Some("spot") => LampKind::Spot(range, cone(light.get("spot").unwrap_or(&Value::Null))?),
        Some(kind) => return Err(format!("its type is `{}`", kind.chars().take(40).collect::<String>())),
        None => return Err("it has no type".to_owned()),
    };
    let direction = world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
    Ok(Lamp { kind, position: world.transform_point3(DVec3::ZERO), direction, color })
}

/// The inner and the outer angle in degrees.
fn cone(spot: &Value) -> Result<[f64; 2], String> {
    let inner = number(spot, "innerConeAngle", 0.0)?;
    let outer = number(spot, "outerConeAngle", FRAC_PI_4)?;
    // Exporters write an outer angle that f32 rounds to more than a right one.
    if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2 + 1e-6) {
        return Err("its cone is not an inner and a larger outer angle up to pi / 2".to_owned());
    }
    Ok([inner, outer].map(|angle| angle.to_degrees().min(90.0)))
}
