//! The paths that lanes may take where conditions are undecided: the decisions that a run follows, and those that it
//! met.
//!
//! *In:* undecided conditions, as instructions meet them. *Out:* the outcome that the run follows, and the paths that
//! branch off. [`explore`](super::explore) runs them.
//!
//! Lanes that derivatives couple decide together: a quad is one group. Without derivatives, a lane is one. A run has
//! as many groups as fit into its lanes, each with its own decisions.

use super::inst::{Inst, Lookup};
use super::{LANES, Mask};

/// The largest number of decisions along a path.
pub(super) const MAX_DECISIONS: u8 = 60;

/// The decisions of one group along one path: bit `k` is the outcome of decision `k`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Path {
    outcomes: u64,
    /// The number of given decisions. The others follow the value.
    given: u8,
    /// The number of decisions that were met.
    pub(super) met: u8,
}

/// The paths that a run follows, and those that it found.
#[derive(Clone, Debug)]
pub(super) struct Paths {
    /// The number of lanes that decide together.
    pub(super) group: usize,
    /// The path of each group.
    pub(super) paths: [Path; LANES],
    /// Whether any decision was met.
    pub(super) any: bool,
}

impl Paths {
    pub(super) fn new(couples: bool) -> Self {
        Self { group: if couples { 4 } else { 1 }, paths: [Path::default(); LANES], any: false }
    }

    /// Forgets all decisions.
    pub(super) fn clear(&mut self) {
        if self.any {
            self.paths = [Path::default(); LANES];
            self.any = false;
        }
    }

    /// The outcomes for these lanes: the given ones first, then those of the value.
    pub(super) fn decide(&mut self, truth: u64, undecided: u64) -> u64 {
        self.any = true;
        let mut decided = truth;
        for lane in Mask(undecided).lanes() {
            let Some(path) = self.paths.get_mut(lane / self.group) else { continue };
            let bit = 1u64 << lane;
            if path.met >= MAX_DECISIONS {
                path.met = MAX_DECISIONS + 1;
                continue;
            }
            let place = 1u64 << path.met;
            if path.met < path.given {
                decided = if path.outcomes & place != 0 { decided | bit } else { decided & !bit };
            } else if truth & bit != 0 {
                path.outcomes |= place;
            } else {
                path.outcomes &= !place;
            }
            path.met += 1;
        }
        decided
    }
}

impl Path {
    /// The paths that branch off from this one at decisions that were not given.
    pub(super) fn others(self) -> impl Iterator<Item = Self> {
        (self.given..self.met.min(MAX_DECISIONS)).map(move |place| {
            let kept = self.outcomes & ((1u64 << place) - 1);
            let turned = !self.outcomes & (1u64 << place);
            Self { outcomes: kept | turned, given: place + 1, met: 0 }
        })
    }
}

/// Whether lanes of a quad read from each other.
pub(super) fn couples(section: &super::code::Section, inner: &super::code::Inner) -> bool {
    section.insts.iter().any(|inst| match inst {
        Inst::Derivative { .. } => true,
        Inst::Texture { call } => {
            inner.textures.get(*call as usize).is_some_and(|call| call.lookup == Lookup::Implicit)
        }
        _ => false,
    })
}
