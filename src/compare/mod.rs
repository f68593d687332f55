//! Pictures and how far they are apart.
//!
//! *In:* two [`Picture`]s. *Out:* error figures.

#[cfg(feature = "cli")]
mod flip;
mod picture;
mod verdict;

#[cfg(feature = "cli")]
pub use flip::flip;
pub use picture::Picture;
pub use verdict::{Judge, Verdict, Worst, ulp_f32};
