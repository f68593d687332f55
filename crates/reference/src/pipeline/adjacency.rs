//! Primitives with adjacent vertices (OpenGL 3.2 §2.6.1, tables 2.4 and 2.5).
//!
//! *In:* a primitive and a number of vertices. *Out:* the positions of the four or six vertices of each primitive, in the
//! order of `gl_in` under the last-vertex convention. *Holds:* triangles of a strip keep their winding.

use glisten_scene::Primitive;
use smallvec::{SmallVec, smallvec};

/// The vertices of one primitive, adjacent ones included.
pub(super) type Seen = SmallVec<[u32; 6]>;

/// The vertices of primitives with adjacency, in the order of `gl_in` under the last-vertex convention.
pub(super) fn primitives(primitive: Primitive, count: u32) -> Vec<Seen> {
    match primitive {
        Primitive::LinesAdjacency => (0..count / 4).map(|i| (4 * i..4 * i + 4).collect()).collect(),
        Primitive::LineStripAdjacency => (0..count.saturating_sub(3)).map(|i| (i..i + 4).collect()).collect(),
        Primitive::TrianglesAdjacency => (0..count / 6).map(|i| (6 * i..6 * i + 6).collect()).collect(),
        Primitive::TriangleStripAdjacency => {
            let number = count.saturating_sub(4) / 2;
            (0..number).map(|i| of_strip(i, number)).collect()
        }
        _ => Vec::new(),
    }
}

/// Triangle `i` of a strip with adjacency (table 2.5, whose numbers begin at 1).
fn of_strip(i: u32, number: u32) -> Seen {
    let at = 2 * i;
    // The vertex next to the edge that the triangle before has, and to the edge that the next one has.
    let before = if i == 0 { 1 } else { at - 2 };
    let after = if i + 1 == number { at + 5 } else { at + 6 };
    if i.is_multiple_of(2) {
        smallvec![at, before, at + 2, after, at + 4, at + 3]
    } else {
        smallvec![at + 2, before, at, at + 3, at + 4, after]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strip(count: u32) -> Vec<Vec<u32>> {
        primitives(Primitive::TriangleStripAdjacency, count)
            .into_iter()
            .map(|all| [0, 2, 4, 1, 3, 5].map(|place| all[place] + 1).to_vec())
            .collect()
    }

    /// Corners 1, 2, 3, then the vertices next to the edges 1/2, 2/3 and 3/1.
    #[test]
    fn table_2_5() {
        assert_eq!(strip(6), [vec![1, 3, 5, 2, 6, 4]]);
        assert_eq!(strip(8), [[1, 3, 5, 2, 7, 4], [5, 3, 7, 1, 6, 8]].map(|row| row.to_vec()));
        let ten = [[1, 3, 5, 2, 7, 4], [5, 3, 7, 1, 6, 9], [5, 7, 9, 3, 10, 8]];
        assert_eq!(strip(10), ten.map(|row| row.to_vec()));
        assert!(strip(5).is_empty());
    }
}
