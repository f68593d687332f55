//! The ways that lanes can go where conditions are open: every one is run, and the results are joined.
//!
//! *In:* a machine after its first run, in which each open condition followed the value and was noted. *Out:* its
//! outputs joined over all other ways, which lanes may or may not be discarded, and which stay undecided.
//!
//! Lanes that derivatives couple decide together: a quad is one group; where no derivatives are taken, a lane is one. A
//! run has room for as many groups as fit into its lanes, each with its own decisions to follow, so that many ways run
//! at once. *Holds:* a group runs [`MAX_WAYS`] times at most; past that its outputs are anything and it is undecided.

use super::inst::{Class, Inst, Lookup};
use super::machine::Machine;
use super::registers::Register;
use super::{LANES, Mask};
use crate::domain::{Domain, Integer, Number};
use glisten_scene::picture::Interval;

/// The most ways of one group.
pub(super) const MAX_WAYS: usize = 64;
/// The most decisions along a way.
const MAX_DECISIONS: u8 = 60;

/// The decisions of one group along one way: bit `k` is the outcome of the `k`th.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    outcomes: u64,
    /// How many are given; the others follow the value.
    given: u8,
    /// How many were met.
    met: u8,
}

/// The ways that a run follows and has found.
#[derive(Clone, Debug)]
pub(super) struct Paths {
    /// Lanes that decide together.
    group: usize,
    ways: [Way; LANES],
    /// Whether any decision was met.
    any: bool,
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
    fn others(self) -> impl Iterator<Item = Self> {
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

/// Registers of some ports, floats and ints.
type Files<D> = (Vec<Register<<D as Domain>::Float>>, Vec<Register<<D as Domain>::Int>>);

/// What the first run left, to be joined with the others.
struct Joined<D: Domain> {
    floats: Vec<Register<D::Float>>,
    ints: Vec<Register<D::Int>>,
    /// Lanes that the first run discarded.
    first: u64,
    /// Lanes that some way discards.
    discarded: u64,
    /// Lanes that some way keeps: their outputs mean something.
    kept: u64,
    undecided: u64,
}

impl<D: Domain> Machine<D> {
    /// Runs every other way of the groups of these lanes that met an open condition.
    pub(super) fn explore(&mut self, lanes: u64) {
        if !self.paths.any || self.budget_exceeded {
            return;
        }
        let group = self.paths.group;
        let members = (1u64 << group) - 1;
        let mut ways: Vec<(usize, Way)> = Vec::new();
        let mut counts = [0usize; LANES];
        let mut joined = self.first_outcome();
        let inputs = self.copy_inputs();
        for (number, way) in self.paths.ways.iter().enumerate().take(LANES / group) {
            if way.met > 0 && lanes >> (number * group) & members != 0 {
                counts[number] = 1;
                if way.met > MAX_DECISIONS {
                    joined.undecided |= members << (number * group);
                } else {
                    ways.extend(way.others().map(|other| (number, other)));
                }
            }
        }
        while !ways.is_empty() {
            // The latest first: depth first, so that the list stays short.
            let batch = ways.split_off(ways.len().saturating_sub(LANES / group));
            self.paths.clear();
            self.paths.any = true;
            let mut mask = 0;
            for (slot, (number, way)) in batch.iter().enumerate() {
                self.paths.ways[slot] = *way;
                mask |= (lanes >> (number * group) & members) << (slot * group);
                self.move_group(&inputs, *number * group, slot * group, group);
            }
            self.run_ways(mask);
            for (slot, (number, _)) in batch.iter().enumerate() {
                let way = self.paths.ways[slot];
                counts[*number] += 1;
                joined.add(self, number * group, slot * group, group);
                if counts[*number] >= MAX_WAYS || way.met > MAX_DECISIONS || self.budget_exceeded {
                    joined.undecided |= members << (number * group);
                }
                if joined.undecided >> (number * group) & members == 0 {
                    ways.extend(way.others().map(|other| (*number, other)));
                }
            }
            ways.retain(|(number, _)| joined.undecided >> (number * group) & members == 0);
            // A way that does not end is one that the bound of loops leaves open.
            self.budget_exceeded = false;
        }
        self.paths.clear();
        self.restore_inputs(&inputs);
        self.leave(joined);
    }

    fn run_ways(&mut self, mask: u64) {
        let code = std::sync::Arc::clone(&self.code.inner);
        self.discarded = 0;
        self.budget = self.loop_budget >> 4;
        self.budget_exceeded = false;
        self.run_main(&code, mask);
    }

    fn first_outcome(&self) -> Joined<D> {
        let inner = &self.code.inner;
        let of = |class: Class| inner.outputs.iter().filter(move |port| port.class == class);
        Joined {
            floats: of(Class::Float).filter_map(|port| self.registers.floats.get(port.register).cloned()).collect(),
            ints: of(Class::Int).filter_map(|port| self.registers.ints.get(port.register).cloned()).collect(),
            first: self.discarded,
            discarded: self.discarded,
            kept: !self.discarded,
            undecided: self.undecided,
        }
    }

    fn copy_inputs(&self) -> Files<D> {
        let inner = &self.code.inner;
        let of = |class: Class| inner.inputs.iter().filter(move |port| port.class == class);
        (
            of(Class::Float).filter_map(|port| self.registers.floats.get(port.register).cloned()).collect(),
            of(Class::Int).filter_map(|port| self.registers.ints.get(port.register).cloned()).collect(),
        )
    }

    /// Puts the inputs of a group's lanes, as they were, into other lanes.
    fn move_group(&mut self, inputs: &Files<D>, from: usize, to: usize, group: usize) {
        let code = std::sync::Arc::clone(&self.code.inner);
        let of = |class: Class| code.inputs.iter().filter(move |port| port.class == class);
        for (port, saved) in of(Class::Float).zip(&inputs.0) {
            if let Some(register) = self.registers.floats.get_mut(port.register) {
                register.copy_lanes(saved, from, to, group);
            }
        }
        for (port, saved) in of(Class::Int).zip(&inputs.1) {
            if let Some(register) = self.registers.ints.get_mut(port.register) {
                register.copy_lanes(saved, from, to, group);
            }
        }
    }

    fn restore_inputs(&mut self, inputs: &Files<D>) {
        self.move_group(inputs, 0, 0, LANES);
    }

    /// Leaves the joined outcome as that of the run.
    fn leave(&mut self, mut joined: Joined<D>) {
        let code = std::sync::Arc::clone(&self.code.inner);
        let of = |class: Class| code.outputs.iter().filter(move |port| port.class == class);
        for lane in Mask(joined.undecided & !self.undecided).lanes() {
            for lanes in joined.floats.iter_mut().map(Register::spread) {
                lanes.set(lane, D::Float::with_range(lanes.get(lane).value(), Interval::ALL));
            }
            for lanes in joined.ints.iter_mut().map(Register::spread) {
                lanes.set(lane, D::Int::with_choices(lanes.get(lane).bits(), i32::MIN, i32::MAX));
            }
        }
        for (port, outcome) in of(Class::Float).zip(joined.floats) {
            if let Some(register) = self.registers.floats.get_mut(port.register) {
                *register = outcome;
            }
        }
        for (port, outcome) in of(Class::Int).zip(joined.ints) {
            if let Some(register) = self.registers.ints.get_mut(port.register) {
                *register = outcome;
            }
        }
        self.discarded = joined.first;
        self.perhaps_discarded = joined.discarded & joined.kept | joined.undecided & !self.undecided;
        self.undecided = joined.undecided;
    }
}

impl<D: Domain> Joined<D> {
    /// Joins what a way left in the lanes from `at` on to the group's lanes from `from` on.
    fn add(&mut self, machine: &Machine<D>, from: usize, at: usize, group: usize) {
        let inner = &machine.code.inner;
        let of = |class: Class| inner.outputs.iter().filter(move |port| port.class == class);
        for member in 0..group {
            let (from, at) = (from + member, at + member);
            if machine.discarded >> at & 1 == 1 {
                self.discarded |= 1 << from;
                continue;
            }
            // Where nothing was kept so far there is nothing to join.
            let fresh = self.kept >> from & 1 == 0;
            self.kept |= 1 << from;
            for (port, register) in of(Class::Float).zip(&mut self.floats) {
                let Some(new) = machine.registers.floats.get(port.register).map(|new| new.source().at(at)) else {
                    continue;
                };
                let lanes = register.spread();
                lanes.set(from, if fresh { new } else { lanes.get(from).joined(new) });
            }
            for (port, register) in of(Class::Int).zip(&mut self.ints) {
                let Some(new) = machine.registers.ints.get(port.register).map(|new| new.source().at(at)) else {
                    continue;
                };
                let lanes = register.spread();
                lanes.set(from, if fresh { new } else { lanes.get(from).joined(new) });
            }
        }
    }
}
