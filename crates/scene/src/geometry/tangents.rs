//! Tangents by MikkTSpace, as glTF 2.0 (§3.7.2.1) asks for where a file has none.
//!
//! *In:* a [`Geometry`] with normals and texture coordinates. *Out:* for each vertex the direction of growing s, perpendicular to the
//! normal, and the handedness: the bitangent is cross(normal, tangent) times w. *Holds:* where corners of a vertex get different
//! tangents, as along the seam of a mirrored texture, the vertex is split; vertices keep their numbers, and new ones follow them.
//! Where texture coordinates say nothing, the tangent is some direction perpendicular to the normal. All tangents are finite.

use super::Geometry;
use bevy_mikktspace::{Geometry as Faces, TangentSpace, generate_tangents};
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// The most corners of triangles at one vertex, as at the hub of a fan, and at one place. Beyond, a triangle has its own direction:
/// the work grows with the squares of both.
const MAX_FAN: u32 = 512;
const MAX_CROWD: u32 = 4096;

/// A corner as MikkTSpace sees it: position, normal, texture coordinate.
type Corner = ([f32; 3], [f32; 3], [f32; 2]);

/// Triangles with the tangents of their corners.
struct Surface {
    corners: Vec<[Corner; 3]>,
    tangents: Vec<[Option<TangentSpace>; 3]>,
}

impl Surface {
    fn corner(&self, face: usize, vertex: usize) -> Corner {
        self.corners.get(face).and_then(|corners| corners.get(vertex)).copied().unwrap_or_default()
    }
}

impl Faces for Surface {
    fn num_faces(&self) -> usize {
        self.corners.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corner(face, vertex).0
    }

    fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corner(face, vertex).1
    }

    fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
        self.corner(face, vertex).2
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, vertex: usize) {
        if let Some(slot) = self.tangents.get_mut(face).and_then(|tangents| tangents.get_mut(vertex)) {
            *slot = tangent;
        }
    }
}

impl Geometry {
    /// Adds tangents, unless the file has them.
    pub(crate) fn complete_tangents(&mut self) {
        if self.tangents.len() == self.positions.len() {
            return;
        }
        let corners = self.corner_tangents();
        let mut tangents: Vec<Option<[f64; 4]>> = vec![None; self.positions.len()];
        let mut splits: HashMap<(u32, [u64; 4]), u32> = HashMap::new();
        for (place, tangent) in corners.into_iter().enumerate() {
            let Some(row) = self.indices.get(place).copied() else { continue };
            let Some(known) = tangents.get_mut(row as usize) else { continue };
            if *known.get_or_insert(tangent) == tangent {
                continue;
            }
            let next = self.positions.len() as u32;
            let split = *splits.entry((row, tangent.map(f64::to_bits))).or_insert(next);
            if split == next {
                self.repeat(row as usize);
                tangents.push(Some(tangent));
            }
            if let Some(index) = self.indices.get_mut(place) {
                *index = split;
            }
        }
        let any = |normal: &[f64; 3]| anything(DVec3::from(*normal));
        let all = tangents.into_iter().zip(&self.normals);
        self.tangents = all.map(|(tangent, normal)| tangent.unwrap_or_else(|| any(normal))).collect();
    }

    /// Adds a vertex like another one, but for its tangent.
    fn repeat(&mut self, row: usize) {
        self.positions.extend(self.positions.get(row).copied());
        self.normals.extend(self.normals.get(row).copied());
        self.texcoords.extend(self.texcoords.get(row).copied());
        self.texcoords2.extend(self.texcoords2.get(row).copied());
        self.colors.extend(self.colors.get(row).copied());
    }

    /// The tangent of each corner, in the order of the indices.
    fn corner_tangents(&self) -> Vec<[f64; 4]> {
        let triangles = self.indices.as_chunks::<3>().0;
        let corners: Vec<[Corner; 3]> = triangles.iter().map(|rows| rows.map(|row| self.corner(row))).collect();
        let plain = Plain::of(&corners);
        let numbers: Vec<usize> = (0..corners.len()).filter(|number| plain.takes(&corners, *number)).collect();
        let taken: Vec<[Corner; 3]> = numbers.iter().filter_map(|number| corners.get(*number)).copied().collect();
        let mut surface = Surface { tangents: vec![[None; 3]; taken.len()], corners: taken };
        // The error has no variants.
        let _ = generate_tangents(&mut surface);
        let mut spaces: Vec<[Option<TangentSpace>; 3]> = vec![[None; 3]; corners.len()];
        for (number, found) in numbers.into_iter().zip(surface.tangents) {
            if let Some(space) = spaces.get_mut(number) {
                *space = found;
            }
        }
        let tangents = triangles.iter().zip(spaces).flat_map(|(rows, spaces)| {
            let own = self.own_direction(rows);
            std::array::from_fn::<_, 3, _>(|k| {
                let normal = self.normals.get(rows[k] as usize).copied().map_or(DVec3::Z, DVec3::from);
                let found = spaces[k].map(|space| space.tangent_encoded().map(f64::from));
                found
                    .and_then(|found| flattened(found, normal))
                    .or_else(|| flattened(own, normal))
                    .unwrap_or_else(|| anything(normal))
            })
        });
        tangents.collect()
    }

