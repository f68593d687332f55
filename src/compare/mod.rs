//! Pictures and how far they are apart.
//!
//! *In:* two [`Picture`]s. *Out:* error figures.

#[cfg(feature = "cli")]
mod flip;
mod picture;
mod range;
mod verdict;

#[cfg(feature = "cli")]
pub use flip::flip;
pub use picture::Picture;
pub use range::Range;
pub use verdict::{Contributed, FaultCount, Judge, Verdict, Worst, shares, ulp_f32};
