//! [`Registers`]: a file of floats and one of ints, with loops over lanes.
//!
//! A register is a box. An instruction writes to a spare one and swaps it in, so that operands and result never
//! overlap and nothing is copied. A register whose lanes are all equal stores one number, and computations on such
//! registers are done once. Examples are the counter of a loop over lights, and all uniforms that it selects.

use super::inst::{Class, Operand};
use crate::domain::{Block, Domain, Element, Lanes, Number, NumberBlock, Profile, Source, WIDTH};
use std::hint::black_box;

/// The largest number of results of one instruction: a `mat4`.
const SPARES: usize = 16;

/// The lanes that an instruction has written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filled {
    /// Each lane.
    Lanes,
    /// Only the first lane, which represents all.
    One,
}

/// One scalar.
#[derive(Clone, Debug)]
pub(super) struct Register<T: Element> {
    lanes: Box<Lanes<T>>,
    filled: Filled,
}

/// Registers of one type, and the numbers for all lanes of that type.
#[derive(Debug)]
pub(super) struct File<T: Element> {
    registers: Vec<Register<T>>,
    pub(super) pool: Vec<T>,
    spares: Vec<Register<T>>,
}

#[derive(Debug)]
pub(super) struct Registers<D: Domain> {
    pub(super) floats: File<D::Float>,
    pub(super) ints: File<D::Int>,
    /// The freedom of the device where the specifications leave it open.
    pub(super) profile: Profile,
}

impl<T: Element> Register<T> {
    fn blank() -> Self {
        Self { lanes: Box::default(), filled: Filled::Lanes }
    }

    #[inline(always)]
    pub(super) fn source(&self) -> Source<'_, T> {
        match self.filled {
            Filled::Lanes => Source::Lanes(&self.lanes),
            Filled::One => Source::One(self.lanes.get(0)),
        }
    }

    /// The lanes, if each has its own number.
    pub(super) fn lanes(&self) -> Option<&Lanes<T>> {
        (self.filled == Filled::Lanes).then_some(&self.lanes)
    }

    /// The lanes, after giving each its own number.
    #[inline(always)]
    pub(super) fn spread(&mut self) -> &mut Lanes<T> {
        if self.filled == Filled::One {
            *self.lanes = Lanes::splat(self.lanes.get(0));
            self.filled = Filled::Lanes;
        }
        &mut self.lanes
    }

    /// Replaces each number.
    pub(super) fn change(&mut self, f: impl Fn(T) -> T) {
        self.change_lanes(|_, number| f(number));
    }

    /// Replaces each number by one that may depend on its lane: 0, if all lanes have the same.
    pub(super) fn change_lanes(&mut self, f: impl Fn(usize, T) -> T) {
        match self.filled {
            Filled::Lanes => self.lanes.update(f),
            Filled::One => self.lanes.set(0, f(0, self.lanes.get(0))),
        }
    }

    /// Copies some lanes of another register.
    pub(super) fn copy_lanes(&mut self, other: &Self, from: usize, to: usize, count: usize) {
        let other = other.source();
        let lanes = self.spread();
        for place in 0..count {
            lanes.set(to + place, other.at(from + place));
        }
    }

    /// Copies some lanes to others, unless all are equal.
    fn copy_within(&mut self, from: usize, to: usize, count: usize) {
        if self.filled == Filled::Lanes {
            for place in 0..count {
                self.lanes.set(to + place, self.lanes.get(from + place));
            }
        }
    }

    /// Writes the register with `fill`.
    #[inline(always)]
    pub(super) fn fill(&mut self, fill: impl FnOnce(&mut Lanes<T>) -> Filled) {
        self.filled = fill(&mut self.lanes);
    }
}

impl<T: Element> File<T> {
    /// The number of registers.
    pub(super) fn len(&self) -> usize {
        self.registers.len()
    }

    /// Joins some lanes of every register with others.
    pub(super) fn join_lanes(&mut self, from: usize, into: usize, count: usize, hull: impl Fn(T, T) -> T) {
        for register in self.registers.iter_mut().filter(|register| register.filled == Filled::Lanes) {
            let lanes = &mut register.lanes;
            for place in 0..count {
                lanes.set(into + place, hull(lanes.get(into + place), lanes.get(from + place)));
            }
        }
    }

