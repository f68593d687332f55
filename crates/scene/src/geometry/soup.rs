//! [`Soup`]: triangles as a file has them, whose corners choose position, texture coordinate and normal each for itself.
//!
//! *In:* lists of a file. *Out:* a [`Geometry`]: one vertex for each combination that occurs.

use super::Geometry;
use super::normals::{self, Normals};
use glam::DVec3;
use std::collections::HashMap;

/// Normals of a point that are closer than a step, about 0.2 seconds of arc, are one.
const STEPS: f64 = 1_048_576.0;

/// The corner of a triangle: rows of the soup's lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corner {
    pub(crate) position: u32,
    pub(crate) texcoord: Option<u32>,
    pub(crate) normal: Option<u32>,
}

/// Triangles with their own choice of data.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Soup {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) texcoords: Vec<[f64; 2]>,
    pub(crate) normals: Vec<[f64; 3]>,
    /// A second set of texture coordinates: one for each position, or none.
    pub(crate) texcoords2: Vec<[f64; 2]>,
    /// One for each position, or none.
    pub(crate) colors: Vec<[f64; 4]>,
    /// One for each position, or none.
    pub(crate) tangents: Vec<[f64; 4]>,
    pub(crate) triangles: Vec<[Corner; 3]>,
}

impl Soup {
    pub(super) fn position(&self, corner: Corner) -> DVec3 {
        self.positions.get(corner.position as usize).copied().map_or(DVec3::ZERO, DVec3::from)
    }

    /// The normal that the file gives a corner, if it has a direction.
    fn own_normal(&self, corner: Corner) -> Option<DVec3> {
        let normal = DVec3::from(*self.normals.get(corner.normal? as usize)?);
        normal.try_normalize()
    }

    /// Whether each corner has a normal of the file.
    pub(crate) fn has_normals(&self) -> bool {
        self.triangles.iter().flatten().all(|corner| self.own_normal(*corner).is_some())
    }

    /// Whether each corner has a texture coordinate of the file.
    pub(crate) fn has_texcoords(&self) -> bool {
        self.triangles.iter().flatten().all(|corner| corner.texcoord.is_some())
    }

    /// The geometry with normals of a kind. Texture coordinates that the file lacks are (0, 0). Triangles without area are
    /// left out.
    pub(crate) fn geometry(&self, kind: Normals) -> Geometry {
        let own = |corner: Corner| if kind.from_file { self.own_normal(corner) } else { None };
        let computed = if kind.from_file && self.has_normals() { Vec::new() } else { normals::compute(self, kind) };
        // Tangents of a file belong to its normals (glTF 2.0 §3.7.2.1).
        let tangents = if computed.is_empty() && kind.from_file { self.tangents.as_slice() } else { &[] };
        let mut vertices: HashMap<Key, u32> = HashMap::new();
        let mut geometry = Geometry::default();
        for (index, triangle) in self.triangles.iter().enumerate() {
            if self.area_vector(triangle) == DVec3::ZERO {
                continue;
            }
            for (k, corner) in triangle.iter().enumerate() {
                let computed = || computed.get(index).and_then(|normals| normals.get(k)).copied();
                let normal = own(*corner).or_else(computed).unwrap_or(DVec3::Z);
                let texcoord = corner.texcoord.and_then(|row| self.texcoords.get(row as usize)).copied();
                let key = Key {
                    position: corner.position,
                    texcoord: corner.texcoord,
                    normal: normal.to_array().map(|value| (value * STEPS).round() as i32),
                };
                let next = geometry.positions.len() as u32;
                let vertex = *vertices.entry(key).or_insert(next);
                if vertex == next {
                    let row = corner.position as usize;
                    geometry.positions.push(self.position(*corner).to_array());
                    geometry.normals.push(normal.to_array());
                    geometry.texcoords.push(texcoord.unwrap_or([0.0; 2]));
                    geometry.texcoords2.extend(self.texcoords2.get(row));
                    geometry.colors.extend(self.colors.get(row));
                    geometry.tangents.extend(tangents.get(row));
                }
                geometry.indices.push(vertex);
            }
        }
        geometry
    }

    /// The cross product of two edges: perpendicular to the triangle, twice its area long.
    pub(super) fn area_vector(&self, [a, b, c]: &[Corner; 3]) -> DVec3 {
        let [a, b, c] = [a, b, c].map(|corner| self.position(*corner));
        (b - a).cross(c - a)
    }
}

/// Corners with the same key are one vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Key {
    position: u32,
    texcoord: Option<u32>,
    /// In steps: computed normals of one plane differ by rounding.
    normal: [i32; 3],
}
