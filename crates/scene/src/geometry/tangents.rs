//! Tangents and bitangents from texture coordinates.
//!
//! *In:* a [`Geometry`] with normals and texture coordinates. *Out:* for each vertex the direction of growing s, perpendicular to the
//! normal, and the handedness: the bitangent is cross(normal, tangent) times w. *Holds:* where texture coordinates say nothing, the
//! tangent is some direction perpendicular to the normal.

use super::Geometry;
use glam::{DVec2, DVec3};

impl Geometry {
    /// The file's tangents, or those of the texture coordinates.
    pub(super) fn tangents(&self) -> Vec<[f64; 4]> {
        if self.tangents.len() == self.positions.len() {
            return self.tangents.clone();
        }
        let mut along = vec![DVec3::ZERO; self.positions.len()];
        let mut across = along.clone();
        for corners in self.indices.chunks_exact(3) {
            let rows: Vec<usize> = corners.iter().map(|index| *index as usize).collect();
            let position = |k: usize| rows.get(k).and_then(|row| self.positions.get(*row)).copied().map(DVec3::from);
            let texcoord = |k: usize| rows.get(k).and_then(|row| self.texcoords.get(*row)).copied().map(DVec2::from);
            let (Some(p), Some(q), Some(r)) = (position(0), position(1), position(2)) else { continue };
            let (Some(s), Some(t), Some(u)) = (texcoord(0), texcoord(1), texcoord(2)) else { continue };
            let ([e, f], [g, h]) = ([q - p, r - p], [t - s, u - s]);
            let area = g.perp_dot(h);
            if area == 0.0 {
                continue;
            }
            let (tangent, bitangent) = ((e * h.y - f * g.y) / area, (f * g.x - e * h.x) / area);
            for row in rows {
                if let (Some(along), Some(across)) = (along.get_mut(row), across.get_mut(row)) {
                    *along += tangent;
                    *across += bitangent;
                }
            }
        }
        let normals = self.normals.iter().copied().map(DVec3::from);
        normals
            .zip(along.into_iter().zip(across))
            .map(|(normal, (along, across))| {
                let flat = along - normal * normal.dot(along);
                let tangent = flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
                let handedness = if normal.cross(tangent).dot(across) < 0.0 { -1.0 } else { 1.0 };
                tangent.extend(handedness).to_array()
            })
            .collect()
    }

    /// The direction of growing t for each vertex.
    pub(super) fn bitangents(&self) -> Vec<[f64; 3]> {
        let normals = self.normals.iter().copied().map(DVec3::from);
        let tangents = self.tangents();
        normals.zip(tangents).map(|(normal, [x, y, z, w])| (normal.cross(DVec3::new(x, y, z)) * w).to_array()).collect()
    }
}
