//! Pictures and how far they are apart.
//!
//! *In:* two [`Picture`]s. *Out:* error figures.

#[cfg(feature = "flip")]
mod flip;
mod picture;
mod range;
mod verdict;

#[cfg(feature = "flip")]
pub use flip::flip;
pub use picture::Picture;
pub use range::Range;
pub use verdict::{Contributed, FaultCount, Judge, Verdict, Worst, shares, ulp_f32};
