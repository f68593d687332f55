//! The executor: a stage's HIR compiled to register code that runs 64 lanes at once.
//!
//! *In:* a linked [`Program`](glisten_front::link::Program). *Out:* [`Code`], instructions for one stage that no domain is part
//! of, and [`Machine`]s that run it in a [`Domain`](super::domain::Domain), one a thread.
//!
//! ```text
//! let code = Code::compile(&program, Stage::Fragment)?;
//! let mut machine = Machine::<F64>::new(&code, &uniforms, &textures);
//! if let Some(lanes) = machine.float_input(varying, 0) { lanes.set(3, 0.25); }
//! machine.run(live, helpers);
//! let red = machine.float_output(color, 0);
//! ```
//!
//! # How it runs
//!
//! Calls are inlined; what hangs on constants and uniforms alone runs once a draw (the preamble); each other scalar is a
//! register of 64 lanes. Arithmetic ignores the mask: it is total, so inactive lanes may compute anything. Lanes part at
//! branches by masks, and a block whose mask is empty is jumped over. Nothing is copied but where lanes part: see
//! `compile`.
//!
//! # Where the time goes
//!
//! `cargo bench --bench exec` times a tile of the Blinn-Phong sphere and the whole sphere in each domain. In a sampled
//! profile of the sphere in f64 a quarter is `pow`, a call for each lane; a quarter the loop over instructions with its
//! additions and products; a sixth `normalize` and the other built-ins of vectors; a quarter the pipeline around.
//! In the envelope a quarter is `normalize` (three roots and three quotients a lane, two of each for the ends), the rest
//! spread over products and sums: an operation is some forty vector instructions on blocks of eight lanes
//! ([`Block`](super::domain::Block)), compiled for AVX2 where that is there.
//! Lessons: what is the same in all lanes is computed once (the counter of a loop over lights, and what it picks from
//! uniforms); built-ins of vectors must not keep room for 16 arguments whatever they have; joining products with sums and
//! reading uniforms as single numbers keep the working set in the first-level cache; the closures of the loops over lanes
//! must be inlined, so glisten is compiled as one unit in release (a quarter of the time).
//! What is to be compiled for AVX2 must be inlined, too: closures may be, the library's `array::from_fn` is not, and a
//! function's name in a closure's place is not. A block whose address anybody has taken is not made a vector of: what is
//! done once more takes copies.
//! Refuted: the whole loop over instructions compiled for AVX2. Not all of it is inlined, and it takes a third longer; in
//! f64 `pow` is a call anyway, and the rest waits for the cache.
//!
//! *Holds:* a run never panics and always ends, whatever the program does: indices are clamped into range, integer
//! division by zero is defined ([`Integer`](super::domain::Integer)), loops stop at [`LOOP_BUDGET`].

mod code;
mod compile;
mod composite;
mod compute;
mod explore;
mod inst;
mod lookup;
mod machine;
mod memory;
mod mute;
mod muted_run;
mod observe;
mod paths;
mod registers;
mod run;
mod show;
#[cfg(test)]
mod tests;

pub use code::Code;
pub use machine::{LOOP_BUDGET, Machine, Purpose};
pub use mute::{Muted, Operation};
pub use observe::{Event, Kind, Observer, Order, Piece, Values, What};

/// How many invocations run at once: a tile of 8x8 pixels (quad by quad), or 64 vertices.
///
/// Lanes `4q` to `4q + 3` are a quad: x0y0, x1y0, x0y1, x1y1, where y0 is the row *above* y1 in the picture (rows of a
/// picture are stored top row first). OpenGL's y points up, so `dFdy` is the value at y0 minus that at y1:
/// [`DFDY_SIGN`].
pub const LANES: usize = super::domain::LANES;

/// What `value(y1) - value(y0)` is multiplied by to give `dFdy`: see [`LANES`].
pub const DFDY_SIGN: f64 = -1.0;

/// A set of lanes: bit `i` is lane `i`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Mask(pub u64);

impl Mask {
    /// No lane.
    pub const NONE: Self = Self(0);
    /// Every lane.
    pub const ALL: Self = Self(u64::MAX);

    /// The first `count` lanes.
    pub fn first(count: usize) -> Self {
        Self(if count >= LANES { u64::MAX } else { (1 << count) - 1 })
    }

    /// Whether the lane is in it.
    pub fn contains(self, lane: usize) -> bool {
        lane < LANES && self.0 >> lane & 1 == 1
    }

    /// Whether no lane is in it.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The lanes in it, in order.
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            (rest != 0).then(|| {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                lane
            })
        })
    }
}
