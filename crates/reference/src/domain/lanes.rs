//! [`Lanes`]: a number in each of 64 lanes, in blocks of eight, with operations on a whole block.
//!
//! *In:* the contents of the executor's registers. *Out:* the operations of [`Number`] on eight lanes.
//!
//! *Holds:* an operation on a block yields the result of [`Number`]'s in each lane. A domain whose numbers are single
//! machine numbers stores them in an array, and the compiler vectorizes the loops. A domain whose numbers have parts
//! stores each part separately ([`Element::Few`]) and defines its own operations.

use super::Number;
use std::fmt::Debug;

/// The number of lanes.
pub const LANES: usize = 64;

/// The number of lanes in a block, which is enough for every vector unit.
pub const WIDTH: usize = 8;

/// The value in a lane.
pub trait Element: Copy + Default + Debug + Send + Sync + 'static {
    /// Whether it is a single machine number. Then a loop over lanes is a few vector instructions.
    const PLAIN: bool = false;
    /// Eight elements.
    type Few: Few<Self>;
}

/// Eight elements. Lanes are counted modulo [`WIDTH`].
pub trait Few<T>: Copy + Default + Debug + Send + Sync + 'static {
    /// One value in all lanes.
    fn splat(value: T) -> Self;
    /// One value for each lane.
    fn of(elements: &[T; WIDTH]) -> Self;
    /// The value in a lane.
    fn get(&self, lane: usize) -> T;
    /// Sets the value in a lane.
    fn set(&mut self, lane: usize, value: T);
    /// The block with the lanes in the mask replaced by those of `by`.
    #[inline(always)]
    fn replaced(&self, by: &Self, mask: u8) -> Self {
        let mut out = *self;
        for lane in 0..WIDTH {
            out.set(lane, if mask >> lane & 1 == 1 { by.get(lane) } else { self.get(lane) });
        }
        out
    }
}

impl<T: Copy + Default + Debug + Send + Sync + 'static> Few<T> for [T; WIDTH] {
    #[inline(always)]
    fn splat(value: T) -> Self {
        [value; WIDTH]
    }
    #[inline(always)]
    fn of(elements: &[T; WIDTH]) -> Self {
        *elements
    }
    #[inline(always)]
    fn get(&self, lane: usize) -> T {
        self[lane % WIDTH]
    }
    #[inline(always)]
    fn set(&mut self, lane: usize, value: T) {
        self[lane % WIDTH] = value;
    }
}

/// The result of comparing two blocks.
pub type Answers<N> = <<N as Number>::Int as Element>::Few;

/// Eight numbers. Methods without a comment are [`Number`]'s of that name, in each lane.
pub trait Block<N: Number>: Few<N> {
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
    fn widen(&self) -> <N::Wide as Element>::Few {
        let mut out = <N::Wide as Element>::Few::default();
        for lane in 0..WIDTH {
            out.set(lane, self.get(lane).widen());
        }
        out
    }
    /// The single rounding at the end of a built-in function.
    #[inline(always)]
    fn narrow(wide: &<N::Wide as Element>::Few) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, N::narrow(wide.get(lane)));
        }
        out
    }
    /// A sum, from left to right; with an envelope, in any order.
    #[inline(always)]
    fn sum(count: usize, term: impl Fn(usize) -> Self) -> Self {
        if N::OPEN {
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
impl<N: Number> Block<N> for [N; WIDTH] {}

/// An element in each of [`LANES`] lanes. Lane numbers are taken modulo that.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<T: Element>([T::Few; LANES / WIDTH]);

impl<T: Element> Lanes<T> {
    /// One value in all lanes.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([T::Few::splat(value); LANES / WIDTH])
    }
    /// The value in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> T {
        self.0[lane / WIDTH % (LANES / WIDTH)].get(lane)
    }
    /// Sets the value in a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: T) {
        self.0[lane / WIDTH % (LANES / WIDTH)].set(lane, value);
    }
    /// The values of all lanes, in order.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = T> {
        (0..LANES).map(|lane| self.get(lane))
    }
    /// Sets all lanes.
    #[inline(always)]
    pub fn load(&mut self, elements: &[T; LANES]) {
        let (chunks, _) = elements.as_chunks();
        for (block, chunk) in self.0.iter_mut().zip(chunks) {
            *block = T::Few::of(chunk);
        }
    }
    /// Sets the first lanes, one for each element.
    #[inline(always)]
    pub fn assign(&mut self, elements: impl IntoIterator<Item = T>) {
        for (lane, element) in (0..LANES).zip(elements) {
            self.set(lane, element);
        }
    }
    /// Replaces the value in each lane.
    #[inline(always)]
    pub fn update(&mut self, f: impl Fn(usize, T) -> T) {
        for lane in 0..LANES {
            self.set(lane, f(lane, self.get(lane)));
        }
    }
    /// The blocks, in order.
    #[inline(always)]
    pub fn blocks(&self) -> &[T::Few; LANES / WIDTH] {
        &self.0
    }
    /// The blocks, mutable.
    #[inline(always)]
    pub fn blocks_mut(&mut self) -> &mut [T::Few; LANES / WIDTH] {
        &mut self.0
    }
}

impl<T: Element> Default for Lanes<T> {
    fn default() -> Self {
        Self::splat(T::default())
    }
}

/// A scalar in all lanes.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a, T: Element> {
    /// A number in each lane.
    Lanes(&'a Lanes<T>),
    /// One number for all lanes.
    One(T),
}

impl<T: Element> Source<'_, T> {
    /// The number in a lane. Lane numbers are taken modulo [`LANES`].
    #[inline(always)]
    pub fn at(&self, lane: usize) -> T {
        match self {
            Self::Lanes(lanes) => lanes.get(lane),
            Self::One(value) => *value,
        }
    }

    /// A block of lanes.
    #[inline(always)]
    pub fn block(&self, place: usize) -> T::Few {
        match self {
            Self::Lanes(lanes) => lanes.0[place % (LANES / WIDTH)],
            Self::One(value) => T::Few::splat(*value),
        }
    }
}

macro_rules! arrays {
    ($($element:ty: $plain:literal),*) => { $(
        impl Element for $element {
            const PLAIN: bool = $plain;
            type Few = [Self; WIDTH];
        }
    )* };
}

arrays!(f64: true, f32: true, u32: true, super::EnvelopeInt: false, super::ShadowInt: false);

impl<const INSIDE: bool> Element for super::Shadowed<INSIDE> {
    type Few = [Self; WIDTH];
}
