//! [`Tests`]: what is known of the fragments of a batch, as sets of lanes.
//!
//! *In:* coverage, depth tests and discards. *Out:* which fragments are drawn, may be drawn, and why that is open.

use super::store::Test;

/// Whether a fragment near an edge is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// It is drawn, or not, whatever happens to others.
    Open,
    /// Exactly one fragment of this role is drawn to its pixel.
    Owner,
}

/// The test results of the fragments of a batch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tests {
    /// Those whose values pass. For owners: if they are the owner.
    pub(super) passes: u64,
    /// Those for which a conforming GPU may decide differently.
    pub(super) undecided: u64,
    /// Those of them for which the reason is not an edge alone.
    pub(super) doubtful: u64,
    /// Those near an edge that may be drawn or not ([`Role::Open`]).
    pub(super) open: u64,
    /// Those near an edge of which exactly one is drawn to its pixel ([`Role::Owner`]).
    pub(super) owners: u64,
    /// Those near an edge that the reference's coverage does not have.
    pub(super) outside: u64,
}

impl Tests {
    /// Those that some conforming GPU draws.
    pub(super) fn possible(self) -> u64 {
        self.passes | self.undecided
    }

    /// Those near an edge.
    pub(super) fn edge(self) -> u64 {
        self.open | self.owners
    }

    #[inline(always)]
    pub(super) fn of(self, lane: usize) -> Test {
        Test { passes: self.passes >> lane & 1 == 1, undecided: self.undecided >> lane & 1 == 1 }
    }

    /// Adds the result of a lane, which keeps its role.
    #[inline(always)]
    pub(super) fn add(&mut self, lane: usize, test: Test) {
        self.passes |= u64::from(test.passes) << lane;
        self.undecided |= u64::from(test.undecided) << lane;
    }

    /// Notes that a lane is near an edge.
    pub(super) fn set_role(&mut self, lane: usize, role: Role, is_inside: bool) {
        let bit = 1 << lane;
        match role {
            Role::Open => self.open |= bit,
            Role::Owner => self.owners |= bit,
        }
        self.outside |= if is_inside { 0 } else { bit };
    }

    /// The results of some lanes, moved by a function on sets.
    pub(super) fn moved(self, by: impl Fn(u64) -> u64) -> Self {
        Self {
            passes: by(self.passes),
            undecided: by(self.undecided),
            doubtful: by(self.doubtful),
            open: by(self.open),
            owners: by(self.owners),
            outside: by(self.outside),
        }
    }

    /// The results of both.
    pub(super) fn merge(&mut self, other: Self) {
        self.passes |= other.passes;
        self.undecided |= other.undecided;
        self.doubtful |= other.doubtful;
        self.open |= other.open;
        self.owners |= other.owners;
        self.outside |= other.outside;
    }
}
