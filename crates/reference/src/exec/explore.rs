//! Runs every path that lanes may take where conditions are undecided, and joins the results.
//!
//! *In:* a machine after its first run, in which each undecided condition followed the value and was recorded. *Out:*
//! its outputs joined over all other paths, the lanes that may or may not be discarded, and the lanes that remain
//! undecided. *Holds:* a group of lanes runs at most [`MAX_PATHS`] times. After that its outputs may be anything, and
//! it is undecided.

use super::inst::Class;
use super::machine::Machine;
use super::paths::{MAX_DECISIONS, Path};
use super::registers::Register;
use super::{LANES, Mask};
use crate::domain::{Domain, Integer, Number};
use glisten_scene::picture::Interval;

/// The largest number of paths of one group.
const MAX_PATHS: usize = 64;

/// Registers of some ports, floats and ints.
type Files<D> = (Vec<Register<<D as Domain>::Float>>, Vec<Register<<D as Domain>::Int>>);

/// The results of the first run, to be joined with those of the others.
struct Joined<D: Domain> {
    floats: Vec<Register<D::Float>>,
    ints: Vec<Register<D::Int>>,
    /// Lanes that the first run discarded.
    first: u64,
    /// Lanes that some path discards.
    discarded: u64,
    /// Lanes that some path keeps. Their outputs have a meaning.
    kept: u64,
    undecided: u64,
}

impl<D: Domain> Machine<D> {
    /// Runs all other paths of the groups of these lanes that met an undecided condition.
    pub(super) fn explore(&mut self, lanes: u64) {
        if !self.paths.any || self.budget_exceeded {
            return;
        }
        let group = self.paths.group;
        let members = (1u64 << group) - 1;
        let mut paths: Vec<(usize, Path)> = Vec::new();
        let mut counts = [0usize; LANES];
        let mut joined = self.first_outcome();
        let inputs = self.copy_inputs();
        for (number, path) in self.paths.paths.iter().enumerate().take(LANES / group) {
            if path.met > 0 && lanes >> (number * group) & members != 0 {
                counts[number] = 1;
                if path.met > MAX_DECISIONS {
                    joined.undecided |= members << (number * group);
                } else {
                    paths.extend(path.others().map(|other| (number, other)));
                }
            }
        }
        while !paths.is_empty() {
            // The latest first (depth first), so that the list stays short.
            let batch = paths.split_off(paths.len().saturating_sub(LANES / group));
            self.paths.clear();
            self.paths.any = true;
            let mut mask = 0;
            for (slot, (number, path)) in batch.iter().enumerate() {
                self.paths.paths[slot] = *path;
                mask |= (lanes >> (number * group) & members) << (slot * group);
                self.move_group(&inputs, *number * group, slot * group, group);
            }
            self.run_paths(mask);
            for (slot, (number, _)) in batch.iter().enumerate() {
                let path = self.paths.paths[slot];
                counts[*number] += 1;
                joined.add(self, number * group, slot * group, group);
                if counts[*number] >= MAX_PATHS || path.met > MAX_DECISIONS || self.budget_exceeded {
                    joined.undecided |= members << (number * group);
                }
                if joined.undecided >> (number * group) & members == 0 {
                    paths.extend(path.others().map(|other| (*number, other)));
                }
            }
            paths.retain(|(number, _)| joined.undecided >> (number * group) & members == 0);
            // A path without an end is one that an undecided loop bound permits.
            self.budget_exceeded = false;
        }
        self.paths.clear();
        self.restore_inputs(&inputs);
        self.leave(joined);
    }

    fn run_paths(&mut self, mask: u64) {
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

    /// Copies the original inputs of a group's lanes into other lanes.
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

    /// Stores the joined outcome as that of the run.
    fn leave(&mut self, mut joined: Joined<D>) {
        let code = std::sync::Arc::clone(&self.code.inner);
        let of = |class: Class| code.outputs.iter().filter(move |port| port.class == class);
        for lane in Mask(joined.undecided & !self.undecided).lanes() {
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
        self.discarded = joined.first;
        self.perhaps_discarded = joined.discarded & joined.kept | joined.undecided & !self.undecided;
        self.undecided = joined.undecided;
    }
}

impl<D: Domain> Joined<D> {
    /// Joins the results of a path in the lanes from `at` with those of the group's lanes from `from`.
    fn add(&mut self, machine: &Machine<D>, from: usize, at: usize, group: usize) {
        let inner = &machine.code.inner;
        let of = |class: Class| inner.outputs.iter().filter(move |port| port.class == class);
        for member in 0..group {
            let (from, at) = (from + member, at + member);
            if machine.discarded >> at & 1 == 1 {
                self.discarded |= 1 << from;
                continue;
            }
            // If nothing was kept so far, there is nothing to join.
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
