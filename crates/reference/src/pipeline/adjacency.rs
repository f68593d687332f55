//! The vertices that a geometry shader sees of each primitive (OpenGL 3.2 §2.6.1, §2.12.1, tables 2.4 and 2.5).
//!
//! *In:* a primitive and a number of vertices. *Out:* the positions of up to six vertices for each primitive, in the order
//! of `gl_in`. *Holds:* triangles of a strip keep their winding, and the provoking vertex has the place that the
//! convention gives it.

use super::assembly::{Assembled, assemble};
use glisten_scene::{Primitive, State};
use smallvec::{SmallVec, smallvec};

/// The vertices of one primitive, adjacent ones included.
pub(super) type Seen = SmallVec<[u32; 6]>;

/// What a geometry shader sees of each primitive that `count` vertices form.
pub(super) fn seen(state: &State, count: u32) -> Vec<Seen> {
    let primitive = state.primitive;
    if primitive.has_adjacency() {
        let list = primitives(primitive, count).into_iter().enumerate();
        return list.map(|(number, all)| turned(state, number, all)).collect();
    }
    let vertices = |assembled: Assembled| -> Seen {
        match assembled {
            Assembled::Point(vertex) => smallvec![vertex],
            Assembled::Line(ends) => ends.into_iter().collect(),
            Assembled::Triangle(mut corners, first) => {
                corners.rotate_left(if state.provoking_last { 0 } else { first });
                corners.into_iter().collect()
            }
        }
    };
    assemble(primitive, count).into_iter().map(vertices).collect()
}

/// Turned until the provoking vertex comes first, if the convention says so.
fn turned(state: &State, number: usize, mut all: Seen) -> Seen {
    if let Assembled::Triangle(_, first) = inner(state.primitive, number, all.clone())
        && !state.provoking_last
    {
        all.rotate_left(2 * first);
    }
    all
}

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
    if i % 2 == 0 {
        smallvec![at, before, at + 2, after, at + 4, at + 3]
    } else {
        smallvec![at + 2, before, at, at + 3, at + 4, after]
    }
}

/// The primitive without its adjacent vertices.
pub(super) fn inner(primitive: Primitive, number: usize, all: Seen) -> Assembled {
    let at = |place: usize| all.get(place).copied().unwrap_or(0);
    match primitive {
        Primitive::LinesAdjacency | Primitive::LineStripAdjacency => Assembled::Line([at(1), at(2)]),
        _ => {
            let odd = primitive == Primitive::TriangleStripAdjacency && number % 2 == 1;
            Assembled::Triangle([at(0), at(2), at(4)], usize::from(odd))
        }
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

    #[test]
    fn the_provoking_vertex_has_its_place() {
        for (primitive, count) in [
            (Primitive::TriangleStrip, 6),
            (Primitive::TriangleFan, 6),
            (Primitive::TriangleStripAdjacency, 12),
            (Primitive::LineStripAdjacency, 7),
            (Primitive::LineLoop, 4),
        ] {
            let assembled = assemble(primitive, count);
            for last in [false, true] {
                let state = State { primitive, provoking_last: last, ..State::INITIAL };
                for (all, assembled) in seen(&state, count).iter().zip(&assembled) {
                    let place = match (all.len(), last) {
                        (4, false) => 1,
                        (4, true) => 2,
                        (6, true) => 4,
                        (_, false) => 0,
                        (size, true) => size - 1,
                    };
                    assert_eq!(all[place], assembled.provoking(last), "{primitive:?}");
                }
            }
        }
    }
}
