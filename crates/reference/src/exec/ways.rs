//! The ways that lanes may take where conditions are undecided.
//!
//! *In:* undecided conditions, as instructions meet them. *Out:* in the first run, which lanes met one; while
//! [exploring](super::explore), a free lane for the other way of each, with a copy of all that the first lane has.
//!
//! *Holds:* a lane of a fragment is one way. Two ways that are at the same place, active or waiting for the same
//! constructs, may be merged: their numbers become the hull of both. That happens only when no lane is free, and
//! bounds the time by that of a few runs, however many ways there are. A fragment whose ways cannot be merged, one of whose
//! ways meets more than [`MOST_OPEN`] undecided conditions while its numbers have hardly a bound, or whose loops run far longer
//! than in the first run, is given up.
//!
//! Lanes that derivatives couple decide together: a quad is one group. Without derivatives, a lane is one.

use super::LANES;
use super::inst::{Inst, Lookup};
use crate::domain::limits::MOST_OPEN;
use smallvec::SmallVec;

/// A group that belongs to no fragment.
pub(super) const FREE: u8 = u8::MAX;

/// Which lanes are ways of which fragment.
#[derive(Clone, Debug)]
pub(super) struct Ways {
    /// The number of lanes that decide together.
    pub(super) group: usize,
    /// The lanes that met an undecided condition in the first run.
    pub(super) met: u64,
    /// Whether undecided conditions are followed both ways.
    pub(super) exploring: bool,
    /// The lanes in use.
    pub(super) used: u64,
    /// The fragment of each group.
    pub(super) owners: [u8; LANES],
    /// The fragments that are given up.
    pub(super) given_up: u64,
    /// Whether ways were merged for lack of lanes.
    pub(super) crowded: bool,
    /// The largest number of groups in use.
    pub(super) most: usize,
    /// The number of undecided conditions that each group has met.
    opened: [u8; LANES],
}

impl Ways {
    pub(super) fn new(couples: bool) -> Self {
        Self {
            group: if couples { 4 } else { 1 },
            met: 0,
            exploring: false,
            used: 0,
            owners: [FREE; LANES],
            given_up: 0,
            crowded: false,
            most: 0,
            opened: [0; LANES],
        }
    }

    /// Begins the first run.
    pub(super) fn begin_first(&mut self) {
        (self.met, self.exploring, self.opened) = (0, false, [0; LANES]);
    }

    /// Counts a condition for the groups that have not decided it.
    pub(super) fn count_open(&mut self, undecided: u64) {
        for (number, count) in self.opened.iter_mut().enumerate().take(LANES / self.group) {
            let members = (1 << self.group) - 1;
            let is_open = undecided >> (number * self.group) & members != 0;
            *count = count.saturating_add(u8::from(is_open));
        }
    }

    /// Whether a group has met many undecided conditions.
    pub(super) fn is_open(&self, number: usize) -> bool {
        self.opened.get(number).is_some_and(|count| *count > MOST_OPEN)
    }

    /// Lets a group go on as another one did.
    pub(super) fn copy_group(&mut self, from: usize, to: usize) {
        (self.owners[to], self.opened[to]) = (self.owners[from], self.opened[from]);
    }

    /// The number of groups in all lanes.
    pub(super) fn capacity(&self) -> usize {
        LANES / self.group
    }

    /// The lanes of the first group.
    pub(super) fn members(&self) -> u64 {
        (1 << self.group) - 1
    }

    /// Begins with one way for each of some fragments, in these lanes.
    pub(super) fn begin(&mut self, fragments: usize, lanes: u64) {
        self.owners = [FREE; LANES];
        for (number, owner) in self.owners.iter_mut().enumerate().take(fragments) {
            *owner = number as u8;
        }
        (self.exploring, self.used, self.given_up, self.opened) = (true, lanes, 0, [0; LANES]);
        (self.crowded, self.most) = (false, fragments);
    }

    /// The groups of a fragment.
    pub(super) fn of(&self, fragment: usize) -> impl Iterator<Item = usize> {
        let owners = self.owners.iter().take(self.capacity()).enumerate();
        owners.filter(move |(_, owner)| usize::from(**owner) == fragment).map(|(group, _)| group)
    }

    pub(super) fn free(&self) -> usize {
        self.of(usize::from(FREE)).count()
    }

    /// The fragments by the number of their groups, the largest first.
    pub(super) fn largest(&self) -> SmallVec<[(usize, usize); 16]> {
        let mut counts = [0_usize; LANES];
        for owner in self.owners.iter().take(self.capacity()) {
            if let Some(count) = counts.get_mut(usize::from(*owner)) {
                *count += 1;
            }
        }
        let mut order: SmallVec<[(usize, usize); 16]> =
            counts.into_iter().enumerate().filter(|(_, count)| *count > 0).collect();
        order.sort_by_key(|(fragment, count)| (std::cmp::Reverse(*count), *fragment));
        order
    }

    /// Whether two groups are at the same place.
    pub(super) fn together(&self, a: usize, b: usize, masks: impl Iterator<Item = u64>) -> bool {
        let lanes = |mask: u64, group: usize| mask >> (group * self.group) & self.members();
        masks.into_iter().all(|mask| lanes(mask, a) == lanes(mask, b))
    }
}

/// Whether lanes of a quad read from each other.
pub(super) fn couples(section: &super::code::Section, inner: &super::code::Inner) -> bool {
    section.insts.iter().any(|inst| match inst {
        Inst::Derivative { .. } => true,
        Inst::Texture { call } => inner
            .textures
            .get(*call as usize)
            .is_some_and(|call| matches!(call.lookup, Lookup::Implicit | Lookup::QueryLod)),
        _ => false,
    })
}