    /// Whether a number in some lanes, of any register, is like this.
    pub(super) fn any(&self, from: usize, count: usize, is_like: impl Fn(T) -> bool) -> bool {
        let registers = self.registers.iter().filter(|register| register.filled == Filled::Lanes);
        registers.into_iter().any(|register| (from..from + count).any(|lane| is_like(register.lanes.get(lane))))
    }

    /// Copies some lanes of every register to others.
    pub(super) fn copy_lanes(&mut self, from: usize, to: usize, count: usize) {
        self.registers.iter_mut().for_each(|register| register.copy_within(from, to, count));
    }

    fn new(count: usize, pool: Vec<T>) -> Self {
        let blank = |count| (0..count).map(|_| Register::blank()).collect();
        Self { registers: blank(count), pool, spares: blank(SPARES) }
    }

    /// Appends the preamble's results to the pool and allocates the registers of `main`.
    fn finish_preamble(&mut self, count: usize) {
        self.pool.extend(self.registers.iter().map(|register| register.lanes.get(0)));
        self.registers.resize_with(count, Register::blank);
    }

    #[inline(always)]
    pub(super) fn source(&self, operand: Operand) -> Source<'_, T> {
        // The compiler assigns every number in the code; see `alloc`.
        let number = operand.number();
        if operand.is_reg() { self.registers[number].source() } else { Source::One(self.pool[number]) }
    }

    /// The register of a register operand.
    #[inline(always)]
    pub(super) fn register(&mut self, operand: Operand) -> &mut Register<T> {
        &mut self.registers[operand.number()]
    }

    /// A register by its number.
    pub(super) fn get(&self, number: usize) -> Option<&Register<T>> {
        self.registers.get(number)
    }

    /// The mutable register with a number.
    pub(super) fn get_mut(&mut self, number: usize) -> Option<&mut Register<T>> {
        self.registers.get_mut(number)
    }

    fn splat(&mut self, register: usize, from: Operand) {
        let value = self.pool[from.number()];
        self.registers[register].fill(|lanes| {
            lanes.set(0, value);
            Filled::One
        });
    }

    /// A spare register to write to before it is [swapped in](Self::put).
    #[inline(always)]
    pub(super) fn take(&mut self) -> Register<T> {
        self.spares.pop().unwrap_or_else(Register::blank)
    }

    /// Makes a spare register the operand's.
    #[inline(always)]
    pub(super) fn put(&mut self, dst: Operand, mut spare: Register<T>) {
        std::mem::swap(&mut self.registers[dst.number()], &mut spare);
        self.spares.push(spare);
    }
}

/// Eight results of a function.
#[inline(always)]
fn block_of<R: Element>(f: impl Fn(usize) -> R) -> R::Block {
    let mut out = R::Block::default();
    for lane in 0..WIDTH {
        out.set(lane, f(lane));
    }
    out
}

/// Copies all lanes.
#[inline(always)]
pub(super) fn copy<T: Element>(out: &mut Lanes<T>, a: Source<'_, T>) -> Filled {
    match a {
        Source::Lanes(a) => {
            *out = *a;
            Filled::Lanes
        }
        Source::One(a) => {
            out.set(0, a);
            Filled::One
        }
    }
}

/// Applies a function lane by lane.
#[inline(always)]
pub(super) fn map1<A: Element, R: Element>(out: &mut Lanes<R>, a: Source<'_, A>, f: impl Fn(A) -> R) -> Filled {
    if !R::PLAIN {
        return calls1(out, a, &f);
    }
    match a {
        Source::Lanes(a) => {
            for (out, a) in out.blocks_mut().iter_mut().zip(a.blocks()) {
                *out = block_of(|lane| f(a.get(lane)));
            }
            Filled::Lanes
        }
        Source::One(a) => {
            out.set(0, f(a));
            Filled::One
        }
    }
}

#[inline(always)]
pub(super) fn map2<A: Element, B: Element, R: Element>(
    out: &mut Lanes<R>,
    a: Source<'_, A>,
    b: Source<'_, B>,
    f: impl Fn(A, B) -> R,
) -> Filled {
    if !R::PLAIN {
        return calls2(out, a, b, &f);
    }
    match (a, b) {
        (Source::Lanes(a), Source::Lanes(b)) => {
            for (out, (a, b)) in out.blocks_mut().iter_mut().zip(a.blocks().iter().zip(b.blocks())) {
                *out = block_of(|lane| f(a.get(lane), b.get(lane)));
            }
            Filled::Lanes
        }
        (Source::Lanes(a), Source::One(b)) => map1(out, Source::Lanes(a), |a| f(a, b)),
        (Source::One(a), b) => map1(out, b, |b| f(a, b)),
    }
}

