//! Stores under a mask, and tables of registers that an index selects from.

use super::inst::Operand;
use super::registers::{File, Filled, Register, Registers, copy};
use crate::domain::{Block, Domain, Element, Integer, LANES, Lanes, Number, Source, WIDTH};

/// The index into a table of `len` elements, clamped as an `int`.
#[inline(always)]
fn limit(bits: u32, len: usize) -> usize {
    (bits as i32).max(0).min(len as i32 - 1).max(0) as usize
}

#[inline(always)]
fn store<T: Element>(register: &mut Register<T>, a: Source<'_, T>, mask: u64, all: bool) {
    if all {
        return register.fill(|lanes| copy(lanes, a));
    }
    for (place, out) in register.spread().blocks_mut().iter_mut().enumerate() {
        *out = out.replaced(&a.block(place), (mask >> (place * WIDTH)) as u8);
    }
}

/// The element for each lane, with a fast path if all lanes select the same.
#[inline(always)]
fn load<T: Element, I: Integer>(out: &mut Lanes<T>, file: &File<T>, table: &[Operand], index: Source<'_, I>) -> Filled {
    let Some(first) = table.get(limit(index.at(0).bits(), table.len())) else { return Filled::Lanes };
    let same = match index {
        Source::One(_) => true,
        Source::Lanes(lanes) => lanes.iter().fold(0, |acc, lane| acc | (lane.bits() ^ lanes.get(0).bits())) == 0,
    };
    if same {
        return copy(out, file.source(*first));
    }
    for lane in 0..LANES {
        if let Some(operand) = table.get(limit(index.at(lane).bits(), table.len())) {
            out.set(lane, file.source(*operand).at(lane));
        }
    }
    Filled::Lanes
}

/// The possible indices, and first the likely one.
fn places<I: Integer>(index: I, len: usize) -> (usize, std::ops::RangeInclusive<usize>) {
    let (low, high) = index.interval();
    (limit(index.bits(), len), limit(low as u32, len)..=limit(high as u32, len))
}

/// Joins the elements that an undecided index may select to the one that it most likely selects.
fn join_others<T: Element, I: Integer>(
    out: &mut Lanes<T>,
    filled: Filled,
    index: Source<'_, I>,
    len: usize,
    element: impl Fn(usize, usize) -> Option<T>,
    join: impl Fn(T, T) -> T,
) -> Filled {
    if matches!(index, Source::One(index) if index.is_decided()) {
        return filled;
    }
    if filled == Filled::One {
        *out = Lanes::splat(out.get(0));
    }
    for lane in 0..LANES {
        let index = index.at(lane);
        if !index.is_decided() {
            let (likely, all) = places(index, len);
            let others = all.filter(|place| *place != likely).filter_map(|place| element(place, lane));
            out.set(lane, others.fold(out.get(lane), &join));
        }
    }
    Filled::Lanes
}

/// Stores into the elements that each active lane's index may select.
fn store_indexed<T: Element, I: Integer>(
    file: &mut File<T>,
    table: &[Operand],
    index: Source<'_, I>,
    a: Operand,
    mask: u64,
    join: impl Fn(T, T) -> T,
) {
    for lane in super::Mask(mask).lanes() {
        let value = file.source(a).at(lane);
        let index = index.at(lane);
        let (likely, all) = places(index, table.len());
        for (place, home) in all.filter_map(|place| table.get(place).map(|home| (place, *home))) {
            let lanes = file.register(home).spread();
            let old = lanes.get(lane);
            let new = match (index.is_decided(), place == likely) {
                (true, _) => value,
                (false, true) => join(value, old),
                (false, false) => join(old, value),
            };
            lanes.set(lane, new);
        }
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn store_float(&mut self, dst: Operand, a: Operand, mask: u64, all: bool) {
        // `a` is a different register, since the compiler removes stores of a variable to itself.
        let mut own = self.floats.take();
        std::mem::swap(self.floats.register(dst), &mut own);
        store(&mut own, self.float(a), mask, all);
        self.floats.put(dst, own);
    }

    pub(super) fn store_int(&mut self, dst: Operand, a: Operand, mask: u64, all: bool) {
        let mut own = self.ints.take();
        std::mem::swap(self.ints.register(dst), &mut own);
        store(&mut own, self.int(a), mask, all);
        self.ints.put(dst, own);
    }

    pub(super) fn load_float(&mut self, dst: Operand, table: &[Operand], index: Operand) {
        self.write_float(dst, |this, out| {
            let index = this.int(index);
            let filled = load(out, &this.floats, table, index);
            if !D::HAS_INTERVALS {
                return filled;
            }
            let element = |place: usize, lane| table.get(place).map(|operand| this.float(*operand).at(lane));
            join_others(out, filled, index, table.len(), element, Number::joined)
        });
    }

    pub(super) fn load_int(&mut self, dst: Operand, table: &[Operand], index: Operand) {
        self.write_int(dst, |this, out| {
            let index = this.int(index);
            let filled = load(out, &this.ints, table, index);
            if !D::HAS_INTERVALS {
                return filled;
            }
            let element = |place: usize, lane| table.get(place).map(|operand| this.int(*operand).at(lane));
            join_others(out, filled, index, table.len(), element, Integer::joined)
        });
    }

    pub(super) fn store_indexed_float(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) {
        store_indexed(&mut self.floats, table, self.ints.source(index), a, mask, Number::joined);
    }

    /// A register of the table may also be the index or the value, so both are read before anything is written.
    pub(super) fn store_indexed_int(&mut self, table: &[Operand], index: Operand, a: Operand, mask: u64) {
        let mut indices = Lanes::<D::Int>::default();
        indices.update(|lane, _| self.int(index).at(lane));
        store_indexed(&mut self.ints, table, Source::Lanes(&indices), a, mask, Integer::joined);
    }
}
