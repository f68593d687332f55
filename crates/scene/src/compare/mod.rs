//! Pictures and the differences between them.
//!
//! *In:* two [`Picture`]s of the same scene. *Out:* error figures and a [`Verdict`].

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