/// For functions that cost far more than distinguishing the kinds of operands.
#[inline(always)]
pub(super) fn map3<A: Element, B: Element, C: Element, R: Element>(
    out: &mut Lanes<R>,
    a: Source<'_, A>,
    b: Source<'_, B>,
    c: Source<'_, C>,
    f: impl Fn(A, B, C) -> R,
) -> Filled {
    if !R::PLAIN {
        return calls3(out, a, b, c, &f);
    }
    match (a, b, c) {
        (Source::One(a), b, c) => map2(out, b, c, |b, c| f(a, b, c)),
        (a, Source::One(b), Source::One(c)) => map1(out, a, |a| f(a, b, c)),
        (a, b, c) => {
            for (place, out) in out.blocks_mut().iter_mut().enumerate() {
                let (a, b, c) = (a.block(place), b.block(place), c.block(place));
                *out = block_of(|lane| f(a.get(lane), b.get(lane), c.get(lane)));
            }
            Filled::Lanes
        }
    }
}

/// Calls a function for each lane. For functions that cost far more than the call, so that they are compiled once.
#[inline(never)]
pub(super) fn calls1<A: Element, R: Element>(out: &mut Lanes<R>, a: Source<'_, A>, f: &dyn Fn(A) -> R) -> Filled {
    match a {
        Source::Lanes(a) => {
            out.assign(a.iter().map(f));
            Filled::Lanes
        }
        Source::One(a) => {
            out.set(0, f(a));
            Filled::One
        }
    }
}

/// Calls a function of two operands for each lane.
#[inline(never)]
pub(super) fn calls2<A: Element, B: Element, R: Element>(
    out: &mut Lanes<R>,
    a: Source<'_, A>,
    b: Source<'_, B>,
    f: &dyn Fn(A, B) -> R,
) -> Filled {
    if let (Source::One(a), Source::One(b)) = (a, b) {
        out.set(0, f(a, b));
        return Filled::One;
    }
    out.update(|lane, _| f(a.at(lane), b.at(lane)));
    Filled::Lanes
}

/// Calls a function of three operands for each lane.
#[inline(never)]
pub(super) fn calls3<A: Element, B: Element, C: Element, R: Element>(
    out: &mut Lanes<R>,
    a: Source<'_, A>,
    b: Source<'_, B>,
    c: Source<'_, C>,
    f: &dyn Fn(A, B, C) -> R,
) -> Filled {
    if let (Source::One(a), Source::One(b), Source::One(c)) = (a, b, c) {
        out.set(0, f(a, b, c));
        return Filled::One;
    }
    out.update(|lane, _| f(a.at(lane), b.at(lane), c.at(lane)));
    Filled::Lanes
}

/// The blocks of an operand in order; for one number for all lanes, the same block repeatedly. So a loop over them is
/// compiled once for all kinds of operands.
struct Blocks<'a, T: Element> {
    blocks: &'a [T::Block],
    /// 0 if all indices have the same block.
    places: usize,
}

impl<'a, T: Element> Blocks<'a, T> {
    /// The blocks of an operand. `room` stores a number for all lanes. The compiler would branch if it knew that the
    /// blocks are equal, so this is hidden from it.
    #[inline(always)]
    fn of(source: Source<'a, T>, room: &'a mut T::Block) -> Self {
        match source {
            Source::Lanes(lanes) => Self { blocks: lanes.blocks(), places: usize::MAX },
            Source::One(value) => {
                *room = black_box(T::Block::splat(value));
                Self { blocks: std::slice::from_ref(room), places: 0 }
            }
        }
    }

    #[inline(always)]
    fn at(&self, place: usize) -> &T::Block {
        // `of` provides a block for every index.
        &self.blocks[place & self.places]
    }
}

/// Applies a function to blocks of lanes, or its scalar form to single numbers: if all operands are one number for
/// all lanes, and in each lane for domains without block operations or machines without a suitable vector unit.
#[inline(always)]
pub(super) fn blocks1<N: Number>(
    out: &mut Lanes<N>,
    a: Source<'_, N>,
    block: impl Fn(&N::Block) -> N::Block,
    one: impl Fn(N) -> N,
) -> Filled {
    if let (true, Source::Lanes(a)) = (N::Block::OWN, a) {
        let done = N::Block::if_vectorized(
            #[inline(always)]
            || {
                for (out, a) in out.blocks_mut().iter_mut().zip(a.blocks()) {
                    *out = block(a);
                }
            },
        );
        if done.is_some() {
            return Filled::Lanes;
        }
    }
    map1(out, a, one)
}

