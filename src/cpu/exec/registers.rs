//! [`Registers`]: the two files, the pools of numbers for all lanes, and the loops over lanes.
//!
//! A register is a box: an instruction writes into a spare one and swaps it in, so that operands and result never
//! overlap and nothing is copied.

use super::LANES;
use super::inst::{Class, Operand};
use crate::cpu::domain::Domain;
use crate::cpu::domain::faults::Faults;

/// One scalar in all lanes.
pub(super) type Lanes<T> = Box<[T; LANES]>;

/// The most results of one instruction: a `mat4`.
const SPARES: usize = 16;

#[derive(Debug)]
pub(super) struct Registers<D: Domain> {
    pub(super) floats: Vec<Lanes<D::Float>>,
    pub(super) ints: Vec<Lanes<D::Int>>,
    pub(super) float_pool: Vec<D::Float>,
    pub(super) int_pool: Vec<D::Int>,
    pub(super) spare_floats: Vec<Lanes<D::Float>>,
    pub(super) spare_ints: Vec<Lanes<D::Int>>,
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

fn blank<T: Copy + Default>() -> Lanes<T> {
    Box::new([T::default(); LANES])
}

#[inline(always)]
pub(super) fn source<'a, T: Copy>(file: &'a [Lanes<T>], pool: &'a [T], operand: Operand) -> Source<'a, T> {
    // The compiler hands out every number that code names; see `alloc`.
    if operand.is_reg() { Source::Lanes(&file[operand.number()]) } else { Source::One(pool[operand.number()]) }
}

#[inline(always)]
pub(super) fn map1<A: Copy, R>(out: &mut [R; LANES], a: Source<'_, A>, f: impl Fn(A) -> R) {
    match a {
        Source::Lanes(a) => {
            for (out, a) in out.iter_mut().zip(a) {
                *out = f(*a);
            }
        }
        Source::One(a) => {
            for out in out {
                *out = f(a);
            }
        }
    }
}

#[inline(always)]
pub(super) fn map2<A: Copy, B: Copy, R>(
    out: &mut [R; LANES],
    a: Source<'_, A>,
    b: Source<'_, B>,
    f: impl Fn(A, B) -> R,
) {
    match (a, b) {
        (Source::Lanes(a), Source::Lanes(b)) => {
            for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
                *out = f(*a, *b);
            }
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
) {
    match (a, b, c) {
        (Source::Lanes(a), Source::Lanes(b), Source::Lanes(c)) => {
            for (out, ((a, b), c)) in out.iter_mut().zip(a.iter().zip(b).zip(c)) {
                *out = f(*a, *b, *c);
            }
        }
        (Source::Lanes(a), Source::One(b), Source::One(c)) => map1(out, Source::Lanes(a), |a| f(a, b, c)),
        (Source::One(a), b, c) => map2(out, b, c, |b, c| f(a, b, c)),
        (a, b, c) => {
            for (lane, out) in out.iter_mut().enumerate() {
                *out = f(a.at(lane), b.at(lane), c.at(lane));
            }
        }
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn new(count: [usize; 2], float_pool: Vec<D::Float>, int_pool: Vec<D::Int>, faults: Faults) -> Self {
        let [floats, ints] = count;
        Self {
            floats: (0..floats).map(|_| blank()).collect(),
            ints: (0..ints).map(|_| blank()).collect(),
            float_pool,
            int_pool,
            spare_floats: (0..SPARES).map(|_| blank()).collect(),
            spare_ints: (0..SPARES).map(|_| blank()).collect(),
            faults,
        }
    }

    /// Appends the preamble's results to the pools and makes room for the registers of `main`.
    pub(super) fn finish_preamble(&mut self, count: [usize; 2]) {
        let [floats, ints] = count;
        self.float_pool.extend(self.floats.iter().map(|lanes| lanes[0]));
        self.int_pool.extend(self.ints.iter().map(|lanes| lanes[0]));
        self.floats.resize_with(floats, blank);
        self.ints.resize_with(ints, blank);
    }

    pub(super) fn splat(&mut self, class: Class, register: usize, from: Operand) {
        match class {
            Class::Float => *self.floats[register] = [self.float_pool[from.number()]; LANES],
            Class::Int => *self.ints[register] = [self.int_pool[from.number()]; LANES],
        }
    }

    #[inline(always)]
    pub(super) fn float(&self, operand: Operand) -> Source<'_, D::Float> {
        source(&self.floats, &self.float_pool, operand)
    }

    #[inline(always)]
    pub(super) fn int(&self, operand: Operand) -> Source<'_, D::Int> {
        source(&self.ints, &self.int_pool, operand)
    }

    /// Lets `fill` write a float register's lanes, whatever it reads.
    #[inline(always)]
    pub(super) fn write_float(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut [D::Float; LANES])) {
        if let Some(mut spare) = self.spare_floats.pop() {
            fill(self, &mut spare);
            std::mem::swap(&mut self.floats[dst.number()], &mut spare);
            self.spare_floats.push(spare);
        }
    }

    /// Likewise of an int register.
    #[inline(always)]
    pub(super) fn write_int(&mut self, dst: Operand, fill: impl FnOnce(&Self, &mut [D::Int; LANES])) {
        if let Some(mut spare) = self.spare_ints.pop() {
            fill(self, &mut spare);
            std::mem::swap(&mut self.ints[dst.number()], &mut spare);
            self.spare_ints.push(spare);
        }
    }
}
