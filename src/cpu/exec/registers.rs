//! [`Registers`]: a file of floats and one of ints, and the loops over lanes.
//!
//! A register is a box: an instruction writes into a spare one and swaps it in, so that operands and result never
//! overlap and nothing is copied. A register whose lanes are all alike keeps one number: what is computed from such
//! registers is computed once. The counter of a loop over lights is one, and so is all that it picks from uniforms.

use super::LANES;
use super::inst::{Class, Operand};
use crate::cpu::domain::Domain;
use crate::cpu::domain::faults::Faults;

/// One scalar in all lanes.
pub(super) type Lanes<T> = Box<[T; LANES]>;

/// The most results of one instruction: a `mat4`.
const SPARES: usize = 16;

/// What an instruction has written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filled {
    /// Each lane.
    Lanes,
    /// The first lane, which stands for all.
    One,
}

/// One scalar.
#[derive(Clone, Debug)]
pub(super) struct Register<T> {
    lanes: Lanes<T>,
    filled: Filled,
}

/// Registers of one type, and the numbers for all lanes of that type.
#[derive(Debug)]
pub(super) struct File<T> {
    registers: Vec<Register<T>>,
    pub(super) pool: Vec<T>,
    spares: Vec<Register<T>>,
}

#[derive(Debug)]
pub(super) struct Registers<D: Domain> {
    pub(super) floats: File<D::Float>,
    pub(super) ints: File<D::Int>,
    /// Faults of a driver that are admitted.
    pub(super) faults: Faults,
}

/// What an operand stands for.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a, T> {
    /// A number in each lane.
    Lanes(&'a [T; LANES]),
    /// One number for all lanes.
    One(T),
}

impl<T: Copy> Source<'_, T> {
    /// The number in a lane; lanes are counted modulo [`LANES`].
    #[inline(always)]
    pub fn at(&self, lane: usize) -> T {
        match self {
            Self::Lanes(lanes) => lanes[lane % LANES],
            Self::One(value) => *value,
        }
    }
}

impl<T: Copy + Default> Register<T> {
    fn blank() -> Self {
        Self { lanes: Box::new([T::default(); LANES]), filled: Filled::Lanes }
    }

    #[inline(always)]
    pub(super) fn source(&self) -> Source<'_, T> {
        match self.filled {
            Filled::Lanes => Source::Lanes(&self.lanes),
            Filled::One => Source::One(self.lanes[0]),
        }
    }

    /// Its lanes, where each has its own number.
    pub(super) fn lanes(&self) -> Option<&[T; LANES]> {
        (self.filled == Filled::Lanes).then_some(&self.lanes)
    }

    /// Its lanes, each with its own number from here on.
    #[inline(always)]
    pub(super) fn spread(&mut self) -> &mut [T; LANES] {
        if self.filled == Filled::One {
            *self.lanes = [self.lanes[0]; LANES];
            self.filled = Filled::Lanes;
        }
        &mut self.lanes
    }

    /// Takes some lanes of another register.
    pub(super) fn copy_lanes(&mut self, other: &Self, from: usize, to: usize, count: usize) {
        let other = other.source();
        for (place, lane) in self.spread().iter_mut().skip(to).take(count).enumerate() {
            *lane = other.at(from + place);
        }
    }

    /// Lets `fill` write it.
    #[inline(always)]
    pub(super) fn fill(&mut self, fill: impl FnOnce(&mut [T; LANES]) -> Filled) {
        self.filled = fill(&mut self.lanes);
    }
}

impl<T: Copy + Default> File<T> {
    fn new(count: usize, pool: Vec<T>) -> Self {
        let blank = |count| (0..count).map(|_| Register::blank()).collect();
        Self { registers: blank(count), pool, spares: blank(SPARES) }
    }

    /// Appends the preamble's results to the pool and makes room for the registers of `main`.
    fn finish_preamble(&mut self, count: usize) {
        self.pool.extend(self.registers.iter().map(|register| register.lanes[0]));
        self.registers.resize_with(count, Register::blank);
    }

