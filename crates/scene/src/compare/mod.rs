//! How far two pictures are apart.
//!
//! *In:* two [`Picture`](crate::picture::Picture)s. *Out:* error figures.

#[cfg(feature = "flip")]
mod flip;
mod verdict;

#[cfg(feature = "flip")]
pub use flip::flip;
pub use verdict::{Contributed, FaultCount, Judge, Verdict, Worst, shares, ulp_f32};
