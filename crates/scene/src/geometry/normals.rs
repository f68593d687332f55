//! Normals for triangles whose file has none.
//!
//! *In:* a [`Soup`]. *Out:* the unit normal of each corner. *Holds:* the faces around a point whose normals are at most the crease
//! angle from that of the corner's own face are averaged, each weighted by its angle at the point (Thürmer and Wüthrich,
//! "Computing vertex normals from polygonal facets", 1998), so that the result does not depend on how polygons are cut. Points
//! at the same place are one, as files often repeat them along the seams of a texture.

use super::soup::Soup;
use glam::DVec3;
use std::collections::HashMap;

/// Which normals a mesh has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Normals {
    /// Whether those of the file are taken where it has any.
    pub(crate) from_file: bool,
    /// The cosine of the largest angle between faces that are shaded as one surface; above 1 for flat shading.
    pub(crate) crease: f64,
}

impl Normals {
    /// The default crease angle in degrees.
    pub(crate) const CREASE: f64 = 60.0;
    /// A normal for each face.
    pub(crate) const FLAT: Self = Self { from_file: false, crease: 2.0 };

    /// Those of the file, otherwise smooth up to the default angle.
    #[cfg(test)]
    pub(crate) fn of_file() -> Self {
        Self { from_file: true, ..Self::smooth(Self::CREASE) }
    }

    /// Smooth up to an angle in degrees.
    pub(crate) fn smooth(degrees: f64) -> Self {
        // Faces at exactly the angle are smooth, in spite of rounding.
        Self { from_file: false, crease: degrees.to_radians().cos() - 1e-9 }
    }
}

/// The largest number of faces around a point that are compared in pairs. With more of them, as at the tip of a fan, all are
/// averaged.
const MAX_FACES: usize = 512;

/// A face at a point: its normal, and its angle there.
type Sector = (DVec3, f64);

/// The normals of the corners of each triangle. A triangle without area has that of its neighbors.
pub(super) fn compute(soup: &Soup, kind: Normals) -> Vec<[DVec3; 3]> {
    let faces: Vec<DVec3> =
        soup.triangles.iter().map(|triangle| soup.area_vector(triangle).normalize_or_zero()).collect();
    if kind.crease > 1.0 {
        return faces.iter().map(|face| [*face; 3]).collect();
    }
    let (points, count) = welded(soup);
    let mut sectors: Vec<Vec<Sector>> = vec![Vec::new(); count];
    for (triangle, face) in soup.triangles.iter().zip(&faces) {
        for k in 0..3 {
            let [at, next, last] = [0, 1, 2].map(|step| soup.position(triangle[(k + step) % 3]));
            let (to_next, to_last) = ((next - at).normalize_or_zero(), (last - at).normalize_or_zero());
            let angle = to_next.dot(to_last).clamp(-1.0, 1.0).acos();
            let point = points.get(triangle[k].position as usize);
            if let Some(around) = point.and_then(|point| sectors.get_mut(*point as usize)) {
                around.push((*face, angle));
            }
        }
    }
    let sums: Vec<DVec3> =
        sectors.iter().map(|around| around.iter().map(|(normal, angle)| *normal * *angle).sum()).collect();
    let at = |position: u32, face: DVec3| -> DVec3 {
        let point = points.get(position as usize).map_or(0, |point| *point as usize);
        let all = sums.get(point).copied().unwrap_or_default();
        let around = sectors.get(point).map_or(&[][..], Vec::as_slice);
        let near = |(normal, _): &&Sector| normal.dot(face) >= kind.crease;
        let sum: DVec3 = if around.len() > MAX_FACES || face == DVec3::ZERO {
            all
        } else {
            around.iter().filter(near).map(|(normal, angle)| *normal * *angle).sum()
        };
        sum.try_normalize().unwrap_or(face)
    };
    let triangles = soup.triangles.iter().zip(&faces);
    triangles.map(|(triangle, face)| triangle.map(|corner| at(corner.position, *face))).collect()
}

/// A number for each position, the same for those at the same place, and how many numbers there are.
fn welded(soup: &Soup) -> (Vec<u32>, usize) {
    let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(soup.positions.len());
    let numbers = soup
        .positions
        .iter()
        .map(|position| {
            let next = places.len() as u32;
            // Adding 0 makes -0 the same as 0.
            *places.entry(position.map(|value| (value + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    (numbers, places.len())
}
