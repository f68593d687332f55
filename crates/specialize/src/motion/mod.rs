//! Moves computations from the fragment stage to the vertex stage.
//!
//! An affine function of varyings that are interpolated alike, `A * v + b` with `A` and `b` the same for all fragments, can
//! be computed at the vertices and interpolated instead: interpolation weighs the vertices by weights whose sum is 1, with
//! perspective or without, so both give the same number but for rounding.
//!
//! | file | what it does |
//! | --- | --- |
//! | `affine` | finds what is affine in varyings, expression by expression |
//! | `candidates` | lists the largest such expressions, and who uses what |
//! | `choose` | chooses those that save more than the varyings that they add |
//! | `apply` | writes the varying, its computation, and its use |
//!
//! *In:* a pruned fragment stage and a settled vertex stage of one program. *Out:* both, changed, and what was `Moved`.
//! *Holds:* nothing here runs unless [`Options::move_to_vertex`](crate::Options::move_to_vertex) is set. What moves has no
//! effects and looks nothing up, so it does not matter that it is also computed where a branch would have avoided it.
//! Varyings of different interpolation are never mixed.

mod affine;
mod apply;
mod candidates;
mod choose;

use crate::prune::Pruned;
use crate::settle::Settled;
use candidates::Candidates;
use glisten_front::Program;
use glisten_front::hir::Types;
use glisten_front::source::Span;

/// Rounds of moving: an expression that was too costly alone may pay when another has moved.
const ROUNDS: usize = 3;

/// A computation that moved to the vertex stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Move {
    /// The varying that carries its result.
    pub(crate) name: String,
    /// Where it was in the fragment stage.
    pub(crate) span: Span,
}

/// Moves what pays. `live` says which globals of the fragment stage somebody reads when it has ended.
pub(crate) fn run(
    types: &Types,
    program: &Program,
    fragment: &mut Pruned,
    live: &[bool],
    vertex: &mut Settled,
) -> Vec<Move> {
    let mut moved = Vec::new();
    if !apply::can_extend(&vertex.shader) {
        return moved;
    }
    for _ in 0..ROUNDS {
        let links = apply::Links::of(program, fragment, &vertex.shader);
        let candidates = Candidates::of(types, &fragment.shader, &links);
        let chosen = choose::choose(&candidates);
        if chosen.is_empty() {
            break;
        }
        moved.extend(apply::apply(types, &candidates, &chosen, &links, fragment, vertex));
        fragment.again(types, live);
    }
    moved
}
