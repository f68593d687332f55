//! Follows undecided conditions: both ways of each, on lanes of their own.
//!
//! *In:* conditions, as instructions meet them. *Out:* the lanes for which they are true; while
//! [exploring](super::explore), more lanes than before. *Holds:* [`ways`](super::ways) says which lanes belong to which
//! fragment, and when ways are merged.

use super::Mask;
use super::inst::{Operand, Slot};
use super::machine::Machine;
use super::run::bits_where;
use super::ways::FREE;
use crate::domain::limits::WIDEST;
use crate::domain::{Domain, Integer, Number, Source};
use smallvec::SmallVec;

/// Copies the bits of a group to another.
fn copied(mask: u64, from: usize, to: usize, members: u64) -> u64 {
    mask & !(members << to) | (mask >> from & members) << to
}

impl<D: Domain> Machine<D> {
    /// The lanes of `mask` where the condition is true. An undecided one follows the value in the first run; while
    /// exploring, it is followed both ways, and `mask` gains the lanes of the other ones.
    #[inline(always)]
    pub(super) fn truth(&mut self, condition: Operand, mask: &mut u64) -> u64 {
        let (truth, undecided) = self.answers(condition);
        if D::HAS_INTERVALS && undecided & *mask != 0 {
            return self.open(undecided & *mask, truth & *mask, mask, |machine, mask| {
                let (truth, undecided) = machine.answers(condition);
                (truth & mask, undecided & mask)
            });
        }
        truth & *mask
    }

    /// The observer sees only the lanes where the condition is `is`, or may be.
    pub(super) fn watch_where(&mut self, condition: Operand, is: bool, slot: Slot) {
        let (truth, undecided) = self.answers(condition);
        self.slots[slot as usize] = self.watched;
        self.watched &= undecided | if is { truth } else { !truth };
    }

    fn answers(&self, condition: Operand) -> (u64, u64) {
        match self.registers.int(condition) {
            Source::One(value) => {
                (if value.is_true() { u64::MAX } else { 0 }, if value.is_decided() { 0 } else { u64::MAX })
            }
            Source::Lanes(lanes) => bits_where(lanes),
        }
    }

    /// The lanes among those waiting in `rest` whose selector is one of the labels.
    pub(super) fn matching(&mut self, selector: Operand, labels: &[u32], rest: usize, mask: &mut u64) -> u64 {
        let find = |machine: &Self, _: u64| {
            let asked = machine.slots[rest];
            let selector = machine.registers.int(selector);
            let (mut hit, mut undecided) = (0, 0);
            for lane in Mask(asked).lanes() {
                let value = selector.at(lane);
                hit |= u64::from(labels.contains(&value.bits())) << lane;
                let (low, high) = value.interval();
                let possible = labels.iter().any(|label| (low..=high).contains(&(*label as i32)));
                undecided |= u64::from(!value.is_decided() && possible) << lane;
            }
            (hit, undecided)
        };
        let (hit, undecided) = find(self, *mask);
        if D::HAS_INTERVALS && undecided != 0 { self.open(undecided, hit, mask, find) } else { hit }
    }

    #[cold]
    #[inline(never)]
    fn open(&mut self, undecided: u64, truth: u64, mask: &mut u64, find: impl Fn(&Self, u64) -> (u64, u64)) -> u64 {
        self.ways.count_open(undecided);
        if !self.ways.exploring {
            self.ways.met |= undecided;
            return truth;
        }
        self.give_up_hopeless(mask);
        self.count_registers(64 - self.ways.free() * self.ways.group, 1);
        loop {
            let (truth, undecided) = find(self, *mask);
            if self.needed(undecided) <= self.ways.free() {
                return self.fork(truth, undecided, mask);
            }
            self.make_room(mask);
        }
    }

    /// The number of groups that undecided lanes add.
    fn needed(&self, undecided: u64) -> usize {
        let (group, members) = (self.ways.group, self.ways.members());
        let of = |number: usize| (1_usize << (undecided >> (number * group) & members).count_ones()) - 1;
        (0..self.ways.capacity()).map(of).sum()
    }

    /// Gives each undecided lane a second way. Returns the lanes whose condition is true.
    fn fork(&mut self, mut truth: u64, undecided: u64, mask: &mut u64) -> u64 {
        let (size, members) = (self.ways.group, self.ways.members());
        let groups = (0..self.ways.capacity()).map(|group| (group, undecided >> (group * size) & members));
        let mut open: SmallVec<[(usize, u64); 16]> = groups.filter(|(_, open)| *open != 0).collect();
        while let Some((group, lanes)) = open.pop() {
            let other = self.ways.of(usize::from(FREE)).next();
            // `open` has made room.
            let Some(other) = other else { continue };
            self.copy_way(group, other, mask);
            truth = copied(truth, group * size, other * size, members);
            let lane = lanes.trailing_zeros() as usize;
            truth = truth & !(1 << (other * size + lane)) | 1 << (group * size + lane);
            let rest = lanes & (lanes - 1);
            if rest != 0 {
                open.extend([(group, rest), (other, rest)]);
            }
        }
        self.ways.most = self.ways.most.max(self.ways.capacity() - self.ways.free());
        truth & *mask
    }