    fn corner(&self, row: u32) -> Corner {
        let row = row as usize;
        // A zero has one sign, so that equal corners are equal.
        let single = |value: f64| value as f32 + 0.0;
        let position = self.positions.get(row).copied().unwrap_or_default().map(single);
        let normal = self.normals.get(row).copied().unwrap_or_default().map(single);
        (position, normal, self.texcoords.get(row).copied().unwrap_or_default().map(single))
    }

    /// The direction of growing s of a triangle by itself, and the handedness; zero if its texture coordinates have no area.
    fn own_direction(&self, rows: &[u32; 3]) -> [f64; 4] {
        let [p, q, r] = rows.map(|row| self.positions.get(row as usize).copied().map_or(DVec3::ZERO, DVec3::from));
        let [s, t, u] = rows.map(|row| self.texcoords.get(row as usize).copied().map_or(DVec2::ZERO, DVec2::from));
        let ([e, f], [g, h]) = ([q - p, r - p], [t - s, u - s]);
        let handedness = if g.perp_dot(h) < 0.0 { -1.0 } else { 1.0 };
        if g.perp_dot(h) == 0.0 {
            return [0.0; 4];
        }
        ((e * h.y - f * g.y) * handedness).normalize_or_zero().extend(handedness).to_array()
    }

    /// The direction of growing t for each vertex.
    pub(super) fn bitangents(&self) -> Vec<[f64; 3]> {
        let normals = self.normals.iter().copied().map(DVec3::from);
        let pairs = normals.zip(&self.tangents);
        pairs.map(|(normal, [x, y, z, w])| (normal.cross(DVec3::new(*x, *y, *z)) * *w).to_array()).collect()
    }
}

/// A tangent made perpendicular to the normal, if it has a direction there.
fn flattened([x, y, z, w]: [f64; 4], normal: DVec3) -> Option<[f64; 4]> {
    let tangent = DVec3::new(x, y, z);
    let flat = (tangent - normal * normal.dot(tangent)).try_normalize()?;
    Some(flat.extend(w).to_array())
}

/// Some tangent of a normal.
fn anything(normal: DVec3) -> [f64; 4] {
    normal.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_vector().extend(1.0).to_array()
}

/// How many corners of triangles there are at each vertex and at each place, by their bits.
struct Plain {
    vertices: HashMap<[u32; 8], u32>,
    places: HashMap<[u32; 3], u32>,
}

impl Plain {
    fn of(corners: &[[Corner; 3]]) -> Self {
        let mut plain = Self { vertices: HashMap::new(), places: HashMap::new() };
        for corner in corners.as_flattened() {
            *plain.vertices.entry(key(corner)).or_default() += 1;
            *plain.places.entry(corner.0.map(f32::to_bits)).or_default() += 1;
        }
        plain
    }

    /// Whether MikkTSpace gets a triangle: its numbers are finite, and not too many others share its corners.
    fn takes(&self, corners: &[[Corner; 3]], number: usize) -> bool {
        let few = |corner: &Corner| {
            let (x, y, z) = corner;
            let is_finite = x.iter().chain(y).chain(z).all(|value| value.is_finite());
            let at_vertex = self.vertices.get(&key(corner)).copied().unwrap_or_default();
            let at_place = self.places.get(&x.map(f32::to_bits)).copied().unwrap_or_default();
            is_finite && at_vertex <= MAX_FAN && at_place <= MAX_CROWD
        };
        corners.get(number).is_some_and(|corners| corners.iter().all(few))
    }
}

fn key((position, normal, texcoord): &Corner) -> [u32; 8] {
    let [x, y, z] = position.map(f32::to_bits);
    let [u, v, w] = normal.map(f32::to_bits);
    let [s, t] = texcoord.map(f32::to_bits);
    [x, y, z, u, v, w, s, t]
}
