//! Runs instructions: masks and jumps.

use super::code::{Inner, Runs, Section};
use super::guess::UndefinedThing;
use super::inst::Inst;
use super::machine::Machine;
use crate::domain::{Domain, Integer, Lanes};

impl<D: Domain> Machine<D> {
    /// Runs a section from its start with these lanes.
    pub(super) fn execute(&mut self, section: &Section, inner: &Inner, start: u64) {
        let mut mask = start;
        let mut place = 0;
        self.whole = start;
        self.last.outermost = None;
        let watched = self.observer.is_some();
        let corrected = self.exactly.is_some();
        let guessed = self.guess.is_some();
        while let Some(inst) = section.insts.get(place) {
            place += 1;
            if watched {
                self.show_choice(inst, section, place - 1, mask);
                if section.runs == Runs::Always {
                    self.count(inst, (section, place - 1), inner, mask);
                }
            }
            let open = if guessed { self.undefined(inst, section, inner, mask) } else { None };
            if open.is_some() {
                self.note_powers(inst);
            }
            if D::HAS_INTERVALS && self.muted.is_some() && self.is_muted(section, place - 1) {
                self.run_muted(inst, section, inner, mask);
                continue;
            }
            match *inst {
                Inst::StoreFloat { dst, a } => self.registers.store_float(dst, a, mask, mask == self.whole),
                Inst::StoreInt { dst, a } => self.registers.store_int(dst, a, mask, mask == self.whole),
                Inst::LoadFloat { dst, table, index } => {
                    self.registers.load_float(dst, section.list(table), index);
                    self.guess(inst, section, place - 1, open);
                }
                Inst::LoadInt { dst, table, index } => {
                    self.registers.load_int(dst, section.list(table), index);
                    self.guess(inst, section, place - 1, open);
                }
                Inst::StoreIndexedFloat { table, index, a } => {
                    self.registers.store_indexed_float(section.list(table), index, a, mask);
                }
                Inst::StoreIndexedInt { table, index, a } => {
                    self.registers.store_indexed_int(section.list(table), index, a, mask);
                }
                Inst::Texture { call } => {
                    if let Some(call) = inner.textures.get(call as usize) {
                        self.undecided |= self.texture(call, inner.stage, mask);
                        self.guess(inst, section, place - 1, open);
                        if corrected {
                            self.correct(inst, section, place - 1);
                        }
                        if watched {
                            self.show_texture(call, section, place - 1, mask);
                        }
                    }
                }
                Inst::Save { slot } => self.slots[slot as usize] = mask,
                Inst::Arm { c, rest, next } => {
                    let truth = self.truth(c, &mut mask);
                    self.slots[rest as usize] = mask & !truth;
                    mask = truth;
                    if mask == 0 {
                        place = next as usize;
                    }
                }
                Inst::Rest { rest: slot, end: target } | Inst::LoopNext { active: slot, exit: target } => {
                    self.forget_waiting(slot + 1);
                    mask = self.slots[slot as usize] & !self.discarded;
                    if mask == 0 {
                        place = target as usize;
                    }
                }
                Inst::Join { slot } => {
                    mask = self.slots[slot as usize] & !self.discarded;
                    self.forget_waiting(slot);
                }
                Inst::Leave { slots } => {
                    for slot in inner.words(slots) {
                        self.slots[*slot as usize] &= !mask;
                    }
                    mask = 0;
                }
                Inst::Discard => {
                    self.discarded |= mask;
                    mask = 0;
                }
                Inst::Endless => {
                    if D::HAS_INTERVALS && self.ways.exploring {
                        self.give_up_lanes(&mut mask);
                    } else if mask != 0 {
                        self.run_away(section, place - 1);
                    }
                }
                Inst::Emit { floats, ints } => {
                    self.emit_vertices(section.list(floats), section.list(ints), mask);
                }
                Inst::EndPrimitive => self.end_primitives(mask),
                Inst::Watch { c, is, slot } => self.watch_where(c, is, slot),
                Inst::Unwatch { slot } => self.watched = self.slots[slot as usize],
                Inst::Note { note, floats, ints } => self.note(note, section, [floats, ints], mask),
                Inst::LoopTest { c, active, exit } => {
                    mask = self.truth(c, &mut mask);
                    self.slots[active as usize] = mask;
                    if mask == 0 {
                        place = exit as usize;
                    }
                }
                Inst::LoopBack { head, exit } => {
                    if D::HAS_INTERVALS && !self.ways.exploring {
                        self.rounds += 1;
                        if self.most_rounds.is_some_and(|most| self.rounds >= most) {
                            self.cut |= mask;
                        }
                    }
                    let cost = (place as u64).saturating_sub(u64::from(head)).max(1);
                    match self.budget.checked_sub(cost) {
                        Some(left) => {
                            self.budget = left;
                            place = head as usize;
                        }
                        None => {
                            if D::HAS_INTERVALS && self.ways.exploring {
                                self.allowance /= 2;
                                self.budget = self.allowance;
                                self.give_up_lanes(&mut mask);
                                place = exit as usize;
                                continue;
                            }
                            if self.last.take(cost, (head as usize, place - 1)) {
                                place = head as usize;
                                continue;
                            }
                            self.budget = 0;
                            self.run_away(section, self.last.outermost.map_or(place - 1, |(_, end)| end));
                            place = exit as usize;
                        }
                    }
                }
                Inst::CaseMask { selector, labels, rest, slot } => {
                    let hit = self.matching(selector, inner.words(labels), rest as usize, &mut mask);
                    self.slots[slot as usize] = hit;
                    self.slots[rest as usize] &= !hit;
                }
                Inst::Idle => mask = 0,
                Inst::Case { slot, next } => {
                    mask |= self.slots[slot as usize] & !self.discarded;
                    if mask == 0 {
                        place = next as usize;
                    }
                }
                ref pure => {
                    if D::HAS_INTERVALS {
                        self.executed += pure.cost();
                        self.registers.compute_apart(pure, section);
                    } else {
                        self.registers.compute(pure, section);
                    }
                    self.guess(pure, section, place - 1, open);
                    if corrected {
                        self.correct(pure, section, place - 1);
                    }
                    if watched {
                        self.show(pure, section, place - 1, mask);
                    }
                }
            }
        }
    }
}

impl<D: Domain> Machine<D> {
    /// Puts a guess in the place of what is undefined of an instruction that has just run.
    #[inline(always)]
    fn guess(&mut self, inst: &Inst, section: &Section, place: usize, open: Option<(UndefinedThing, u64)>) {
        if let Some(open) = open {
            self.put_guess(inst, section, place, open);
        }
    }

    /// Records that the program does not come to an end at an instruction. Loops around it are left after it, and do end.
    fn run_away(&mut self, section: &Section, place: usize) {
        if !std::mem::replace(&mut self.budget_exceeded, true) {
            self.runaway = section.spans.get(place).copied().unwrap_or_default();
        }
    }
}

/// The lanes that are true, and those that are undecided.
#[inline(always)]
pub(super) fn bits_where<I: Integer>(lanes: &Lanes<I>) -> (u64, u64) {
    let (mut truth, mut undecided) = (0u64, 0u64);
    for (byte, lanes) in lanes.blocks().iter().enumerate() {
        let (mut bits, mut uncertain) = (0u64, 0u64);
        for (bit, lane) in lanes.iter().enumerate() {
            bits |= u64::from(lane.is_true()) << bit;
            uncertain |= u64::from(!lane.is_decided()) << bit;
        }
        truth |= bits << (byte * 8);
        undecided |= uncertain << (byte * 8);
    }
    (truth, undecided)
}
