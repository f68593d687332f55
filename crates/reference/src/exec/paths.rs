//! The ways that lanes can go where conditions are open: which decisions a run follows, and which it met.
//!
//! *In:* open conditions, as instructions meet them. *Out:* the outcome that the run follows, and the ways that part from
//! it. [`explore`](super::explore) runs them.
//!
//! Lanes that derivatives couple decide together: a quad is one group; where no derivatives are taken, a lane is one. A
//! run has room for as many groups as fit into its lanes, each with its own decisions to follow.

use super::inst::{Inst, Lookup};
use super::{LANES, Mask};

/// The most decisions along a way.
pub(super) const MAX_DECISIONS: u8 = 60;

/// The decisions of one group along one way: bit `k` is the outcome of the `k`th.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Way {
    outcomes: u64,
    /// How many are given; the others follow the value.
    given: u8,
    /// How many were met.
    pub(super) met: u8,
}

/// The ways that a run follows and has found.
#[derive(Clone, Debug)]
pub(super) struct Paths {
    /// Lanes that decide together.
    pub(super) group: usize,
    pub(super) ways: [Way; LANES],
    /// Whether any decision was met.
    pub(super) any: bool,
}

impl Paths {
    pub(super) fn new(couples: bool) -> Self {
        Self { group: if couples { 4 } else { 1 }, ways: [Way::default(); LANES], any: false }
    }

    /// Forgets all decisions.
    pub(super) fn clear(&mut self) {
        if self.any {
            self.ways = [Way::default(); LANES];
            self.any = false;
        }
    }

    /// The outcomes for these lanes: given ones first, then the value's.
    pub(super) fn decide(&mut self, truth: u64, open: u64) -> u64 {
        self.any = true;
        let mut decided = truth;
        for lane in Mask(open).lanes() {
            let Some(way) = self.ways.get_mut(lane / self.group) else { continue };
            let bit = 1u64 << lane;
            if way.met >= MAX_DECISIONS {
                way.met = MAX_DECISIONS + 1;
                continue;
            }
            let place = 1u64 << way.met;
            if way.met < way.given {
                decided = if way.outcomes & place != 0 { decided | bit } else { decided & !bit };
            } else if truth & bit != 0 {
                way.outcomes |= place;
            } else {
                way.outcomes &= !place;
            }
            way.met += 1;
        }
        decided
    }
}

impl Way {
    /// The ways that part from this one at a decision that was not given.
    pub(super) fn others(self) -> impl Iterator<Item = Self> {
        (self.given..self.met.min(MAX_DECISIONS)).map(move |place| {
            let kept = self.outcomes & ((1u64 << place) - 1);
            let turned = !self.outcomes & (1u64 << place);
            Self { outcomes: kept | turned, given: place + 1, met: 0 }
        })
    }
}

/// Whether lanes of a quad read each other.
pub(super) fn couples(section: &super::code::Section, inner: &super::code::Inner) -> bool {
    section.insts.iter().any(|inst| match inst {
        Inst::Derivative { .. } => true,
        Inst::Texture { call } => {
            inner.textures.get(*call as usize).is_some_and(|call| call.lookup == Lookup::Implicit)
        }
        _ => false,
    })
}
