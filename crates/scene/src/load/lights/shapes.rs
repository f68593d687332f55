//! The shapes of lights: spheres, tubes, disks, rectangles.
//!
//! *In:* the table of a light. *Out:* its [`Shape`]; a shape without a size is an error. *Holds:* axes are computed in f64. A light that
//! says which way is up need not be exact: its height is as far upwards as its direction lets it.

use super::Kind;
use crate::tables::Reader;
use glam::DVec3;
use std::f64::consts::PI;
use toml::de::DeTable;

/// The shape of a light; zeros for one without.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape {
    /// Where a flat light shines; zero for both sides.
    pub(super) direction: DVec3,
    /// From the middle to the rim, or to an end of a tube.
    pub(super) x: DVec3,
    /// The same at right angles.
    pub(super) y: DVec3,
    pub(super) radius: f64,
}

impl Shape {
    /// The shape of a light; `None` (reported) for one without a size.
    pub(super) fn load(reader: &mut Reader, table: &DeTable<'_>, kind: Kind) -> Option<Self> {
        match kind {
            Kind::Sphere => Some(Self { radius: size(reader, table, "radius")?, ..Self::default() }),
            Kind::Tube => tube(reader, table),
            Kind::Disk => {
                let radius = size(reader, table, "radius")?;
                let (direction, [x, y]) = flat(reader, table)?;
                Some(Self { direction, x: radius * x, y: radius * y, radius })
            }
            Kind::Rectangle => {
                let [width, height] = [size(reader, table, "width")?, size(reader, table, "height")?];
                let (direction, [x, y]) = flat(reader, table)?;
                Some(Self { direction, x: width / 2.0 * x, y: height / 2.0 * y, radius: 0.0 })
            }
            Kind::Directional | Kind::Point | Kind::Spot | Kind::Hemisphere => Some(Self::default()),
        }
    }

    /// The attenuation of a point light that gives as much from far away: the inverse of the area that it shows, over pi.
    pub(super) fn attenuation(&self, kind: Kind) -> [f64; 3] {
        let area = match kind {
            Kind::Sphere | Kind::Disk => PI * self.radius * self.radius,
            Kind::Tube => 4.0 * self.radius * self.x.length(),
            Kind::Rectangle => 4.0 * self.x.length() * self.y.length(),
            Kind::Directional | Kind::Point | Kind::Spot | Kind::Hemisphere => return [1.0, 0.0, 0.0],
        };
        [1.0, 0.0, PI / area]
    }
}

/// The middle between the ends of a tube.
pub(super) fn middle(reader: &mut Reader, table: &DeTable<'_>) -> DVec3 {
    let [from, to] = ["from", "to"].map(|key| DVec3::from(reader.reals(table, key, [0.0; 3])));
    (from + to) / 2.0
}

fn tube(reader: &mut Reader, table: &DeTable<'_>) -> Option<Shape> {
    let radius = size(reader, table, "radius")?;
    let [from, to] = ["from", "to"].map(|key| DVec3::from(reader.reals(table, key, [0.0; 3])));
    let x = (to - from) / 2.0;
    if let Some(node) = table.get("to").filter(|_| x == DVec3::ZERO) {
        let span = reader.span_of(node);
        reader.wrong_value(span, "a tube light has two ends, `from` and `to`", "the same place");
        return None;
    }
    Some(Shape { x, radius, ..Shape::default() })
}

/// A length above 0.
fn size(reader: &mut Reader, table: &DeTable<'_>, key: &str) -> Option<f64> {
    let node = table.get(key)?;
    let length = reader.finite(node, key)?;
    if length <= 0.0 {
        let span = reader.span_of(node);
        reader.wrong_value(span, format!("the `{key}` of a light is above 0"), "no size");
        return None;
    }
    Some(length)
}

/// Where a flat light shines, and its axes: to the right of one who looks along it, and upwards.
fn flat(reader: &mut Reader, table: &DeTable<'_>) -> Option<(DVec3, [DVec3; 2])> {
    let is_aimed = table.contains_key("target");
    let key = if is_aimed { "target" } else { "direction" };
    let mut direction = DVec3::from(reader.reals(table, key, [0.0, -1.0, 0.0]));
    if is_aimed {
        direction -= DVec3::from(reader.reals(table, "position", [0.0; 3]));
    }
    let Some(along) = direction.try_normalize() else {
        let span = table.get(key).map(|node| reader.span_of(node)).unwrap_or_default();
        let message = "a flat light shines somewhere";
        reader.wrong_value(span, message, if is_aimed { "the light itself is there" } else { "no direction" });
        return None;
    };
    let up = DVec3::from(reader.reals(table, "up", [0.0, 1.0, 0.0]));
    // A light that shines straight up or down has its height along z.
    let right = along.cross(up).try_normalize().or_else(|| along.cross(DVec3::NEG_Z).try_normalize());
    let right = right.unwrap_or_else(|| along.any_orthonormal_vector());
    let both = reader.flag(table, "two_sided", false);
    // A sum with zero has no negative zeros.
    let axes = [right, right.cross(along)].map(|axis| axis + DVec3::ZERO);
    Some((if both { DVec3::ZERO } else { direction }, axes))
}
