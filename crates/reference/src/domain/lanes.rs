//! [`Lanes`]: an element in each of 64 lanes, in blocks of eight.
//!
//! *In:* the contents of the executor's registers. *Out:* the same, by lane and by block.
//!
//! *Holds:* a domain whose numbers are single machine numbers stores them in an array, and the compiler vectorizes the
//! loops. A domain whose numbers have parts may store each part separately ([`Element::Block`]).

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
    type Block: Block<Self>;
}

/// Eight elements. Lanes are counted modulo [`WIDTH`].
pub trait Block<T>: Copy + Default + Debug + Send + Sync + 'static {
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

impl<T: Copy + Default + Debug + Send + Sync + 'static> Block<T> for [T; WIDTH] {
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

/// An element in each of [`LANES`] lanes. Lane numbers are taken modulo that.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<T: Element>([T::Block; LANES / WIDTH]);

impl<T: Element> Lanes<T> {
    /// One value in all lanes.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([T::Block::splat(value); LANES / WIDTH])
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
            *block = T::Block::of(chunk);
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
    pub fn blocks(&self) -> &[T::Block; LANES / WIDTH] {
        &self.0
    }
    /// The blocks, mutable.
    #[inline(always)]
    pub fn blocks_mut(&mut self) -> &mut [T::Block; LANES / WIDTH] {
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
    pub fn block(&self, place: usize) -> T::Block {
        match self {
            Self::Lanes(lanes) => lanes.0[place % (LANES / WIDTH)],
            Self::One(value) => T::Block::splat(*value),
        }
    }
}

macro_rules! arrays {
    ($($element:ty),*) => { $(
        impl Element for $element {
            const PLAIN: bool = true;
            type Block = [Self; WIDTH];
        }
    )* };
}

arrays!(f64, f32, u32);
