//! [`Lanes`]: a number in each of 64 lanes, kept in blocks of eight, and what can be done to a block at once.
//!
//! *In:* what the executor's registers hold. *Out:* the same operations as [`Number`]'s, on eight lanes.
//!
//! *Holds:* an operation on a block gives in each lane what [`Number`]'s gives. A domain whose numbers are one machine
//! number each keeps them in an array and says no more: the compiler makes vectors of the loops. One whose numbers have
//! parts keeps each part by itself ([`Element::Few`]) and brings operations of its own.

use super::Number;
use std::fmt::Debug;

/// How many lanes there are.
pub const LANES: usize = 64;

/// How many lanes a block has: enough for every vector unit.
pub const WIDTH: usize = 8;

/// What a lane holds.
pub trait Element: Copy + Default + Debug + Send + Sync + 'static {
    /// Whether it is one number of the machine: then a loop over lanes is a few vector instructions.
    const PLAIN: bool = false;
    /// Eight of them.
    type Few: Few<Self>;
}

/// Eight elements. Lanes are counted modulo [`WIDTH`].
pub trait Few<T>: Copy + Default + Debug + Send + Sync + 'static {
    /// The same in all lanes.
    fn splat(value: T) -> Self;
    /// One in each lane.
    fn of(elements: &[T; WIDTH]) -> Self;
    /// What a lane holds.
    fn get(&self, lane: usize) -> T;
    /// Changes it.
    fn set(&mut self, lane: usize, value: T);
    /// With the lanes of the other that the mask names.
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

/// What comparing two blocks gives.
pub type Answers<N> = <<N as Number>::Int as Element>::Few;

/// Eight numbers. Methods without a comment are [`Number`]'s of that name, in each lane.
pub trait Block<N: Number>: Few<N> {
    /// Whether the operations are the block's own, not [`Number`]'s lane by lane.
    const OWN: bool = false;
    /// Runs a loop over blocks, compiled for the vector unit that operations of the block's own are for; nothing where the
    /// machine has none.
    #[inline(always)]
    fn if_vectorized<R>(work: impl FnOnce() -> R) -> Option<R> {
        Some(work())
    }
    /// Runs a loop over blocks, compiled for the vector unit that the machine has where that pays.
    #[inline(always)]
    fn vectorized<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    /// A function in each lane.
    #[inline(always)]
    fn map(&self, f: impl Fn(N) -> N) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, f(self.get(lane)));
        }
        out
    }
    /// A function of two in each lane.
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
    /// To compute a built-in function in.
    #[inline(always)]
    fn widen(&self) -> <N::Wide as Element>::Few {
        let mut out = <N::Wide as Element>::Few::default();
        for lane in 0..WIDTH {
            out.set(lane, self.get(lane).widen());
        }
        out
    }
    /// The one rounding at a built-in function's end.
    #[inline(always)]
    fn narrow(wide: &<N::Wide as Element>::Few) -> Self {
        let mut out = Self::default();
        for lane in 0..WIDTH {
            out.set(lane, N::narrow(wide.get(lane)));
        }
        out
    }
    /// A sum from left to right; with an envelope in any order.
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

/// Lane by lane: of each domain without operations on blocks of its own, and of the others where a machine has no unit for
/// those.
impl<N: Number> Block<N> for [N; WIDTH] {}

/// An element in each of [`LANES`] lanes, which are counted modulo that.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<T: Element>([T::Few; LANES / WIDTH]);

impl<T: Element> Lanes<T> {
    /// The same in all lanes.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([T::Few::splat(value); LANES / WIDTH])
    }
    /// What a lane holds.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> T {
        self.0[lane / WIDTH % (LANES / WIDTH)].get(lane)
    }
    /// Changes it.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: T) {
        self.0[lane / WIDTH % (LANES / WIDTH)].set(lane, value);
    }
    /// What all lanes hold, in order.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = T> {
        (0..LANES).map(|lane| self.get(lane))
    }
    /// Changes all lanes to these.
    #[inline(always)]
    pub fn load(&mut self, elements: &[T; LANES]) {
        let (chunks, _) = elements.as_chunks();
        for (block, chunk) in self.0.iter_mut().zip(chunks) {
            *block = T::Few::of(chunk);
        }
    }
    /// Changes the first lanes, one for each element.
    #[inline(always)]
    pub fn assign(&mut self, elements: impl IntoIterator<Item = T>) {
        for (lane, element) in (0..LANES).zip(elements) {
            self.set(lane, element);
        }
    }
    /// Changes all lanes.
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
    /// The blocks, to be changed.
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
    /// The number in a lane; lanes are counted modulo [`LANES`].
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
