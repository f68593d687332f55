//! [`NumberBlock`]: the operations of [`Number`] on eight lanes at once.
//!
//! *In:* blocks of eight numbers. *Out:* blocks of eight results.
//!
//! *Holds:* an operation on a block yields the result of [`Number`]'s in each lane. A domain whose numbers have parts
//! may define its own operations on its blocks.

use super::Number;
use crate::domain::{Block, Element, WIDTH};

/// The result of comparing two blocks.
pub type Answers<N> = <<N as Number>::Int as Element>::Block;

/// Eight numbers. Methods without a comment are [`Number`]'s of that name, in each lane.
pub trait NumberBlock<N: Number>: Block<N> {
    /// Whether the operations are the block's own, instead of [`Number`]'s lane by lane.
    const OWN: bool = false;
    /// Runs a loop over blocks, compiled for the vector unit of the block's own operations. Returns `None` if the
    /// machine has none.
    #[inline(always)]
    fn if_vectorized<R>(work: impl FnOnce() -> R) -> Option<R> {
        Some(work())
    }
    /// Runs a loop over blocks, compiled for the machine's vector unit if that is faster.
    #[inline(always)]
    fn vectorized<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    /// The nearest number in each lane.
    #[inline(always)]
    fn of_values(values: &[f64; WIDTH]) -> Self {
        let mut out = Self::default();
        for (lane, value) in values.iter().enumerate() {
            out.set(lane, N::from_f64(*value));
        }
        out
    }
    /// Applies a function in each lane.
    #[inline(always)]
    fn map(&self, f: impl Fn(N) -> N) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, f(self.get(lane)));
        }
        out
    }
    /// Applies a function of two operands in each lane.
    #[inline(always)]
    fn zip(&self, other: &Self, f: impl Fn(N, N) -> N) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, f(self.get(lane), other.get(lane)));
        }
        out
    }
    /// A comparison in each lane.
    #[inline(always)]
    fn answers(&self, other: &Self, f: impl Fn(N, N) -> N::Int) -> Answers<N> {
        let mut out = Answers::<N>::default();
        for lane in 0..WIDTH {
            out.set(lane, f(self.get(lane), other.get(lane)));
        }
        out
    }
    /// The block in the type for built-in functions.
    #[inline(always)]
    fn widen(&self) -> <N::Wide as Element>::Block {
        let mut out = <N::Wide as Element>::Block::default();
        for lane in 0..WIDTH {
            out.set(lane, self.get(lane).widen());
        }
        out
    }
    /// The single rounding at the end of a built-in function.
    #[inline(always)]
    fn narrow(wide: &<N::Wide as Element>::Block) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, N::narrow(wide.get(lane)));
        }
        out
    }
    /// A sum, from left to right; with an envelope, in any order.
    #[inline(always)]
    fn sum(count: usize, term: impl Fn(usize) -> Self) -> Self {
        if N::HAS_INTERVALS || N::SUMS_BY_CHOICE {
            let mut out = Self::default();
            for lane in 0..WIDTH {
                out.set(lane, N::sum((0..count).map(|place| term(place).get(lane))));
            }
            return out;
        }
        let mut sum = if count == 0 { Self::default() } else { term(0) };
        for place in 1..count {
            sum = sum.add(&term(place));
        }
        sum
    }
    /// `a + b`
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self.zip(other, N::add)
    }
    /// `a - b`
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.zip(other, N::sub)
    }
    /// `a * b`
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        self.zip(other, N::mul)
    }
    /// `a / b`
    #[inline(always)]
    fn div(&self, other: &Self) -> Self {
        self.zip(other, N::div)
    }
    /// §8.3
    #[inline(always)]
    fn min(&self, other: &Self) -> Self {
        self.zip(other, N::min)
    }
    /// §8.3
    #[inline(always)]
    fn max(&self, other: &Self) -> Self {
        self.zip(other, N::max)
    }
    /// §8.2
    #[inline(always)]
    fn pow(&self, exponent: &Self) -> Self {
        self.zip(exponent, N::pow)
    }
    /// `-a`
    #[inline(always)]
    fn neg(&self) -> Self {
        self.map(N::neg)
    }
    /// §8.3
    #[inline(always)]
    fn abs(&self) -> Self {
        self.map(N::abs)
    }
    /// `a a`
    #[inline(always)]
    fn square(&self) -> Self {
        self.map(N::square)
    }
    /// §8.3
    #[inline(always)]
    fn floor(&self) -> Self {
        self.map(N::floor)
    }
    /// §8.3
    #[inline(always)]
    fn fract(&self) -> Self {
        self.map(N::fract)
    }
    /// §8.2
    #[inline(always)]
    fn sqrt(&self) -> Self {
        self.map(N::sqrt)
    }
    /// §8.2
    #[inline(always)]
    fn inversesqrt(&self) -> Self {
        self.map(N::inversesqrt)
    }
    /// §8.2
    #[inline(always)]
    fn exp(&self) -> Self {
        self.map(N::exp)
    }
    /// §8.2
    #[inline(always)]
    fn exp2(&self) -> Self {
        self.map(N::exp2)
    }
    /// §8.2
    #[inline(always)]
    fn log(&self) -> Self {
        self.map(N::log)
    }
    /// §8.2
    #[inline(always)]
    fn log2(&self) -> Self {
        self.map(N::log2)
    }
    /// §8.1
    #[inline(always)]
    fn sinh(&self) -> Self {
        self.map(N::sinh)
    }
    /// §8.1
    #[inline(always)]
    fn cosh(&self) -> Self {
        self.map(N::cosh)
    }
    /// §8.1
    #[inline(always)]
    fn tanh(&self) -> Self {
        self.map(N::tanh)
    }
    /// §8.1
    #[inline(always)]
    fn asinh(&self) -> Self {
        self.map(N::asinh)
    }
    /// §8.1
    #[inline(always)]
    fn acosh(&self) -> Self {
        self.map(N::acosh)
    }
    /// §8.1
    #[inline(always)]
    fn atanh(&self) -> Self {
        self.map(N::atanh)
    }
    /// [`Number::unit_scale`]
    #[inline(always)]
    fn unit_scale(&self) -> Self {
        self.map(N::unit_scale)
    }
    /// [`Number::scaled`]
    #[inline(always)]
    fn scaled(&self, scale: &Self) -> Self {
        self.zip(scale, N::scaled)
    }
    /// [`Number::limited`]
    #[inline(always)]
    fn limited(&self, least: &Self, most: &Self) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, self.get(lane).limited(least.get(lane), most.get(lane)));
        }
        out
    }
    /// [`Number::cosine_at_most`]
    #[inline(always)]
    fn cosine_at_most(&self) -> Self {
        self.map(N::cosine_at_most)
    }
    /// §8.3
    #[inline(always)]
    fn mix(&self, y: &Self, a: &Self) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, self.get(lane).mix(y.get(lane), a.get(lane)));
        }
        out
    }
    /// `a < b`
    #[inline(always)]
    fn less(&self, other: &Self) -> Answers<N> {
        self.answers(other, N::less)
    }
    /// `a <= b`
    #[inline(always)]
    fn less_equal(&self, other: &Self) -> Answers<N> {
        self.answers(other, N::less_equal)
    }
    /// `a == b`
    #[inline(always)]
    fn equal(&self, other: &Self) -> Answers<N> {
        self.answers(other, N::equal)
    }
    /// `c ? a : b`
    #[inline(always)]
    fn select(condition: &Answers<N>, yes: &Self, no: &Self) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, N::select(condition.get(lane), yes.get(lane), no.get(lane)));
        }
        out
    }
}

/// The operations lane by lane: for domains without block operations, and for the others on machines without a
/// suitable vector unit.
impl<N: Number> NumberBlock<N> for [N; WIDTH] {}