    /// Makes a free group a copy of another.
    fn copy_way(&mut self, from: usize, to: usize, mask: &mut u64) {
        self.ways.copy_group(from, to);
        let (size, members) = (self.ways.group, self.ways.members());
        let (from, to) = (from * size, to * size);
        for bits in self.slots.iter_mut().chain([mask, &mut self.discarded, &mut self.undecided, &mut self.ways.used]) {
            *bits = copied(*bits, from, to, members);
        }
        self.whole = self.ways.used;
        self.registers.floats.copy_lanes(from, to, size);
        self.registers.ints.copy_lanes(from, to, size);
        self.streams.copy(from, to, size);
        self.count_registers(size, 1);
    }

    /// Merges ways of the fragment that has most of those that can be; if there are none, gives up the largest.
    fn make_room(&mut self, mask: &mut u64) {
        self.ways.crowded = true;
        let order = self.ways.largest();
        for (fragment, count) in &order {
            if *count > 1 && self.merge_ways(*fragment, mask) {
                return;
            }
        }
        if let Some((fragment, _)) = order.first() {
            self.give_up(*fragment, mask);
        }
    }

    /// Merges all ways of a fragment that are at the same place. Returns false if there are none.
    fn merge_ways(&mut self, fragment: usize, mask: &mut u64) -> bool {
        let mut groups: SmallVec<[usize; 16]> = self.ways.of(fragment).collect();
        let mut merged = false;
        while let Some(last) = groups.pop() {
            let place = |group: &&usize| {
                let masks = self.slots.iter().copied().chain([*mask, self.discarded]);
                self.ways.together(**group, last, masks)
            };
            if let Some(into) = groups.iter().find(place).copied() {
                let size = self.ways.group;
                self.registers.floats.join_lanes(last * size, into * size, size, D::Float::joined);
                self.registers.ints.join_lanes(last * size, into * size, size, D::Int::joined);
                self.streams.join(last * size, into * size, size);
                self.count_registers(size, 3);
                self.undecided |= (self.undecided >> (last * size) & self.ways.members()) << (into * size);
                self.release(last, mask);
                merged = true;
            }
        }
        merged
    }

    fn release(&mut self, group: usize, mask: &mut u64) {
        let lanes = self.ways.members() << (group * self.ways.group);
        self.ways.owners[group] = FREE;
        for bits in self.slots.iter_mut().chain([mask, &mut self.discarded, &mut self.undecided, &mut self.ways.used]) {
            *bits &= !lanes;
        }
        self.whole = self.ways.used;
    }

    fn give_up(&mut self, fragment: usize, mask: &mut u64) {
        self.ways.given_up |= 1 << fragment;
        let groups: SmallVec<[usize; 16]> = self.ways.of(fragment).collect();
        groups.into_iter().for_each(|group| self.release(group, mask));
    }

    /// Gives up all fragments with a hopeless way.
    fn give_up_hopeless(&mut self, mask: &mut u64) {
        for fragment in 0..self.ways.capacity() {
            if self.ways.of(fragment).any(|group| self.is_hopeless(group)) {
                self.give_up(fragment, mask);
            }
        }
    }

    /// Whether following a way finds no bound: it has met many undecided conditions, and one of its numbers has hardly a
    /// bound.
    pub(super) fn is_hopeless(&self, group: usize) -> bool {
        let is_wide = |number: D::Float| {
            let width = number.interval().width();
            width.is_nan() || width > WIDEST * (1.0 + number.value().abs())
        };
        let size = self.ways.group;
        self.ways.is_open(group) && self.registers.floats.any(group * size, size, is_wide)
    }

    /// Gives up all fragments with a way among these lanes.
    pub(super) fn give_up_lanes(&mut self, mask: &mut u64) {
        for fragment in 0..self.ways.capacity() {
            let (size, members) = (self.ways.group, self.ways.members());
            if self.ways.of(fragment).any(|group| *mask >> (group * size) & members != 0) {
                self.give_up(fragment, mask);
            }
        }
        *mask = 0;
    }

    /// Forgets who waited inside a construct that has ended; its slots are the later ones. So ways that are together
    /// have equal masks.
    #[inline(always)]
    pub(super) fn forget_waiting(&mut self, first: u32) {
        if D::HAS_INTERVALS && self.ways.exploring {
            self.slots.iter_mut().skip(first as usize).for_each(|slot| *slot = 0);
        }
    }
}
