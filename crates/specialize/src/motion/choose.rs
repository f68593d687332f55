//! Chooses the candidates that pay.
//!
//! *In:* candidates. *Out:* the numbers of those that move. *Holds:* what is chosen leaves fewer operations and varyings,
//! weighed together, than without it; no more than [`MOST_VARYINGS`] are added.

use super::affine::LocalName;
use super::candidates::Candidates;
use glisten_front::hir::GlobalId;
use std::collections::BTreeSet;

/// The cost of a scalar that is interpolated: in operations of the fragment stage.
const INTERPOLATION: u64 = 2;
/// Scalars that are interpolated: what every implementation has (OpenGL 3.2, `MAX_VARYING_COMPONENTS`).
const MOST_COMPONENTS: u64 = 60;
/// Varyings: what every implementation of WebGPU has, less one.
const MOST_VARYINGS: usize = 15;
/// Passes over the candidates.
const PASSES: usize = 6;
/// Of more candidates none is chosen: they are a program for a machine.
const MOST_CANDIDATES: usize = 256;

/// The candidates that move.
pub(super) fn choose(candidates: &Candidates) -> Vec<usize> {
    let n = candidates.list.len();
    if n == 0 || n > MOST_CANDIDATES {
        return Vec::new();
    }
    let none = vec![false; n];
    let before = cost(candidates, &none);
    let mut best = (before, none.clone());
    // Some pay only together, others only if the rest stays.
    for start in [none, vec![true; n]] {
        let found = improved(candidates, start);
        if found.0 < best.0 {
            best = found;
        }
    }
    let needed = Needed::of(candidates, &best.1);
    (0..n).filter(|index| is(&best.1, *index) && needed.is_needed(candidates, *index)).collect()
}

fn is(moves: &[bool], index: usize) -> bool {
    moves.get(index).copied().unwrap_or(false)
}

/// Changes one candidate at a time as long as that helps.
fn improved(candidates: &Candidates, start: Vec<bool>) -> (u64, Vec<bool>) {
    let mut moves = start;
    let mut least = cost(candidates, &moves);
    for _ in 0..PASSES {
        let mut changed = false;
        for index in 0..moves.len() {
            flip(&mut moves, index);
            let now = cost(candidates, &moves);
            // Of equals the one that leaves the program as it is.
            if now < least || (now == least && !is(&moves, index)) {
                changed |= now < least;
                least = now;
            } else {
                flip(&mut moves, index);
            }
        }
        if !changed {
            break;
        }
    }
    (least, moves)
}

fn flip(moves: &mut [bool], index: usize) {
    if let Some(slot) = moves.get_mut(index) {
        *slot = !*slot;
    }
}

/// The varyings and locals that the fragment stage still needs.
struct Needed {
    varyings: BTreeSet<GlobalId>,
    locals: BTreeSet<LocalName>,
}

impl Needed {
    fn of(candidates: &Candidates, moves: &[bool]) -> Self {
        let mut needed = Self { varyings: candidates.open.varyings.clone(), locals: candidates.open.locals.clone() };
        // A local that is needed needs what it is computed from: later ones first.
        for (index, candidate) in candidates.list.iter().enumerate().rev() {
            if !is(moves, index) && needed.is_needed(candidates, index) {
                needed.varyings.extend(candidate.needs.varyings.iter().copied());
                needed.locals.extend(candidate.needs.locals.iter().copied());
            }
        }
        needed
    }

    /// Whether a candidate is anything but the value of locals that nobody reads.
    fn is_needed(&self, candidates: &Candidates, index: usize) -> bool {
        candidates.list.get(index).is_some_and(|candidate| {
            candidate.places.iter().any(|(_, _, local)| local.is_none_or(|local| self.locals.contains(&local)))
        })
    }
}

/// Operations and interpolation of the fragment stage, as far as candidates and varyings make them.
fn cost(candidates: &Candidates, moves: &[bool]) -> u64 {
    let needed = Needed::of(candidates, moves);
    let mut cost = 0;
    let (mut components, mut n_varyings) = (0u64, 0);
    for (index, candidate) in candidates.list.iter().enumerate() {
        if !needed.is_needed(candidates, index) {
            continue;
        }
        if is(moves, index) {
            components += u64::from(candidate.components);
            n_varyings += 1;
        } else {
            cost += u64::from(candidate.operations);
        }
    }
    let added = n_varyings;
    for (id, scalars) in &candidates.varyings {
        if needed.varyings.contains(id) {
            components += u64::from(*scalars);
            n_varyings += 1;
        }
    }
    let too_many = added > 0 && (components > MOST_COMPONENTS || n_varyings > MOST_VARYINGS);
    if too_many { u64::MAX } else { cost + components * INTERPOLATION }
}
