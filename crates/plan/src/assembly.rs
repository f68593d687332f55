//! Primitive assembly: which vertices form which primitive, as lists (OpenGL 3.2 §2.6.1 and table 2.12).
//!
//! *In:* a primitive type, the order of its vertices, and the provoking vertex convention. *Out:* vertex indices for
//! a list of points, lines or triangles. WebGPU has neither fans nor loops, and its first vertex is the provoking
//! one. Every strip, fan and loop is therefore expanded, and where OpenGL's last vertex provokes, each primitive is
//! rotated until that vertex comes first. *Holds:* winding and primitive numbers are unchanged. So are vertex
//! indices, and with them `gl_VertexID`.

use glisten_scene::Primitive;

/// The vertex indices of a list, or `None` if drawing `count` vertices in order is the same.
///
/// The order does not depend on whether the program has a flat varying: a program that loses its last one draws the same
/// bits. Incomplete primitives at the end are dropped, as in OpenGL.
pub fn list(primitive: Primitive, count: u32, indices: Option<&[u32]>, provoking_last: bool) -> Option<Vec<u32>> {
    let as_is = match primitive {
        Primitive::Points => true,
        Primitive::Lines | Primitive::Triangles => !provoking_last,
        Primitive::LineStrip
        | Primitive::LineLoop
        | Primitive::TriangleStrip
        | Primitive::TriangleFan
        | Primitive::LinesAdjacency
        | Primitive::LineStripAdjacency
        | Primitive::TrianglesAdjacency
        | Primitive::TriangleStripAdjacency => false,
    };
    if as_is {
        return indices.map(<[u32]>::to_vec);
    }
    let number = |position: u32| match indices {
        Some(indices) => indices.get(position as usize).copied().unwrap_or(0),
        None => position,
    };
    let mut positions = Vec::new();
    match primitive {
        Primitive::Points => positions.extend(0..count),
        Primitive::Lines => lines(&mut positions, (0..count / 2).map(|i| [2 * i, 2 * i + 1]), provoking_last),
        Primitive::LineStrip => {
            lines(&mut positions, (1..count).map(|i| [i - 1, i]), provoking_last);
        }
        Primitive::LineLoop => {
            let closing = (count >= 2).then(|| [count - 1, 0]);
            lines(&mut positions, (1..count).map(|i| [i - 1, i]).chain(closing), provoking_last);
        }
        Primitive::Triangles => {
            let corners = (0..count / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
            triangles(&mut positions, corners, if provoking_last { 2 } else { 0 });
        }
        Primitive::TriangleStrip => {
            // In an odd triangle (i + 1, i, i + 2), vertex i provokes under the first-vertex convention.
            for i in 0..count.saturating_sub(2) {
                let odd = i % 2 == 1;
                let corners = if odd { [i + 1, i, i + 2] } else { [i, i + 1, i + 2] };
                let first = if provoking_last { 2 } else { usize::from(odd) };
                triangles(&mut positions, std::iter::once(corners), first);
            }
        }
        Primitive::TriangleFan => {
            // The hub never provokes: under the first-vertex convention it is the vertex after it.
            let corners = (0..count.saturating_sub(2)).map(|i| [0, i + 1, i + 2]);
            triangles(&mut positions, corners, if provoking_last { 2 } else { 1 });
        }
        // Without a geometry shader, adjacent vertices are ignored (§2.6.1).
        Primitive::LinesAdjacency => {
            lines(&mut positions, (0..count / 4).map(|i| [4 * i + 1, 4 * i + 2]), provoking_last);
        }
        Primitive::LineStripAdjacency => {
            lines(&mut positions, (1..count.saturating_sub(2)).map(|i| [i, i + 1]), provoking_last);
        }
        Primitive::TrianglesAdjacency => {
            let corners = (0..count / 6).map(|i| [6 * i, 6 * i + 2, 6 * i + 4]);
            triangles(&mut positions, corners, if provoking_last { 2 } else { 0 });
        }
        Primitive::TriangleStripAdjacency => {
            for i in 0..count.saturating_sub(4) / 2 {
                let (at, odd) = (2 * i, i % 2 == 1);
                let corners = if odd { [at + 2, at, at + 4] } else { [at, at + 2, at + 4] };
                let first = if provoking_last { 2 } else { usize::from(odd) };
                triangles(&mut positions, std::iter::once(corners), first);
            }
        }
    }
    Some(positions.into_iter().map(number).collect())
}

fn lines(positions: &mut Vec<u32>, ends: impl Iterator<Item = [u32; 2]>, provoking_last: bool) {
    for [from, to] in ends {
        positions.extend(if provoking_last { [to, from] } else { [from, to] });
    }
}

/// Adds triangles, rotated so that corner `first` comes first.
fn triangles(positions: &mut Vec<u32>, corners: impl Iterator<Item = [u32; 3]>, first: usize) {
    for mut triangle in corners {
        triangle.rotate_left(first);
        positions.extend(triangle);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_vertex_comes_first_and_winding_stays() {
        assert_eq!(list(Primitive::Triangles, 7, None, true), Some(vec![2, 0, 1, 5, 3, 4]));
        assert_eq!(list(Primitive::TriangleStrip, 5, None, true), Some(vec![2, 0, 1, 3, 2, 1, 4, 2, 3]));
        assert_eq!(list(Primitive::TriangleFan, 4, None, true), Some(vec![2, 0, 1, 3, 0, 2]));
        assert_eq!(list(Primitive::Lines, 4, None, true), Some(vec![1, 0, 3, 2]));
        assert_eq!(list(Primitive::LineLoop, 3, None, true), Some(vec![1, 0, 2, 1, 0, 2]));
    }

    #[test]
    fn first_vertex_rule_of_table_2_12() {
        assert_eq!(list(Primitive::Triangles, 6, None, false), None);
        assert_eq!(list(Primitive::TriangleStrip, 4, None, false), Some(vec![0, 1, 2, 1, 3, 2]));
        assert_eq!(list(Primitive::TriangleFan, 4, None, false), Some(vec![1, 2, 0, 2, 3, 0]));
        assert_eq!(list(Primitive::LineStrip, 3, None, false), Some(vec![0, 1, 1, 2]));
    }

    #[test]
    fn indices_are_looked_up_last() {
        assert_eq!(list(Primitive::Triangles, 3, Some(&[7, 8, 9]), true), Some(vec![9, 7, 8]));
        assert_eq!(list(Primitive::Points, 2, Some(&[7, 8]), true), Some(vec![7, 8]));
    }

    #[test]
    fn too_few_vertices_make_nothing() {
        for primitive in [Primitive::LineLoop, Primitive::LineStrip, Primitive::TriangleFan, Primitive::TriangleStrip] {
            assert_eq!(list(primitive, 0, None, true), Some(vec![]));
            assert_eq!(list(primitive, 1, None, true), Some(vec![]));
        }
    }
}
