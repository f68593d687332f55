//! Stores under a mask, and tables of registers that an index picks from.

use super::LANES;
use super::inst::Operand;
use super::registers::{Lanes, Registers, Source, map1, source};
use crate::cpu::domain::{Domain, Integer, Number};

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

/// The places that an index may mean, the likely one first.
fn places<I: Integer>(index: I, len: usize) -> (usize, std::ops::RangeInclusive<usize>) {
    let (low, high) = index.choices();
    (limit(index.bits(), len), limit(low as u32, len)..=limit(high as u32, len))
}

/// The elements that an open index may mean, joined to the one that it most likely means.
fn join_others<T: Copy, I: Integer>(
    out: &mut [T; LANES],
    index: Source<'_, I>,
    len: usize,
    element: impl Fn(usize, usize) -> Option<T>,
    join: impl Fn(T, T) -> T,
) {
    if matches!(index, Source::One(index) if index.sure()) {
        return;
    }
    for (lane, out) in out.iter_mut().enumerate() {
        let index = index.at(lane);
        if !index.sure() {
            let (likely, all) = places(index, len);
            let others = all.filter(|place| *place != likely).filter_map(|place| element(place, lane));
            *out = others.fold(*out, &join);
        }
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

    pub(super) fn load_float(&mut self, dst: Operand, table: &[Operand], index: Operand) {
        self.write_float(dst, |this, out| {
            let index = this.int(index);
            load(out, &this.floats, &this.float_pool, table, index);
            if D::OPEN {
                let element = |place: usize, lane| table.get(place).map(|operand| this.float(*operand).at(lane));
                join_others(out, index, table.len(), element, Number::joined);
            }
        });
    }

    pub(super) fn load_int(&mut self, dst: Operand, table: &[Operand], index: Operand) {
        self.write_int(dst, |this, out| {
            let index = this.int(index);
            load(out, &this.ints, &this.int_pool, table, index);
            if D::OPEN {
                let element = |place: usize, lane| table.get(place).map(|operand| this.int(*operand).at(lane));
                join_others(out, index, table.len(), element, Integer::joined);
            }
        });
    }

    pub(super) fn store_indexed_float(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) {
        for lane in super::Mask(mask).lanes() {
            let value = self.float(a).at(lane);
            let index = self.int(index).at(lane);
            let (likely, all) = places(index, table.len());
            for home in all.filter_map(|place| table.get(place).map(|home| (place, home))) {
                let old = &mut self.floats[home.1.number()][lane];
                *old = match (index.sure(), home.0 == likely) {
                    (true, _) => value,
                    (false, true) => value.joined(*old),
                    (false, false) => old.joined(value),
                };
            }
        }
    }

    pub(super) fn store_indexed_int(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) {
        for lane in super::Mask(mask).lanes() {
            let value = self.int(a).at(lane);
            let index = self.int(index).at(lane);
            let (likely, all) = places(index, table.len());
            for home in all.filter_map(|place| table.get(place).map(|home| (place, home))) {
                let old = &mut self.ints[home.1.number()][lane];
                *old = match (index.sure(), home.0 == likely) {
                    (true, _) => value,
                    (false, true) => value.joined(*old),
                    (false, false) => old.joined(value),
                };
            }
        }
    }
}
