//! The differences between two pictures.
//!
//! *In:* two [`Picture`](crate::picture::Picture)s of the same scene. *Out:* error figures and a [`Verdict`].

#[cfg(feature = "flip")]
mod flip;
mod verdict;

#[cfg(feature = "flip")]
pub use flip::flip;
pub use verdict::{Conclusion, Contributed, Criterion, FaultCount, Verdict, Worst, shares, ulp_f32};
