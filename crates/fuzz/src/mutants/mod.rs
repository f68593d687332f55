//! Mutants: sources with one change of the kind that people make.
//!
//! ```text
//!  source ──► tokens ──► changed     one of the table of changes, at a place by chance ──► Mutant
//!                                                                                          │
//!  verdict: glisten's first error ◄────────────────────────────────────────────────────────┤
//!           glslang's, where it is installed ◄─────────────────────────────────────────────┘
//! ```
//!
//! *In:* texts, and a number from which chance follows. *Out:* [`Mutant`]s, and a [`Verdict`] on each. *Holds:* the same number gives
//! the same mutants on every machine. Most mutants are wrong; some are right, or right and different.

mod changed;
mod sources;
mod tokens;
mod verdict;

pub use changed::{Mutant, mutant};
pub use sources::{Whole, sources};
pub use verdict::{Verdict, verdict};

/// Numbers by chance: SplitMix64.
#[derive(Clone, Debug)]
pub struct Chance(u64);

impl Chance {
    /// The numbers that follow from this one.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number below `limit`; 0 if that is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^= mixed >> 31;
        if limit == 0 { 0 } else { (mixed % limit as u64) as usize }
    }

    /// One of several; none of none.
    pub fn one<'a, T>(&mut self, of: &'a [T]) -> Option<&'a T> {
        of.get(self.below(of.len()))
    }
}
