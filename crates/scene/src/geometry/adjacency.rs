//! [`Geometry::with_adjacency`]: the triangles of a mesh, each with the vertices opposite of its edges.
//!
//! *In:* indexed triangles. *Out:* six indices for each (OpenGL 3.2 §2.6.1, figure 2.3): its own ones at 0, 2 and 4, and between them the
//! vertex of the triangle on the other side of that edge. *Holds:* vertices at one place are one, so seams of texture coordinates are
//! no borders; at a border, the edge's first vertex stands for what is missing.

use super::Geometry;
use std::collections::HashMap;

/// A place, by the bits of its coordinates as the vertex shader gets them.
type Place = [u32; 3];

impl Geometry {
    /// The indices for `triangles_adjacency`.
    pub(crate) fn with_adjacency(&self) -> Vec<u32> {
        let place = |index: u32| -> Option<Place> {
            // A zero has one sign.
            self.positions.get(index as usize).map(|position| position.map(|value| (value as f32 + 0.0).to_bits()))
        };
        let triangles = || self.indices.as_chunks::<3>().0.iter();
        let edges = |[a, b, c]: [u32; 3]| [(a, b, c), (b, c, a), (c, a, b)];
        let mut opposite: HashMap<(Place, Place), u32> = HashMap::new();
        for (from, to, other) in triangles().copied().flat_map(edges) {
            if let (Some(from), Some(to)) = (place(from), place(to)) {
                opposite.entry((from, to)).or_insert(other);
            }
        }
        let across = |from: u32, to: u32| {
            let edge = place(to).zip(place(from));
            edge.and_then(|edge| opposite.get(&edge)).copied().unwrap_or(from)
        };
        triangles().copied().flat_map(edges).flat_map(|(from, to, _)| [from, across(from, to)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Geometry;

    #[test]
    fn neighbors_across_edges_and_seams() {
        // Two triangles of a square; the second one has vertices of its own at the common corners.
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]];
        let [a, b, c, d] = corners;
        let geometry =
            Geometry { positions: vec![a, b, c, a, c, d], indices: vec![0, 1, 2, 3, 4, 5], ..Geometry::default() };
        assert_eq!(geometry.with_adjacency(), [0, 0, 1, 1, 2, 5, 3, 1, 4, 4, 5, 5]);
    }
}
