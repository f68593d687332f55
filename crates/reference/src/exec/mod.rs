//! The executor: compiles a stage's HIR to register code that runs 64 lanes at once.
//!
//! *In:* a linked [`Program`](glisten_front::link::Program). *Out:* [`Code`], the instructions of one stage,
//! independent of the domain, and [`Machine`]s that run it in a [`Domain`](super::domain::Domain), one per thread.
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
//! Calls are inlined. What depends only on constants and uniforms runs once per draw (the preamble); each other
//! scalar is a register of 64 lanes. Arithmetic ignores the mask: it is total, so inactive lanes may compute
//! anything. Lanes diverge at branches through masks, and a block with an empty mask is skipped. Values are copied
//! only where lanes diverge: see `compile`.
//!
//! # Performance
//!
//! `cargo bench --bench exec` times a tile of the Blinn-Phong sphere and the whole sphere in each domain. In a
//! sampled profile of the sphere in f64, a quarter is `pow`, with a call for each lane; a quarter the loop over
//! instructions with its additions and products; a sixth `normalize` and the other built-in functions of vectors; and
//! a quarter the surrounding pipeline. In the envelope, a quarter is `normalize` (three roots and three quotients per
//! lane, two of each for the bounds), and the rest is spread over products and sums: an operation is some forty
//! vector instructions on blocks of eight lanes ([`NumberBlock`](super::domain::NumberBlock)), compiled for AVX2 if
//! that is available.
//! Lessons: values that are the same in all lanes are computed once (the counter of a loop over lights, and the
//! uniforms that it selects). Built-in functions of vectors must not reserve room for 16 arguments. Combining
//! products with sums, and reading uniforms as single numbers, keep the working set in the first-level cache. The
//! closures of the loops over lanes must be inlined, so this crate has one codegen unit in release builds (a quarter
//! of the time). Code for AVX2 must be inlined, too: closures can be; the standard library's `array::from_fn`, and a
//! function passed by name, are not. The compiler does not vectorize a block whose address has been taken, so lanes
//! that are computed again work on copies.
//! Refuted: compiling the whole loop over instructions for AVX2. Not all of it is inlined, and it takes a third
//! longer; in f64, `pow` is a call anyway, and the rest waits for the cache.
//!
//! *Holds:* a run never panics and always ends, for every program: indices are clamped, integer division by zero is
//! defined ([`Integer`](super::domain::Integer)), and loops end at [`LOOP_BUDGET`].

mod code;
mod compile;
mod composite;
mod compute;
mod corrected_run;
mod cost;
mod count;
mod emitting;
mod exactly;
mod explore;
mod follow;
mod guess;
mod identity;
mod inst;
mod lookup;
mod machine;
mod memory;
mod mute;
mod muted_run;
mod noise;
mod note;
mod observe;
mod registers;
mod run;
mod short_lookup;
mod show;
mod step;
mod streams;
#[cfg(test)]
mod tests;
mod ways;

pub use code::{Code, Form};
pub use exactly::Exactly;
pub(crate) use guess::{Guess, Numbers, Place};
pub use guess::{UndefinedKind, UndefinedThing};
pub(crate) use identity::hashed;
pub use machine::{LOOP_BUDGET, Machine, Purpose};
pub use mute::{Muted, Operation};
pub use note::{Note, NoteKind, Noted, NotedScalar};
pub use observe::{Event, Fate, Invoked, Kind, Observer, Order, Piece, Values, What};
pub use step::Step;
pub use streams::Stream;

/// The number of invocations that run at once: a tile of 8x8 pixels (quad by quad), or 64 vertices.
///
/// Lanes `4q` to `4q + 3` are a quad: x0y0, x1y0, x0y1, x1y1, where y0 is the row *above* y1 in the picture (rows of a
/// picture are stored top row first). OpenGL's y points up, so `dFdy` is the value at y0 minus that at y1:
/// [`DFDY_SIGN`].
pub const LANES: usize = super::domain::LANES;

/// The factor from `value(y1) - value(y0)` to `dFdy`: see [`LANES`].
pub const DFDY_SIGN: f64 = -1.0;

/// A set of lanes: bit `i` is lane `i`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Mask(pub u64);

impl Mask {
    /// No lanes.
    pub const NONE: Self = Self(0);
    /// All lanes.
    pub const ALL: Self = Self(u64::MAX);

    /// The first `count` lanes.
    pub fn first(count: usize) -> Self {
        Self(if count >= LANES { u64::MAX } else { (1 << count) - 1 })
    }

    /// Whether the set contains the lane.
    pub fn contains(self, lane: usize) -> bool {
        lane < LANES && self.0 >> lane & 1 == 1
    }

    /// Whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The lanes of the set, in ascending order.
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
