//! Stores under a mask, and tables of registers that an index picks from.

use super::LANES;
use super::inst::Operand;
use super::registers::{Lanes, Registers, Source, map1, source};
use super::run::bits_where;
use crate::cpu::domain::{Domain, Integer};

/// The place in a table of `len` that an index means: limited into range as an `int`.
#[inline(always)]
fn limit(bits: u32, len: usize) -> usize {
    (bits as i32).max(0).min(len as i32 - 1).max(0) as usize
}

#[inline(always)]
fn store<T: Copy>(out: &mut [T; LANES], a: Source<'_, T>, mask: u64, all: bool) {
    if all {
        return map1(out, a, |a| a);
    }
    for (lane, out) in out.iter_mut().enumerate() {
        let new = a.at(lane);
        *out = if mask >> lane & 1 == 1 { new } else { *out };
    }
}

/// The element for each lane; fast where all lanes mean the same.
#[inline(always)]
fn load<T: Copy, I: Integer>(
    out: &mut [T; LANES],
    file: &[Lanes<T>],
    pool: &[T],
    table: &[Operand],
    index: Source<'_, I>,
) {
    let Some(first) = table.get(limit(index.at(0).bits(), table.len())) else { return };
    let same = match index {
        Source::One(_) => true,
        Source::Lanes(lanes) => lanes.iter().fold(0, |acc, lane| acc | (lane.bits() ^ lanes[0].bits())) == 0,
    };
    if same {
        return map1(out, source(file, pool, *first), |a| a);
    }
    for (lane, out) in out.iter_mut().enumerate() {
        if let Some(operand) = table.get(limit(index.at(lane).bits(), table.len())) {
            *out = source(file, pool, *operand).at(lane);
        }
    }
}

/// Lanes where the index is not sure.
#[inline(always)]
fn unsure<I: Integer>(index: Source<'_, I>) -> u64 {
    match index {
        Source::One(value) => {
            if value.sure() {
                0
            } else {
                u64::MAX
            }
        }
        Source::Lanes(lanes) => bits_where(lanes).1,
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn store_float(&mut self, dst: Operand, a: Operand, mask: u64, all: bool) {
        if let Some(mut spare) = self.spare_floats.pop() {
            std::mem::swap(&mut self.floats[dst.number()], &mut spare);
            // `a` is another register: the compiler drops stores of a variable to itself.
            store(&mut spare, self.float(a), mask, all);
            std::mem::swap(&mut self.floats[dst.number()], &mut spare);
            self.spare_floats.push(spare);
        }
    }

    pub(super) fn store_int(&mut self, dst: Operand, a: Operand, mask: u64, all: bool) {
        if let Some(mut spare) = self.spare_ints.pop() {
            std::mem::swap(&mut self.ints[dst.number()], &mut spare);
            store(&mut spare, self.int(a), mask, all);
            std::mem::swap(&mut self.ints[dst.number()], &mut spare);
            self.spare_ints.push(spare);
        }
    }

    pub(super) fn load_float(&mut self, dst: Operand, table: &[Operand], index: Operand) -> u64 {
        self.write_float(dst, |this, out| load(out, &this.floats, &this.float_pool, table, this.int(index)));
        unsure(self.int(index))
    }

    pub(super) fn load_int(&mut self, dst: Operand, table: &[Operand], index: Operand) -> u64 {
        let doubt = unsure(self.int(index));
        self.write_int(dst, |this, out| load(out, &this.ints, &this.int_pool, table, this.int(index)));
        doubt
    }

    pub(super) fn store_indexed_float(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) -> u64 {
        for lane in super::Mask(mask).lanes() {
            let value = self.float(a).at(lane);
            if let Some(home) = table.get(limit(self.int(index).at(lane).bits(), table.len())) {
                self.floats[home.number()][lane] = value;
            }
        }
        unsure(self.int(index)) & mask
    }

    pub(super) fn store_indexed_int(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) -> u64 {
        let doubt = unsure(self.int(index)) & mask;
        for lane in super::Mask(mask).lanes() {
            let value = self.int(a).at(lane);
            if let Some(home) = table.get(limit(self.int(index).at(lane).bits(), table.len())) {
                self.ints[home.number()][lane] = value;
            }
        }
        doubt
    }
}
