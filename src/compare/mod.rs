//! Pictures and the differences between them.
//!
//! *In:* two [`Picture`]s of the same scene. *Out:* error figures and a [`Verdict`].

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
