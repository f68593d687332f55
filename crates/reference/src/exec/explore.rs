//! Runs all ways that lanes may take where conditions are undecided, and joins the results.
//!
//! *In:* a machine after its first run, in which each undecided condition followed the value. *Out:* its outputs joined
//! over all ways, the lanes that may or may not be discarded, and the lanes that remain undecided.
//!
//! *Holds:* several fragments share a run, and each has as many lanes as it needs ([`ways`](super::ways)). The outputs of
//! a fragment that is given up may be anything. What is run does not depend on other runs of the machine.

use super::inst::{Class, Inst};
use super::machine::Machine;
use super::registers::Register;
use super::streams::Streams;
use super::{LANES, Mask};
use crate::domain::{Domain, Integer, Number};
use glisten_scene::picture::Interval;

/// The share of the groups that are fragments when a run begins; the others are for their ways. The following runs have
/// more if these were few.
const PACKED: usize = 8;
/// Loops may run this many times as long as in the first run, and the number of instructions below.
const LONGER: u64 = 2;
const AT_LEAST: u64 = 1 << 12;

/// Registers of some ports, floats and ints.
type Files<D> = (Vec<Register<<D as Domain>::Float>>, Vec<Register<<D as Domain>::Int>>);

/// The results of the first run, to be joined with those of the others.
struct Joined<D: Domain> {
    floats: Vec<Register<D::Float>>,
    ints: Vec<Register<D::Int>>,
    /// Lanes that the first run discarded.
    first: u64,
    /// Lanes that some way discards.
    discarded: u64,
    /// Lanes that some way keeps. Their outputs have a meaning.
    kept: u64,
    undecided: u64,
    /// Lanes whose outputs may be anything.
    unlimited: u64,
    /// The vertices that a geometry stage emits.
    streams: Streams<D>,
}

impl<D: Domain> Machine<D> {
    /// Runs all ways of the groups of these lanes that met an undecided condition.
    pub(super) fn explore(&mut self, lanes: u64) {
        if self.ways.met & lanes == 0 || self.budget_exceeded {
            return;
        }
        let (group, members) = (self.ways.group, self.ways.members());
        let capacity = self.ways.capacity();
        let open: Vec<usize> =
            (0..capacity).filter(|number| self.ways.met & lanes & members << (number * group) != 0).collect();
        let (hopeless, open): (Vec<usize>, Vec<usize>) = open.into_iter().partition(|group| self.is_hopeless(*group));
        let mut joined = self.first_outcome();
        joined.unlimited = hopeless.iter().fold(0, |all, number| all | members << (number * group));
        let inputs = self.copy_inputs();
        let spent = self.loop_budget.saturating_sub(self.budget + self.last.budget);
        let allowance = (LONGER * spent + AT_LEAST).min(self.loop_budget);
        let mut packed = (capacity / PACKED).max(1);
        let mut rest = &open[..];
        while !rest.is_empty() {
            let (now, later) = rest.split_at(packed.min(rest.len()));
            rest = later;
            let mut mask = 0;
            for (slot, number) in now.iter().enumerate() {
                mask |= (lanes >> (number * group) & members) << (slot * group);
                self.move_group(&inputs, number * group, slot * group, group);
            }
            self.ways.begin(now.len(), mask);
            self.run_ways(mask, allowance);
            for (fragment, number) in now.iter().enumerate() {
                let lanes = members << (number * group);
                if self.ways.given_up >> fragment & 1 == 1 {
                    joined.unlimited |= lanes;
                }
                let ways: Vec<usize> = self.ways.of(fragment).collect();
                for way in ways {
                    joined.add(self, number * group, way * group, group);
                }
            }
            if !self.ways.crowded && 2 * self.ways.most <= capacity {
                packed = (packed * 2).min(capacity / 2);
            }
        }
        self.ways.exploring = false;
        self.restore_inputs(&inputs);
        self.leave(joined);
    }

    /// Lets the outputs of groups with lanes that were cut be anything.
    pub(super) fn leave_cut(&mut self) {
        if self.cut == 0 {
            return;
        }
        let (group, members) = (self.ways.group, self.ways.members());
        let groups = (0..self.ways.capacity()).map(|number| members << (number * group));
        let unlimited = groups.filter(|lanes| self.cut & lanes != 0).fold(0, |all, lanes| all | lanes);
        let perhaps_discarded = self.perhaps_discarded;
        let joined = Joined { unlimited, ..self.first_outcome() };
        self.leave(joined);
        self.perhaps_discarded |= perhaps_discarded;
    }

    fn run_ways(&mut self, mask: u64, allowance: u64) {
        let code = std::sync::Arc::clone(&self.code.inner);
        (self.discarded, self.undecided) = (0, 0);
        self.streams.clear();
        (self.budget, self.allowance) = (allowance, allowance);
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
            unlimited: 0,
            streams: self.streams.clone(),
        }
    }

    fn copy_inputs(&self) -> Files<D> {
        let inner = &self.code.inner;
        let of = |class: Class| inner.given().filter(move |port| port.class == class);
        (
            of(Class::Float).filter_map(|port| self.registers.floats.get(port.register).cloned()).collect(),
            of(Class::Int).filter_map(|port| self.registers.ints.get(port.register).cloned()).collect(),
        )
    }

    /// Copies the original inputs of a group's lanes into other lanes.
    fn move_group(&mut self, inputs: &Files<D>, from: usize, to: usize, group: usize) {
        let code = std::sync::Arc::clone(&self.code.inner);
        let of = |class: Class| code.given().filter(move |port| port.class == class);
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

    /// Stores the joined outcome as that of the run.
    fn leave(&mut self, mut joined: Joined<D>) {
        let code = std::sync::Arc::clone(&self.code.inner);
        let of = |class: Class| code.outputs.iter().filter(move |port| port.class == class);
        for lane in Mask(joined.unlimited).lanes() {
            joined.streams.unlimit(lane);
            for lanes in joined.floats.iter_mut().map(Register::spread) {
                lanes.set(lane, D::Float::with_interval(lanes.get(lane).value(), Interval::ALL));
            }
            for lanes in joined.ints.iter_mut().map(Register::spread) {
                lanes.set(lane, D::Int::with_interval(lanes.get(lane).bits(), i32::MIN, i32::MAX));
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
        self.streams = joined.streams;
        self.discarded = joined.first;
        let discards = code.main.insts.iter().any(|inst| matches!(inst, Inst::Discard));
        let unknown = if discards { joined.unlimited } else { 0 };
        self.perhaps_discarded = joined.discarded & joined.kept | unknown;
        self.undecided = joined.undecided;
    }
}

impl<D: Domain> Joined<D> {
    /// Joins the results of a way in the lanes from `at` with those of the group's lanes from `from`.
    fn add(&mut self, machine: &Machine<D>, from: usize, at: usize, group: usize) {
        let inner = &machine.code.inner;
        let of = |class: Class| inner.outputs.iter().filter(move |port| port.class == class);
        for member in 0..group {
            let (from, at) = (from + member, at + member);
            self.undecided |= (machine.undecided >> at & 1) << from;
            if machine.discarded >> at & 1 == 1 {
                self.discarded |= 1 << from;
                continue;
            }
            // If nothing was kept so far, there is nothing to join.
            let fresh = self.kept >> from & 1 == 0;
            self.kept |= 1 << from;
            if let Some(stream) = machine.streams.get(at) {
                self.streams.join_one(stream, from, fresh);
            }
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
