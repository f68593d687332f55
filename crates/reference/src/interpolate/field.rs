//! [`Field`]: the arithmetic of the equations, over one number or over eight at once.
//!
//! *In:* numbers of a domain, or [`Eight`] of them. *Out:* the results of each operation. *Holds:* each lane of eight has the
//! result of the number's operation.

use crate::domain::{Block, Number, NumberBlock, WIDTH};

/// A number, or several. Operations are those of [`Number`].
pub(crate) trait Field: Copy {
    /// The nearest number, in each lane.
    fn constant(value: f64) -> Self;
    /// `a + b`
    fn add(self, other: Self) -> Self;
    /// `a - b`
    fn sub(self, other: Self) -> Self;
    /// `a b`
    fn mul(self, other: Self) -> Self;
    /// `a / b`
    fn div(self, other: Self) -> Self;
}

impl<N: Number> Field for N {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        N::from_f64(value)
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Number::add(self, other)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Number::sub(self, other)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Number::mul(self, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Number::div(self, other)
    }
}

/// A number in each of eight lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight<N: Number>(N::Block);

impl<N: Number> Eight<N> {
    /// One number in all lanes.
    #[inline(always)]
    pub(crate) fn splat(number: N) -> Self {
        Self(Block::splat(number))
    }

    /// The numbers from a place on. Beyond the end, it is the last one.
    #[inline(always)]
    pub(crate) fn from(numbers: &[N], start: usize) -> Self {
        Self(Block::of(&window(numbers, start)))
    }

    /// The numbers nearest to the values from a place on.
    #[inline(always)]
    pub(crate) fn of_values(values: &[f64], start: usize) -> Self {
        Self(NumberBlock::of_values(&window(values, start)))
    }

    /// Writes as many numbers as there is room for.
    #[inline(always)]
    pub(crate) fn store(self, to: &mut [N]) {
        for (lane, to) in to.iter_mut().enumerate().take(WIDTH) {
            *to = self.0.get(lane);
        }
    }

    /// The product, where [`Number`]'s operations have the same names.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        Field::mul(self, other)
    }

    /// `1 / a`
    #[inline(always)]
    pub(crate) fn reciprocal(self) -> Self {
        Field::div(Self::constant(1.0), self)
    }

    /// Fills numbers, eight at a time: `numbers` gets the place of the first.
    #[inline(always)]
    pub(crate) fn fill(to: &mut [N], numbers: impl Fn(usize) -> Self) {
        for start in (0..to.len()).step_by(WIDTH) {
            numbers(start).store(&mut to[start..]);
        }
    }
}

#[inline(always)]
fn window<T: Copy + Default>(all: &[T], start: usize) -> [T; WIDTH] {
    let from = all.get(start..).unwrap_or_default();
    if let Some(whole) = from.first_chunk() {
        return *whole;
    }
    let mut out = [from.last().copied().unwrap_or_default(); WIDTH];
    out[..from.len()].copy_from_slice(from);
    out
}

impl<N: Number> Field for Eight<N> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::splat(N::from_f64(value))
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.add(&other.0))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.sub(&other.0))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.mul(&other.0))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(self.0.div(&other.0))
    }
}