    #[inline(always)]
    pub(super) fn source(&self, operand: Operand) -> Source<'_, T> {
        // The compiler hands out every number that code names; see `alloc`.
        let number = operand.number();
        if operand.is_reg() { self.registers[number].source() } else { Source::One(self.pool[number]) }
    }

    /// The register of an operand that is one.
    #[inline(always)]
    pub(super) fn register(&mut self, operand: Operand) -> &mut Register<T> {
        &mut self.registers[operand.number()]
    }

    /// A register by its number.
    pub(super) fn get(&self, number: usize) -> Option<&Register<T>> {
        self.registers.get(number)
    }

    /// Likewise to be changed.
    pub(super) fn get_mut(&mut self, number: usize) -> Option<&mut Register<T>> {
        self.registers.get_mut(number)
    }

    fn splat(&mut self, register: usize, from: Operand) {
        let value = self.pool[from.number()];
        self.registers[register].fill(|lanes| {
            lanes[0] = value;
            Filled::One
        });
    }

    /// A register to write into before it is [swapped in](Self::put).
    #[inline(always)]
    pub(super) fn take(&mut self) -> Register<T> {
        self.spares.pop().unwrap_or_else(Register::blank)
    }

    /// Puts a register that is not needed back.
    #[inline(always)]
    pub(super) fn give_back(&mut self, spare: Register<T>) {
        self.spares.push(spare);
    }

    /// Makes a spare register that of the operand.
    #[inline(always)]
    pub(super) fn put(&mut self, dst: Operand, mut spare: Register<T>) {
        std::mem::swap(&mut self.registers[dst.number()], &mut spare);
        self.spares.push(spare);
    }
}

#[inline(always)]
pub(super) fn map1<A: Copy, R>(out: &mut [R; LANES], a: Source<'_, A>, f: impl Fn(A) -> R) -> Filled {
    match a {
        Source::Lanes(a) => {
            for (out, a) in out.iter_mut().zip(a) {
                *out = f(*a);
            }
            Filled::Lanes
        }
        Source::One(a) => {
            out[0] = f(a);
            Filled::One
        }
    }
}

#[inline(always)]
pub(super) fn map2<A: Copy, B: Copy, R>(
    out: &mut [R; LANES],
    a: Source<'_, A>,
    b: Source<'_, B>,
    f: impl Fn(A, B) -> R,
) -> Filled {
    match (a, b) {
        (Source::Lanes(a), Source::Lanes(b)) => {
            for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
                *out = f(*a, *b);
            }
            Filled::Lanes
        }
        (Source::Lanes(a), Source::One(b)) => map1(out, Source::Lanes(a), |a| f(a, b)),
        (Source::One(a), b) => map1(out, b, |b| f(a, b)),
    }
}

/// For functions that cost far more than telling the kinds of operands apart.
#[inline(always)]
pub(super) fn map3<A: Copy, B: Copy, C: Copy, R>(
    out: &mut [R; LANES],
    a: Source<'_, A>,
    b: Source<'_, B>,
    c: Source<'_, C>,
    f: impl Fn(A, B, C) -> R,
) -> Filled {
    match (a, b, c) {
        (Source::Lanes(a), Source::Lanes(b), Source::Lanes(c)) => {
            for (out, ((a, b), c)) in out.iter_mut().zip(a.iter().zip(b).zip(c)) {
                *out = f(*a, *b, *c);
            }
            Filled::Lanes
        }
        (Source::Lanes(a), Source::One(b), Source::One(c)) => map1(out, Source::Lanes(a), |a| f(a, b, c)),
        (Source::One(a), b, c) => map2(out, b, c, |b, c| f(a, b, c)),
        (a, b, c) => {
            for (lane, out) in out.iter_mut().enumerate() {
                *out = f(a.at(lane), b.at(lane), c.at(lane));
            }
            Filled::Lanes
        }
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn new(count: [usize; 2], float_pool: Vec<D::Float>, int_pool: Vec<D::Int>, faults: Faults) -> Self {
        let [floats, ints] = count;
        Self { floats: File::new(floats, float_pool), ints: File::new(ints, int_pool), faults }
    }

    /// Appends the preamble's results to the pools and makes room for the registers of `main`.
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

    /// Lets `fill` write a float register, whatever it reads.
    #[inline(always)]
    pub(super) fn write_float(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut [D::Float; LANES]) -> Filled) {
        let mut spare = self.floats.take();
        spare.fill(|lanes| fill(self, lanes));
        self.floats.put(dst, spare);
    }

    /// Likewise of an int register.
    #[inline(always)]
    pub(super) fn write_int(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut [D::Int; LANES]) -> Filled) {
        let mut spare = self.ints.take();
        spare.fill(|lanes| fill(self, lanes));
        self.ints.put(dst, spare);
    }
}
