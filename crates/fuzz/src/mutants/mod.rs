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

pub use crate::chance::Chance;
pub use changed::{Mutant, mutant};
pub use sources::{Whole, sources};
pub use verdict::{Verdict, verdict};
