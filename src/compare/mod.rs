//! Pictures and how far they are apart.
//!
//! *In:* two [`Picture`]s. *Out:* error figures.

mod picture;
mod verdict;

pub use picture::Picture;
pub use verdict::{Judge, Verdict, Worst, ulp_f32};