#[inline(always)]
pub(super) fn blocks2<N: Number, R: Element>(
    out: &mut Lanes<R>,
    a: Source<'_, N>,
    b: Source<'_, N>,
    block: impl Fn(&N::Block, &N::Block) -> R::Block,
    one: impl Fn(N, N) -> R,
) -> Filled {
    if N::Block::OWN && !matches!((a, b), (Source::One(_), Source::One(_))) {
        let done = N::Block::if_vectorized(
            #[inline(always)]
            || {
                let mut rooms = [N::Block::default(); 2];
                let [a_room, b_room] = &mut rooms;
                let (a, b) = (Blocks::of(a, a_room), Blocks::of(b, b_room));
                for (place, out) in out.blocks_mut().iter_mut().enumerate() {
                    *out = block(a.at(place), b.at(place));
                }
            },
        );
        if done.is_some() {
            return Filled::Lanes;
        }
    }
    map2(out, a, b, one)
}

#[inline(always)]
pub(super) fn blocks3<N: Number>(
    out: &mut Lanes<N>,
    [a, b, c]: [Source<'_, N>; 3],
    block: impl Fn(&N::Block, &N::Block, &N::Block) -> N::Block,
    one: impl Fn(N, N, N) -> N,
) -> Filled {
    if N::Block::OWN && !matches!((a, b, c), (Source::One(_), Source::One(_), Source::One(_))) {
        let done = N::Block::if_vectorized(
            #[inline(always)]
            || {
                let mut rooms = [N::Block::default(); 3];
                let [a_room, b_room, c_room] = &mut rooms;
                let (a, b, c) = (Blocks::of(a, a_room), Blocks::of(b, b_room), Blocks::of(c, c_room));
                for (place, out) in out.blocks_mut().iter_mut().enumerate() {
                    *out = block(a.at(place), b.at(place), c.at(place));
                }
            },
        );
        if done.is_some() {
            return Filled::Lanes;
        }
    }
    map3(out, a, b, c, one)
}

impl<D: Domain> Registers<D> {
    pub(super) fn new(count: [usize; 2], float_pool: Vec<D::Float>, int_pool: Vec<D::Int>, profile: Profile) -> Self {
        let [floats, ints] = count;
        Self { floats: File::new(floats, float_pool), ints: File::new(ints, int_pool), profile }
    }

    /// Appends the preamble's results to the pools and allocates the registers of `main`.
    pub(super) fn finish_preamble(&mut self, count: [usize; 2]) {
        let [floats, ints] = count;
        self.floats.finish_preamble(floats);
        self.ints.finish_preamble(ints);
    }

    pub(super) fn splat(&mut self, class: Class, register: usize, from: Operand) {
        match class {
            Class::Float => self.floats.splat(register, from),
            Class::Int => self.ints.splat(register, from),
        }
    }

    /// Gives each lane of a register its own number.
    pub(super) fn spread(&mut self, class: Class, register: usize) {
        match class {
            Class::Float => drop(self.floats.get_mut(register).map(Register::spread)),
            Class::Int => drop(self.ints.get_mut(register).map(Register::spread)),
        }
    }

    #[inline(always)]
    pub(super) fn float(&self, operand: Operand) -> Source<'_, D::Float> {
        self.floats.source(operand)
    }

    #[inline(always)]
    pub(super) fn int(&self, operand: Operand) -> Source<'_, D::Int> {
        self.ints.source(operand)
    }

    /// Writes a float register with `fill`, which may read any register.
    #[inline(always)]
    pub(super) fn write_float(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut Lanes<D::Float>) -> Filled) {
        let mut spare = self.floats.take();
        spare.fill(|lanes| fill(self, lanes));
        self.floats.put(dst, spare);
    }

    /// Writes an int register with `fill`, which may read any register.
    #[inline(always)]
    pub(super) fn write_int(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut Lanes<D::Int>) -> Filled) {
        let mut spare = self.ints.take();
        spare.fill(|lanes| fill(self, lanes));
        self.ints.put(dst, spare);
    }
}
