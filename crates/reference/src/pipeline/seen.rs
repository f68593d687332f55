//! The vertices that a geometry shader sees of each primitive (OpenGL 3.2 §2.12.1).
//!
//! *In:* the state of a draw and a number of vertices. *Out:* the positions of up to six vertices for each primitive, in the
//! order of `gl_in`. *Holds:* triangles of a strip keep their winding, and the provoking vertex has the place that the
//! convention gives it.

use super::adjacency::{Seen, primitives};
use super::assembly::{Assembled, assemble, inner};
use glisten_scene::State;
use smallvec::smallvec;

/// The vertices of each primitive that `count` vertices form.
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

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_scene::Primitive;

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
