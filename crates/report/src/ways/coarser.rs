//! The mesh of a scene at other tessellations.
//!
//! *In:* a scene file as a table. *Out:* texts of scene files whose meshes by shape have fewer or more segments and rings.
//! *Holds:* a mesh from a file, and a scene without a mesh, have none.

use glisten_scene::default_tessellation;
use toml::{Table, Value};

/// Part of the segments and rings, as a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part(pub(super) u32, pub(super) u32);

/// No mesh has more segments or rings.
const MOST: u32 = 1024;
/// The coarsest mesh, of shapes that have as many by default.
const COARSEST: [u32; 2] = [3, 2];

/// The text of the scene with this part of the segments and rings in all of its meshes by shape, and the numbers of the
/// finest one; `None` if that changes nothing.
pub(super) fn tessellated(scene: &Table, part: Part) -> Option<(String, [u32; 2])> {
    let mut scene = scene.clone();
    scene.remove("report");
    let mut finest: Option<[u32; 2]> = None;
    for draw in scene.get_mut("draw")?.as_array_mut()? {
        let Some(mesh) = draw.get_mut("mesh").and_then(Value::as_table_mut) else { continue };
        let Some([before, after]) = counts(mesh, part) else { continue };
        if before == after {
            continue;
        }
        for (key, count) in ["segments", "rings"].into_iter().zip(after) {
            mesh.insert(key.into(), Value::Integer(i64::from(count)));
        }
        let size = |[segments, rings]: [u32; 2]| u64::from(segments) * u64::from(rings);
        if finest.is_none_or(|known| size(after) > size(known)) {
            finest = Some(after);
        }
    }
    Some((toml::to_string(&scene).ok()?, finest?))
}

/// The segments and rings of a mesh, and those of a part of them.
fn counts(mesh: &Table, Part(times, of): Part) -> Option<[[u32; 2]; 2]> {
    let default = default_tessellation(mesh.get("shape")?.as_str()?)?;
    let written = |key: &str| mesh.get(key).and_then(Value::as_integer).and_then(|count| u32::try_from(count).ok());
    let before = [written("segments").unwrap_or(default[0]), written("rings").unwrap_or(default[1])];
    let scaled = |count: u32, default: u32, coarsest: u32| {
        // A side that is in one piece by default may stay so.
        let least = default.min(coarsest).min(count);
        (count.saturating_mul(times) / of.max(1)).clamp(least, MOST.max(count))
    };
    let after = [scaled(before[0], default[0], COARSEST[0]), scaled(before[1], default[1], COARSEST[1])];
    Some([before, after])
}

#[cfg(test)]
mod tests {
    use super::{Part, tessellated};

    fn counts(mesh: &str, part: Part) -> Option<[u32; 2]> {
        let text = format!("[[draw]]\nprogram = \"phong\"\nmesh = {{ {mesh} }}\n");
        tessellated(&text.parse().expect("a table"), part).map(|(_, counts)| counts)
    }

    #[test]
    fn segments_and_rings_follow_their_part() {
        assert_eq!(counts("shape = \"sphere\"", Part(1, 2)), Some([32, 16]));
        assert_eq!(counts("shape = \"sphere\", segments = 8, rings = 4", Part(1, 4)), Some([3, 2]));
        assert_eq!(counts("shape = \"sphere\", segments = 40", Part(2, 1)), Some([80, 64]));
        assert_eq!(counts("shape = \"cylinder\"", Part(1, 4)), Some([16, 1]));
    }

    #[test]
    fn a_mesh_that_has_no_segments_stays() {
        assert_eq!(counts("shape = \"quad\"", Part(1, 2)), None);
        assert_eq!(counts("file = \"a.obj\"", Part(1, 2)), None);
        assert_eq!(counts("shape = \"saddle\"", Part(1, 2)), None);
    }
}
